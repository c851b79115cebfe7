"""Quantity: one number read off a run, with its unit and, where there is one, its accepted range."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

#: What the tags of limits mean.
TAGS = {
    "V": "read in a public source",
    "V2": "read in two public sources",
    "U": "believed right, not yet checked against a copy of the standard",
    "practice": "usual in practice",
}


@dataclass(frozen=True)
class Quantity:
    """A value, and the range in which it is accepted.

    Parameters
    ----------
    key : str
        Name for programs, ``mean_force``.
    name : str
        Name for people.
    unit : str
        Empty for a pure number.
    value : float
    low, high : float, optional
        Accepted range, both ends included; None for an open end.
    tag : str, optional
        How sure the range is, one of `TAGS`.

    """

    key: str
    name: str
    unit: str
    value: float
    low: float | None = None
    high: float | None = None
    tag: str | None = None

    @property
    def inside(self) -> bool | None:
        """Whether the value is in its range; None without a range."""
        if self.low is None and self.high is None:
            return None
        above = self.low is None or self.value >= self.low
        return bool(above and (self.high is None or self.value <= self.high))  # of numpy's numbers too

    @property
    def row(self) -> dict[str, Any]:
        """Quantity, unit, value, low, high, inside and tag, as in ``validate.json``."""
        return {
            "quantity": self.name,
            "unit": self.unit,
            "value": self.value,
            "low": self.low,
            "high": self.high,
            "inside": self.inside,
            "tag": self.tag,
        }


def shown(value: float | None, unit: str = "") -> str:
    """A number as a table shows it: digits that an engineer reads, by unit."""
    if value is None:
        return ""
    digits = {"N": 1, "mm": 1, "%": 2, "ms": 1, "km/h": 1, "": 3, "count": 0, "1e-6": 0}.get(unit, 4)
    text = f"{value:.{digits}f}"
    return text.replace("-", "\N{MINUS SIGN}") if float(text) else text.lstrip("-")


def shown_limits(quantity: Quantity) -> str:
    """The range as a table shows it; empty without one."""
    low, high = quantity.low, quantity.high
    if low is None and high is None:
        return ""
    if low is None:
        return f"≤ {_plain(high)}"
    if high is None:
        return f"≥ {_plain(low)}"
    return _plain(low) if low == high else f"{_plain(low)} to {_plain(high)}"


def verdict(quantity: Quantity) -> str:
    """``inside``, ``outside`` or nothing."""
    return {True: "inside", False: "outside", None: ""}[quantity.inside]


def _plain(value: float | None) -> str:
    return "" if value is None else f"{value:g}".replace("-", "\N{MINUS SIGN}")
