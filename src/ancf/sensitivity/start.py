"""Derivatives of the consistent start of a simulation."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import SolveError
from ..solvers.directions import products_along, rows_along
from ..solvers.sensitivity import ABAR, ENOUGH, MOST, NOISY, A, Matrices, Q, V
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
from .family import Push


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

    def sensitivity(self, dq: FloatArray, dv: FloatArray, push: Any, gap: Any) -> FloatArray:
        """Derivatives of q, v, a and the algorithmic acceleration, (4, size), from those that are asked for.

        Parameters
        ----------
        dq, dv : (size,)
            Of the initial state, before constraints hold.
        push, gap : function of the level of the constraints
            Derivatives of the residual, and of the rows of the constraints, at fixed free unknowns.
        """
        d = np.zeros((3, self.system.size))
        d[0], d[1] = self._free(dq), self._free(dv)
        lam = self.system.multipliers
        d[:2, lam] = 0.0
        if len(lam):
            self._shift(d, 0, (1.0, 0.0, 0.0), gap)
            self._shift(d, 1, (0.0, 1.0, 0.0), gap)
        self._accelerate(d, push((0.0, 0.0, 1.0)))
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

    def _accelerate(self, d: FloatArray, push: FloatArray) -> None:
        """Accelerations and multipliers."""
        system, core = self.system, self.system.core
        system.level[:] = 0.0, 0.0, 1.0
        r, still, before = np.empty(system.size), np.zeros(system.size), np.inf
        for _ in range(MOST):
            products_along(core, self.m, self.q, self.v, self.a, d, still, r)
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


def at_level(system: System, families: list[Any], k: int, states: Any, when: Any) -> tuple[Any, Any]:
    """Functions of the level of the constraints for :meth:`Start.sensitivity`, of family k."""
    q, v, a = (x[None] for x in states)

    def push_at(level: tuple[float, float, float]) -> Push:
        before = system.level.copy()
        system.level[:] = level
        families[k].know(system)
        made: Push = families[k].at_steps(q, v, a, when, gaps=False)
        system.level[:] = before
        return made

    def push(level: tuple[float, float, float]) -> FloatArray:
        found: FloatArray = push_at(level).push[0]
        return found

    return push, push  # the rows of the multipliers are in the residual
