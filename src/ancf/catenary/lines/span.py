"""Span: the part of a line between two supports, with its droppers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks

CLOSEST = 0.05  # m, of droppers to each other and to the supports
MOST = 1000  # droppers in a span
SHARPEST = 10.0  # m, of a curve
LONGEST = 1000.0  # m; spans of overhead lines have up to 80 m
DEEPEST = 5.0  # m, of a pre-sag; usual is a thousandth of the span


def within(value: float, most: float, where: str, usual: str) -> None:
    """Raise ModelError for a length that can only be a slip of units."""
    if abs(value) > most:
        raise ModelError(where, f"is {value:g} m, at most {most:g} m either way", f"units are m: {usual}")


def of_supports(value: object, where: str, count: int) -> FloatArray:
    """One number for each of so many supports (count,); ModelError if there are others."""
    clean = checks.array(value, where, (None,))
    if clean.size != count:
        what = f"has {clean.size} values, the line has {count} supports"
        raise ModelError(where, what, "give one, or one for each support")
    return clean


@dataclass(frozen=True, slots=True, kw_only=True)
class DropperRule:
    """Where droppers are when nobody lists them: at equal distances between the first and the last.

    Parameters
    ----------
    first : float, m
        Distance of the first from the support before, and of the last from the support behind.
    pitch_max : float, m
        Largest distance of two droppers.

    """

    first: float
    pitch_max: float

    def __post_init__(self) -> None:
        checks.positive(self.first, "span.droppers.first")
        checks.positive(self.pitch_max, "span.droppers.pitch_max")

    def places(self, length: float) -> tuple[float, ...]:
        """Places in a span of this length, m."""
        room = length - 2.0 * self.first
        if room <= 0.0:
            what = f"is {self.first:g} m, more than half of a span of {length:g} m"
            raise ModelError("span.droppers.first", what)
        count = max(1, math.ceil(room / self.pitch_max - 1e-9))
        if count > MOST:
            what = f"is {self.pitch_max:g} m, which makes {count} droppers in a span"
            raise ModelError("span.droppers.pitch_max", what, "units are m")
        return tuple(np.linspace(self.first, length - self.first, count + 1).round(6).tolist())


@dataclass(frozen=True, slots=True, kw_only=True)
class Span:
    """One span.

    Parameters
    ----------
    length : float, m
        Distance of its two supports.
    droppers : (n,) m, or DropperRule
        Places of the droppers from the start of the span, increasing; none in a line without messenger.
    pre_sag : float or (n,), m
        How far the contact wire at rest is below its nominal height, at each dropper; one number is the
        depth of a parabola between the first and the last dropper.
    radius : float, m
        Of the track's curve; positive to the left, where y points. Default straight.
    long_droppers : (m,) m, or DropperRule
        Of a compound catenary, those between messenger and auxiliary; default by the rule of the auxiliary.

    Attributes
    ----------
    droppers, pre_sag : tuple of float
        One value for each dropper.

    """

    length: float
    droppers: Any
    pre_sag: Any = 0.0
    radius: float | None = None
    long_droppers: Any = None

    @property
    def curvature(self) -> float:
        """1/radius, 1/m; 0 on straight track."""
        return 0.0 if self.radius is None else 1.0 / self.radius

    def __post_init__(self) -> None:
        """Check the values alone; places in a line are named by the line."""
        if checks.positive(self.length, "span.length") > LONGEST:
            what = f"must be at most {LONGEST:g} m, is {self.length:g} m"
            raise ModelError("span.length", what, "units are m")
        given: Any = self.droppers
        if isinstance(given, DropperRule):
            given = given.places(self.length)
        none = isinstance(given, list | tuple) and not given
        none = none or (isinstance(given, np.ndarray) and given.shape == (0,))
        droppers = np.zeros(0) if none else checks.array(given, "span.droppers", (None,))
        if self.radius is not None and abs(checks.number(self.radius, "span.radius")) < SHARPEST:
            what = f"is {self.radius:g} m, at least {SHARPEST:g} m either way"
            raise ModelError("span.radius", what, "leave it out on straight track")
        _check_places(droppers.tolist(), self.length)
        object.__setattr__(self, "droppers", tuple(droppers.tolist()))
        object.__setattr__(self, "pre_sag", _pre_sag(self.pre_sag, droppers))
        if self.long_droppers is not None:
            object.__setattr__(self, "long_droppers", self.long_places(self.long_droppers))

    def long_places(self, given: Any) -> tuple[float, ...]:
        """Places of droppers between messenger and auxiliary, from a list or a rule, m."""
        if isinstance(given, DropperRule):
            given = given.places(self.length)
        places = checks.array(given, "span.long_droppers", (None,)).tolist()
        try:
            _check_places(places, self.length)
        except ModelError as error:
            where = error.where.replace("span.droppers", "span.long_droppers")
            raise ModelError(where, error.what, error.hint) from None
        return tuple(places)


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
    if depth > DEEPEST:
        raise ModelError("span.pre_sag", f"is {depth:g} m, at most {DEEPEST:g} m", "units are m: 0.05")
    if x.size == 0:
        if depth:
            raise ModelError("span.pre_sag", "has no effect on a span without droppers", "leave it out")
        return ()
    width = float(x[-1] - x[0])
    if width == 0.0:
        return (depth,)
    return tuple((4.0 * depth * (x - x[0]) * (x[-1] - x) / width**2).tolist())
