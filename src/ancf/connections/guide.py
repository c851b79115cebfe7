"""Guide: a point stays on a line in space, and the directions of its body stay as they are."""

from __future__ import annotations

from ..arrays import IntArray
from ..model.bodies.rigid import PointMass
from ..model.joints.rigid_joints import Guide
from .directions import held
from .joint_build import Locate, Row, Vector, normals, place_of


def rows(joint: Guide, locate: Locate, slots: dict[str, IntArray]) -> list[Row]:
    """Two components of the position, and the directions."""
    start = joint.point.initial_position
    gap = place_of(joint.point, locate).minus(Vector(constant=start))
    on_line = [Row(gap, Vector(constant=normal)) for normal in normals(joint.axis)]
    if isinstance(joint.point.body, PointMass):
        return on_line
    return [*on_line, *held(joint.point, start, slots)]
