"""Cycles of a history by rainflow counting, and their damage by a line of stress against cycles."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks


@dataclass(frozen=True)
class Cycles:
    """Cycles of a history, in the order in which they close; those that never do count a half.

    Parameters
    ----------
    range, mean : (n,) float
        Upper less lower end, and middle, in the unit of the history.
    count : (n,) float
        1 or 1/2.

    """

    range: FloatArray
    mean: FloatArray
    count: FloatArray

    @property
    def largest(self) -> float:
        """Largest range; 0 of a history that stays as it is."""
        return float(np.max(self.range, initial=0.0))

    def number(self, least: float = 0.0) -> float:
        """How many have at least this range."""
        return float(np.sum(self.count[self.range >= checks.number(least, "cycles.least")]))


@dataclass(frozen=True)
class FatigueLine:
    """Straight line of ranges against cycles to failure in logarithms (Basquin).

    Parameters
    ----------
    range : float
        That is borne `cycles` times, in the unit of the history.
    cycles : float
    slope : float
        m: a range twice as large is borne 2^-m times as often.

    """

    range: float
    cycles: float
    slope: float

    def __post_init__(self) -> None:
        for key in ("range", "cycles", "slope"):
            checks.positive(getattr(self, key), f"fatigue.{key}")

    def damage(self, found: Cycles) -> float:
        """Share of the life that cycles take (Palmgren and Miner): sum of count over cycles to failure."""
        if not isinstance(found, Cycles):
            raise ModelError(
                "fatigue.damage", f"must be Cycles, is {checks.shown(found)}", "rainflow(history)"
            )
        return float(np.sum(found.count * (found.range / self.range) ** self.slope) / self.cycles)


def turning_points(history: npt.ArrayLike) -> FloatArray:
    """First value, all reversals and last value of a history (n,); values that repeat count once."""
    x = np.asarray(history, dtype=np.float64)
    x = x[np.concatenate(([True], np.diff(x) != 0.0))]
    if x.size < 3:
        return x
    turns = np.flatnonzero(np.diff(np.sign(np.diff(x)))) + 1
    made: FloatArray = x[np.concatenate(([0], turns, [x.size - 1]))]
    return made


def rainflow(history: npt.ArrayLike) -> Cycles:
    """Cycles of a history (n,), counted by rainflow (ASTM E1049-85, 5.4.4).

    A range that is not larger than the one after it is a cycle, if it does not contain the first point of
    what is left, and otherwise half a one. What remains at the end counts as halves.

    Raises
    ------
    ModelError
        The history is empty, or holds a value that is not finite.

    """
    try:
        values = np.asarray(history, dtype=np.float64)
    except (TypeError, ValueError):
        values = np.zeros(0)
    if values.ndim != 1 or not values.size or not np.all(np.isfinite(values)):
        raise ModelError("rainflow.history", "must be a list of finite numbers")
    stack: list[float] = []
    found: list[tuple[float, float, float]] = []
    for point in turning_points(values).tolist():
        stack.append(point)
        while len(stack) > 2:
            start, end = stack[-3], stack[-2]
            if abs(stack[-1] - end) < abs(end - start):
                break
            whole = len(stack) > 3
            found.append((abs(end - start), 0.5 * (start + end), 1.0 if whole else 0.5))
            if whole:
                del stack[-3:-1]
            else:
                del stack[0]
    found += [(abs(b - a), 0.5 * (a + b), 0.5) for a, b in pairwise(stack)]
    columns = np.array(found, dtype=np.float64).reshape(-1, 3).T
    return Cycles(columns[0], columns[1], columns[2])
