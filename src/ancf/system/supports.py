"""Supports of the model as held unknowns, local axes and given motions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..model.bodies.beam import Beam
from ..model.bodies.rigid import Body, RigidBody
from ..model.functions.function import TimeFunction
from ..model.joints.basic import Slide
from ..model.model import Model
from ..model.supports.support import Clamp, Hold, Pin, Support
from ..model.supports.winch import Winch
from .nodes import node_of, start_vectors
from .numbering import Numbering


@dataclass(frozen=True)
class Rotation:
    """Local axes of a slot: R(t) = exp(theta(t) axis) R0, or exp(vector(t)) R0; constant without either."""

    slot: int
    R0: FloatArray  # (3, 3), first column along the initial vector
    axis: FloatArray
    angle: TimeFunction | None = None
    rate: TimeFunction | None = None
    acceleration: TimeFunction | None = None
    vector: TimeFunction | None = None

    def part(self, time: float, share: float) -> FloatArray:
        """R (3, 3) when a share of the turn at a time is there."""
        from scipy.spatial.transform import Rotation as Turn

        return Turn.from_rotvec(share * self.turn(time)).as_matrix() @ self.R0

    def turn(self, time: float) -> FloatArray:
        """Axis times angle (3,) at a time, rad."""
        if self.vector is not None:
            return self.vector(time)
        return self.axis * (0.0 if self.angle is None else self.angle(time)[0])

    @property
    def moves(self) -> bool:
        """Whether it depends on time."""
        return self.angle is not None or self.vector is not None

    def turned(self, times: FloatArray) -> FloatArray:
        """R at times (n,) of a rotation vector, shape (n, 9), row by row."""
        from scipy.spatial.transform import Rotation as Turn

        assert self.vector is not None
        R: FloatArray = Turn.from_rotvec(self.vector.table(times)).as_matrix() @ self.R0
        return R.reshape(-1, 9)

    def matrices(self, theta: FloatArray, rate: FloatArray, acceleration: FloatArray) -> FloatArray:
        """R, dR/dt and d2R/dt2, shape (n, 3, 3, 3), from angles of shape (n,)."""
        K = np.cross(np.eye(3), self.axis)  # K x = axis x x
        s, c = np.sin(theta)[:, None, None], np.cos(theta)[:, None, None]
        R = np.eye(3) + s * K + (1 - c) * (K @ K)
        w, dw = rate[:, None, None], acceleration[:, None, None]
        return np.stack([R, w * (K @ R), dw * (K @ R) + w**2 * (K @ K @ R)], axis=1) @ self.R0


@dataclass(frozen=True)
class Motion:
    """Given motion of unknowns: ``rest`` (k,) and ``values(t)`` of shape (n, k) for times (n,).

    Rates are differences of the values alone, so that they lose no digits to where a support stands.

    ``part(time, share)`` (k,) is where they are when a share of the motion from the initial shape is there.
    """

    unknowns: list[int]
    values: Callable[[FloatArray], FloatArray]
    part: Callable[[float, float], FloatArray] | None = None  # None: the whole is there from the beginning
    rates: Callable[[FloatArray], tuple[FloatArray, FloatArray]] | None = None
    drive: Winch | None = None  # it follows from step to step
    rest: FloatArray | float = 0.0


@dataclass
class Constraints:
    """What the supports of a model hold."""

    held: set[int] = field(default_factory=set)
    rotations: list[Rotation] = field(default_factory=list)
    motions: list[Motion] = field(default_factory=list)
    driven: set[int] = field(default_factory=set)  # slots
    positions: dict[str, list[int]] = field(default_factory=dict)  # by support, see _held_positions


def collect(model: Model, numbering: Numbering) -> Constraints:
    """All supports of the model; a later clamp of the same node adds to the earlier one."""
    constraints = Constraints(positions=_held_positions(model, numbering))
    clamps: dict[int, Clamp] = {}
    for support in model.supports:
        body = support.point.body
        node = node_of(body, support.point.x)
        slots = numbering.slots[body.name][node].tolist()
        if isinstance(support, Winch):
            unknown = numbering.lengths[support.name]
            constraints.held.add(unknown)
            drive = support if support.driven else None
            constraints.motions.append(Motion([unknown], support.lengths, drive=drive))
            constraints.driven.add(unknown)
        elif isinstance(support, Pin):
            _hold_position(constraints, slots[0], start_vectors(body)[node, 0], support.displacement)
        elif isinstance(support, Hold):
            _hold_components(constraints, numbering, support, node)
        else:
            clamps[slots[1]] = _refined(clamps.get(slots[1]), support)
    for clamp in clamps.values():
        _clamp(constraints, numbering, clamp)
    for joint in model.connections:
        if isinstance(joint, Slide) and joint.motion is not None:
            arc = numbering.arcs[joint.name]
            constraints.held.add(arc)
            constraints.motions.append(_slid(arc, joint))
            constraints.driven.add(arc)
    return constraints


def _held_positions(model: Model, numbering: Numbering) -> dict[str, list[int]]:
    """Unknowns of the position that each support holds; the first of two that hold the same one has it.

    Raises
    ------
    ModelError
        Supports of bodies that share a node hold the same component, and one of them moves it.
    """
    owner: dict[int, Support] = {}
    for support in model.supports:
        body = support.point.body
        slot = int(numbering.slots[body.name][node_of(body, support.point.x), 0])
        for i in (slot + c for c in range(3) if f"position {'xyz'[c]}" in support.held):
            other = owner.setdefault(i, support)
            moved = support.displacement is not None or other.displacement is not None
            if moved and other.point.body is not body:
                what = f'"{other.name}" and "{support.name}" both hold {numbering.describe(i)}'
                raise ModelError("supports", f"{what}, and one of them moves it", "keep one of them")
    holding = (s for s in model.supports if not isinstance(s, Winch))
    return {s.name: [i for i, first in owner.items() if first is s] for s in holding}


def _clamp(constraints: Constraints, numbering: Numbering, clamp: Clamp) -> None:
    body: Body = clamp.point.body
    node = node_of(body, clamp.point.x)
    shared = numbering.shared[body.name]
    slots, vectors = numbering.slots[body.name][node, :shared].tolist(), start_vectors(body)[node]
    _hold_position(constraints, slots[0], vectors[0], clamp.displacement)
    if isinstance(body, RigidBody):  # what is held altogether needs nothing to keep it rigid
        clamp = replace(clamp, stretch="fixed")
        constraints.held |= set(numbering.multipliers[body.name].tolist())
    for slot, vector in zip(slots[1:], vectors[1:shared], strict=True):
        _hold_slope(constraints, slot, clamp, vector)


def _hold_components(constraints: Constraints, numbering: Numbering, hold: Hold, node: int) -> None:
    slots = numbering.slots[hold.point.body.name][node].tolist()
    letters = (hold.position, hold.slope, hold.slope_y, hold.slope_z)
    for slot, components in zip(slots, letters, strict=False):  # a cable has the first two
        constraints.held |= {slot + "xyz".index(c) for c in components}
    if hold.displacement is not None:
        place = start_vectors(hold.point.body)[node, 0]
        _move(constraints, slots[0], ["xyz".index(c) for c in hold.position], place, hold.displacement)
    if hold.twist:
        body = hold.point.body
        assert isinstance(body, Beam)
        y, z = body.node_y[node], body.node_z[node]
        R0 = np.column_stack([y, z, np.cross(y, z)])
        constraints.held.add(slots[2] + 1)
        constraints.rotations.append(Rotation(slots[2], R0, np.array([0.0, 0.0, 1.0])))


def _refined(earlier: Clamp | None, later: Clamp) -> Clamp:
    if earlier is None:
        return later
    if later.rotation is None and later.rotation_vector is None:
        later = replace(
            later,
            rotation=earlier.rotation,
            rotation_rate=earlier.rotation_rate,
            rotation_acceleration=earlier.rotation_acceleration,
            axis=earlier.axis,
            rotation_vector=earlier.rotation_vector,
        )
    stretch = "fixed" if "fixed" in (earlier.stretch, later.stretch) else "free"
    return replace(later, stretch=stretch, displacement=later.displacement or earlier.displacement)


def _hold_position(
    constraints: Constraints, slot: int, position: FloatArray, displacement: TimeFunction | None
) -> None:
    constraints.held |= {slot, slot + 1, slot + 2}
    if displacement is not None:
        _move(constraints, slot, [0, 1, 2], position, displacement)


def _move(
    constraints: Constraints, slot: int, parts: list[int], position: FloatArray, displacement: TimeFunction
) -> None:
    """Let the held components ``parts`` of a position follow a displacement from its initial value."""
    table = displacement.table
    unknowns = [slot + c for c in parts]

    def part(time: float, share: float) -> FloatArray:
        return (position + share * displacement(time))[parts]

    moved = Motion(unknowns, lambda t: table(t)[:, parts], part, rest=position[parts])
    constraints.motions.append(moved)
    constraints.driven.add(slot)


def _slid(arc: int, joint: Slide) -> Motion:
    """Motion of a joint that is driven along its carrier."""
    motion, first = joint.motion, joint.s
    assert motion is not None
    return Motion([arc], motion.table, lambda time, share: first + share * (motion(time) - first))


def _hold_slope(constraints: Constraints, slot: int, clamp: Clamp, vector: FloatArray) -> None:
    """Hold the direction of one of the slopes, or all of it; ``vector`` is its initial value."""
    given = clamp.rotation, clamp.rotation_rate, clamp.rotation_acceleration
    rotation = Rotation(slot, axes(vector), clamp.axis, *given, clamp.rotation_vector)
    if rotation.moves:
        constraints.driven.add(slot)
    if clamp.stretch == "free":
        constraints.held |= {slot + 1, slot + 2}
        constraints.rotations.append(rotation)
        return
    constraints.held |= {slot, slot + 1, slot + 2}
    length = float(np.linalg.norm(vector))
    unknowns = [slot, slot + 1, slot + 2]

    def part(time: float, share: float) -> FloatArray:
        return length * rotation.part(time, share)[:, 0]

    if clamp.rotation_vector is not None:
        constraints.motions.append(Motion(unknowns, lambda t: length * rotation.turned(t)[:, ::3], part))
    if clamp.rotation is None:
        return
    angle, rate, acceleration = clamp.rotation, clamp.rotation_rate, clamp.rotation_acceleration

    def slope(order: int, t: FloatArray) -> FloatArray:
        zero = np.zeros_like(t)
        first = rate.table(t)[:, 0] if rate is not None else zero
        second = acceleration.table(t)[:, 0] if acceleration is not None else zero
        return length * rotation.matrices(angle.table(t)[:, 0], first, second)[:, order, :, 0]

    exact = None if rate is None else (lambda t: (slope(1, t), slope(2, t)))
    constraints.motions.append(Motion(unknowns, lambda t: slope(0, t), part, exact))


def axes(tangent: FloatArray) -> FloatArray:
    """Right-handed axes (3, 3) with the tangent as first column."""
    t: FloatArray = tangent / np.linalg.norm(tangent)
    helper = np.zeros(3)
    helper[int(np.argmin(np.abs(t)))] = 1.0
    n = _across(t, helper)
    n /= np.linalg.norm(n)
    return np.column_stack([t, n, _across(t, n)])


def _across(a: FloatArray, b: FloatArray) -> FloatArray:
    """Cross product of two vectors; that of the library takes 20 us to find out that they are two."""
    (x, y, z), (u, v, w) = a.tolist(), b.tolist()
    return np.array([y * w - z * v, z * u - x * w, x * v - y * u])
