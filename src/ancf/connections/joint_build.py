"""From joints and rigid bodies of the model to the rows of a JointBatch."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..elements.registry import ELEMENTS
from ..model.beam import Beam
from ..model.bodies import RigidBody
from ..model.connections import Spherical
from ..model.elements import KINDS
from ..model.joints import Fixation, Revolute
from ..model.points import Point
from .joint import JointBatch

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Locate = Callable[[Point], Any]


@dataclass(frozen=True)
class Vector:
    """Sum of factors times vectors of unknowns, plus a constant: a point or an axis of a body."""

    slots: tuple[int, ...] = ()
    factors: tuple[float, ...] = ()
    constant: FloatArray = field(default_factory=lambda: np.zeros(3))

    def minus(self, other: Vector) -> Vector:
        """Difference of two vectors."""
        turned = tuple(-f for f in other.factors)
        return Vector(self.slots + other.slots, self.factors + turned, self.constant - other.constant)


@dataclass(frozen=True)
class Row:
    """d1 . d2 - c = 0."""

    first: Vector
    second: Vector
    value: float = 0.0


UNITS = tuple(Vector(constant=e) for e in np.eye(3))


def place_of(end: Point | FloatArray, locate: Locate) -> Vector:
    """Position of a point or of the ground."""
    if not isinstance(end, Point):
        return Vector(constant=np.asarray(end, dtype=np.float64))
    probe = locate(end)
    used = probe.S[0] != 0.0
    return Vector(tuple(probe.slots[used].tolist()), tuple(probe.S[0][used].tolist()))


def axis_of(end: Point | FloatArray, direction: FloatArray, slots: dict[str, IntArray]) -> Vector:
    """Direction (3,) in the initial shape as an axis that turns with the body, or stays with the ground."""
    if not isinstance(end, Point):
        return Vector(constant=direction)
    body = end.body
    if isinstance(body, RigidBody):
        return Vector(tuple(slots[body.name][0, 1:4].tolist()), tuple((body.axes.T @ direction).tolist()))
    assert isinstance(body, Beam)
    node = int(np.argmin(np.abs(body.node_x - end.x)))
    axes = node_axes(body, node)
    return Vector(
        tuple(slots[body.name][node, 1:4].tolist()), tuple(np.linalg.solve(axes, direction).tolist())
    )


def node_axes(beam: Beam, node: int) -> FloatArray:
    """Initial r_x, and r_y and r_z where there are, of a node as columns."""
    vectors = ELEMENTS[beam.element].initial_vectors(beam)[node]
    axes: FloatArray = vectors[1 : KINDS[beam.element].vectors].T
    return axes


def normals(direction: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Two unit vectors normal to a direction and to each other."""
    first = np.cross(direction, np.eye(3)[int(np.argmin(np.abs(direction)))])
    first /= np.linalg.norm(first)
    return first, np.cross(direction, first)


def rigid(body: RigidBody, slots: dict[str, IntArray]) -> list[Row]:
    """The three directors stay orthonormal."""
    d = [Vector((int(i),), (1.0,)) for i in slots[body.name][0, 1:4]]
    return [Row(d[i], d[j], float(i == j)) for i in range(3) for j in range(i, 3)]


def coincide(a: Point | FloatArray, b: Point | FloatArray, locate: Locate) -> list[Row]:
    """Two points stay together."""
    gap = place_of(a, locate).minus(place_of(b, locate))
    return [Row(gap, unit) for unit in UNITS]


def spherical(joint: Spherical, locate: Locate, slots: dict[str, IntArray]) -> list[Row]:
    """Rows of a spherical joint."""
    return coincide(joint.a, joint.b, locate)


def revolute(joint: Revolute, locate: Locate, slots: dict[str, IntArray]) -> list[Row]:
    """The axis of a stays normal to two directions of b."""
    axis = axis_of(joint.a, joint.axis, slots)
    across = [axis_of(joint.b, n, slots) for n in normals(joint.axis)]
    return [*coincide(joint.a, joint.b, locate), *(Row(axis, n) for n in across)]


def fixation(joint: Fixation, locate: Locate, slots: dict[str, IntArray]) -> list[Row]:
    """Position and slopes of a node go with a rigid body; with a free stretch only their directions."""
    beam, hub = joint.point.body, joint.to
    assert isinstance(beam, Beam)
    node = int(np.argmin(np.abs(beam.node_x - joint.point.x)))
    here = locate(joint.point)
    arm = hub.axes.T @ (beam.node_position[node] - hub.position)
    seat = Vector(tuple(slots[hub.name][0].tolist()), (1.0, *arm.tolist()))
    gap = Vector(tuple(here.slots.tolist()), tuple(here.S[0].tolist())).minus(seat)
    rows = [Row(gap, unit) for unit in UNITS]
    axes = node_axes(beam, node)
    for k in range(min(slots[beam.name].shape[1], 4) - 1):
        slope = Vector((int(slots[beam.name][node, k + 1]),), (1.0,))
        size = float(np.linalg.norm(axes[:, k]))
        along = axes[:, k] / size
        held = [(n, 0.0) for n in normals(along)]
        if joint.stretch == "fixed":
            held.append((along, size))
        for direction, value in held:
            turned = Vector(tuple(slots[hub.name][0, 1:4].tolist()), tuple((hub.axes.T @ direction).tolist()))
            rows.append(Row(slope, turned, value))
    return rows


BUILDERS: dict[type, Callable[[Any, Locate, dict[str, IntArray]], list[Row]]] = {
    Spherical: spherical,
    Revolute: revolute,
    Fixation: fixation,
}


def count(item: Any) -> int:
    """Number of rows of a connection, 0 for those without multipliers."""
    if type(item) not in BUILDERS:
        return 0
    if isinstance(item, Fixation):
        per_slope = 3 if item.stretch == "fixed" else 2
        beam = item.point.body
        return 3 + per_slope * (3 if isinstance(beam, Beam) and beam.has_section else 1)
    return 5 if isinstance(item, Revolute) else 3


def batch(rows: Iterable[Row], unknowns: Iterable[int], level: FloatArray) -> JointBatch:
    """Batch of rows with these multipliers; places, mass and stiffness follow later."""
    rows = list(rows)
    entries = [
        (slot, factor, which)
        for row in rows
        for which, vector in enumerate((row.first, row.second))
        for slot, factor in zip(vector.slots, vector.factors, strict=True)
    ]
    counts = np.array([len(r.first.slots) + len(r.second.slots) for r in rows], dtype=np.int64)
    n = len(rows)
    return JointBatch(
        unknown=np.array(list(unknowns), dtype=np.int64),
        level=level,
        constant=np.array([[*r.first.constant, *r.second.constant, r.value] for r in rows]).reshape(n, 7),
        scale=np.zeros((n, 2)),
        alpha=np.zeros(n),
        start=np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        slot=np.array([e[0] for e in entries], dtype=np.int64),
        factor=np.array([e[1] for e in entries], dtype=np.float64),
        second=np.array([e[2] for e in entries], dtype=np.int64),
        place=np.full(len(entries), -1, dtype=np.int64),
        pair_start=np.concatenate([[0], np.cumsum(counts**2)]).astype(np.int64),
        pair=np.full(int(np.sum(counts**2)), -1, dtype=np.int64),
    )
