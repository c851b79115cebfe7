"""Universal joint: two points coincide, axes of the two bodies stay normal."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from ancf.errors import ModelError
from ancf.model import checks
from ancf.model.checks import FloatArray
from ancf.model.kind import JOINT, Kind, Look
from ancf.model.make_joints import check_pair, require_axes
from ancf.model.points import Point
from ancf.model.tables import numbers


@dataclass(frozen=True, slots=True, eq=False)
class Universal:
    """Two points coincide; ``axis_a`` of the first body stays normal to ``axis_b``."""

    name: str
    a: Point
    b: Point | FloatArray
    axis_a: FloatArray
    axis_b: FloatArray


def entry() -> type:
    """Its table in a model file."""
    from pydantic import Field

    from ancf.model.file.fields import (
        Entry,
        ItemName,
        PointLabel,
        PointOrPosition,
        Vector,
    )

    class UniversalEntry(Entry):
        """Two coincident points, their bodies turn about two axes of a cross."""

        type: Literal["universal"] = Field(description="Kind of connection.")
        a: PointLabel
        b: PointOrPosition = Field(description="The other point, or a position [m].")
        axis_a: Vector = Field(description="Axis in the first body at the start [-].")
        axis_b: Vector = Field(description="Axis in the second body at the start [-].")
        name: ItemName = None

    return UniversalEntry


def universal(
    model: Any, a: Any, b: Any, axis_a: Any, axis_b: Any, name: str | None = None
) -> Universal:
    """Join two coincident points by the cross of a universal joint."""
    where, label, first, second = model.named_pair(
        "universal", "universal joint", a, b, name
    )
    axes = (
        checks.direction(axis_a, f"{where}.axis_a"),
        checks.direction(axis_b, f"{where}.axis_b"),
    )
    if abs(float(axes[0] @ axes[1])) > 1e-9:
        raise ModelError(
            f"{where}.axis_b",
            "must be normal to axis_a",
            f"their cosine is {axes[0] @ axes[1]:.3g}",
        )
    for key, end in (("a", first), ("b", second)):
        if not isinstance(end, np.ndarray):
            require_axes(end, f"{where}.{key}")
    check_pair(where, first, second, model.size)
    return model.add_connection(where, Universal(label, first, second, *axes))


UNIVERSAL = Kind(
    Universal,
    "universal",
    "universal joint",
    "universal",
    entry,
    lambda item: f"axes {numbers(item.axis_a)}, {numbers(item.axis_b)}",
    ends=("a", "b"),
    asked=JOINT,
    rows="universal",
    look=Look("circle", "light", 4.0),
    add=universal,
)
