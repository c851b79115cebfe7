"""Derivatives by differences of whole computations, and what a derivative leaves of a change (Taylor)."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from ..arrays import FloatArray
from ..model.model import Model
from ..model.vary import value_of, varied

#: Central differences from which is extrapolated.
LEVELS = 5
#: Changes of the number in Taylor's remainders, as shares of the largest one.
DECADES = (1.0, 0.1, 0.01, 0.001)
#: Round-off of a computation, as a share of its numbers; a remainder has to be ten times that to be judged.
ROUND_OFF = 3e-13

#: Numbers of a model that is computed.
Answer = Callable[[Model], FloatArray]


def extrapolated(
    answer: Answer, model: Model, name: str, width: float = 1e-2, levels: int = LEVELS
) -> FloatArray:
    """Derivative of an answer by a number of the model: central differences, extrapolated to none (Romberg).

    Parameters
    ----------
    answer : callable
        Takes a Model, returns numbers of any shape.
    model : Model
    name : str
        Path of the number.
    width : float
        Largest change, as a share of the number.
    levels : int
        Central differences, each with half the change of the one before.

    Returns
    -------
    derivative : ndarray
        Entry of Romberg's table that agrees best with its neighbours.
    """
    p, change = value_of(model, name), width * _size(model, name)

    def at(x: float) -> FloatArray:
        return np.asarray(answer(varied(model, name, p + x)))

    rows: list[list[FloatArray]] = []
    best, least = np.zeros(0), np.inf
    for k in range(levels):
        e = change * 2.0**-k
        row = [(at(e) - at(-e)) / (2.0 * e)]
        for j in range(k):
            row.append(row[j] + (row[j] - rows[-1][j]) / (4.0 ** (j + 1) - 1.0))
        for j in range(1, k + 1):
            moved = float(np.max(np.abs(row[j] - rows[-1][min(j, k - 1)])))
            if moved < least:
                best, least = row[j], moved
        rows.append(row)
    return best


def remainders(answer: Answer, model: Model, name: str, slope: FloatArray, width: float) -> list[float]:
    """Largest entries of f(p + h) - f(p) - h f'(p) over DECADES of h, as shares of f and h f'.

    ``width`` is the largest h as a share of p.
    """
    p, size, here = value_of(model, name), _size(model, name), np.asarray(answer(model))
    scale = float(np.max(np.abs(here)) + np.max(np.abs(slope)) * width * size)
    found = []
    for share in DECADES:
        h = share * width * size
        there = np.asarray(answer(varied(model, name, p + h)))
        found.append(float(np.max(np.abs(there - here - h * slope))) / scale)
    return found


def order(left: list[float]) -> float | None:
    """Power of h with which remainders fall, in the decade farthest from 2; None if all is round-off."""
    pairs = [(a, b) for a, b in pairwise(left) if b > 10.0 * ROUND_OFF]
    slopes = [float(np.log10(a / b)) for a, b in pairs]
    return max(slopes, key=lambda slope: abs(slope - 2.0), default=None)


def _size(model: Model, name: str) -> float:
    """Of a number that is zero, 1."""
    return abs(value_of(model, name)) or 1.0
