"""Joints that hold directions: universal joint, weld and guide."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..bodies.beam import Beam
from ..bodies.rigid import PointMass, RigidBody
from ..kind import JOINT, Kind, Look
from ..points import Point
from ..supports.support import require_node
from ..tables import numbers
from .make_joints import End, check_pair, require_axes

#: Cosine of the angle of two directions up to which they are normal to each other, sine of parallel ones.
NORMAL = PARALLEL = 1e-9
#: Sine of the angle up to which two cables that are welded lie along one curve.
STRAIGHT = 0.01


@dataclass(frozen=True, slots=True, eq=False)
class Universal:
    """A universal (Cardan) joint: two points coincide, an axis of each body stays normal to the other's.

    Attributes
    ----------
    a : Point
        Of a rigid body, or a node of a beam with a cross-section.
    b : Point or (3,) array
        The same, or a fixed position, m: the ground.
    axis_a, axis_b : (3,) arrays
        Unit vectors, normal to each other: initial global directions of the arms of the cross, fixed in the
        body of `a` and in that of `b`.

    """

    name: str
    a: Point
    b: Point | FloatArray
    axis_a: FloatArray
    axis_b: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Weld:
    """A rigid connection: two points coincide, and their bodies do not turn against each other.

    Slopes of beams keep their directions to each other and may stretch. Two cables in one line share their
    slope; two at a right angle keep it.

    Attributes
    ----------
    a, b : Point
        Nodes of beams and cables, or of rigid bodies.

    """

    name: str
    a: Point
    b: Point

    @property
    def shares_slope(self) -> bool:
        """Whether both are cables in one line."""
        return _is_cable(self.a) and _is_cable(self.b) and not _across(self.a, self.b)


@dataclass(frozen=True, slots=True, eq=False)
class Guide:
    """A guided end: a point stays on a straight line that is fixed in space, and its body does not turn.

    Attributes
    ----------
    point : Point
        A node of a beam or cable, whose slopes keep their directions, a point of a rigid body, or a point
        mass.
    axis : (3,) array
        Unit vector along the line, which goes through the initial position of the point.

    """

    name: str
    point: Point
    axis: FloatArray

    @property
    def start(self) -> FloatArray:
        """Where the point is at first, (3,) m: a place on the line."""
        return self.point.initial_position


def make_universal(
    where: str, name: str, a: Point, b: End, axes: tuple[Any, Any], size: Callable[[], float]
) -> Universal:
    """Check what ``Model.universal`` was given; `size` gives the size of the model in m."""
    one = checks.direction(axes[0], f"{where}.axis_a")
    two = checks.direction(axes[1], f"{where}.axis_b")
    if abs(float(one @ two)) > NORMAL:
        what = f"must be normal to axis_a; the cosine of their angle is {float(one @ two):.3g}"
        raise ModelError(f"{where}.axis_b", what, "the arms of the cross are at a right angle")
    for key, end in (("a", a), ("b", b)):
        if isinstance(end, Point):
            require_axes(end, f"{where}.{key}")
    check_pair(where, a, b, size)
    return Universal(name, a, b, one, two)


def make_weld(where: str, name: str, a: Point, b: End, size: Callable[[], float]) -> Weld:
    """Check what ``Model.weld`` was given; `size` gives the size of the model in m."""
    if not isinstance(b, Point):
        if isinstance(a.body, PointMass):
            raise ModelError(f"{where}.b", "is a position in space", f"model.pin({a}) holds it there")
        held = a.body.name if isinstance(a.body, RigidBody) else a
        hint = f"a clamp is a weld to the ground: model.clamp({held}); results have its reaction_moment"
        raise ModelError(f"{where}.b", "is a position in space", hint)
    for key, end in (("a", a), ("b", b)):
        if isinstance(end.body, PointMass):
            what = f'"{end.body.name}" is a point mass and has no orientation'
            raise ModelError(f"{where}.{key}", what, "join it with model.connect(...)")
        if isinstance(end.body, Beam):
            require_node(end, f"{where}.{key}")
    check_pair(where, a, b, size)
    if _is_cable(a) and _is_cable(b):
        _join_cables(where, a, b)
    return Weld(name, a, b)


def make_guided(where: str, name: str, point: Point, axis: Any) -> Guide:
    """Check what ``Model.guide`` was given."""
    direction = checks.direction(axis, f"{where}.axis")
    if isinstance(point.body, Beam):
        require_node(point, f"{where}.point")
    return Guide(name, point, direction)


def _join_cables(where: str, a: Point, b: Point) -> None:
    """Without torsion a corner of two cables has no plane: only a right angle is one condition.

    Pieces of one curve meet at a small angle, by rounded numbers or splines: the second takes the first
    one's direction there.
    """
    one, two = tangent(a), tangent(b)
    sine = float(np.linalg.norm(np.cross(one, two)))
    if sine <= PARALLEL or _across(a, b):
        return
    if sine > STRAIGHT:
        angle = float(np.degrees(np.arccos(np.clip(one @ two, -1, 1))))
        what = f"two cables meet at {angle:.4g} degrees; they have no torsion that would hold such a corner"
        hint = 'element = "nonlocking" for one of them, or clamp both to a rigid body: clamp(point, to=body)'
        raise ModelError(f"{where}.b", what, hint)
    beam, node = b.body, require_node(b, f"{where}.b")
    along = one if one @ two > 0.0 else -one
    beam.node_tangent, beam.node_y = beam.node_tangent.copy(), beam.node_y.copy()
    beam.node_tangent[node] = along
    side = beam.node_y[node] - (beam.node_y[node] @ along) * along
    beam.node_y[node] = side / np.linalg.norm(side)


def _is_cable(point: Point) -> bool:
    return isinstance(point.body, Beam) and not point.body.has_section


def _across(a: Point, b: Point) -> bool:
    return abs(float(tangent(a) @ tangent(b))) <= NORMAL


def tangent(point: Point) -> FloatArray:
    """Initial unit tangent (3,) of a beam at a node."""
    found: FloatArray = point.body.initial_tangent(point.x)
    return found


def _entry(name: str) -> Callable[[], Any]:
    return lambda: getattr(import_module("ancf.model.file.joint_items"), name)


UNIVERSAL = Kind(
    Universal,
    "universal",
    "universal joint",
    "universal",
    _entry("UniversalEntry"),
    lambda item: f"axes {numbers(item.axis_a)} and {numbers(item.axis_b)}",
    ends=("a", "b"),
    asked=JOINT,
    rows="universal",
    look=Look("diamond", "light", 4.5),
)
WELD = Kind(
    Weld,
    "weld",
    "weld",
    "weld",
    _entry("WeldEntry"),
    lambda item: "slope shared" if item.shares_slope else "position, directions",
    ends=("a", "b"),
    asked=JOINT,
    rows="weld",
    look=Look("square", "grey", 4.0),
)
GUIDE = Kind(
    Guide,
    "guide",
    "guide",
    "guide",
    _entry("GuideEntry"),
    lambda item: f"axis {numbers(item.axis)}",
    ends=("point", "start"),
    keys=("point", "point"),
    between=lambda item: str(item.point),
    asked=JOINT,
    rows="guide",
    look=Look("square", "light", 5.0),
)
