"""Static equilibrium by load steps, a regularised Newton method and a line search.

Each correction solves (K + mu M) dq = -r.  The mass-weighted term is there only while the plain
matrix K is not positive definite or the corrections are too long: a slack cable has hardly any
stiffness against falling, a compressed one a negative one.  mu goes to zero as the iteration settles,
so that the last corrections are Newton's own.  The line search looks for the place along the
correction where the out-of-balance force does no more work.  Because only positive definite matrices
are accepted, the result is a stable equilibrium.
"""

from __future__ import annotations

import time as clock
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..errors import SolveError
from ..system.core import (
    Core,
    apply_load,
    apply_supports,
    assemble,
    factorise_matrix,
    follow_supports,
    place_supports,
    residual,
    restrict,
    solve_matrix,
)
from ..system.system import System
from .floating import check_supported
from .stepping import Stats

FloatArray = NDArray[np.float64]

TOLERANCE = 1e-12  # of a correction, positions relative to the size of the model
ACCEPTED = 1e-9  # where round-off keeps corrections above TOLERANCE
MAX_ITERATIONS = 300  # in a load step
MOST_HALVINGS = 12  # of a load step
LONGEST = 0.3  # largest change of a slope, or of a position in sizes of the model, in one correction
DISTURBANCE = 1e-4  # of the slopes, to leave an unstable equilibrium


@dataclass
class Iteration:
    """One equilibrium iteration: state vectors, forces and counters."""

    system: System
    core: Core
    q: FloatArray
    force: FloatArray  # at full load
    moment: FloatArray
    zero: FloatArray = field(init=False)
    iterations: int = 0
    jacobians: int = 0
    mu: float = 0.0

    def __post_init__(self) -> None:
        self.zero = np.zeros_like(self.q)
        self.push = 0.0

    def out_of_balance(self, q: FloatArray, share: float) -> FloatArray:
        """Residual for a share of the loads, on free unknowns."""
        r = np.empty_like(q)
        self.core.loads.moment[:] = share * self.moment
        residual(self.core.batches, self.core.ws, q, self.zero, self.zero, share * self.force, r)
        apply_supports(self.core.supports, r)
        return r[: self.system.n]

    def moved(self, dq: FloatArray, s: float) -> FloatArray:
        """State vector after a part s of a correction."""
        q = self.q.copy()
        q[: self.system.n] -= s * dq
        follow_supports(self.core.supports, q, self.zero.copy(), self.zero.copy())
        return q

    def factorise(self, mass: float, stiffness: float = 1.0) -> int:
        """Factorise mass M + stiffness K at q; negative pivots, or negative numbers if singular."""
        core = self.core
        assemble(core.batches, core.ws, self.q, self.zero, core.A, mass, 0.0, stiffness)
        restrict(core.supports, core.A)
        self.jacobians += 1
        return int(factorise_matrix(core.A, core.factor))

    def solve(self, r: FloatArray) -> FloatArray:
        """Solution for a residual, with the last factorisation."""
        x = r.copy()
        solve_matrix(self.core.factor, x)
        return x

    def length(self, dq: FloatArray) -> float:
        """Largest entry, positions in sizes of the model."""
        return float(np.max(np.abs(dq) * self.core.weight))

    def correction(self, r: FloatArray) -> FloatArray:
        """dq of (K + mu M) dq = r with the least mu that makes the matrix positive definite."""
        if self.factorise(self.mu) == 0:
            return self.solve(r)
        if self.push == 0.0:
            self.factorise(1.0, 0.0)
            self.push = max(self.length(self.solve(r)), 1e-12)
        self.mu = max(self.mu, 1e-3 * self.push)
        for _ in range(60):
            if self.factorise(self.mu) == 0:
                return self.solve(r)
            self.mu *= 4.0
        raise SolveError("equilibrium", "no regularisation makes the stiffness positive definite")


