"""Numbers of a check as text: as many digits as its tolerance is worth."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..check import Check

#: Digits of a number without a tolerance to go by.
DIGITS = 5
#: Decimals that are still written without an exponent, and the largest such number.
DECIMALS, LARGE = 9, 1e6
UNKNOWN = "no number"


def value(check: Check) -> str:
    """The computed number."""
    return _shown(check.value, check)


def reference(check: Check) -> str:
    """The reference, with what it is when the value need not be equal."""
    text = _shown(check.reference, check)
    return f"{check.rule} {text}" if check.rule in ("at least", "at most") else text


def deviation(check: Check) -> str:
    """Value less reference; their ratio where that is what counts."""
    if check.rule == "factor":
        return f"factor {_plain(check.value / check.reference, 3)}" if check.reference else UNKNOWN
    return _plain(check.deviation, 2, sign=True)


def tolerance(check: Check) -> str:
    """The tolerance, by its rule."""
    text = _plain(check.tolerance, 3)
    if check.rule == "within":
        return f"± {text}" if check.tolerance else "exact"
    if check.rule == "factor":
        return f"factor {text}"
    return text if check.tolerance else "none"


def share(use: float | None) -> str:
    """Use of a tolerance, per cent."""
    if use is None:
        return ""
    if not math.isfinite(use):
        return "beyond"
    return "< 0.1 %" if 0 < use < 1e-3 else f"{100 * use:.2g} %" if use < 1 else f"{100 * use:.0f} %"


def duration(seconds: float) -> str:
    """Run time."""
    if seconds < 100:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s"


def _shown(number: float, check: Check) -> str:
    if check.rule == "factor" or not check.tolerance > 0 or not math.isfinite(number):
        return _plain(number, DIGITS)
    decimals = max(0, 1 - math.floor(math.log10(check.tolerance)))
    if decimals <= DECIMALS and abs(number) < LARGE:
        return _minus(f"{number:.{decimals}f}")
    size = math.floor(math.log10(abs(number))) if number else 0
    return _plain(number, min(max(2, size + decimals + 1), 15))


def _plain(number: float, digits: int, sign: bool = False) -> str:
    if not math.isfinite(number):
        return UNKNOWN
    return _minus(f"{number:{'+' if sign and number else ''}.{digits}g}")


def _minus(text: str) -> str:
    """A minus sign instead of a hyphen."""
    return text.replace("-", "\N{MINUS SIGN}")
