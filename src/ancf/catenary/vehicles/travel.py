"""Travel: where a train is at a time, from a speed or a speed profile."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks


@dataclass(frozen=True)
class Travel:
    """Speed over time, linear between the given times and constant after the last one.

    Parameters
    ----------
    times : (n,) s
        Increasing, the first is 0.
    speeds : (n,) m/s
        Positive.

    """

    times: FloatArray
    speeds: FloatArray

    @property
    def constant(self) -> bool:
        """Whether the speed does not change."""
        return bool(np.all(self.speeds == self.speeds[0]))

    @property
    def top(self) -> float:
        """Highest speed, m/s."""
        return float(np.max(self.speeds))

    def speed(self, t: Any) -> FloatArray:
        """Speed, m/s."""
        speed: FloatArray = np.interp(t, self.times, self.speeds)
        return speed

    def distance(self, t: Any) -> FloatArray:
        """Distance since t = 0, m."""
        t = np.asarray(t, dtype=np.float64)
        k = np.clip(np.searchsorted(self.times, t, side="right") - 1, 0, len(self.times) - 1)
        since = t - self.times[k]
        distance: FloatArray = self._reached[k] + 0.5 * since * (self.speeds[k] + self.speed(t))
        return distance

    def time(self, distance: float) -> float:
        """Time at which a distance >= 0 is reached, s."""
        k = int(np.searchsorted(self._reached, distance, side="right")) - 1
        rest, v = distance - self._reached[k], self.speeds[k]
        a = 0.0
        if k + 1 < len(self.times):
            a = (self.speeds[k + 1] - v) / (self.times[k + 1] - self.times[k])
        return float(self.times[k] + 2.0 * rest / (v + np.sqrt(v * v + 2.0 * a * rest)))

    @property
    def _reached(self) -> FloatArray:
        mean = 0.5 * (self.speeds[1:] + self.speeds[:-1])
        return np.concatenate([[0.0], np.cumsum(mean * np.diff(self.times))])


def make_travel(speed: float | Sequence[Sequence[float]], where: str = "run.speed") -> Travel:
    """Travel at a speed in m/s, or along a profile of pairs (time in s, speed in m/s)."""
    if not isinstance(speed, Sequence | np.ndarray):
        return Travel(np.zeros(1), np.full(1, checks.positive(speed, where)))
    table = checks.array(speed, where, (len(speed), 2))
    for k, value in enumerate(table[:, 1]):
        checks.positive(value, f"{where}[{k}][1]")
    if table[0, 0] != 0.0:
        raise ModelError(f"{where}[0][0]", f"is {table[0, 0]:g} s, a profile starts at 0 s")
    late = np.flatnonzero(np.diff(table[:, 0]) <= 0.0)
    if len(late):
        raise ModelError(f"{where}[{late[0] + 1}][0]", "is not later than the time before")
    return Travel(table[:, 0].copy(), table[:, 1].copy())
