"""Prismatic joint: a cylindrical joint that does not turn."""

from __future__ import annotations

from ..arrays import IntArray
from ..model.guides import Prismatic
from . import cylindrical
from .joint_build import Locate, Row, axis_of, normals


def rows(joint: Prismatic, locate: Locate, slots: dict[str, IntArray]) -> list[Row]:
    """Those of a cylindrical joint, and two directions across the axis that stay normal."""
    first, second = normals(joint.axis)
    turn = Row(axis_of(joint.a, first, slots), axis_of(joint.b, second, slots))
    return [*cylindrical.rows(joint, locate, slots), turn]
