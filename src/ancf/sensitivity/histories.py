"""Derivatives of the states of a run at its stored times; of velocities alone where places follow."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..solvers.derivatives.sensitivity import ABAR, Q, V, places


@dataclass(frozen=True)
class Places:
    """Derivatives of q by one parameter at the ends of all steps, computed from those of v when called.

    The rule of the steps leads from velocities to places, and nothing else moves these: no joint that is
    shifted onto, no support with a motion of its own.

    Parameters
    ----------
    start, bar : (size,)
        Derivatives of q and of the algorithmic acceleration at the start.
    rates : (steps + 1, size)
        Those of v.
    h, rest, full, scheme
        The steps, see :func:`ancf.solvers.derivatives.sensitivity.places`.
    """

    start: FloatArray
    bar: FloatArray
    rates: FloatArray
    h: float
    rest: float
    full: int
    scheme: Any

    def __call__(self) -> FloatArray:
        """(steps + 1, size)."""
        made = np.empty_like(self.rates)
        made[0] = self.start
        places(self.rates, self.h, self.rest, self.full, self.scheme, self.bar.copy(), made)
        return made


class Histories:
    """Room for the derivatives by all parameters.

    Parameters
    ----------
    parameters, count, size : int
        How many parameters, stored times and entries of a state.
    led : bool
        Places follow from velocities, of which every step is stored.

    Attributes
    ----------
    rows : (p, n, 2, size) or, led, (p, n, 1, size)
    stored : int
        Times so far.
    """

    def __init__(self, parameters: int, count: int, size: int, led: bool) -> None:
        self.led, self.stored = led, 0
        self.rows = np.empty((parameters, count, 1 if led else 2, size))

    def begin(self, found: FloatArray, held: FloatArray) -> None:
        """Store the start, (p, 4, size), and what of it is held, (p, 2, size)."""
        self.start = found
        first = found[:, None, : V + 1].copy()
        first[:, 0] += held
        self.keep(first)

    def keep(self, made: FloatArray) -> None:
        """Store derivatives of q and v, (p, n, 2, size)."""
        self.rows[:, self.stored : self.stored + made.shape[1]] = made[:, :, V:] if self.led else made
        self.stored += made.shape[1]

    def found(self, run: Any) -> list[tuple[Any, FloatArray]]:
        """Derivatives of q, or what computes them, and of v at the stored times, (n, size), by parameter."""
        each = self.rows[:, : self.stored]
        if not self.led:
            return [(rows[:, Q], rows[:, V]) for rows in each]
        steps = run.h, run.rest, run.full, run.scheme
        starts = zip(self.start[:, Q].copy(), self.start[:, ABAR].copy(), each[:, :, 0], strict=True)
        return [(Places(*own, *steps), own[2]) for own in starts]
