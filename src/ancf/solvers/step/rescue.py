"""A step of the Newmark family by a globalised Newton method with the exact tangent.

The fast iteration of :mod:`ancf.solvers.newmark` leaves out of its symmetric matrix how damping forces
change with the positions.  Where damping is large against stiffness and inertia, that part decides: while a
cable straightens, say, its bending damping pushes the curvature aside, a force that grows against the
matrix as the curvature falls.  Here the tangent is that of the residual itself, with all it depends on and
not symmetric, by central differences.  Unknowns of which no residual knows two are moved together, so that a
chain of any length takes 36 evaluations (Curtis, Powell & Reid 1974).

A correction dx = -J^-1 R is cut to lam dx until the simplified correction J^-1 R(x + lam dx) is shorter than
dx, the natural monotonicity test (Deuflhard, Newton Methods for Nonlinear Problems, section 3.3), which
does not depend on how the equations are scaled.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray, IntArray
from ...later import csc_array, splu
from ...linalg.ordering import band
from ...system.core import (
    Core,
    Tables,
    apply_load,
    apply_supports,
    first_event,
    follow_supports,
    place_supports,
    residual,
)
from ...system.system import System
from ..newmark import LARGEST_ROUND_OFF, Rule
from ..status import EVENT, FACTORIZATIONS, ITERATIONS, JACOBIANS, NOT_FINITE, OK, SINGULAR, SLOW
from .differences import accept, differences
from .memory import H_FACTOR, NORM, WORST, Memory
from .scheme import Scheme

#: Iterations, and cuts of one correction, before a guess is given up.
MOST_ITERATIONS, MOST_CUTS = 40, 8
#: Difference in units of the size of the model, or of a slope.
DIFFERENCE = 1e-7
#: Groups of unknowns that are moved together; more of them take too long.
MOST_GROUPS = 240


class Groups(NamedTuple):
    """Unknowns that are moved together, and where the entries of the tangent are found."""

    start: IntArray  # (groups + 1,)
    unknown: IntArray  # of the groups, one after the other
    rows: IntArray  # (m,) of the entries of the tangent
    columns: IntArray  # (m,)
    of: IntArray  # (n,) group of an unknown, -1: held


def groups_of(system: System) -> Groups | None:
    """Groups of a system; None where contacts, of which the pattern does not know, or too many prevent it."""
    if "contacts" in system.parts or system.core.entwined:
        return None
    n = system.numbering.blocks
    pairs = np.concatenate([system.pairs, system.pairs[:, ::-1], np.repeat(np.arange(n), 2).reshape(-1, 2)])
    pairs = np.unique(pairs, axis=0)  # sorted by the first
    near = np.split(pairs[:, 1], np.flatnonzero(np.diff(pairs[:, 0])) + 1)
    color = np.full(n, -1)
    for block in np.argsort(band(system.pairs, n)).tolist():  # blocks with a common neighbour differ
        taken = {color[other] for beside in near[block] for other in near[beside]}
        color[block] = next(c for c in range(n + 1) if c not in taken)
    if 6 * (color.max() + 1) > MOST_GROUPS:
        return None
    of = (6 * color[:, None] + np.arange(6)).ravel()
    of[system.core.supports.held] = -1
    unknown = np.argsort(of, kind="stable")[np.count_nonzero(of < 0) :]
    start = np.searchsorted(of[unknown], np.arange(of.max() + 2))
    six = np.arange(6)
    rows = (6 * pairs[:, :1] + np.repeat(six, 6)).ravel()
    columns = (6 * pairs[:, 1:] + np.tile(six, 6)).ravel()
    free = (of[rows] >= 0) & (of[columns] >= 0)
    held = np.flatnonzero(of < 0)
    rows, columns = np.append(rows[free], held), np.append(columns[free], held)
    return Groups(start.astype(np.int64), unknown.astype(np.int64), rows, columns, of)


class Rescue:
    """Steps that the fast iteration does not manage.

    Parameters
    ----------
    system : System
    memory : Memory
        State of the run; a step that fails leaves it at its start.
    """

    def __init__(self, system: System, memory: Memory) -> None:
        self.system, self.memory = system, memory
        self.groups = groups_of(system)
        n, size = system.n, system.size
        self.step = DIFFERENCE / np.where(system.core.weight > 0.0, system.core.weight, 1.0)
        self.rated = 1.0 - system.core.joints.mask[:size]
        self.base, self.moved = np.zeros((3, size)), np.zeros((3, size))
        self.r = np.zeros(size)
        if self.groups is not None:
            self.out = np.zeros((len(self.groups.start) - 1, n))

    def take(self, core: Core, tables: Tables, h: float, scheme: Scheme, rule: Rule) -> int:
        """Take one step of length h to the time of the tables' first row; returns its status."""
        m = self.memory
        if self.groups is None or rule.projects:
            return SLOW
        apply_load(core.loads, tables.value[0], m.f)
        core.joints.level[:] = rule.w0, rule.w1, rule.w2
        status = SLOW
        with np.errstate(all="ignore"):
            for q, v, a in self._guesses(h, scheme):
                place_supports(core.supports, core.loads.value, tables, 0, q, v, a)
                status = self._solve(np.stack([q, v, a]), h, scheme, rule)
                if status == OK:
                    break
        m.memo[H_FACTOR] = 0.0
        if status == OK:
            m.a3[:], m.a2[:], m.a1[:] = m.a2, m.a1, m.a0
            m.q0[:], m.v0[:], m.a0[:] = m.q, m.v, m.a
            m.q[:], m.v[:], m.a[:] = self.base
            status = int(accept(core, m, h, scheme, rule.furthest))
            if status != OK:
                return status
            event = int(first_event(core.joints.tail, m.q))
            return EVENT + event if event >= 0 else OK
        return status

    def _guesses(self, h: float, s: Scheme) -> Iterator[tuple[FloatArray, FloatArray, FloatArray]]:
        """Ends of the step: moved on with the velocity, where it was, with the acceleration as it was."""
        m, am, af = self.memory, s.alpha_m, s.alpha_f
        for share in (1.0, 0.0, -1.0):
            if share >= 0.0:
                bar = ((share - 1.0) * m.v / h - (0.5 - s.beta) * m.abar) / s.beta
                a = ((1.0 - am) * bar - af * m.a + am * m.abar) / (1.0 - af)
            else:
                a = m.a.copy()
                bar = ((1.0 - af) * a + af * m.a - am * m.abar) / (1.0 - am)
            q = m.q + h * m.v + h * h * ((0.5 - s.beta) * m.abar + s.beta * bar)
            v = m.v + h * ((1.0 - s.gamma) * m.abar + s.gamma * bar)
            a, v = a * self.rated, v * self.rated
            yield np.where(self.rated > 0.0, q, m.q), v, a

    def _residual(self, state: FloatArray) -> FloatArray:
        core, r = self.system.core, self.r
        residual(core.batches, core.ws, state[0], state[1], state[2], self.memory.f, r)
        apply_supports(core.supports, r)
        return r[: self.system.n].copy()

    def _tangent(self, state: FloatArray, gb: float, ib: float) -> csc_array:
        g, n, core = self.groups, self.system.n, self.system.core
        assert g is not None
        differences(
            core, state, self.moved, self.memory.f, self.r, self.step, self.rated, gb, ib, g.start, g.unknown,
            self.out,
        )  # fmt: skip
        free = g.of[g.columns] >= 0
        values = np.where(
            free, self.out[np.maximum(g.of[g.columns], 0), g.rows] / (2.0 * self.step[g.columns]), 1.0
        )
        return csc_array((values, (g.rows, g.columns)), shape=(n, n))

    def _solve(self, state: FloatArray, h: float, scheme: Scheme, rule: Rule) -> int:
        """Newton's method from a guess of q, v, a; leaves the solution in ``base``."""
        n, weight, m = self.system.n, self.system.core.weight, self.memory
        c = (1.0 - scheme.alpha_f) / (1.0 - scheme.alpha_m)
        B, G = scheme.beta * h * h * c, scheme.gamma * h * c
        rates = np.stack([np.ones(n), G / B * self.rated[:n], self.rated[:n] / B])
        r = self._residual(state)
        for _ in range(MOST_ITERATIONS):
            m.counts[[ITERATIONS, JACOBIANS, FACTORIZATIONS]] += 1
            tangent = self._tangent(state, G / B, 1.0 / B)
            if not np.all(np.isfinite(tangent.data)):
                return NOT_FINITE
            try:
                factor = splu(tangent)
            except RuntimeError:  # it is singular
                return SINGULAR
            d = factor.solve(r)
            norm, cut = float(np.max(np.abs(d) * weight)), 1.0
            m.memo[NORM], m.memo[WORST] = norm, float(np.argmax(np.abs(d) * weight))
            if not norm < 1e300:
                return NOT_FINITE
            for _ in range(MOST_CUTS):
                trial = state.copy()
                trial[:, :n] -= cut * rates * d
                follow_supports(self.system.core.supports, trial[0], trial[1], trial[2])
                r = self._residual(trial)
                d_next = factor.solve(r)
                left = float(np.max(np.abs(d_next) * weight))
                if left <= (1.0 - 0.25 * cut) * norm or norm <= LARGEST_ROUND_OFF:
                    break
                cut *= 0.5
            else:
                return SLOW
            state = trial
            if cut == 1.0 and (left <= rule.tolerance or norm <= LARGEST_ROUND_OFF):
                state[:, :n] -= rates * d_next
                follow_supports(self.system.core.supports, state[0], state[1], state[2])
                self.base[:] = state
                return OK
        return SLOW
