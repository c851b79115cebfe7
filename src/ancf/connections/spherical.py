"""Spherical joint: two points stay together."""

from __future__ import annotations

from ..arrays import IntArray
from ..model.joints.basic import Spherical
from .joint_build import Locate, Row, coincide


def rows(joint: Spherical, locate: Locate, slots: dict[str, IntArray]) -> list[Row]:
    """Rows of a spherical joint."""
    return coincide(joint.a, joint.b, locate)
