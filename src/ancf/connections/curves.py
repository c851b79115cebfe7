"""Curves of springs and dampers: straight lines between given places, and beyond them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..compiled import formula


def curves(given: Sequence[FloatArray | None]) -> dict[str, Any]:
    """Fields of a batch with n curves, one after the other, from their rows (k, 2), None for none.

    Returns
    -------
    dict
        begins (n + 1,), the row at which each begins, and the next where it has none; in the m rows of all
        place (m,), height (m,) and area (m,), the integral of the height from 0 to the place.
    """
    rows = [np.zeros((0, 2)) if one is None else one for one in given]
    whole = np.concatenate([*rows, np.zeros((0, 2))])
    return {
        "begins": np.concatenate([[0], np.cumsum([len(one) for one in rows])]).astype(np.int64),
        "place": np.ascontiguousarray(whole[:, 0]),
        "height": np.ascontiguousarray(whole[:, 1]),
        "area": np.concatenate([*(_area(*one.T) for one in rows if len(one)), np.zeros(0)]),
    }


def _area(x: FloatArray, f: FloatArray) -> FloatArray:
    grown = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(x) * (f[1:] + f[:-1]))])
    k = int(np.clip(np.searchsorted(x, 0.0) - 1, 0, x.size - 2))
    slope = (f[k + 1] - f[k]) / (x[k + 1] - x[k])
    at_zero = grown[k] - x[k] * (f[k] - 0.5 * slope * x[k])
    area: FloatArray = grown - at_zero
    return area


@formula
def looked_up(batch, k, x):
    """Value, slope and integral from 0 of curve k at x; all zero where there is none."""
    low, high = batch.begins[k], batch.begins[k + 1] - 1
    if high <= low:
        return 0.0, 0.0, 0.0
    while high - low > 1:
        middle = (low + high) // 2
        if batch.place[middle] <= x:
            low = middle
        else:
            high = middle
    slope = (batch.height[high] - batch.height[low]) / (batch.place[high] - batch.place[low])
    d = x - batch.place[low]
    value = batch.height[low] + slope * d
    return value, slope, batch.area[low] + 0.5 * d * (batch.height[low] + value)
