"""Derivatives of the consistent start of a simulation."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import SolveError
from ..solvers.directions import products_along, rows_along
from ..solvers.sensitivity import ABAR, ENOUGH, MOST, NOISY, A, Matrices, Q, V, Way
from ..system.core import (
    apply_supports,
    assemble,
    factorise_matrix,
    follow_supports,
    place_supports,
    restrict,
    solve_matrix,
)
from ..system.system import System
from .family import Family
from .nearby import Nearby


class Start:
    """A consistent start, in which sensitivities begin.

    Parameters
    ----------
    system : System
    m : Matrices
    q, v, a : ndarray, shape (size,)
        At the start.
    when : tuple
        Start, step, first and last time of the tables of the start, see ``Inputs.tables``.
    """

    def __init__(
        self, system: System, m: Matrices, q: FloatArray, v: FloatArray, a: FloatArray, when: Any
    ) -> None:
        self.system, self.m = system, m
        self.q, self.v, self.a = q.copy(), v.copy(), a.copy()
        core, start = system.core, when
        tables = system.inputs.tables(start[0], start[1], 1, *start[2:])
        place_supports(core.supports, core.loads.value, tables, 0, self.q, self.v, self.a)
        system.level[:] = 0.0, 0.0, 1.0
        assemble(core.batches, core.ws, self.q, self.v, core.A, 1.0, 0.0, 0.0)
        restrict(core.supports, core.A)
        if factorise_matrix(core.A, core.factor) < 0:
            raise SolveError("sensitivities at the start", "the mass matrix is singular")

    def sensitivity(
        self,
        dq: FloatArray,
        dv: FloatArray,
        push: Any,
        gap: Any,
        shift: FloatArray | None = None,
        turn: FloatArray | None = None,
    ) -> FloatArray:
        """Derivatives of q, v, a and the algorithmic acceleration, (4, size), from those that are asked for.

        Parameters
        ----------
        dq, dv : (size,)
            Of the initial state, before constraints hold.
        push, gap : function of the level of the constraints
            Derivatives of the residual, and of the rows of the constraints, at fixed free unknowns.
        shift : (size,), optional
            Derivatives of q that are not in these, where it is held.
        turn : (k, 3, 3), optional
            Those of the local axes of supports.
        """
        d = np.zeros((3, self.system.size))
        d[0], d[1] = self._free(dq), self._free(dv)
        if shift is not None:
            d[0] += shift
        lam = self.system.multipliers
        d[:2, lam] = 0.0
        if len(lam):
            self._shift(d, 0, (1.0, 0.0, 0.0), gap)
            self._shift(d, 1, (0.0, 1.0, 0.0), gap)
        self._accelerate(d, push((0.0, 0.0, 1.0)), np.zeros((0, 3, 3)) if turn is None else turn)
        made = np.zeros((4, self.system.size))
        made[Q], made[V], made[A], made[ABAR] = d[0], d[1], d[2], d[2]
        return made

    def _free(self, x: FloatArray) -> FloatArray:
        free = np.zeros_like(x)
        free[: self.system.n] = x[: self.system.n]
        free[self.system.core.supports.held] = 0.0
        return free

    def _shift(self, d: FloatArray, k: int, level: tuple[float, float, float], gap: Any) -> None:
        """Shift d[k] onto the derivative of the constraints of a level."""
        system, core, r = self.system, self.system.core, np.empty(self.system.size)
        for _ in range(MOST):
            system.level[:] = level
            rows_along(core, self.m, self.q, self.v, self.a, d, r)
            r += gap(level)
            r *= core.joints.mask
            system.level[:] = 0.0, 0.0, 1.0
            apply_supports(core.supports, r)
            solve_matrix(core.factor, r)
            r[system.multipliers] = 0.0
            r[system.n :] = 0.0
            d[k] -= r
            follow_supports(core.supports, *d)
            if np.max(np.abs(r)) <= NOISY * np.max(np.abs(d[k]), initial=0.0):
                return

    def _accelerate(self, d: FloatArray, push: FloatArray, turn: FloatArray) -> None:
        """Accelerations and multipliers, and the shadows of all."""
        system, core = self.system, self.system.core
        system.level[:] = 0.0, 0.0, 1.0
        r, still, before = np.empty(system.size), np.zeros(system.size), np.inf
        for _ in range(MOST):
            products_along(core, self.m, self.q, self.v, self.a, d, turn, still, r)
            r += push
            r[core.supports.held] = 0.0
            solve_matrix(core.factor, r)
            r[system.n :] = 0.0
            d[0, system.multipliers] -= r[system.multipliers]
            r[system.multipliers] = 0.0
            d[2] -= r
            norm, size = float(np.max(np.abs(r))), float(np.max(np.abs(d[2]), initial=0.0))
            if norm <= ENOUGH * size or (norm <= NOISY * size and norm >= 0.5 * before):
                break
            before = norm
        follow_supports(core.supports, *d)
        for k, R in enumerate(turn):
            i, j = core.supports.rot_slot[k], core.supports.rot_shadow[k]
            for s, x in zip(d, (self.q, self.v, self.a), strict=True):
                s[j : j + 3] += R @ x[i : i + 3]


def starts(
    system: System,
    m: Matrices,
    nearby: Nearby,
    given: list[tuple[FloatArray, FloatArray]],
    states: Any,
    when: Any,
) -> Iterator[tuple[FloatArray, FloatArray]]:
    """For each family the derivatives of a consistent start, see :meth:`Start.sensitivity`, and held ones.

    Parameters
    ----------
    system, m : System, Matrices
    nearby : Nearby
        The families.
    given : list of (dq, dv)
        What of the initial state is asked for, by family.
    states : (q, v, a)
        At the start.
    when : tuple
        See :class:`Start`.

    Yields
    ------
    made : (4, size)
    held : (2, size)
        Derivatives of q and v where supports hold them.
    """
    first, step, *limits = when
    q, v, a = states
    begin = Start(system, m, q, v, a, when)
    way, tables = Way(*(x[None].copy() for x in states)), system.inputs.tables(first, step, 1, *limits)
    pushes = nearby.plain_at_steps(way, when, tables).copy()
    still = np.zeros((2, system.size))
    rows = {k: row for row, k in enumerate(nearby.plain)}
    for k, family in enumerate(nearby.families):
        if k in rows:  # it does nothing to rows of joints
            own = pushes[rows[k], 0]
            moved = nearby.shifts.get(k), nearby.turns.get(k)
            made = begin.sensitivity(*given[k], lambda _, own=own: own, lambda _: 0.0, *moved)
            yield made, still
        else:
            at = _at_level(system, family, states, when)
            made = begin.sensitivity(*given[k], at, at)
            here = Way(*(x[None].copy() for x in states))
            yield made, family.at_steps(*here, when, gaps=False).held[:2, 0]


def _at_level(system: System, family: Family, states: Any, when: Any) -> Callable[[Any], FloatArray]:
    """What a family does to the residual, as a function of the level of the constraints."""
    q, v, a = (x[None] for x in states)

    def push(level: tuple[float, float, float]) -> FloatArray:
        before = system.level.copy()
        system.level[:] = level
        family.know(system)
        made: FloatArray = family.at_steps(q, v, a, when, gaps=False).push[0]
        system.level[:] = before
        return made

    return push
