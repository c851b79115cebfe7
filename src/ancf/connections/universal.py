"""Universal joint: two points stay together, and an axis of each body normal to that of the other."""

from __future__ import annotations

from ..arrays import IntArray
from ..model.joints.rigid_joints import Universal
from .joint_build import Locate, Row, axis_of, coincide


def rows(joint: Universal, locate: Locate, slots: dict[str, IntArray]) -> list[Row]:
    """Three rows for the point, one for the cross."""
    cross = Row(axis_of(joint.a, joint.axis_a, slots), axis_of(joint.b, joint.axis_b, slots))
    return [*coincide(joint.a, joint.b, locate), cross]
