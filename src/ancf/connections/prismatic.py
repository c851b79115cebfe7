"""Prismatic joint: a cylindrical joint that does not turn."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray, IntArray
from ..model.bodies.beam import Beam
from ..model.joints.guides import Prismatic
from ..model.points import Point
from . import cylindrical
from .directions import slopes_of
from .joint_build import Locate, Row, axis_of, normals


def rows(joint: Prismatic, locate: Locate, slots: dict[str, IntArray]) -> list[Row]:
    """Those of a cylindrical joint, and two directions across the axis that stay normal."""
    first, second = normals(joint.axis, _own_axes(joint, slots))
    turn = Row(axis_of(joint.a, first, slots), axis_of(joint.b, second, slots))
    return [*cylindrical.rows(joint, locate, slots), turn]


def _own_axes(joint: Prismatic, slots: dict[str, IntArray]) -> FloatArray:
    """Which directions count matters where a section shears: its own axes tell them, not the global ones."""
    for end in (joint.a, joint.b):
        if isinstance(end, Point) and isinstance(end.body, Beam):
            return np.array([along for _, along in slopes_of(end, slots)])
    return np.eye(3)
