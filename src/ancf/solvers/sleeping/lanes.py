"""Cables of a part of a line that sleeps: constants that are zero, as its modes have stiffness and mass, and
chunks of elements that nothing touches.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray, IntArray
from ...elements.cable import CableBatch
from ...elements.cable_columns import DA_L, DB_L, EA_L, EI_L, MASS

#: Rows of the cables' constants that are zero in sleep.
ASLEEP_ROWS = (EA_L, EI_L, DA_L, DB_L, MASS)


class Lanes(NamedTuple):
    """Where the constants of a part's cables stand that are zero in sleep, in the flat arrays."""

    data: IntArray
    slope: IntArray


def lanes_of(cables: CableBatch, elements: IntArray) -> Lanes:
    """Of a part with these elements."""
    chunk = np.searchsorted(cables.first, elements, side="right") - 1
    lane, data, slope = elements - cables.first[chunk], cables.lane_data, cables.lane_slope
    rows = np.array(ASLEEP_ROWS)[:, None]
    return Lanes(
        np.ravel_multi_index((chunk[None], rows, lane[None]), data.shape).ravel(),
        np.ravel_multi_index((chunk, np.zeros_like(chunk), lane), slope.shape),
    )


def sleep(cables: CableBatch, lanes: Lanes) -> tuple[FloatArray, FloatArray]:
    """Take stiffness and mass from the cables of a part; what was taken."""
    data, slope = cables.lane_data.reshape(-1), cables.lane_slope.reshape(-1)
    kept = data[lanes.data], slope[lanes.slope]
    data[lanes.data], slope[lanes.slope] = 0.0, 0.0
    return kept


def wake(cables: CableBatch, lanes: Lanes, kept: tuple[FloatArray, FloatArray]) -> None:
    """Give it back."""
    cables.lane_data.reshape(-1)[lanes.data], cables.lane_slope.reshape(-1)[lanes.slope] = kept


class Chunks:
    """Chunks of elements; those that sleep altogether are not touched by anything.

    Parameters
    ----------
    cables : CableBatch
    elements : list of ndarray
        Elements of each part.
    touched : ndarray, (chunks, 2)
        Blocks that each touches, see :class:`ancf.system.near.Near`; changed where parts sleep.
    """

    def __init__(self, cables: CableBatch, elements: list[IntArray], touched: IntArray) -> None:
        self.touched, self.all = touched, touched.copy()
        self.size, self.asleep = np.diff(cables.first), np.zeros(len(touched), dtype=np.int64)
        chunks = [np.searchsorted(cables.first, own, side="right") - 1 for own in elements]
        self.own = [np.unique(own, return_counts=True) for own in chunks]

    def mark(self, k: int, asleep: int) -> None:
        """A part falls asleep (1) or wakes (0)."""
        chunks, count = self.own[k]
        self.asleep[chunks] += count if asleep else -count
        awake = self.asleep[chunks] < self.size[chunks]
        self.touched[chunks] = self.all[chunks] * awake[:, None]
