"""Derivatives of the consistent start of a simulation."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import SolveError
from ..solvers.derivatives.directions import accelerate_along, rows_along
from ..solvers.derivatives.sensitivity import ABAR, MOST, NOISY, A, Matrices, Q, V, Way
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
from .memory import Memory
from .memory_abreast import MemoryAbreast
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

    def shapes(self, given: tuple[FloatArray, FloatArray], gap: Any, shift: FloatArray | None) -> FloatArray:
        """Derivatives of q and v at the start, and zeros for a, (3, size).

        Parameters
        ----------
        given : (2, size)
            Of the initial state, before constraints hold.
        gap : function of the level of the constraints
            Derivatives of their rows at fixed free unknowns.
        shift : (size,), optional
            Derivatives of q that are not in these, where it is held.
        """
        d = np.zeros((3, self.system.size))
        d[0], d[1] = self._free(given[0]), self._free(given[1])
        if shift is not None:
            d[0] += shift
        lam = self.system.multipliers
        d[:2, lam] = 0.0
        if len(lam):
            self._shift(d, 0, (1.0, 0.0, 0.0), gap)
            self._shift(d, 1, (0.0, 1.0, 0.0), gap)
        return d

    def accelerated(self, d: FloatArray, push: FloatArray, turn: FloatArray) -> FloatArray:
        """Derivatives of q, with multipliers, v, a and the algorithmic acceleration, (p, 4, size).

        Parameters
        ----------
        d : (p, 3, size)
            See :meth:`shapes`; changed.
        push : (p, size)
            Derivatives of the residual at fixed free unknowns.
        turn : (p, k, 3, 3)
            Those of the local axes of supports, or k = 0.
        """
        room = np.zeros((2, self.system.size))
        self.system.level[:] = 0.0, 0.0, 1.0
        accelerate_along(self.system.core, self.m, self.q, self.v, self.a, d, turn, push, *room)
        made = np.empty((len(d), 4, self.system.size))
        made[:, [Q, V, A]], made[:, ABAR] = d, d[:, 2]
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


def starts(
    system: System,
    m: Matrices,
    nearby: Nearby,
    given: list[tuple[FloatArray, FloatArray]],
    states: Any,
    when: Any,
    memory: Memory | MemoryAbreast | None = None,
) -> tuple[FloatArray, FloatArray]:
    """For each family the derivatives of a consistent start, see :meth:`Start.accelerated`, and held ones.

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
    memory : Memory or MemoryAbreast, optional
        That of friction at the start, whose derivatives are filled.

    Returns
    -------
    made : (p, 4, size)
    held : (p, 2, size)
        Derivatives of q and v where supports hold them.
    """
    first, step, *limits = when
    q, v, a = states
    begin = Start(system, m, q, v, a, when)
    if memory:
        memory.choose(begin.q, begin.v)
    way, tables = Way(*(x[None].copy() for x in states)), system.inputs.tables(first, step, 1, *limits)
    pushes, held, rows = (np.zeros((len(nearby.families), k, system.size)) for k in (1, 2, 3))
    nearby.know()
    known: dict[Any, FloatArray] = {}
    pushes[nearby.plain] = nearby.plain_at_steps(way, when, tables)
    for k in nearby.plain:
        gap = _rows_of(nearby, k, way, tables, known) if k in nearby.rows else lambda _: 0.0
        rows[k] = begin.shapes(given[k], gap, nearby.shifts.get(k))
    for k in nearby.others:
        at = _at_level(system, nearby.families[k], states, when)
        rows[k], pushes[k, 0] = begin.shapes(given[k], at, None), at((0.0, 0.0, 1.0))
        here = Way(*(x[None].copy() for x in states))
        held[k] = nearby.families[k].at_steps(*here, when, gaps=False).held[:2, 0]
    if memory:
        first_s = rows.copy()
        first_s[:, :2] += held
        for d in first_s:
            follow_supports(system.core.supports, *d)
        memory.begin(begin.q, begin.v, first_s)
        memory.choose(begin.q, begin.v)
        pushes[:, 0] += memory.push(way, tables)
    return begin.accelerated(rows, pushes[:, 0], nearby.turn), held


def _rows_of(
    nearby: Nearby, k: int, way: Way, tables: Any, known: dict[Any, FloatArray]
) -> Callable[[Any], FloatArray]:
    """What a family does to rows of joints, by the level, as all are ``known``."""

    def rows(level: tuple[float, float, float]) -> FloatArray:
        if level not in known:
            known[level] = nearby.rows_at(level, way, tables)
        found: FloatArray = known[level][nearby.rows.index(k), 0]
        return found

    return rows


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
