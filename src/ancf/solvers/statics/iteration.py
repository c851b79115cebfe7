"""One correction of an equilibrium: (K + mu M) dq = -r, with mu that makes the matrix positive definite."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...compiled import traits
from ...errors import SolveError
from ...later import LinearOperator, SuperLU, gmres, splu
from ...linalg.sparse import to_sparse
from ...model.bodies.beam import Beam
from ...model.joints.basic import Slide
from ...system.at_rest import assemble_at_rest
from ...system.contacts import strips_touch, touching
from ...system.core import (
    Core,
    apply_supports,
    factorise_matrix,
    follow_supports,
    residual,
    restrict,
    solve_matrix,
)
from ...system.reactions import ROUND_OFF, largest_stiffness
from ...system.system import System
from .free_spin import Spin, is_neutral, lowest_square, softest_mode
from .mixed import Mixed

ACCEPTED = 1e-9  # of a correction, where round-off keeps it above the tolerance
SLENDER = 5e5  # EA L^2/EI of a beam up to which ACCEPTED is above round-off
SHORT = 1.0  # longest correction with sliding joints, in sizes of the model
#: Share to which a larger mu has to shorten a correction, and how often in a row it may fail to.
SHORTER, MOST_IDLE = 0.9, 4
AT_END = 1e-9  # of the length of a line: a sliding point that is no farther from its end has no equilibrium
LEAST_MU = 1e-15  # of the ratio of stiffness to mass
MORE_MU, MOST_MU = 5.0, 60  # factor by which mu grows until the matrix will do, and how often
NEUTRAL_MU = 1e-13  # up to which mu may only make up for round-off
NEUTRAL_MU_JOINTS = 1e-10  # NEUTRAL_MU with the stiffness that the rows of joints add
PROBE, NOTHING = 1e-7, 1e-300  # of differences, positions in sizes of the model; no correction at all
LEFT_OVER, DIRECTIONS = 1e-3, 40  # of the residual by GMRES, and how many directions it looks in
OUTWEIGHED = 2.0  # times mu: what holds a vibration of this square is more than mu
NEARLY, FAR_LONGER = 1e-2, 10.0  # corrections next to an equilibrium, and what no longer is one
SWING = 1e-6  # of the square of a frequency: mu that is small beside what loads hold
UNCARRIED = 1e-3  # of what joints have to carry, with the right multipliers
ENDLESS = 1e4  # times that are multipliers of a joint without a direction
COUNTED_MU = 1e-9  # with which pivots are counted where a body has no stiffness of its own


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
    last: float = np.inf  # length of the last correction
    last_moved: int = 0  # entry that it changed most
    held: bool = False  # whether surfaces and friction hold what they touch
    plain: bool = True  # whether an indefinite matrix is taken as it is where loads follow
    laid: FloatArray | None = None  # where cables lay without friction, if that acts from there

    def __post_init__(self) -> None:
        self.zero = np.zeros_like(self.q)
        self.begun = self.system.kept_memory()  # what is remembered at first
        self.lu: SuperLU | None = None
        arcs = self.system.numbering.arcs
        slides = [c for c in self.system.model.connections if isinstance(c, Slide)]
        self.arcs = [(c, arcs[c.name]) for c in slides if arcs[c.name] not in self.core.supports.held]
        # a stable equilibrium has as many negative pivots as multipliers (Sylvester)
        self.expected = len(np.setdiff1d(self.system.multipliers, self.core.supports.held))
        slenderness = [_slenderness(b) for b in self.system.model.beams.values()]
        self.accepted = ACCEPTED * max([1.0, *slenderness])
        self.follows = any(len(batch.base) > 0 and _follows(batch) for batch in self.core.external)
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

    def strips(self, q: FloatArray) -> BoolArray:
        """Which contacts of strips push in a state."""
        return strips_touch(self.core, q)

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

    @cached_property
    def least(self) -> float:
        """Least mu, 1/s^2: of what joints join a part of what loads let it swing with in the model's size.

        It may turn where nothing holds it, as about the vertical: mu that hardly outweighs what round-off
        makes of that would let it turn far, and leave the equilibrium.
        """
        least = LEAST_MU * self.ratio
        if not self.expected:
            return least
        model, largest = self.system.model, float(np.max(np.abs(self.force), initial=0.0))
        mass = sum(
            b.section.rhoA * b.length if isinstance(b, Beam) else b.mass for b in model.bodies.values()
        )
        return max(least, SWING * largest / (mass * model.size)) if mass > 0.0 else least

    def _assemble(self, mass: float, stiffness: float, spin: bool) -> None:
        core = self.core
        assemble_at_rest(self.mixed.batches, core.ws, self.q, core.A, mass, 0.0, stiffness)
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

    def renew_multipliers(self, share: float) -> None:
        """Those that balance the forces of a state, with the last factorisation.

        The scale of the gaps in the forces may have changed between the last two matrices: multipliers then
        still balance gaps that are closed.
        """
        unknown = np.setdiff1d(self.system.multipliers, self.core.supports.held)
        if len(unknown) and not len(self.core.joints.tail):
            self.q[unknown] -= self.solve(self.out_of_balance(self.q, share))[unknown]

    def overtaxed(self, share: float) -> str | None:
        """The joint with the largest multiplier, if no multipliers balance a state whose gaps are closed."""
        unknown = np.setdiff1d(self.system.multipliers, self.core.supports.held)
        if not len(unknown) or len(self.core.joints.tail):
            return None
        alone = self.q.copy()
        alone[unknown] = 0.0
        left, carried = (self.out_of_balance(q, share) for q in (self.q, alone))
        left[self.system.multipliers] = carried[self.system.multipliers] = 0.0
        most = float(np.max(np.abs(carried)))
        balanced = np.max(np.abs(left)) <= UNCARRIED * most + ROUND_OFF * largest_stiffness(self.system)
        if balanced or np.max(np.abs(self.q[unknown])) <= ENDLESS * most:
            return None
        worst = unknown[int(np.argmax(np.abs(self.q[unknown])))]
        owners = self.system.numbering.multipliers.items()
        return next(name for name, own in owners if worst in own)

    def length(self, dq: FloatArray) -> float:
        """Largest entry, positions in sizes of the model."""
        return float(np.max(np.abs(dq) * self.core.weight))

    def correction(self, r: FloatArray) -> FloatArray:
        """dq of (K + mu M) dq = r, with mu large enough to make the matrix positive definite.

        Loads that depend on the state, as moments, are no conservative ones and the symmetric part of their
        stiffness says nothing about stability: with them an indefinite K is taken as it is.
        """
        if len(self.core.joints.tail) or self.held:
            return self._short_correction(r)
        if self.mu == 0.0 and not (self.follows or self.spin) and np.any(self.strips(self.q)):
            # a body that only a strip holds has a pivot of round-off, of either sign
            self.mu = LEAST_MU * self.ratio
        negative = self.factorise(self.mu)
        self.spinning = bool(self.spin) and self.spins(r, negative)
        if self.spinning:
            self.mu = 0.0
        elif negative and bool(self.spin):
            negative = self.factorise(self.mu)
        plain = self.follows and self.plain and self.mu == 0.0
        if self.spinning or negative == 0 or (negative > 0 and plain):
            dq = self.solve(r)
            if not (self.expected and self._runs_away(dq)):
                return dq
        self.mu = max(self.mu, self.least)
        for _ in range(MOST_MU):
            if self.factorise(self.mu) == 0:
                return self.solve(r)
            self.mu *= MORE_MU
        raise SolveError("equilibrium", "no regularisation makes the stiffness positive definite")

    def _runs_away(self, dq: FloatArray) -> bool:
        """Whether a correction near an equilibrium is a long one.

        What nothing holds, as a body that may turn about the vertical, has a stiffness of either sign that is
        due to what is out of balance: mu that just outweighs it leaves nearly none, and the body turns far.
        """
        return self.last < NEARLY and self.length(dq) > FAR_LONGER * self.last

    def lacks_slopes(self) -> bool:
        """Whether the matrix lacks derivatives near an equilibrium.

        Those of loads that follow, or of how the forces of strips turn with their wire, where mu is there for
        a body alone that only its contact holds.
        """
        if self.follows and self.mu == 0.0:
            return True
        return len(self.touching.turns) > 0 and self.mu <= NEUTRAL_MU * self.ratio

    def followed(self, dq: FloatArray, r: FloatArray, share: float) -> FloatArray:
        """The correction with the derivative of loads that follow, which no symmetric matrix has.

        GMRES from ``dq`` on, preconditioned by the last factorisation; its products are differences. Beside a
        jump of the forces they are no derivatives: what leaves more of the residual than none is not taken.
        """

        def product(x: FloatArray) -> FloatArray:
            s = PROBE / max(self.length(x), NOTHING)
            behind, ahead = (self.out_of_balance(self.moved(x, t), share) for t in (-s, s))
            found: FloatArray = (behind - ahead) / (2.0 * s)
            return found

        shape = len(r), len(r)
        derivative, inverse = (LinearOperator(shape, way, dtype=float) for way in (product, self.solve))
        limits: dict[str, Any] = {"rtol": LEFT_OVER, "restart": DIRECTIONS, "maxiter": 1}
        found: FloatArray = gmres(derivative, r, dq, M=inverse, **limits)[0]
        left, whole = (np.linalg.norm(self.solve(x)) for x in (r - product(found), r))
        return found if left < whole else dq

    def _short_correction(self, r: FloatArray) -> FloatArray:
        """The same, and mu is also large enough to keep the correction short.

        A point that slides down a slope has no stiffness at all until it has found its place; nor has a rope
        that was drawn with a bend, across its plane, until it is taut. What closes the gap of a sliding
        joint stays as long as it is whatever mu is: of the shortest correction a part is taken then.
        """
        shortest, best, idle = np.inf, self.mu, 0
        for _ in range(MOST_MU):
            if self.factorise(self.mu) == 0:
                dq = self.solve(r)
                length = self.length(dq)
                if length <= SHORT:
                    return dq
                idle = idle + 1 if length > SHORTER * shortest else 0
                if length < shortest:
                    shortest, best = length, self.mu
                if idle == MOST_IDLE and self.arcs:
                    break
            self.mu = max(MORE_MU * self.mu, COUNTED_MU * self.ratio)
        self.mu = best
        if self.arcs and np.isfinite(shortest) and self.factorise(self.mu) == 0:
            return self.solve(r) * (SHORT / shortest)
        problem = "no regularisation makes the stiffness positive definite"
        raise self.failure("equilibrium", problem, "begin nearer to where it comes to rest")

    def failure(self, where: str, problem: str, hint: str = "") -> SolveError:
        """Error of an iteration that found nothing."""
        for joint, arc in self.arcs:
            if not AT_END < self.q[arc] / joint.length < 1.0 - AT_END:
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

    def drifts(self, dq: FloatArray) -> bool:
        """Whether a correction, (n,), is a motion against which there is no stiffness."""
        self._assemble(0.0, 1.0, False)
        return is_neutral(to_sparse(self.core.A, self.system.places), dq)

    def harmless(self) -> bool:
        """Whether mu > 0 only makes up for round-off."""
        limit = (NEUTRAL_MU_JOINTS if self.expected else NEUTRAL_MU) * self.ratio
        if len(self.core.joints.tail):
            limit = MORE_MU * COUNTED_MU * self.ratio
        if self.mu > max(limit, MORE_MU * self.least):
            return False
        if self.expected:
            return True
        core = self.core
        x = softest_mode(self.solve, self.system.n, core.supports.held)
        self._assemble(0.0, 1.0, False)
        if is_neutral(to_sparse(core.A, self.system.places), x):
            return True
        # pivots are those of the matrix without strips, which may be all that holds a body
        return len(self.touching.turns) > 0 and self.softest()[0] > OUTWEIGHED * self.mu

    def is_unstable(self) -> bool:
        """Whether a state that joints balance is one that gives way; the last factors then show how.

        What turns with the forces of joints has a stiffness with these alone: it is known only now.
        """
        core, mu = self.core, MORE_MU * self.least
        loaded = self.least > LEAST_MU * self.ratio
        if not loaded or self.held or self.follows or core.joints.tail or np.any(self.strips(self.q)):
            return False
        if self.factorise(mu) == 0:
            return False
        for _ in range(MOST_MU):
            mu *= MORE_MU
            if self.factorise(mu) == 0:
                return True
        return False

    def softest(self) -> tuple[float, FloatArray]:
        """Square of the lowest frequency of the last factors with the contacts, 1/s^2; its shape (n,)."""
        self._assemble(1.0, 0.0, False)
        M = to_sparse(self.core.A, self.system.places)
        return lowest_square(self.solve, M, self.core.supports.held)


def _follows(batch: Any) -> bool:
    own = traits(batch).follows
    return own is None or own(batch)


def _slenderness(beam: Beam) -> float:
    """Share of the largest slenderness at which round-off keeps corrections below ACCEPTED."""
    section = beam.section
    if not beam.has_section or section.G is None or section.J is None:
        return 0.0
    softest = min(section.EI_y, section.EI_z, section.G * section.J)
    return section.EA * beam.length**2 / softest / SLENDER
