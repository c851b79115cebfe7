"""Static equilibrium by load steps, a regularised Newton method and a line search.

Each correction solves (K + mu M) dq = -r.  The mass-weighted term is there only while the plain
matrix K is not positive definite or the corrections are too long: a slack cable has hardly any
stiffness against falling, a compressed one a negative one.  mu goes to zero as the iteration settles,
so that the last corrections are Newton's own.  Corrections are capped; when they do not settle, a line
search looks for the place along the correction where the out-of-balance force does no more work.
Because only positive definite matrices are accepted, the result is a stable equilibrium.

A cable that is longer than its initial shape (slack) would start strongly compressed and crumple.  Its
axial stiffness is first lowered until the load alone stretches it by a good part of its length, its
loads come on at the length of the initial shape, and only then does the natural length take effect
and the stiffness rise to its value: the cable comes to its length from above, always in tension.
"""

from __future__ import annotations

import time as clock
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..elements.cable import CableBatch
from ..elements.cable_build import compression
from ..elements.lanes import LANES
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
PLAIN = 150  # of them without a line search
MOST_HALVINGS = 12  # of a load step
LONGEST = 0.3  # largest change of a slope, or of a position in sizes of the model, in one correction
LEAST_MU = 1e-15  # of the ratio of stiffness to mass
NEUTRAL_MU = 1e-13  # up to which what is missing is round-off
DISTURBANCE = 1e-3  # along the softest mode, to leave an unstable equilibrium


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
        self.scale = 0.0
        self.neutral = False  # what the last plain matrix lacks for definiteness is round-off

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
        """dq of (K + mu M) dq = r, with mu large enough to make the matrix positive definite.

        A moment is no conservative load and the symmetric part of its stiffness says nothing about
        stability: with moments an indefinite K is taken as it is.
        """
        negative = self.factorise(self.mu)
        self.neutral = negative < 0
        if negative == 0 or (negative > 0 and self.mu == 0.0 and len(self.moment) > 0):
            return self.solve(r)
        if self.scale == 0.0:
            self.scale = self.largest_ratio()
        self.mu = max(self.mu, LEAST_MU * self.scale)
        for _ in range(60):
            if self.factorise(self.mu) == 0:
                self.neutral = self.mu <= NEUTRAL_MU * self.scale
                return self.solve(r)
            self.mu *= 5.0
        raise SolveError("equilibrium", "no regularisation makes the stiffness positive definite")

    def largest_ratio(self) -> float:
        """Ratio of stiffness to mass on the diagonal, 1/s^2: the size of the largest eigenvalue."""
        diagonal = (36 * np.arange(self.system.n // 6)[:, None] + 7 * np.arange(6)).ravel()
        sums = []
        for mass, stiffness in ((0.0, 1.0), (1.0, 0.0)):
            self.factorise(mass, stiffness)
            sums.append(float(np.sum(np.abs(self.core.A[diagonal][self.system.free]))))
        return sums[0] / max(sums[1], 1e-300) if self.system.free.size else 1.0


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
    slack = Slack(system, q, force)
    try:
        slack.set(1.0, 1.0)
        halvings = follow_path(it, lambda share: share, load_steps, "of the load")
        if slack.found:
            halvings += follow_path(it, slack.let_out, 4, "of the slack")
            halvings += follow_path(it, slack.stiffen, slack.steps, "of the axial stiffness")
    finally:
        slack.set(0.0, 0.0)
        core.loads.moment[:] = it.moment
    seconds = clock.process_time() - cpu
    return it.q, Stats(load_steps, it.iterations, it.jacobians, it.jacobians, halvings, seconds)


class Slack:
    """The detour by which slack cables come to their equilibrium; nothing if no cable is slack."""

    def __init__(self, system: System, q: FloatArray, force: FloatArray) -> None:
        load = float(np.sum(np.abs(force)))
        self.found = load > 0.0 and any(b.stretch < 1.0 - 1e-9 for b in system.model.bodies.values())
        self.cables = [b for b in system.core.batches if isinstance(b, CableBatch)] if self.found else []
        self.rows = [b.lane_data[:, 2 * LANES : 3 * LANES] for b in self.cables]  # EA L
        self.natural = [
            (row.copy(), b.lane_reference.copy(), b.groups[:, 7].copy())
            for row, b in zip(self.rows, self.cables, strict=True)
        ]
        self.strain = [compression(b, q) for b in self.cables]
        lengths = [b.lane_data[:, :LANES] for b in self.cables]
        stiffest = max(
            (float(np.max(row / h)) for row, h in zip(self.rows, lengths, strict=True)), default=1.0
        )
        self.factor = min(1.0, load / stiffest) if self.found else 1.0
        self.steps = max(1, int(np.ceil(np.log(1.0 / self.factor) / np.log(6.0))))

    def set(self, soft: float, held: float) -> None:
        """Lower EA by a share of the factor's logarithm and free the forces of a share of the compression."""
        for k, batch in enumerate(self.cables):
            stiffness, reference, curved = self.natural[k]
            self.rows[k][:] = stiffness * self.factor**soft
            batch.lane_reference[:] = reference + held * self.strain[k]
            batch.groups[:, 7] = curved if held == 0.0 else 1

    def let_out(self, share: float) -> float:
        """Put the compression back, at low stiffness; the loads stay whole."""
        self.set(1.0, 1.0 - share)
        return 1.0

    def stiffen(self, share: float) -> float:
        """Raise the stiffness to a share of the logarithm; the loads stay whole."""
        self.set(1.0 - share, 0.0)
        return 1.0


def follow_path(it: Iteration, load: Callable[[float], float], steps: int, of: str) -> int:
    """Equilibria along a path from 0 to 1; a step that fails is halved.  Returns the number of halvings.

    ``load(share)`` prepares a point of the path and returns the share of the loads there.
    """
    share, part, halvings = 0.0, 1.0 / steps, 0
    while share < 1.0 - 1e-12:
        before = it.q.copy()
        with np.errstate(all="ignore"):  # what overflows on the way is seen and halved
            problem = settle(it, load(min(share + part, 1.0)))
        if problem is None:
            share = min(share + part, 1.0)
            continue
        it.q, it.mu = before, 0.0
        part, halvings = 0.5 * part, halvings + 1
        if halvings > MOST_HALVINGS:
            raise SolveError(f"equilibrium at {share:.4g} {of}", problem, "give more load_steps")
    return halvings


def settle(it: Iteration, share: float) -> str | None:
    """Newton iterations for one share of the loads; None, or what went wrong."""
    r = it.out_of_balance(it.q, share)
    disturbed = False
    for number in range(MAX_ITERATIONS):
        if not np.all(np.isfinite(r)):
            return "the forces are not finite"
        regular = it.mu == 0.0
        dq = it.correction(r)
        it.iterations += 1
        norm = it.length(dq)
        if (it.mu == 0.0 or it.neutral) and (
            norm <= TOLERANCE or (norm <= ACCEPTED and _stalled(it, dq, r, share))
        ):
            it.q = it.moved(dq, 1.0)
            return None
        if regular and it.mu > 0.0 and not it.neutral and norm < 1e-6 and not disturbed:
            disturbed = True  # balanced, but not stable
            it.q = disturb(it)
            r = it.out_of_balance(it.q, share)
            continue
        longest = min(1.0, LONGEST / max(norm, 1e-300))
        if number < PLAIN:
            s, r = longest, it.out_of_balance(it.moved(dq, longest), share)
        else:
            s, r = line_search(it, dq, r, share, longest)
        it.q = it.moved(dq, s)
        it.mu = relax(it.mu, s, norm)
    return f"Newton's method did not converge in {MAX_ITERATIONS} iterations, last correction {norm:.2e}"


def _stalled(it: Iteration, dq: FloatArray, r: FloatArray, share: float) -> bool:
    """Round-off: the correction does not reduce the residual any more."""
    ahead = it.out_of_balance(it.moved(dq, 1.0), share)
    return bool(np.linalg.norm(ahead) >= 0.5 * np.linalg.norm(r))


def relax(mu: float, s: float, norm: float) -> float:
    """Next regularisation: less after a long step, more after a short one."""
    if mu == 0.0 or (s == 1.0 and norm < 1e-2):
        return 0.0
    return 0.1 * mu if s > 0.3 else (mu if s > 0.05 else 5.0 * mu)


def line_search(
    it: Iteration, dq: FloatArray, r: FloatArray, share: float, longest: float
) -> tuple[float, FloatArray]:
    """Part of the correction to take, at most ``longest``, and the residual there."""
    work0 = float(dq @ r)
    if work0 <= 0.0:  # indefinite matrix: there is nothing to search for
        return longest, it.out_of_balance(it.moved(dq, longest), share)
    low, high, w_low = 0.0, longest, work0
    ahead = r
    for _ in range(12):
        ahead = it.out_of_balance(it.moved(dq, high), share)
        w = float(dq @ ahead)
        if (np.isfinite(w) and abs(w) <= 0.8 * work0) or (np.isfinite(w) and w > 0.0 and high == longest):
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
    """State moved a little along the softest mode, by inverse iteration with the last matrix."""
    x = np.random.default_rng(1).standard_normal(it.system.n)
    x[it.core.supports.held] = 0.0
    for _ in range(4):
        x = it.solve(x)
        x /= it.length(x)
    return it.moved(x, DISTURBANCE)
