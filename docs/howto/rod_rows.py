"""Rod: the distance of two points stays."""

from __future__ import annotations

from typing import Any

from .joint_build import IntArray, Locate, Row, place_of


def rows(joint: Any, locate: Locate, slots: dict[str, IntArray]) -> list[Row]:
    """One row, in which both vectors are the way from one point to the other."""
    way = place_of(joint.b, locate).minus(place_of(joint.a, locate))
    return [Row(way, way, joint.length**2)]
