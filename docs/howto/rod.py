"""Rod: a rigid, massless rod keeps the distance of two points."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from ancf.errors import ModelError
from ancf.model.checks import FloatArray
from ancf.model.joints.make_joints import check_apart
from ancf.model.kind import JOINT, Kind, Look
from ancf.model.points import Point, initial_position
from ancf.model.tables import number


@dataclass(frozen=True, slots=True, eq=False)
class Rod:
    """The distance of two points stays as it is; both ends turn freely."""

    name: str
    a: Point
    b: Point | FloatArray

    @property
    def length(self) -> float:
        """Initial distance of the points, m."""
        between = initial_position(self.b) - initial_position(self.a)
        return float(np.linalg.norm(between))


def entry() -> type:
    """Its table in a model file."""
    from pydantic import Field

    from ancf.model.file.fields import Entry, ItemName, PointLabel, PointOrPosition

    class RodEntry(Entry):
        """A rigid, massless rod between two points."""

        type: Literal["rod"] = Field(description="Kind of connection.")
        a: PointLabel
        b: PointOrPosition = Field(description="The other point, or a position [m].")
        name: ItemName = None

    return RodEntry


def rod(model: Any, a: Any, b: Any, name: str | None = None) -> Rod:
    """Keep the distance of two points."""
    where, label, first, second = model.named_pair("rod", "rod", a, b, name)
    if isinstance(second, Point):
        check_apart(where, first, second)
    made = Rod(label, first, second)
    if made.length <= 1e-9 * model.size:
        hint = "model.connect(...) holds points together"
        raise ModelError(f"{where}.b", "coincides with a: a rod needs a length", hint)
    return model.add_connection(where, made)


ROD = Kind(
    Rod,
    "rod",
    "rod",
    "rod",
    entry,
    lambda item: f"length {number(item.length)} m",
    ends=("a", "b"),
    asked=JOINT,
    rows="rod",
    look=Look("circle", "light", 4.0),
    add=rod,
)
