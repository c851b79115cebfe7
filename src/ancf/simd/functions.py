"""Cosine, sine and exponential of eight numbers, by sums and products alone.

An argument is made small by what is exact, the series does the rest, doublings bring the value back.
"""

from __future__ import annotations

import math
from typing import Any

from ..compiled import formula
from .values import every, greatest

#: A double to which a number is added and from which it is taken again is rounded to an integer.
ROUNDER = 1.5 * 2.0**52
#: 2 pi in two parts: the first has few digits, so that its multiples are exact.
TURN, REST = 6.28125, 0.0019353071795864769
#: exp(x/PARTS) is multiplied with itself; below LEAST the exponential is that of LEAST.
SQUARINGS = 8
PARTS = 2.0**SQUARINGS
LEAST = -40.0


@formula
def cos_and_sin(x: Any) -> Any:
    """Cosine and sine of x, |x| up to 1e5, to 1e-14 and the round-off of x.

    The series are of a quarter of the angle, then its double is taken twice.
    """
    n = x * (1.0 / (2.0 * math.pi)) + every(ROUNDER)
    n = n - every(ROUNDER)
    y = 0.25 * ((x - TURN * n) - REST * n)
    z = y * y
    s = z * (-1.0 / 1307674368000.0) + every(1.0 / 6227020800.0)
    s = s * z - every(1.0 / 39916800.0)
    s = s * z + every(1.0 / 362880.0)
    s = s * z - every(1.0 / 5040.0)
    s = s * z + every(1.0 / 120.0)
    s = s * z - every(1.0 / 6.0)
    s = y + (s * z) * y
    c = z * (1.0 / 20922789888000.0) - every(1.0 / 87178291200.0)
    c = c * z + every(1.0 / 479001600.0)
    c = c * z - every(1.0 / 3628800.0)
    c = c * z + every(1.0 / 40320.0)
    c = c * z - every(1.0 / 720.0)
    c = c * z + every(1.0 / 24.0)
    c = c * z - every(0.5)
    c = every(1.0) + c * z
    s, c = 2.0 * (s * c), every(1.0) - 2.0 * (s * s)
    return every(1.0) - 2.0 * (s * s), 2.0 * (s * c)


@formula
def decay(x: Any) -> Any:
    """exp(x) of x <= 0, to 1e-13 of its value; below -40 that of -40."""
    y = greatest(x, LEAST) * (1.0 / PARTS)
    e = y * (1.0 / 39916800.0) + every(1.0 / 3628800.0)
    e = e * y + every(1.0 / 362880.0)
    e = e * y + every(1.0 / 40320.0)
    e = e * y + every(1.0 / 5040.0)
    e = e * y + every(1.0 / 720.0)
    e = e * y + every(1.0 / 120.0)
    e = e * y + every(1.0 / 24.0)
    e = e * y + every(1.0 / 6.0)
    e = e * y + every(0.5)
    e = e * y + every(1.0)
    e = e * y + every(1.0)
    for _ in range(SQUARINGS):
        e = e * e
    return e
