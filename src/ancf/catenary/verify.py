"""Verification of a form: the whole line in equilibrium against what was prescribed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import ancf

from ..arrays import FloatArray
from ..errors import ModelError
from ..model import checks
from ..model.points import Point
from .assemble import MADE, Assembled
from .forms.route_form import RouteForm
from .forms.shape import Strung


@dataclass(frozen=True, slots=True)
class Verified:
    """Largest differences between a line at rest and its form.

    Attributes
    ----------
    state : State
        The line at rest.
    height, place : float, m
        Heights of the contact wire at the droppers' clamps; positions of all nodes of all wires.
    tension : float, N
        Components along the track of the tensions in the ends of both wires.
    load : float, N
        Forces of the droppers.

    """

    state: ancf.State
    height: float
    place: float
    tension: float
    load: float


def verify(overhead: Assembled) -> Verified:
    """Bring a line to rest and compare; no dropper may be broken.

    Raises
    ------
    ModelError
        It is no model of a line, or that of a route.

    """
    found = checks.kind(overhead, "verify.overhead", Assembled, MADE, "Overhead").form
    if isinstance(found, RouteForm):
        raise ModelError("verify", "is for one tension length", "verify the form of each")
    every = (*overhead.wires, *overhead.stitches)
    wires = [wire for wire in every if wire is not None]
    state = ancf.equilibrium(overhead.model)
    placed = np.stack([wire.positions(state)[wire.shape.nodes.dropper] for wire in overhead.strung_contacts])
    low = placed[found.line.dropper_wire, np.arange(placed.shape[1])]
    droppers = [d for d in overhead.droppers if d is not None]
    ends = np.array([[state.position(p) for p in (d.a, d.b) if isinstance(p, Point)] for d in droppers])
    stretch = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) - found.dropper_natural
    clamps = low[:, 2] - found.lower[:, 2] + found.contact_height
    force = found.spring_stiffness * stretch
    if found.line.droppers.slack:
        force = np.maximum(force, 0.0)
    tensions = [
        end_force(state, wire, last) - wire.shape.wire.tension
        for wire in wires
        if not any(wire is stitch for stitch in overhead.stitches)
        for last in (False, True)
    ]
    return Verified(
        state=state,
        height=_largest(clamps - found.line.dropper_height),
        place=max(_largest(wire.positions(state) - wire.shape.position) for wire in wires),
        tension=_largest(np.array(tensions)),
        load=_largest(force - found.dropper_force),
    )


def end_force(state: ancf.State, wire: Strung, last: bool) -> float:
    """Component of a wire's tension along the track at one of its ends, N."""
    point = wire.end if last else wire.start
    slope = state.slope(point)
    return float(state.tension(point) * slope[0] / np.linalg.norm(slope))


def _largest(values: FloatArray) -> float:
    return float(np.max(np.abs(values), initial=0.0))
