"""One curve over time beside the moving picture."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray

#: Points of a curve at most: more than a screen has columns.
POINTS = 2000


@dataclass(frozen=True, slots=True)
class Curve:
    """A quantity over time.

    Parameters
    ----------
    name : str
        As in the legend of its panel.
    unit : str
    t : (k,) s
    values : (k,)
    panel : str
        Curves with the same panel are drawn together, in the same unit.
    run : int
        Which of several compared runs it is of.
    scale : (low, high), optional
        Values that the panel has to show; all of them where there is none.
    """

    name: str
    unit: str
    t: FloatArray
    values: FloatArray
    panel: str
    run: int = 0
    scale: tuple[float, float] | None = None


def decimated(t: FloatArray, values: FloatArray, most: int = POINTS) -> tuple[FloatArray, FloatArray]:
    """At most so many points of a curve; each kept stretch keeps its smallest and its largest value."""
    if len(t) <= most:
        return t, values
    edges = np.linspace(1, len(t) - 1, most // 2).astype(np.int64)
    kept = [0, len(t) - 1]
    for first, last in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        part = values[first:last]
        kept += [first + int(np.argmin(part)), first + int(np.argmax(part))]
    places = np.unique(kept)
    return t[places], values[places]


def within(t: FloatArray, span: tuple[float, float]) -> slice:
    """The times between two, the ends included."""
    low, high = np.searchsorted(t, span[0], "left"), np.searchsorted(t, span[1], "right")
    return slice(int(low), int(high))
