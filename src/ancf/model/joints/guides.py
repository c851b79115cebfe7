"""Guides: joints of two bodies with an axis or a plane, along which one slides on the other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..points import Point, initial_position
from .make_joints import End, check_apart, coincide, require_axes


@dataclass(frozen=True, slots=True, eq=False)
class Cylindrical:
    """One body slides along an axis of the other and turns about it.

    Attributes
    ----------
    a : Point
        Of a rigid body, or a node of a beam with a cross-section; the axis goes through it.
    b : Point or (3,) array
        The same, initially anywhere on the axis, or a fixed position, m: the ground.
    axis : (3,) array
        Unit vector, initial global direction; fixed in both bodies.

    """

    name: str
    a: Point
    b: Point | FloatArray
    axis: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Prismatic(Cylindrical):
    """One body slides along an axis of the other and does not turn."""


@dataclass(frozen=True, slots=True, eq=False)
class Planar:
    """One body slides in a plane of the other and turns about its normal.

    Attributes
    ----------
    a : Point
        Of a rigid body, or a node of a beam with a cross-section; the plane goes through it.
    b : Point or (3,) array
        The same, initially anywhere in the plane, or a fixed position, m: the ground.
    axis : (3,) array
        Unit normal of the plane, initial global direction; fixed in both bodies.

    """

    name: str
    a: Point
    b: Point | FloatArray
    axis: FloatArray


GuideT = TypeVar("GuideT", Cylindrical, Prismatic, Planar)


def make_guide(
    kind: type[GuideT], where: str, name: str, a: Point, b: End, axis: Any, size: Callable[[], float]
) -> GuideT:
    """Check what ``Model.cylindrical``, ``prismatic`` or ``planar`` was given; `size` gives the model's."""
    direction = checks.direction(axis, f"{where}.axis")
    for key, end in (("a", a), ("b", b)):
        if isinstance(end, Point):
            require_axes(end, f"{where}.{key}")
    if isinstance(b, Point):
        check_apart(where, a, b)
    first, second = initial_position(a), initial_position(b)
    between = second - first
    along = float(between @ direction)
    off = abs(along) if kind is Planar else float(np.linalg.norm(between - along * direction))
    if not coincide(off, first, second, size):
        other = b if isinstance(b, Point) else f"the position {second.tolist()}"
        line = "plane" if kind is Planar else "axis"
        raise ModelError(f"{where}.b", f"{other} is {off:.6g} m off the {line} through {a}, must be on it")
    return kind(name, a, b, direction)
