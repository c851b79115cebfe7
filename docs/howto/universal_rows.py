"""Universal joint: two points stay together, and two axes stay normal."""

from __future__ import annotations

from typing import Any

from .joint_build import IntArray, Locate, Row, axis_of, coincide


def rows(joint: Any, locate: Locate, slots: dict[str, IntArray]) -> list[Row]:
    """Three rows for the point, one for the cross."""
    cross = Row(
        axis_of(joint.a, joint.axis_a, slots), axis_of(joint.b, joint.axis_b, slots)
    )
    return [*coincide(joint.a, joint.b, locate), cross]
