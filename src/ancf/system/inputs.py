"""Functions of time, tabulated at the ends of a block of steps."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..model.functions import TimeFunction
from .core import Tables
from .supports import Constraints, Rotation

#: Points of the difference formulas for the rates of given motions: sixth order.
STENCIL = 7


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
    """

    def __init__(
        self, loads: list[TimeFunction], constraints: Constraints, given: dict[str, float] | None = None
    ) -> None:
        self.loads = loads
        self.given = {} if given is None else dict(given)
        self.changes = 0
        self.led = [k for k, function in enumerate(loads) if function.inputs]
        self.motions = constraints.motions
        self.rotations = [r for r in constraints.rotations if r.moves]
        self.prescribed = np.array([i for m in self.motions for i in m.unknowns], dtype=np.int64)

    def give(self, name: str, value: float) -> None:
        """Let an input have a value from now on."""
        if self.given[name] != value:
            self.given[name] = value
            self.changes += 1

    def tables(self, start: float, step: float, steps: int, first: float, last: float) -> Tables:
        """Tables at start + step, ..., start + steps * step.

        ``first`` and ``last`` are the times of the whole run, s: rates are differences of values
        between them.
        """
        times = on_grid(start, step, np.arange(1, steps + 1), first)
        motion = [self._motion(k, times, step, first, last) for k in range(len(self.motions))]
        rotation = [self._rotation(r, times, step, first, last) for r in self.rotations]
        return Tables(
            value=_amplitudes(self.loads, times, self.given),
            motion=np.ascontiguousarray(np.concatenate([np.zeros((steps, 0, 3)), *motion], axis=1)),
            rotation=np.ascontiguousarray(
                np.stack(rotation, axis=1) if rotation else np.zeros((steps, 0, 3, 3, 3))
            ),
        )

    def _motion(self, k: int, times: FloatArray, step: float, first: float, last: float) -> FloatArray:
        motion = self.motions[k]
        if motion.rates is not None:
            return np.stack([motion.values(times), *motion.rates(times)], axis=-1)
        return np.stack(differences(motion.values, times, step, first, last), axis=-1)

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
    steps = (start - first) / step
    whole = np.round(steps)
    if np.isfinite(steps) and abs(steps - whole) < 1e-6:
        counted: FloatArray = first + step * (float(whole) + number.astype(np.float64))
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
    room = int(min(np.floor((last - times[-1]) / step + 1e-9), STENCIL))
    # which formula a time has depends on its place in the run, not on the block that it is in
    end = max(int(at[-1]) + room, STENCIL - 1)
    begin = np.clip(at - half, 0, end + 1 - STENCIL)
    below = int(at[0] - begin[0])
    grid = on_grid(times[0], step, np.arange(-below, begin[-1] + STENCIL - at[0]), first)
    grid[below : below + n] = times
    values = function(grid)
    rate, second = np.zeros((n, values.shape[1])), np.zeros((n, values.shape[1]))
    weights = _WEIGHTS[at - begin]
    for s in range(STENCIL):  # one after the other: a sum by the library rounds as its length wants
        value = values[begin - begin[0] + s]
        rate += weights[:, 0, s, None] * value
        second += weights[:, 1, s, None] * value
    return values[below : below + n], rate / step, second / step**2


def _amplitudes(functions: list[TimeFunction], times: FloatArray, given: dict[str, float]) -> FloatArray:
    out = np.empty((len(times), len(functions), 3))
    for k, function in enumerate(functions):
        out[:, k] = function(float(times[0])) if function.constant else function.under(given, times)
    return out
