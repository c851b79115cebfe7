"""From joints and rigid bodies of the model to the rows of a JointBatch."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..elements.registry import ELEMENTS
from ..model.bodies.beam import Beam
from ..model.bodies.rigid import RigidBody
from ..model.elements import KINDS
from ..model.kinds import kind_of
from ..model.points import Point
from .joint import JointBatch

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

    @property
    def key(self) -> tuple[Any, ...]:
        """The same for rows that are the same."""
        vectors = ((v.slots, v.factors, v.constant.tobytes()) for v in (self.first, self.second))
        return (*vectors, self.value)


#: Difference of cosines that is round-off.
ALIKE = 1e-9
UNIT_AXES: FloatArray = np.eye(3)
UNITS = tuple(Vector(constant=e) for e in UNIT_AXES)


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


def normals(direction: FloatArray, axes: FloatArray = UNIT_AXES) -> tuple[FloatArray, FloatArray]:
    """Two unit vectors normal to a direction and to each other, one of them to the row of `axes` across it.

    Of rows that are as much across it, but for round-off, it is the first.
    """
    along = np.abs(axes @ direction)
    first = np.cross(direction, axes[int(np.argmax(along < np.min(along) + ALIKE))])
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


def rows_of(joint: Any, locate: Locate, slots: dict[str, IntArray]) -> list[Row]:
    """Rows of a joint, from the module that its kind names; none of a connection that is not made of rows."""
    module = kind_of(joint).rows
    if not module:
        return []
    found: list[Row] = import_module(f"ancf.connections.{module}").rows(joint, locate, slots)
    return found


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
        scale=np.zeros((n, 3)),
        alpha=np.zeros(n),
        start=np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        slot=np.array([e[0] for e in entries], dtype=np.int64),
        factor=np.array([e[1] for e in entries], dtype=np.float64),
        second=np.array([e[2] for e in entries], dtype=np.int64),
        place=np.full(len(entries), -1, dtype=np.int64),
        pair_start=np.concatenate([[0], np.cumsum(counts**2)]).astype(np.int64),
        pair=np.full(int(np.sum(counts**2)), -1, dtype=np.int64),
    )
