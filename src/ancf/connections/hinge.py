"""Hinge: two points stay together, their bodies turn about one axis against each other."""

from __future__ import annotations

from ..arrays import IntArray
from ..model.joints.basic import Revolute
from .joint_build import Locate, Row, axis_of, coincide, normals


def rows(joint: Revolute, locate: Locate, slots: dict[str, IntArray]) -> list[Row]:
    """The axis of a stays normal to two directions of b."""
    axis = axis_of(joint.a, joint.axis, slots)
    across = [axis_of(joint.b, n, slots) for n in normals(joint.axis)]
    return [*coincide(joint.a, joint.b, locate), *(Row(axis, n) for n in across)]
