"""Planar joint: a point of one body stays in a plane of the other, and the normal of the plane is theirs."""

from __future__ import annotations

from ..arrays import IntArray
from ..model.joints.guides import Planar
from .joint_build import Locate, Row, axis_of, normals, place_of


def rows(joint: Planar, locate: Locate, slots: dict[str, IntArray]) -> list[Row]:
    """The distance of the points along the normal stays, and the normal of b across two directions of a."""
    gap = place_of(joint.b, locate).minus(place_of(joint.a, locate))
    normal = axis_of(joint.b, joint.axis, slots)
    across = [axis_of(joint.a, n, slots) for n in normals(joint.axis)]
    return [Row(gap, axis_of(joint.a, joint.axis, slots)), *(Row(normal, n) for n in across)]
