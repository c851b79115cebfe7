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
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import SuperLU, splu

from ..connections.sliding import LEFT
from ..elements.cable import CableBatch
from ..elements.cable_build import compression
from ..elements.lanes import LANES
from ..errors import SolveError
from ..linalg.sparse import to_sparse
from ..model.beam import Beam
from ..model.joints import Slide
from ..system.contacts import touching
from ..system.core import (
    Core,
    apply_load,
    apply_supports,
    assemble,
    factorise_matrix,
    find_inverted,
    first_event,
    follow_supports,
    place_supports,
    residual,
    restrict,
    solve_matrix,
)
from ..system.system import System
from .events import happen
from .floating import check_supported
from .free_spin import Spin, is_neutral, softest_mode
from .mixed import Mixed
from .stepping import COLLAPSED, Stats

FloatArray = NDArray[np.float64]

TOLERANCE = 1e-12  # of a correction, positions relative to the size of the model
ACCEPTED = 1e-9  # where round-off keeps corrections above TOLERANCE
MAX_ITERATIONS = 300  # in a load step
PLAIN = 150  # of them without a line search
MOST_HALVINGS = 12  # of a load step
NEUTRAL_MU = 1e-13  # up to which mu may only make up for round-off
SPUN = 1e-5  # the same where sections spin freely, which leaves their angle open
SLENDER = 5e5  # EA L^2/EI of a beam up to which ACCEPTED is above round-off
LONGEST = 0.3  # largest change of a slope, or of a position in sizes of the model, in one correction
SHORT = 1.0  # longest correction with sliding joints, in sizes of the model
LEAST_MU = 1e-15  # of the ratio of stiffness to mass
NEUTRAL_MU_JOINTS = 1e-10  # NEUTRAL_MU with the stiffness that the rows of joints add
COUNTED_MU = 1e-9  # with which pivots are counted where a body has no stiffness of its own
DISTURBANCE = 1e-3  # along the softest mode, to leave an unstable equilibrium


