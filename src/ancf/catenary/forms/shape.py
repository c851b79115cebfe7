"""WireShape: a wire of a line at rest, with the arc lengths that it has without tension."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

import ancf

from ...arrays import FloatArray, IntArray
from ...errors import ModelError
from ...model import checks
from ...model.bodies.beam import Beam
from ...model.points import Point
from ..lines.wire import Rayleigh, Wire
from .mesh import Nodes

#: Gauss points of the axial and bending integrals: exact for the quadratic energy of a wire under tension.
GAUSS = (3, 2)
#: By which the end of a wire may have gone along the track in the heat, m.
TRAVEL = 2.0


@dataclass(frozen=True, slots=True)
class WireShape:
    """A wire at rest.

    Attributes
    ----------
    wire : Wire
    nodes : Nodes
    arc : (n,) m
        Natural arc lengths at the nodes, from 0.
    position : (n, 3) m
        Positions of the nodes at rest.
    hinges : tuple of int
        Nodes at which the wire turns freely.

    """

    wire: Wire
    nodes: Nodes
    arc: FloatArray
    position: FloatArray
    hinges: tuple[int, ...] = ()

    def add_to(self, model: ancf.Model, name: str, rayleigh: Rayleigh | None = None) -> Strung:
        """Add the wire to a model; its nodes start at their positions at rest."""
        cuts = [0, *self.hinges, self.arc.size - 1]
        parts = [slice(a, b + 1) for a, b in pairwise(cuts)]
        names = [name] if len(parts) == 1 else [f"{name} {k + 1}" for k in range(len(parts))]
        section = self.wire.section(rayleigh)
        beams = [self._add(model, n, section, part) for n, part in zip(names, parts, strict=True)]
        for one, other in pairwise(beams):
            model.connect(one.end, other.start)
        return Strung(self, tuple(beams), np.array(cuts[:-1]))

    def _add(self, model: ancf.Model, name: str, section: ancf.Section, part: slice) -> Beam:
        position, arc = self.position[part], self.arc[part] - self.arc[part.start]
        straight = {"start": position[0], "end": position[-1]}
        beam = model.add_beam(
            name,
            section=section,
            **(straight if len(position) == 2 else {"path": position}),
            length=float(arc[-1]),
            nodes=arc,
            strain="material",
            natural_shape="straight",
            gauss=GAUSS,
        )
        beam.node_position[:] = position  # add_beam spreads the stretch evenly, off by millimetres
        return beam

    def moved(self, position: FloatArray) -> WireShape:
        """The shape for new positions of the nodes, with arc lengths that bring the marks to their places.

        Between two marks all natural lengths change by the same factor.
        """
        marks = self.nodes.marks
        factor = np.diff(self.nodes.x[marks]) / np.diff(position[marks, 0])
        cells = np.diff(self.arc) * np.repeat(factor, np.diff(marks))
        x_error = np.interp(self.nodes.x, self.nodes.x[marks], (self.nodes.x - position[:, 0])[marks])
        placed = position + np.outer(x_error, [1.0, 0.0, 0.0])
        return replace(self, arc=np.concatenate([[0.0], np.cumsum(cells)]), position=placed)


@dataclass(frozen=True, slots=True)
class Strung:
    """A wire in a model: one beam, or several joined by hinges.

    Attributes
    ----------
    shape : WireShape
    beams : tuple of Beam
    first : array of int
        Node of the wire at which each beam starts.

    """

    shape: WireShape
    beams: tuple[Beam, ...]
    first: IntArray

    @property
    def start(self) -> Point:
        """First point of the wire."""
        return self.beams[0].start

    @property
    def end(self) -> Point:
        """Last point of the wire."""
        return self.beams[-1].end

    def point(self, node: int) -> Point:
        """Point at a node of the wire."""
        return self.at(float(self.shape.arc[node]))

    def at(self, arc: float) -> Point:
        """Point at a natural arc length of the whole wire, m."""
        starts = self.shape.arc[self.first]
        k = max(int(np.searchsorted(starts, arc)) - 1, 0)
        return self.beams[k].at(arc - float(starts[k]))

    def arc_at(self, track: float) -> float:
        """Natural arc length at a track position at rest, m."""
        return float(np.interp(track, self.shape.position[:, 0], self.shape.arc))

    def positions(self, state: ancf.State) -> FloatArray:
        """Positions (n, 3) of all nodes of the wire, m."""
        parts = []
        for beam in self.beams:
            first = state.slots[beam.name][:, 0]
            parts.append(state.q[first[:, None] + np.arange(3)])
        return np.concatenate([part[int(k > 0) :] for k, part in enumerate(parts)])


def started(
    wire: Wire, nodes: Nodes, y: FloatArray, z: FloatArray, hinges: tuple[int, ...] = ()
) -> WireShape:
    """Shape through given places of all nodes with the natural lengths of a string under the tension."""
    position: FloatArray = np.stack([nodes.x, y, z], axis=1)
    chord = np.linalg.norm(np.diff(position, axis=0), axis=1)
    force = wire.tension * chord / np.diff(nodes.x)
    arc = np.concatenate([[0.0], np.cumsum(chord / (1.0 + force / wire.EA))])
    return WireShape(wire, nodes, arc, position, hinges)


def on_track(track: object, wires: list[Strung], where: str) -> float:
    """A track position, m; ModelError where no wire is. Heat moves ends along the track."""
    x = checks.number(track, f"overhead.{where}.track")
    places = [wire.shape.position[[0, -1], 0] for wire in wires]
    low, high = float(np.min(places)), float(np.max(places))
    if not low - TRAVEL <= x <= high + TRAVEL:
        what = f"is {x:g} m, the line reaches from {round(low, 3):g} to {round(high, 3):g} m"
        raise ModelError(f"overhead.{where}.track", what)
    return x
