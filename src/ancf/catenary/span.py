"""Span: the part of a line between two supports, with its droppers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import ModelError
from ..model import checks

CLOSEST = 0.05  # m, of droppers to each other and to the supports
LONGEST = 1000.0  # m; spans of overhead lines have up to 80 m


@dataclass(frozen=True, slots=True, kw_only=True)
class Span:
    """One span.

    Parameters
    ----------
    length : float, m
        Distance of its two supports.
    droppers : (n,) m
        Places of the droppers from the start of the span, increasing.
    pre_sag : float or (n,), m
        How far the contact wire at rest is below its nominal height, at each dropper; one number is the
        depth of a parabola between the first and the last dropper.

    Attributes
    ----------
    droppers, pre_sag : tuple of float
        One value for each dropper.

    """

    length: float
    droppers: tuple[float, ...]
    pre_sag: Any = 0.0

    def __post_init__(self) -> None:
        """Check the values alone; places in a line are named by the line."""
        if checks.positive(self.length, "span.length") > LONGEST:
            raise ModelError("span.length", f"must be at most {LONGEST:g} m, is {self.length:g} m")
        droppers = checks.array(self.droppers, "span.droppers", (None,))
        if droppers.size == 0:
            raise ModelError("span.droppers", "has no dropper", "give at least one")
        _check_places(droppers.tolist(), self.length)
        object.__setattr__(self, "droppers", tuple(droppers.tolist()))
        object.__setattr__(self, "pre_sag", _pre_sag(self.pre_sag, droppers))


def _check_places(droppers: list[float], length: float) -> None:
    before = 0.0
    for k, x in enumerate(droppers):
        where = f"span.droppers[{k}]"
        if not 0.0 < x < length:
            raise ModelError(where, f"is at {x:g} m, outside its span of {length:g} m", "0 < x < length")
        if k and x <= before:
            raise ModelError(where, f"is at {x:g} m after one at {before:g} m", "sort the droppers")
        if x - before < CLOSEST or length - x < CLOSEST:
            what = f"is at {x:g} m, closer than {CLOSEST} m to a support or to the dropper before"
            raise ModelError(where, what)
        before = x


def _pre_sag(given: Any, x: np.ndarray[Any, np.dtype[np.float64]]) -> tuple[float, ...]:
    """Sags (n,) in m out of the depth of the parabola, or checked as they are."""
    if isinstance(given, Sequence | np.ndarray) and not isinstance(given, str):
        return tuple(checks.array(given, "span.pre_sag", (x.size,)).tolist())
    depth = checks.non_negative(given, "span.pre_sag")
    width = float(x[-1] - x[0])
    if width == 0.0:
        return (depth,)
    return tuple((4.0 * depth * (x - x[0]) * (x[-1] - x) / width**2).tolist())
