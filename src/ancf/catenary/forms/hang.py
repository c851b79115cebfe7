"""One wire of a line in equilibrium, with what the other wires do to it taken from before."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

import ancf

from ...arrays import FloatArray, IntArray
from ..lines.cant import plumb_above
from ..lines.line import Line
from .along_track import add_sideways, curve_pull
from .rods import add_leans, along
from .shape import Strung, WireShape
from .ties import Ties


@dataclass(frozen=True, slots=True)
class Hung:
    """The wires on the way to their form.

    Attributes
    ----------
    line : Line
    contact, messenger : WireShape
    stitches : tuple of WireShape
        At the supports but the first and the last; may be empty.
    lift : (n,) N
        Vertical forces of the droppers between their clamps.
    arm : (supports, 3) N
        Of the steady arms on the contact wire.
    support, side : (supports,) N
        Upward and sideways forces of the supports on the messenger.
    ends : (stitches, 2, 3) N
        Of the messenger on the two ends of each stitch wire.
    give : (2, n) m/N
        What the contact wire and what the droppers hang from give too little at the clamps, on their meshes.
    error : float, m
        Largest distance of a prescribed place from where the point came to rest.
    auxiliary : WireShape or None
    long_lift : (m,) N
        Vertical forces of the droppers between messenger and auxiliary.
    long_give : (2, m) m/N
        What auxiliary and messenger give too little there.
    auxiliary_side : (supports,) N
        Sideways forces of the supports on the auxiliary.

    """

    line: Line
    contact: WireShape
    messenger: WireShape | None
    stitches: tuple[WireShape, ...]
    lift: FloatArray
    arm: FloatArray
    support: FloatArray
    side: FloatArray
    ends: FloatArray
    give: FloatArray
    error: float = np.inf
    auxiliary: WireShape | None = None
    long_lift: FloatArray = field(default_factory=lambda: np.zeros(0))
    long_give: FloatArray = field(default_factory=lambda: np.zeros((2, 0)))
    auxiliary_side: FloatArray = field(default_factory=lambda: np.zeros(0))

    @property
    def upper(self) -> FloatArray:
        """Nodes (n, 3) from which the droppers hang, m."""
        if self.auxiliary is not None:
            return self.auxiliary.position[self.auxiliary.nodes.dropper]
        if self.messenger is None:
            return np.zeros((0, 3))
        position = self.messenger.position[self.messenger.nodes.dropper]
        for k, shape in enumerate(self.stitches):
            position[self.line.dropper_stitch == k + 1] = shape.position[shape.nodes.dropper]
        return position

    @property
    def dropper(self) -> FloatArray:
        """Vectors (n, 3) of the droppers from node to node, up, m."""
        return self.short.vector

    @property
    def short(self) -> Ties:
        """The droppers of the contact wire."""
        low = self.contact.position[self.contact.nodes.dropper]
        return Ties(self.lift, self.upper - low, self.give, self.line.droppers, self.line.gravity)

    @property
    def long(self) -> Ties:
        """Those between messenger and auxiliary."""
        assert self.messenger is not None
        assert self.auxiliary is not None
        assert self.line.auxiliary is not None
        high = self.messenger.position[self.messenger.nodes.dropper]
        low = self.auxiliary.position[self.auxiliary.nodes.stitch]
        given = self.line.auxiliary.droppers, self.line.gravity
        return Ties(self.long_lift, high - low, self.long_give, *given)


def hang_contact(now: Hung) -> Hung:
    """The contact wire with its clamps at their heights, under droppers that lean to the messenger."""
    line, shape, nodes, inner = now.line, now.contact, now.contact.nodes, slice(1, -1)
    model, wire = _pulled(line, shape, "contact")
    model.hold(wire.start, position="yz")
    model.hold(wire.end, position="yz")
    weight = -np.outer(now.short.weight(line.droppers.clamp_contact), [0.0, 0.0, 1.0])
    _add_forces(model, wire, nodes.dropper, weight)
    target = shape.position[nodes.dropper].copy()
    target[:, 2] = line.dropper_height - now.give[0] * now.lift
    points = [wire.point(i) for i in nodes.dropper]
    hangers = along(target, 2, now.lift)
    hangers.add_to(model, points)
    add_leans(model, points, target, now.upper[:, 1], now.short.lean)
    held = shape.position[nodes.support[inner]].copy()
    held[:, 1] = line.stagger[inner]
    axes = [1, 2] if line.contact_support == "held" else [1]
    if 2 in axes:
        held[:, 2] = np.array(line.heights)[inner]
    else:
        _add_forces(model, wire, nodes.support[inner], carried(line, now.arm)[inner])
    arms = {axis: along(held, axis, now.arm[inner, axis]) for axis in axes}
    for rods in arms.values():
        rods.add_to(model, [wire.point(i) for i in nodes.support[inner]])
    state = ancf.equilibrium(model)
    position = wire.positions(state)
    arm = np.zeros_like(now.arm)
    for axis, rods in arms.items():
        arm[inner, axis] = rods.forces(state)
    if 2 not in axes:
        arm[:, 2] = carried(line, now.arm)[:, 2]
    lift = hangers.forces(state)
    height = position[nodes.dropper, 2] + now.give[0] * lift - line.dropper_height
    side = (position[nodes.support[inner]] - held)[:, axes]
    error = max(_largest(height), _largest(side), _misplaced(shape, position))
    return replace(now, contact=shape.moved(position), lift=lift, arm=arm, error=error)


def hang_messenger(now: Hung) -> Hung:
    """The messenger under the forces of droppers and stitch wires and all weights, held at its supports."""
    if now.messenger is None:
        return now
    line, shape, nodes, inner = now.line, now.messenger, now.messenger.nodes, slice(1, -1)
    model, wire = _pulled(line, shape, "messenger")
    model.hold(wire.start, position="yz")
    model.hold(wire.end, position="yz")
    if now.auxiliary is None:
        own = line.dropper_stitch < 0
        ties, low = now.short, now.contact.position[now.contact.nodes.dropper]
    else:
        ties, low = now.long, now.auxiliary.position[now.auxiliary.nodes.stitch]
        own = np.ones(len(low), dtype=bool)
    _add_forces(model, wire, nodes.dropper[own], ties.down[own])
    points = [wire.point(i) for i in nodes.dropper[own]]
    add_leans(model, points, shape.position[nodes.dropper[own]], low[own, 1], ties.lean[own])
    _add_forces(model, wire, nodes.stitch, -now.ends.reshape(-1, 3))
    held = shape.position[nodes.support[inner]].copy()
    held[:, 1], held[:, 2] = line.messenger_y[inner], (np.array(line.system_height) + line.heights)[inner]
    rods = [along(held, 1, now.side[inner]), along(held, 2, now.support[inner])]
    for group in rods:
        group.add_to(model, [wire.point(i) for i in nodes.support[inner]])
    state = ancf.equilibrium(model)
    position = wire.positions(state)
    side, support = (np.concatenate([[0.0], group.forces(state), [0.0]]) for group in rods)
    error = max(_largest((position[nodes.support[inner]] - held)[:, 1:]), _misplaced(shape, position))
    if now.auxiliary is not None:
        error = max(error, now.error)
    return replace(now, messenger=shape.moved(position), support=support, side=side, error=error)


def hang_auxiliary(now: Hung) -> Hung:
    """The auxiliary at its height below the messenger, under the droppers of the contact wire."""
    if now.auxiliary is None:
        return now
    line, shape, nodes, inner = now.line, now.auxiliary, now.auxiliary.nodes, slice(1, -1)
    assert line.auxiliary is not None
    assert now.messenger is not None
    short, long = now.short, now.long
    model, wire = _pulled(line, shape, "auxiliary")
    model.hold(wire.start, position="yz")
    model.hold(wire.end, position="yz")
    _add_forces(model, wire, nodes.dropper, short.down)
    below = now.contact.position[now.contact.nodes.dropper, 1]
    points = [wire.point(i) for i in nodes.dropper]
    add_leans(model, points, shape.position[nodes.dropper], below, short.lean)
    weight = -np.outer(long.weight(line.auxiliary.droppers.clamp_contact), [0.0, 0.0, 1.0])
    _add_forces(model, wire, nodes.stitch, weight)
    target = shape.position[nodes.stitch].copy()
    level = line.height_at(line.long_x) + line.auxiliary.height
    target[:, 2] = level - now.long_give[0] * now.long_lift
    points = [wire.point(i) for i in nodes.stitch]
    hangers = along(target, 2, now.long_lift)
    hangers.add_to(model, points)
    above = now.messenger.position[now.messenger.nodes.dropper, 1]
    add_leans(model, points, target, above, long.lean)
    held = shape.position[nodes.support[inner]].copy()
    held[:, 1] = plumb_above(line, line.auxiliary.height)[inner]
    arms = along(held, 1, now.auxiliary_side[inner])
    arms.add_to(model, [wire.point(i) for i in nodes.support[inner]])
    state = ancf.equilibrium(model)
    position = wire.positions(state)
    lift = hangers.forces(state)
    off = position[nodes.stitch, 2] + now.long_give[0] * lift - level
    side = np.concatenate([[0.0], arms.forces(state), [0.0]])
    error = max(now.error, _largest(off), _largest((position[nodes.support[inner]] - held)[:, 1]))
    error = max(error, _misplaced(shape, position))
    return replace(now, auxiliary=shape.moved(position), long_lift=lift, auxiliary_side=side, error=error)


def hang_stitches(now: Hung) -> Hung:
    """The stitch wires, whose ends are where the messenger is, under their droppers and weights."""
    error, ends = now.error, now.ends.copy()
    shapes = []
    for k, shape in enumerate(now.stitches):
        assert now.messenger is not None
        held = now.messenger.position[now.messenger.nodes.stitch[2 * k : 2 * k + 2]]
        shape, ends[k], off = _hang_stitch(now, k, shape, held)
        shapes.append(shape)
        error = max(error, off)
    return replace(now, stitches=tuple(shapes), ends=ends, error=error)


def _hang_stitch(
    now: Hung, k: int, shape: WireShape, held: FloatArray
) -> tuple[WireShape, FloatArray, float]:
    """Shape of one stitch wire, forces (2, 3) of the messenger on its ends, error."""
    model, wire = _pulled(now.line, shape, "stitch")
    own = now.line.dropper_stitch == k + 1
    _add_forces(model, wire, shape.nodes.dropper, now.short.down[own])
    points = [wire.point(i) for i in shape.nodes.dropper]
    below = now.contact.position[now.contact.nodes.dropper[own], 1]
    add_leans(model, points, shape.position[shape.nodes.dropper], below, now.short.lean[own])
    rods = [along(held, axis, now.ends[k, :, axis]) for axis in (1, 2)]
    for group in rods:
        group.add_to(model, [wire.start, wire.end])
    state = ancf.equilibrium(model)
    position = wire.positions(state)
    along_track = shape.wire.tension * np.array([-1.0, 1.0])
    force = np.stack([along_track, *(group.forces(state) for group in rods)], axis=1)
    error = max(_largest((position[[0, -1]] - held)[:, 1:]), _misplaced(shape, position))
    return shape.moved(position), force, error


def masses(line: Line, name: str) -> FloatArray:
    """Weights (n,) of the masses on a wire, N, in the order of the track."""
    return np.array([load.mass * line.gravity for load in line.loads_on(name)])


def carried(line: Line, arm: FloatArray) -> FloatArray:
    """Forces (supports, 3) of steady arms that rise at given angles on a wire that hangs free there, N."""
    force = np.zeros_like(arm)
    for k in range(1, len(arm) - 1):
        angle = line.arm(k).angle
        if angle is not None:
            pull = line.arm(k).sense(arm[k, 1]) * abs(arm[k, 1])  # an arm that pushes drives the wire down
            force[k, 2] = pull * np.tan(angle) - 0.5 * line.arm(k).mass * line.gravity
    return force


def _pulled(line: Line, shape: WireShape, name: str) -> tuple[ancf.Model, Strung]:
    """A model of a wire alone under its weight, its tension and curves, held along the track at its start."""
    model = ancf.Model(gravity=(0.0, 0.0, -line.gravity))
    wire = shape.add_to(model, "wire")
    model.hold(wire.start, position="x")
    model.add_force(wire.end, (shape.wire.tension, 0.0, 0.0))
    add_sideways(model, wire, curve_pull(line, shape, name))
    _add_forces(model, wire, shape.nodes.load, -np.outer(masses(line, name), [0.0, 0.0, 1.0]))
    return model, wire


def _add_forces(model: ancf.Model, wire: Strung, nodes: IntArray, force: FloatArray) -> None:
    """Forces (n, 3) in N at nodes of a wire."""
    for node, f in zip(nodes.tolist(), force, strict=True):
        if np.any(f):
            model.add_force(wire.point(node), f)


def _misplaced(shape: WireShape, position: FloatArray) -> float:
    marks = shape.nodes.marks
    return _largest(position[marks, 0] - shape.nodes.x[marks])


def _largest(values: FloatArray) -> float:
    return float(np.max(np.abs(values), initial=0.0))
