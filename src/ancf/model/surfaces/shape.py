"""What all shapes of surfaces share: parameters with their checks, place, axis, description."""

from __future__ import annotations

import math
import os
from dataclasses import MISSING, dataclass, fields
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray
from .. import checks


def _path(given: Any, where: str) -> str:
    return checks.text(os.fspath(given) if isinstance(given, os.PathLike) else given, where)


def _points(given: Any, where: str) -> FloatArray:
    return checks.array(given, where, (None, 3))


def _triangles(given: Any, where: str) -> NDArray[np.int64]:
    return checks.array(given, where, (None, 3)).astype(np.int64)


_CHECKS: dict[str, Any] = {
    "positive": checks.positive,
    "vector": checks.vector,
    "direction": checks.direction,
    "path": _path,
    "points": _points,
    "triangles": _triangles,
}


@dataclass(frozen=True)
class Parameter:
    """A parameter of a shape.

    Parameters
    ----------
    name : str
        Key in the class and in files.
    kind : str
        "positive", "vector", "direction", which is of length 1 after the check, "path", "points" (n, 3), or
        "triangles" (m, 3) of int.
    unit, description : str
    """

    name: str
    kind: str
    unit: str
    description: str

    def check(self, given: Any, where: str) -> Any:
        """The clean value; ModelError if it is wrong."""
        return _CHECKS[self.kind](given, f"{where}.{self.name}")


AT = Parameter("at", "vector", "m", "Its middle; on a rigid body in body axes from the centre of mass")
AXIS = Parameter("axis", "direction", "-", "Direction of its axis, any length")
RADIUS = Parameter("radius", "positive", "m", "Radius")


@dataclass(frozen=True, eq=False)
class Shape:
    """A surface of revolution about an axis through a place.

    Places and directions are global ones of a surface on the ground; on a rigid body they are in body axes,
    from its centre of mass.
    """

    parameters: ClassVar[tuple[Parameter, ...]] = ()

    def __post_init__(self) -> None:
        for p, field in zip(self.parameters, fields(self), strict=True):
            given = getattr(self, p.name)
            if given is None and field.default is not MISSING:
                continue
            object.__setattr__(self, p.name, p.check(given, type(self).__name__))
        self.check()

    def check(self) -> None:
        """Raise ModelError where its numbers do not fit together."""

    @property
    def word(self) -> str:
        """Its name in files."""
        return type(self).__name__.lower()

    @property
    def place(self) -> FloatArray:
        """Where its heights are zero, (3,) m."""
        return np.asarray(getattr(self, "at"), dtype=np.float64)  # noqa: B009

    @property
    def direction(self) -> FloatArray:
        """Unit vector of its axis, (3,)."""
        return np.asarray(getattr(self, "axis", (0.0, 0.0, 1.0)), dtype=np.float64)

    @property
    def numbers(self) -> list[float]:
        """What its profile takes, at most four."""
        return []

    @property
    def outline(self) -> list[tuple[float, float]]:
        """Places (rho, z) on the profile, in order, as a picture draws it; m."""
        return []

    @property
    def narrowest(self) -> float:
        """Depth from which nothing says any more on which side a cable is, m."""
        return math.inf

    def describe(self) -> dict[str, Any]:
        """Its word and its numbers."""
        given = {p.name: getattr(self, p.name) for p in self.parameters}
        plain = {key: x.tolist() if isinstance(x, np.ndarray) else x for key, x in given.items()}
        return {"shape": self.word, **{key: x for key, x in plain.items() if x is not None}}
