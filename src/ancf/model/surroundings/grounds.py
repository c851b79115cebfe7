"""Ground: what bodies lie on, a plane or a table of heights."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks


@dataclass(frozen=True, slots=True, eq=False)
class Relief:
    """Heights z (nx, ny) over increasing x (nx,) and y (ny,), m; linear between them, level outside."""

    x: FloatArray
    y: FloatArray
    z: FloatArray

    def describe(self) -> dict[str, Any]:
        """Plain JSON-able form."""
        return {"x": self.x.tolist(), "y": self.y.tolist(), "z": self.z.tolist()}

    def at(self, x: float, y: float) -> float:
        """Height at a place."""
        along = [np.interp(y, self.y, row) for row in self.z]
        return float(np.interp(x, self.x, along))


@dataclass(frozen=True, slots=True, eq=False)
class Ground:
    """A ground, made by ``Model.add_ground``."""

    name: str
    height: float | Relief
    stiffness: float
    damping: float
    friction: float
    stick: float | None
    normal: FloatArray | None
    on: tuple[str, ...] | None

    @property
    def up(self) -> FloatArray:
        """Normal of the plane, or of the level outside a table."""
        return np.array([0.0, 0.0, 1.0]) if self.normal is None else self.normal

    def acts_on(self, name: str) -> bool:
        """Whether it acts on a body."""
        return self.on is None or name in self.on

    def depth(self, r: FloatArray) -> float:
        """How far a place (3,) is below it, m; negative above."""
        if isinstance(self.height, Relief):
            return self.height.at(r[0], r[1]) - float(r[2])
        return float((np.array([0.0, 0.0, self.height]) - r) @ self.up)


def height_of(given: Any, where: str) -> float | Relief:
    """A number, or a table {"x": (nx,), "y": (ny,), "z": (nx, ny)}, m.

    Raises
    ------
    ModelError
        It is neither.
    """
    if isinstance(given, Relief):
        return given
    if not isinstance(given, Mapping):
        return checks.number(given, where)
    if set(given) != {"x", "y", "z"}:
        what = f'a table of heights has the keys "x", "y" and "z", not {sorted(map(str, given))}'
        raise ModelError(where, what)
    x, y = (checks.array(given[key], f"{where}.{key}", (None,)) for key in "xy")
    for key, line in (("x", x), ("y", y)):
        checks.increasing(line, f"{where}.{key}", "places", " m")
    return Relief(x, y, checks.array(given["z"], f"{where}.z", (len(x), len(y))))


def upward(given: Any, where: str) -> FloatArray | None:
    """Unit normal that points up, or None for a level ground."""
    if given is None:
        return None
    normal = checks.direction(given, where)
    if normal[2] <= 0.0:
        raise ModelError(where, f"is {normal.tolist()}, must point up: its third number > 0")
    return normal
