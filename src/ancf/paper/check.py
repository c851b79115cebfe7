"""Check: a computed number beside its reference, and whether it is near enough."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

Rule = Literal["within", "factor", "at least", "at most"]


@dataclass(frozen=True, slots=True)
class Check:
    """One number of a figure or table and what it is compared with.

    Parameters
    ----------
    name : str
        What it is, unique over all checks: "7.1 cable, 4 elements: tip z".
    value, reference : float
        Computed, and what it should be, in `unit`.
    tolerance : float
        By `rule`: largest difference ("within"), largest ratio of the two in either direction ("factor"), or
        what the value may fall short of ("at least") or exceed ("at most") the reference by.
    unit : str
        "m", "N", "" for a number without one.
    origin : str
        Where the reference comes from: a closed form, an independent code, a page of the paper, a standard.
    rule : "within", "factor", "at least" or "at most"

    """

    name: str
    value: float
    reference: float
    tolerance: float
    unit: str
    origin: str
    rule: Rule = "within"

    @property
    def deviation(self) -> float:
        """Value less reference, in `unit`."""
        return self.value - self.reference

    @property
    def passed(self) -> bool:
        """Whether the value is near enough; a value that is no number never is."""
        if not math.isfinite(self.value):
            return False
        if self.rule == "factor":
            ratio = self.value / self.reference
            return 1.0 / self.tolerance <= ratio <= self.tolerance
        if self.rule == "within":
            return abs(self.deviation) <= self.tolerance
        shortfall = -self.deviation if self.rule == "at least" else self.deviation
        return shortfall <= self.tolerance

    def plain(self) -> dict[str, Any]:
        """Entry of the JSON summary."""
        keys = ("name", "value", "reference", "tolerance", "passed", "rule", "unit", "origin")
        return {key: getattr(self, key) for key in keys}
