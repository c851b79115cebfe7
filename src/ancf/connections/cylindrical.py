"""Cylindrical joint: an axis of one body lies on an axis of the other."""

from __future__ import annotations

from ..arrays import IntArray
from ..model.joints.guides import Cylindrical
from .joint_build import Locate, Row, axis_of, normals, place_of


def rows(joint: Cylindrical, locate: Locate, slots: dict[str, IntArray]) -> list[Row]:
    """The distance of the points and the axis of b stay normal to two directions of a."""
    gap = place_of(joint.b, locate).minus(place_of(joint.a, locate))
    axis = axis_of(joint.b, joint.axis, slots)
    across = [axis_of(joint.a, n, slots) for n in normals(joint.axis)]
    return [*(Row(gap, n) for n in across), *(Row(axis, n) for n in across)]
