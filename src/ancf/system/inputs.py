"""Functions of time, tabulated at the ends of a block of steps."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..model.functions.function import TimeFunction
from ..model.supports.winch import Winch
from .core import Tables
from .drives import acceleration_from, driven_steps
from .supports import Constraints, Motion, Rotation

#: Points of the difference formulas for the rates of given motions: sixth order.
STENCIL = 7
#: Times for which the terms of all formulas are made at once.
FEW = 8
#: Their step at a moment of which no run is known, s, and how many times a quarter of it may be better.
MOMENT, QUARTERS = 1e-3, 12
#: Change of second derivatives by a quarter of the step that is none, and digits of values.
SETTLED, DIGITS = 1e-6, 100 * float(np.finfo(np.float64).eps)


@dataclass(frozen=True)
class Drive:
    """Where a length that follows from step to step stands in tables and state vectors."""

    winch: Winch
    unknown: int
    column: int  # of Tables.motion
    row: int  # of the inputs of loads: the weight goes with the length

    def put(self, tables: Tables, rows: slice, found: FloatArray) -> None:
        """Put lengths and their rates, (3,) or (n, 3), into some rows of tables."""
        tables.motion[rows, self.column] = found
        tables.value[rows, self.row] = found[..., :1]


def _drives(motions: list[Motion], loads: list[TimeFunction]) -> list[Drive]:
    found, column = [], 0
    for motion in motions:
        if motion.drive is not None:
            row = next(k for k, function in enumerate(loads) if function is motion.drive.length)
            found.append(Drive(motion.drive, motion.unknowns[0], column, row))
        column += len(motion.unknowns)
    return found


class Inputs:
    """Values of loads and motions of supports of a System as functions of time.

    Parameters
    ----------
    loads : list of TimeFunction
        Inputs of the loads, each of shape (3,): of the dead ones, then of those that depend on the state.
    constraints : Constraints
        Unknowns and rotations in the order of the System.
    given : dict of str to float
        The model's inputs, with their first values.

    Attributes
    ----------
    given : dict of str to float
        What the model's inputs are now; changed by :meth:`give` alone.
    changes : int
        How often they have changed.
    led : list of int
        Loads that depend on them.
    drives : list of Drive
        Lengths that follow from step to step.
    still : bool
        Nothing depends on time, inputs or the state.
    """

    def __init__(
        self, loads: list[TimeFunction], constraints: Constraints, given: dict[str, float] | None = None
    ) -> None:
        self.loads = loads
        self.given = {} if given is None else dict(given)
        self.changes = 0
        self.last: tuple[tuple[float, int], Tables] | None = None  # of `moment`
        self.motions = constraints.motions
        self.drives = _drives(self.motions, loads)
        own = {drive.row for drive in self.drives}
        self.led = [k for k, function in enumerate(loads) if function.inputs and k not in own]
        self.rotations = [r for r in constraints.rotations if r.moves]
        self.still = not (self.motions or self.rotations) and all(f.constant for f in loads)
        self.prescribed = np.array([i for m in self.motions for i in m.unknowns], dtype=np.int64)

    def give(self, name: str, value: float) -> None:
        """Let an input have a value from now on."""
        if self.given[name] != value:
            self.given[name] = value
            self.changes += 1

    def tables(
        self,
        start: float,
        step: float,
        steps: int,
        first: float,
        last: float,
        here: tuple[FloatArray, FloatArray] | None = None,
        still: bool = False,
    ) -> Tables:
        """Tables at start + step, ..., start + steps * step.

        ``first`` and ``last`` are the times of the whole run, s: rates are differences of values
        between them.  ``here``: state vectors q, v from which lengths follow that are driven; ``still``: they
        are as they are there, with the acceleration of a step from there on.
        """
        if self.still:
            value = _amplitudes(self.loads, np.zeros(steps), self.given)
            return Tables(value, np.zeros((steps, 0, 3)), np.zeros((steps, 0, 3, 3, 3)))
        times = on_grid(start, step, np.arange(1, steps + 1), first)
        motion = [self._motion(k, times, step, first, last) for k in range(len(self.motions))]
        rotation = [self._rotation(r, times, step, first, last) for r in self.rotations]
        made = Tables(
            value=_amplitudes(self.loads, times, self.given),
            motion=np.ascontiguousarray(np.concatenate(motion, axis=1))
            if motion
            else np.zeros((steps, 0, 3)),
            rotation=np.ascontiguousarray(np.stack(rotation, axis=1))
            if rotation
            else np.zeros((steps, 0, 3, 3, 3)),
        )
        for drive in self.drives:
            self._lengths(drive, made, times, step, here, still)
        return made

    def moment(self, time: float, here: tuple[FloatArray, FloatArray]) -> Tables:
        """Tables at one time in s, of which no steps are known; rates are as fine as motions need.

        Those of the last time are kept, unless lengths follow from the state: a start asks several times.
        """
        key = time, self.changes
        if self.last is None or self.last[0] != key or self.drives:
            self.last = key, self._moment(time, here)
        return self.last[1]

    def _moment(self, time: float, here: tuple[FloatArray, FloatArray]) -> Tables:
        made = self.tables(time - MOMENT, MOMENT, 1, time, np.inf, here, still=True)
        times, column = np.array([time]), 0
        for k, motion in enumerate(self.motions):
            columns = slice(column, column := column + len(motion.unknowns))
            if motion.drive is None and motion.rates is None:
                step = suited(motion.values, time)
                if step < MOMENT:
                    made.motion[:, columns] = self._motion(k, times, step, time, np.inf)
        for k, r in enumerate(self.rotations):
            values = r.turned if r.angle is None else r.angle.table
            if r.rate is None and (step := suited(values, time)) < MOMENT:
                made.rotation[:, k] = self._rotation(r, times, step, time, np.inf)
        return made

    def _lengths(
        self,
        drive: Drive,
        tables: Tables,
        times: FloatArray,
        step: float,
        here: tuple[FloatArray, FloatArray] | None,
        still: bool,
    ) -> None:
        """Fill in a driven length."""
        length = 0.0 if here is None else float(here[0][drive.unknown])
        if length <= 0.0:  # there is none yet
            length = float(drive.winch.length.under(self.given, times[:1])[0, 0])
            drive.winch.check_left(np.array([length]), times[:1])
            here = None
        rate = 0.0 if here is None else float(here[1][drive.unknown])
        if still:
            begins = acceleration_from(drive.winch, length, rate, float(times[0]), step, self.given)
            drive.put(tables, slice(None), np.array([length, rate, begins]))
        elif here is None:
            drive.put(tables, slice(None), np.array([length, rate, 0.0]))
        else:
            found = driven_steps(drive.winch, length, rate, times, step, self.given)
            drive.put(tables, slice(None), found)

    def _motion(self, k: int, times: FloatArray, step: float, first: float, last: float) -> FloatArray:
        motion = self.motions[k]
        if motion.drive is not None:
            return np.zeros((len(times), 1, 3))
        if motion.rates is not None:
            return np.stack([motion.rest + motion.values(times), *motion.rates(times)], axis=-1)
        values, *rates = differences(motion.values, times, step, first, last)
        return np.stack([motion.rest + values, *rates], axis=-1)

    def _rotation(self, r: Rotation, times: FloatArray, step: float, first: float, last: float) -> FloatArray:
        if r.vector is not None:
            found = differences(r.turned, times, step, first, last)
            return np.stack(found, axis=1).reshape(-1, 3, 3, 3)
        assert r.angle is not None
        angle = r.angle.table
        if r.rate is not None and r.acceleration is not None:
            columns = [angle(times), r.rate.table(times), r.acceleration.table(times)]
        else:
            columns = list(differences(angle, times, step, first, last))
        return r.matrices(*(c[:, 0] for c in columns))


def on_grid(start: float, step: float, number: NDArray[np.int64], first: float) -> FloatArray:
    """Times start + step * number, counted from ``first`` where they are steps from there.

    They are then the same to the last bit however the run is divided into blocks, which depends on how fast
    the machine is.
    """
    steps = float((start - first) / step)
    if math.isfinite(steps) and abs(steps - round(steps)) < 1e-6:
        counted: FloatArray = first + step * (float(round(steps)) + number.astype(np.float64))
        return counted
    times: FloatArray = start + step * number.astype(np.float64)
    return times


def _weights(offset: int) -> FloatArray:
    """Weights of the first and second derivative at point ``offset`` of a unit grid, shape (2, STENCIL)."""
    x = np.arange(STENCIL) - offset
    powers = np.vander(x, increasing=True).T.astype(np.float64)
    unit = np.zeros((STENCIL, 2))
    unit[1, 0], unit[2, 1] = 1.0, 2.0
    w: FloatArray = np.linalg.solve(powers, unit).T.astype(np.float64)
    return w


_WEIGHTS = np.stack([_weights(offset) for offset in range(STENCIL)])


def differences(
    function: Callable[[FloatArray], FloatArray], times: FloatArray, step: float, first: float, last: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Values and the first two derivatives of a tabulating function, by differences on the step grid.

    The formulas are centred, one-sided next to ``first`` and, where enough steps fit in, next to ``last``.

    Returns
    -------
    tuple of three ndarrays, shape (n, k)
    """
    n, half = len(times), STENCIL // 2
    at = max(int(np.floor((times[0] - first) / step + 1e-9)), 0) + np.arange(
        n
    )  # places on the grid from first
    # by round-off a time may be beyond the last one
    room = int(np.clip(np.floor((last - times[-1]) / step + 1e-9), 0, STENCIL))
    # which formula a time has depends on its place in the run, not on the block that it is in
    end = max(int(at[-1]) + room, STENCIL - 1)
    begin = np.clip(at - half, 0, end + 1 - STENCIL)
    below = int(at[0] - begin[0])
    grid = on_grid(times[0], step, np.arange(-below, begin[-1] + STENCIL - at[0]), first)
    grid[below : below + n] = times
    values = function(grid)
    if n <= FEW:  # the same sums, one after the other, by fewer calls
        window = values[(begin - begin[0])[:, None] + np.arange(STENCIL)]
        terms = _WEIGHTS[at - begin][..., None] * window[:, None]
        sums = np.add.accumulate(terms, axis=2)[:, :, -1] + 0.0
        return values[below : below + n], sums[:, 0] / step, sums[:, 1] / step**2
    rate, second = np.zeros((n, values.shape[1])), np.zeros((n, values.shape[1]))
    centred = bool(np.all(at - begin == half))  # all times have the same formula
    weights = _WEIGHTS[half, :, :, None] if centred else _WEIGHTS[at - begin].transpose(1, 2, 0)
    for s in range(STENCIL):  # one after the other: a sum by the library rounds as its length wants
        value = values[s : s + n] if centred else values[begin - begin[0] + s]
        rate += weights[0, s, :, None] * value
        second += weights[1, s, :, None] * value
    return values[below : below + n], rate / step, second / step**2


def suited(function: Callable[[FloatArray], FloatArray], time: float) -> float:
    """Step in s, ``MOMENT`` or less, of the differences from a time on that see how a function changes."""
    times, step = np.array([time]), MOMENT
    values, _, second = differences(function, times, step, time, np.inf)
    best, least = step, math.inf
    for _ in range(QUARTERS):
        finer = differences(function, times, 0.25 * step, time, np.inf)[2]
        change = float(np.max(np.abs(second - finer)))
        if change < least:
            best = step
        if change <= SETTLED * np.max(np.abs(finer)) + DIGITS * np.max(np.abs(values)) / (0.25 * step) ** 2:
            return best
        step, second, least = 0.25 * step, finer, min(change, least)
    return best


def _amplitudes(functions: list[TimeFunction], times: FloatArray, given: dict[str, float]) -> FloatArray:
    out = np.empty((len(times), len(functions), 3))
    for k, function in enumerate(functions):
        out[:, k] = function(float(times[0])) if function.constant else function.under(given, times)
    return out