def equilibrium(
    system: System, of: list[str] | None, load_steps: int, time: float
) -> tuple[FloatArray, Stats]:
    """State vector of a stable equilibrium under the loads at ``time`` and what it took.

    Raises
    ------
    ModelError
        A body is not supported.
    SolveError
        The iteration did not converge.
    """
    others = [] if of is None else [name for name in system.model.bodies if name not in of]
    check_supported(system, others)
    cpu = clock.process_time()
    q, _ = system.initial_state(time)
    core = system.holding(others) if others else system.core
    h = 1e-3
    tables = system.drive.tables(time - h, h, 1, time, np.inf)
    v, a = np.zeros_like(q), np.zeros_like(q)
    place_supports(core.supports, core.loads.moment, tables, 0, q, v, a)
    force = np.empty_like(q)
    apply_load(core.loads, tables.load[0], force)
    it = Iteration(system, core, q, force, core.loads.moment.copy())
    share, part, halvings = 0.0, 1.0 / load_steps, 0
    while share < 1.0 - 1e-12:
        before = it.q.copy()
        problem = settle(it, min(share + part, 1.0))
        if problem is None:
            share = min(share + part, 1.0)
            continue
        it.q, it.mu = before, 0.0
        part, halvings = 0.5 * part, halvings + 1
        if halvings > MOST_HALVINGS:
            raise SolveError(f"equilibrium at {share:.4g} of the load", problem, "give more load_steps")
    core.loads.moment[:] = it.moment
    seconds = clock.process_time() - cpu
    return it.q, Stats(load_steps, it.iterations, it.jacobians, it.jacobians, halvings, seconds)


def settle(it: Iteration, share: float) -> str | None:
    """Newton iterations for one share of the loads; None, or what went wrong."""
    r = it.out_of_balance(it.q, share)
    disturbed = False
    for _ in range(MAX_ITERATIONS):
        if not np.all(np.isfinite(r)):
            return "the forces are not finite"
        regular = it.mu == 0.0
        dq = it.correction(r)
        it.iterations += 1
        norm = it.length(dq)
        if it.mu == 0.0 and (norm <= TOLERANCE or (norm <= ACCEPTED and _stalled(it, dq, r, share))):
            it.q = it.moved(dq, 1.0)
            return None
        if regular and it.mu > 0.0 and it.length(dq) < 1e-9 and not disturbed:
            disturbed = True  # balanced, but not stable
            it.q = disturb(it)
            r = it.out_of_balance(it.q, share)
            continue
        s, r = line_search(it, dq, r, share, min(1.0, LONGEST / max(norm, 1e-300)))
        it.q = it.moved(dq, s)
        it.mu = relax(it.mu, s, norm)
    return f"Newton's method did not converge in {MAX_ITERATIONS} iterations, last correction {norm:.2e}"


def _stalled(it: Iteration, dq: FloatArray, r: FloatArray, share: float) -> bool:
    """Round-off: the correction does not reduce the residual any more."""
    ahead = it.out_of_balance(it.moved(dq, 1.0), share)
    return bool(np.linalg.norm(ahead) >= 0.5 * np.linalg.norm(r))


def relax(mu: float, s: float, norm: float) -> float:
    """Next regularisation: less after a full step, more after a short one."""
    if mu == 0.0 or (s == 1.0 and norm < 1e-3):
        return 0.0
    return 0.1 * mu if s > 0.5 else (mu if s > 0.1 else 4.0 * mu)


def line_search(
    it: Iteration, dq: FloatArray, r: FloatArray, share: float, longest: float
) -> tuple[float, FloatArray]:
    """Part of the correction to take, at most ``longest``, and the residual there."""
    work0 = float(dq @ r)
    low, high, w_low = 0.0, longest, work0
    ahead = r
    for _ in range(12):
        ahead = it.out_of_balance(it.moved(dq, high), share)
        w = float(dq @ ahead)
        if np.isfinite(w) and abs(w) <= 0.8 * work0 or (np.isfinite(w) and w > 0.0 and high == longest):
            return high, ahead
        if np.isfinite(w) and w > 0.0:
            low, w_low = high, w
            high = 0.5 * (high + longest)
            continue
        longest = high
        ratio = w_low / (w_low - w) if np.isfinite(w) else 0.1
        high = low + float(np.clip(ratio, 0.1, 0.7)) * (high - low)
    return high, ahead


def disturb(it: Iteration) -> FloatArray:
    """State with small random slopes, always the same ones."""
    noise = np.zeros_like(it.q)
    noise[: it.system.n] = DISTURBANCE * np.random.default_rng(1).standard_normal(it.system.n)
    noise[: it.system.n] /= it.core.weight
    noise[it.core.supports.held] = 0.0
    q = it.q + noise
    follow_supports(it.core.supports, q, it.zero.copy(), it.zero.copy())
    return q