@dataclass
class Iteration:
    """One equilibrium iteration: state vectors, forces and counters."""

    system: System
    core: Core
    q: FloatArray
    force: FloatArray  # at full load
    inputs: FloatArray  # of loads that depend on the state, at full load
    zero: FloatArray = field(init=False)
    iterations: int = 0
    jacobians: int = 0
    mu: float = 0.0

    def __post_init__(self) -> None:
        self.zero = np.zeros_like(self.q)
        self.lu: SuperLU | None = None
        arcs = self.system.numbering.arcs
        slides = [c for c in self.system.model.connections if isinstance(c, Slide)]
        self.arcs = [(c, arcs[c.name]) for c in slides if arcs[c.name] not in self.core.supports.held]
        # a stable equilibrium has as many negative pivots as multipliers (Sylvester)
        self.expected = len(np.setdiff1d(self.system.multipliers, self.core.supports.held))
        slenderness = [_slenderness(b) for b in self.system.model.beams.values()]
        self.accepted = ACCEPTED * max([1.0, *slenderness])
        self.follows = any(len(batch.base) > 0 for batch in self.core.external)
        self.mixed = Mixed(self.core.batches)
        self.spin = Spin(self.system, self.core.supports.held)
        self.spinning = False

    def out_of_balance(self, q: FloatArray, share: float) -> FloatArray:
        """Residual for a share of the loads, on free unknowns."""
        r = np.empty_like(q)
        self.core.loads.value[:] = share * self.inputs
        residual(self.core.batches, self.core.ws, q, self.zero, self.zero, share * self.force, r)
        apply_supports(self.core.supports, r)
        return r[: self.system.n]

    def moved(self, dq: FloatArray, s: float) -> FloatArray:
        """State vector after a part s of a correction."""
        q = self.q.copy()
        q[: self.system.n] -= s * dq
        for joint, arc in self.arcs:
            q[arc] = min(max(q[arc], 0.0), joint.length)
        follow_supports(self.core.supports, q, self.zero.copy(), self.zero.copy())
        return q

    def factorise(self, mass: float, stiffness: float = 1.0, spin: bool = False) -> int:
        """Factorise mass M + stiffness K at q.

        Returns the number of negative pivots beyond those of the multipliers, or a negative number if
        the matrix is singular.  With sliding joints, which alone may hold a body that has no stiffness
        of its own, the factors are those of a sparse LU with pivoting, and the pivots are counted
        with a little mass.
        """
        core = self.core
        self.jacobians += 1
        self.lu = None
        self.touching = touching(core, self.q, self.system.n)
        self._assemble(mass, stiffness, spin)
        if core.joints.tail:
            try:
                self.lu = splu(to_sparse(core.A, self.system.places))
            except RuntimeError:  # exactly singular
                return -1
            self._assemble(max(mass, COUNTED_MU * self.ratio), stiffness, spin)
        negative = int(factorise_matrix(core.A, core.factor))
        return negative if negative < 0 else abs(negative - self.expected)

    @cached_property
    def ratio(self) -> float:
        """Largest ratio of stiffness to mass on the diagonal, 1/s^2: the size of the largest eigenvalue."""
        diagonal = (36 * np.arange(self.system.n // 6)[:, None] + 7 * np.arange(6)).ravel()
        parts = []
        for mass, stiffness in ((0.0, 1.0), (1.0, 0.0)):
            self._assemble(mass, stiffness, False)
            parts.append(np.abs(self.core.A[diagonal][self.system.free]))
        moves = parts[1] > 0.0  # multipliers and s have no mass
        return float(np.max(parts[0][moves] / parts[1][moves], initial=1.0))

    def _assemble(self, mass: float, stiffness: float, spin: bool) -> None:
        core = self.core
        assemble(self.mixed.batches, core.ws, self.q, self.zero, core.A, mass, 0.0, stiffness)
        if spin:
            self.spin.add(core.A, self.q)
        restrict(core.supports, core.A)

    def solve(self, r: FloatArray) -> FloatArray:
        """Solution for a residual, with the last factorisation and the contacts."""
        x = self._back(r)
        if len(self.touching.stiffness) == 0:
            return x
        B = self.touching.rows
        Z = np.array([self._back(b) for b in B]).T
        small = np.diag(1.0 / self.touching.stiffness) + B @ Z  # Woodbury's formula
        corrected: FloatArray = x - Z @ np.linalg.solve(small, B @ x)
        return corrected

    def _back(self, r: FloatArray) -> FloatArray:
        """Solution with the last factorisation alone."""
        if self.lu is not None:
            solution: FloatArray = self.lu.solve(r)
            return solution
        x = r.copy()
        solve_matrix(self.core.factor, x)
        return x

    def length(self, dq: FloatArray) -> float:
        """Largest entry, positions in sizes of the model."""
        return float(np.max(np.abs(dq) * self.core.weight))

    def correction(self, r: FloatArray) -> FloatArray:
        """dq of (K + mu M) dq = r, with mu large enough to make the matrix positive definite.

        Loads that depend on the state, as moments, are no conservative ones and the symmetric part of their
        stiffness says nothing about stability: with them an indefinite K is taken as it is.
        """
        if len(self.core.joints.tail):
            return self._short_correction(r)
        negative = self.factorise(self.mu)
        self.spinning = bool(self.spin) and self.spins(r, negative)
        if self.spinning:
            self.mu = 0.0
        elif negative and bool(self.spin):
            negative = self.factorise(self.mu)
        if self.spinning or negative == 0 or (negative > 0 and self.mu == 0.0 and self.follows):
            return self.solve(r)
        self.mu = max(self.mu, LEAST_MU * self.ratio)
        for _ in range(60):
            if self.factorise(self.mu) == 0:
                return self.solve(r)
            self.mu *= 5.0
        raise SolveError("equilibrium", "no regularisation makes the stiffness positive definite")

    def _short_correction(self, r: FloatArray) -> FloatArray:
        """The same with sliding joints: mu is also large enough to keep the correction short.

        A point that slides down a slope has no stiffness at all until it has found its place.
        """
        for _ in range(60):
            if self.factorise(self.mu) == 0:
                dq = self.solve(r)
                if self.length(dq) <= SHORT:
                    return dq
            self.mu = max(5.0 * self.mu, COUNTED_MU * self.ratio)
        raise self.failure("equilibrium", "no regularisation makes the stiffness positive definite")

    def failure(self, where: str, problem: str, hint: str = "") -> SolveError:
        """Error of an iteration that found nothing."""
        for joint, arc in self.arcs:
            if not 1e-9 < self.q[arc] / joint.length < 1.0 - 1e-9:
                end = f"s = {self.q[arc]:.6g} m, an end of {joint.carrier.name}"
                what = f"slides to {end}: there is no equilibrium between"
                return SolveError(
                    f"{where}, {joint.name}", what, "hold it there, or give the carrier more sag"
                )
        return SolveError(where, problem, hint)

    def spins(self, r: FloatArray, negative: int) -> bool:
        """Whether sections spin freely; if so, the matrix holds them.  ``negative``: from factorising K."""
        residual = float(np.max(np.abs(r)))
        if negative == 0 and (self.mu > 0.0 or not self.spin.is_free(self.solve, self.q, False, residual)):
            return False
        if self.factorise(0.0, spin=True) != 0:
            return False
        return negative == 0 or self.spin.is_free(self.solve, self.q, True, residual)

    def harmless(self) -> bool:
        """Whether mu > 0 only makes up for round-off."""
        limit = NEUTRAL_MU_JOINTS if self.expected else NEUTRAL_MU
        if len(self.core.joints.tail):
            limit = 5.0 * COUNTED_MU
        if self.mu > limit * self.ratio:
            return False
        if self.expected:
            return True
        core = self.core
        x = softest_mode(self.solve, self.system.n, core.supports.held)
        assemble(core.batches, core.ws, self.q, self.zero, core.A, 0.0, 0.0, 1.0)
        restrict(core.supports, core.A)
        return is_neutral(to_sparse(core.A, self.system.places), x)


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
    system.level[:] = 1.0, 0.0, 0.0
    cpu = clock.process_time()
    q, _ = system.initial_state(time)
    core = system.holding(others) if others else system.core
    h = 1e-3
    tables = system.inputs.tables(time - h, h, 1, time, np.inf)
    v, a = np.zeros_like(q), np.zeros_like(q)
    place_supports(core.supports, core.loads.value, tables, 0, q, v, a)
    force = np.empty_like(q)
    apply_load(core.loads, tables.value[0], force)
    it = Iteration(system, core, q, force, core.loads.value.copy())
    slack = Slack(system, q, force)
    try:
        slack.set(1.0, 1.0)
        halvings = follow_path(it, lambda share: share, load_steps, "of the load")
        if slack.found:
            halvings += follow_path(it, slack.let_out, 4, "of the slack")
            halvings += follow_path(it, slack.stiffen, slack.steps, "of the axial stiffness")
        settle_contacts(it)
    finally:
        slack.set(0.0, 0.0)
        core.loads.value[:] = it.inputs
    seconds = clock.process_time() - cpu
    return it.q, Stats(load_steps, it.iterations, it.jacobians, it.jacobians, halvings, seconds)


def settle_contacts(it: Iteration) -> None:
    """Open the contacts that pull and close those that overlap until all are right."""
    for _ in range(4 * len(it.arcs)):
        code = first_event(it.core.joints.tail, it.q)
        if code < 0 or code % 4 == LEFT:
            return
        happen(it.system, it.q, it.zero.copy(), int(code), "equilibrium")
        problem = settle(it, 1.0)
        if problem is not None:
            raise it.failure("equilibrium", problem, "give more load_steps")


class Slack:
    """The detour by which slack cables come to their equilibrium; nothing if no cable is slack."""

    def __init__(self, system: System, q: FloatArray, force: FloatArray) -> None:
        load = float(np.sum(np.abs(force)))
        cables = [b for b in system.model.beams.values() if b.element == "cable"]
        self.found = load > 0.0 and any(b.stretch < 1.0 - 1e-9 for b in cables)
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
            raise it.failure(f"equilibrium at {share:.4g} {of}", problem, "give more load_steps")
    return halvings


def settle(it: Iteration, share: float) -> str | None:
    """Newton iterations for one share of the loads; None, or what went wrong."""
    r = it.out_of_balance(it.q, share)
    it.mixed.correct(it.zero)
    disturbed = False
    for number in range(MAX_ITERATIONS):
        if not np.all(np.isfinite(r)):
            return "the forces are not finite"
        regular = it.mu == 0.0
        dq = it.correction(r)
        it.iterations += 1
        norm = it.length(dq)
        accepted = max(it.accepted, SPUN) if it.spinning else it.accepted
        settled = norm <= TOLERANCE or (norm <= accepted and _stalled(it, dq, r, share))
        if settled and (it.mu == 0.0 or it.harmless()):
            it.q = it.moved(dq, 1.0)
            slot = find_inverted(it.core.batches, it.core.ws, it.q)
            return None if slot < 0 else f"{it.system.element_of(slot)}: {COLLAPSED}"
        if regular and it.mu > 0.0 and norm < 1e-6 and not disturbed and not it.harmless():
            disturbed = True  # balanced, but not stable
            it.q = disturb(it)
            it.mixed.correct(it.zero)
            r = it.out_of_balance(it.q, share)
            continue
        longest = min(1.0, LONGEST / max(norm, 1e-300))
        if number < PLAIN:
            s, r = longest, it.out_of_balance(it.moved(dq, longest), share)
        else:
            s, r = line_search(it, dq, r, share, longest)
        before, it.q = it.q, it.moved(dq, s)
        it.mixed.correct(it.q - before)
        it.mu = relax(it.mu, s, norm)
    return f"Newton's method did not converge in {MAX_ITERATIONS} iterations, last correction {norm:.2e}"


def _slenderness(beam: Beam) -> float:
    """Share of the largest slenderness at which round-off keeps corrections below ACCEPTED."""
    section = beam.section
    if not beam.has_section or section.G is None or section.J is None:
        return 0.0
    softest = min(section.EI_y, section.EI_z, section.G * section.J)
    return section.EA * beam.length**2 / softest / SLENDER


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
    """State moved a little along the softest mode."""
    x = softest_mode(it.solve, it.system.n, it.core.supports.held)
    return it.moved(x / it.length(x), DISTURBANCE)
