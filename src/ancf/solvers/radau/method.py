"""Radau IIA steps for equations of motion of index 3: simplified Newton, error estimate, step control.

What moves is a small *problem* (see :class:`Problem`) with free unknowns x, some of which may be
multipliers.  At the stages of a step its residual

    R_i = M A_i + f(Q_i, V_i) + C_q^T L_i - F(t_i)   and   C(Q_i)

is zero; the multipliers stand in Q and have no rates.  Written for increments dQ of the stages, a Newton
correction with constant matrices falls apart along the eigenvalues mu of the Runge-Kutta matrix into

    (M/(h mu)^2 + D/(h mu) + K) z = -(part of R that belongs to mu),

one real and one complex system of the size of the problem for three stages, one complex system for two.
The same factors give the error estimate, in which stiff parts and the direction of constraints are
filtered.  Reference: Hairer & Wanner, Solving Ordinary Differential Equations II, sections IV.8 and VII.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

from ...arrays import FloatArray, IntArray
from ..status import DIVERGED, NOT_FINITE, OK, SINGULAR
from .collocation import Collocation, collocation

MAX_ITERATIONS = 12
#: Contraction above which the matrices are renewed: during a step, and after it.
SLOW, TIRED = 0.5, 0.1
#: Least theta/(1 - theta) that is believed before a step has shown its own contraction.
STALE = 0.03
#: Corrections up to this multiple of the tolerance that new matrices do not reduce are round-off.
ROUND_OFF = 1e4
#: Share of the error tolerance, of positions and of velocities, that Newton's method may leave.
NEWTON_SHARE = 5e-3
SAFETY, SHRINK, GROW = 0.9, 0.2, 5.0
#: A step that should change by less than this keeps its size, and with it its matrices.
MILD, WORTH = 0.9, 1.2
#: Exponents of the control (Hairer & Wanner, IV.8), of the error now and of the one before; least values.
NOW, BEFORE, LEAST_ERROR, LEAST_BEFORE = 0.7, 0.3, 1e-10, 1e-2
#: Error of a step that has none.
ENDLESS = 1e10
#: In each step the last contraction is believed less, and round-off that was seen is forgotten.
BELIEF, FADING = 0.8, 0.99
#: A correction of so many sizes of the model is none; what stands for a contraction that is none.
FAR, NEVER = 1e3, 1e300
#: Pivots on the diagonal are kept down to this share of the largest entry of a column.
PIVOT = 0.1
#: Numbers, and arrays of the last step, that decide how a run goes on.
KEPT = (
    *("t", "speed", "worst", "norm", "_h_matrices", "_contraction", "_noise", "_eta"),
    *("_fresh", "_rejected", "_error_before"),
)
LAST = ("q0", "v0", "Q", "V", "A")


@dataclass
class Matrices:
    """Mass, damping and tangent stiffness (with the constraints) at one state, csc of one size."""

    M: csc_array
    D: csc_array
    K: csc_array
    alike: bool = False  # the three have entries in the same places

    def combined(self, mass: complex, damping: complex) -> csc_array:
        """Mass M + damping D + K."""
        if self.alike:
            data = mass * self.M.data + damping * self.D.data + self.K.data
            return csc_array((data, self.K.indices, self.K.indptr), shape=self.K.shape)
        return csc_array(mass * self.M + damping * self.D + self.K)


class Problem(Protocol):
    """Equations of motion of n free unknowns."""

    multipliers: IntArray  # unknowns without rates
    weight: FloatArray  # (n,) 1/size of each unknown; what is done with a multiplier's is nothing

    def residuals(self, t: FloatArray, q: FloatArray, v: FloatArray, a: FloatArray) -> FloatArray:
        """Residuals at the times t, shape (m,), of states of shape (m, n)."""
        ...

    def matrices(self, t: float, q: FloatArray, v: FloatArray) -> Matrices:
        """Matrices at one state."""
        ...


@dataclass
class Step:
    """A step that Newton's method has solved; all arrays (s, n)."""

    t: float
    h: float
    q0: FloatArray  # (n,) at the start
    v0: FloatArray
    Q: FloatArray
    V: FloatArray
    A: FloatArray
    rates: NDArray[np.bool_]  # (n,) no multiplier
    method: Collocation

    @property
    def times(self) -> FloatArray:
        """Times of the stages."""
        return self.t + self.h * self.method.c

    def at(self, tau: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Q, V, A at t + tau h, each (m, n): polynomials through the accelerations of the stages.

        Order s + 1 in q and s in v; multipliers are interpolated between the stages.
        """
        value, once, twice = self.method.integrals(tau)
        A = _mixed(value, self.A)
        V = self.v0 + self.h * _mixed(once, self.A)
        Q = self.q0 + self.h * tau[:, None] * self.v0 + self.h**2 * _mixed(twice, self.A)
        Q[:, ~self.rates] = _mixed(value, self.Q[:, ~self.rates])
        return Q, V, A


class Counts:
    """What the steps cost."""

    def __init__(self) -> None:
        self.steps = self.newton_iterations = self.jacobians = self.factorizations = self.retries = 0


class Stepper:
    """Takes steps of a problem: :meth:`solve`, :meth:`error`, :meth:`next_size`, :meth:`accept`.

    Parameters
    ----------
    problem : Problem
    stages : int
        2 or 3.
    tolerance : float
        Error of a step: of q in units of 1/weight, of v relative to ``speed`` in the mean.
    newton_tolerance : float
        Least error of q that Newton's method is asked for.
    duration : float
        Of the whole run, s: the least ``speed`` is one size of the model in that time.
    """

    def __init__(
        self, problem: Problem, stages: int, tolerance: float, newton_tolerance: float, duration: float
    ) -> None:
        self.problem, self.method = problem, collocation(stages)
        self.tolerance, self.newton_tolerance = tolerance, newton_tolerance
        self.speed = 1.0 / duration
        self.rates = np.ones(len(problem.weight), dtype=np.bool_)
        self.rates[problem.multipliers] = False
        self.weight = problem.weight * self.rates
        self.scale = np.ones(len(self.weight))  # of rows and columns: multipliers come in other units
        self.counts = Counts()
        self.last: Step | None = None
        self.worst, self.norm = 0, 0.0
        self._h_matrices, self._contraction, self._noise, self._eta = 0.0, 0.0, 0.0, 1.0
        self._fresh = False  # the matrices are of the step at hand
        self._rejected, self._error_before = True, 1.0

    def start(self, t: float, q: FloatArray, v: FloatArray, a: FloatArray) -> None:
        """Consistent state at the time t, copied; nothing of steps before is taken to be as it was."""
        self.t, self.q, self.v, self.a = t, q.copy(), v.copy(), a.copy()
        self.last, self._h_matrices = None, 0.0

    def values(self) -> dict[str, float]:
        """Numbers that decide how it goes on, ready for JSON."""
        kept = {name: getattr(self, name) for name in KEPT}
        kept |= {f"counts.{name}": count for name, count in vars(self.counts).items()}
        if self.last is not None:
            kept |= {"last.t": self.last.t, "last.h": self.last.h}
        return kept

    def arrays(self) -> dict[str, Any]:
        """Arrays that do: the state, the last step, and the matrices whose factors are kept."""
        kept: dict[str, Any] = {name: getattr(self, name) for name in ("q", "v", "a", "scale")}
        if self.last is not None:
            kept["last"] = {name: getattr(self.last, name) for name in LAST}
        if self._h_matrices > 0.0:
            kept["matrices"] = {name: getattr(self.matrices, name).data for name in ("M", "D", "K")}
        return kept

    def restore(self, values: dict[str, Any], arrays: Mapping[str, Any]) -> None:
        """Be as when :meth:`values` and :meth:`arrays` (by place, after "stepper.") were taken."""
        for name in KEPT:
            setattr(self, name, values[name])
        self.q, self.v, self.a, self.scale = (
            arrays[f"stepper.{name}"].copy() for name in ("q", "v", "a", "scale")
        )
        self.last = None
        if "last.t" in values:
            own = {name: arrays[f"stepper.last.{name}"].copy() for name in LAST}
            self.last = Step(values["last.t"], values["last.h"], **own, rates=self.rates, method=self.method)
        if self._h_matrices > 0.0:
            self.matrices = self.problem.matrices(self.t, self.q, self.v)  # their places
            for name in ("M", "D", "K"):
                getattr(self.matrices, name).data[:] = arrays[f"stepper.matrices.{name}"]
            self._factorise(self._h_matrices)
        for name in vars(self.counts):
            setattr(self.counts, name, values[f"counts.{name}"])

    def solve(self, h: float, adaptive: bool) -> tuple[int, Step]:
        """Solve the stages of a step of size h from the present state; returns a status and the step."""
        step, self._fresh = self._predicted(h), False
        bound = self.newton_tolerance
        if adaptive:
            bound = max(bound, NEWTON_SHARE * self.tolerance * min(1.0, h * self.speed))
        if self._h_matrices != h or self._contraction > TIRED:
            status = self._renew(step)
            if status != OK:
                return status, step
        status = self._newton(step, bound)
        if status != OK and not self._fresh:
            step = self._predicted(h)
            status = self._renew(step)
            if status == OK:
                status = self._newton(step, bound)
        if status != OK:
            self._h_matrices = 0.0
        return status, step

    def accept(self, step: Step, t: float) -> None:
        """The state at the end of a step becomes the present one; t is the time there."""
        self.t, self.last = t, step
        self.q, self.v, self.a = step.Q[-1].copy(), step.V[-1].copy(), step.A[-1].copy()
        self.counts.steps += 1

    def error(self, step: Step) -> float:
        """Estimated error of a step in units of the tolerance, stiff parts filtered."""
        dq, dv = self._estimate(step, self.v, self.matrices.M @ self.a)
        error = self._size(step, dq, dv)
        if error >= 1.0 and self._rejected:
            # the same with the rate at the corrected start: what a stiff component would lose anyway
            q, v = self.q + dq, self.v + dv
            force = -self.problem.residuals(np.array([self.t]), q[None], v[None], 0.0 * v[None])[0]
            force[~self.rates] = 0.0
            error = self._size(step, *self._estimate(step, v, force))
        return float(error) if np.isfinite(error) else ENDLESS

    def next_size(self, h: float, error: float) -> float:
        """Size of the next step after an accepted or a rejected one (proportional-integral control)."""
        power = 1.0 / (self.method.stages + 1)
        if error >= 1.0:
            self._rejected = True
            return h * float(min(max(SAFETY * error**-power, SHRINK), MILD))
        error = max(error, LEAST_ERROR)
        factor: float = SAFETY * error ** (-NOW * power) * self._error_before ** (BEFORE * power)
        factor = min(max(factor, SHRINK), 1.0 if self._rejected and self.last is not None else GROW)
        self._error_before, self._rejected = max(error, LEAST_BEFORE), False
        return h if MILD <= factor <= WORTH else factor * h

    def failed(self) -> None:
        """Newton's method has failed: the next step starts cautiously."""
        self.counts.retries += 1
        self._rejected = True

    def _predicted(self, h: float) -> Step:
        """First guess: the accelerations of the last step extrapolated."""
        c, a = self.method.c, self.method.a
        if self.last is None:
            A = np.tile(self.a, (len(c), 1))
            multipliers = np.tile(self.q[~self.rates], (len(c), 1))
        else:
            value = self.method.integrals(1.0 + c * h / self.last.h)[0]
            A = _mixed(value, self.last.A)
            multipliers = _mixed(value, self.last.Q[:, ~self.rates])
        A[:, ~self.rates] = 0.0
        V = self.v + h * _mixed(a, A)
        Q = self.q + h * _mixed(a, V)
        Q[:, ~self.rates] = multipliers
        return Step(self.t, h, self.q, self.v, Q, V, A, self.rates, self.method)

    def _renew(self, step: Step) -> int:
        """Matrices in the middle of the predicted step, and their factors."""
        middle = (len(step.Q) - 1) // 2
        t = float(step.times[middle])
        self.matrices = self.problem.matrices(t, step.Q[middle], step.V[middle])
        self.counts.jacobians += 1
        self._fresh, self._h_matrices, self._contraction, self._eta = True, 0.0, 0.0, 1.0
        mass = float(np.max(np.abs(self.matrices.M.data), initial=1e-300))
        self.scale[~self.rates] = mass / step.h**2
        if not self._factorise(step.h):
            return SINGULAR
        self._h_matrices = step.h
        return OK

    def _factorise(self, h: float) -> bool:
        """Factorise the matrices for a step h; whether that is possible."""
        self.factors = []
        for mu in self.method.mu:
            s = 1.0 / (h * (mu.real if mu.imag == 0.0 else mu))
            E = self.matrices.combined(s * s, s)
            E.data *= self.scale[E.indices] * np.repeat(self.scale, np.diff(E.indptr))
            self.counts.factorizations += 1
            try:
                self.factors.append(splu(E, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=PIVOT))
            except RuntimeError:
                return False
        return True

    def _solve(self, k: int, r: NDArray[Any]) -> NDArray[Any]:
        """Solve the system of eigenvalue k."""
        real = self.method.mu[k].imag == 0.0
        x: NDArray[Any] = self.factors[k].solve(self.scale * (r.real if real else r))
        scaled: NDArray[Any] = self.scale * x
        return scaled

    def _newton(self, step: Step, bound: float) -> int:
        """Correct the stages until the error left is below the bound."""
        method, h = self.method, step.h
        to_v, to_a = method.inverse / h, method.inverse @ method.inverse / h**2
        bound = max(bound, self._noise)
        self._noise *= FADING
        old, eta, theta = -1.0, max(self._eta**BELIEF, STALE), 0.0
        for _ in range(MAX_ITERATIONS):
            r = self.problem.residuals(step.times, step.Q, step.V, step.A)
            if not np.all(np.isfinite(r)):
                self.worst = int(np.argmin(np.all(np.isfinite(r), axis=0)))
                return NOT_FINITE
            parts = [self._solve(k, _mixed(row, r)) for k, row in enumerate(method.to_modes)]
            d = -_mixed(method.from_modes, np.array(parts)).real
            step.Q += d
            d[:, ~self.rates] = 0.0
            step.V += _mixed(to_v, d)
            step.A += _mixed(to_a, d)
            self.counts.newton_iterations += 1
            sizes = np.max(np.abs(d), axis=0) * self.weight
            self.worst = int(np.argmax(sizes))
            self.norm = norm = float(sizes[self.worst])
            if not np.isfinite(norm) or norm > FAR:
                return DIVERGED if np.isfinite(norm) else NOT_FINITE
            if old > 0.0:
                theta = norm / old
                eta = theta / (1.0 - theta) if theta < 1.0 else NEVER
                self._contraction = theta
            if eta * norm <= bound:
                self._eta = eta
                return OK
            if theta > SLOW and norm <= ROUND_OFF * self.newton_tolerance and self._fresh:
                self._noise, self._contraction, self._eta = 2.0 * norm, 0.0, 1.0
                return OK
            if theta >= 1.0 or (theta > SLOW and not self._fresh):
                return DIVERGED
            old = norm
        return DIVERGED

    def _estimate(self, step: Step, v: FloatArray, force: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Errors of q (that of v times the step included) and v at the end; ``force`` is M a at the start."""
        method, h, M = self.method, step.h, self.matrices.M
        mu = method.mu[0]
        s = 1.0 / (h * (mu if mu.imag != 0.0 else mu.real))
        eq = h * method.gamma * v + _mixed(method.e, step.Q - step.q0)
        eq[~self.rates] = 0.0
        ev = _mixed(method.e, step.V - step.v0)
        rhs = s * (h * method.gamma * force + M @ ev) + s * s * (M @ eq) + s * (self.matrices.D @ eq)
        dq = self._solve(0, rhs)
        dv = s * (dq - eq)
        dv[~self.rates] = 0.0
        return dq.real, dv.real

    def _size(self, step: Step, dq: FloatArray, dv: FloatArray) -> float:
        """Errors in units of the tolerance.

        Velocities that a stiff spring or a constraint takes back within the step are no error.
        """
        mu = self.method.mu[0]
        s = 1.0 / (step.h * (mu if mu.imag != 0.0 else mu.real))
        dv = np.real(self._solve(0, s * s * (self.matrices.M @ dv)))
        sizes = np.abs(dq) * self.weight
        self.worst = int(np.argmax(sizes))
        self._see(step.V[-1])
        return max(float(sizes[self.worst]), self._rate(dv) / self.speed) / self.tolerance

    def _rate(self, v: FloatArray) -> float:
        """Mean rate of a velocity, weighted with the masses as in the kinetic energy, sizes per s."""
        M = self.matrices.M
        unit = np.divide(1.0, self.weight, out=np.zeros_like(self.weight), where=self.rates)
        return float(np.sqrt(max(np.sum(v * (M @ v)), 0.0) / np.sum(unit * (M @ unit))))

    def _see(self, v: FloatArray) -> None:
        """The largest rate so far is what errors of velocities are compared with."""
        self.speed = max(self.speed, self._rate(v))


def _mixed(factors: NDArray[Any], rows: NDArray[Any]) -> NDArray[Any]:
    """``factors @ rows`` without BLAS, whose threads would go on spinning."""
    out: NDArray[Any] = np.einsum("...j,jn->...n", factors, rows)
    return out
