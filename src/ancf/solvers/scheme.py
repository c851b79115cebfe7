"""The Newmark family's formulas: coefficients, prediction, and what an accepted step leaves to the next."""

from __future__ import annotations

from typing import NamedTuple

from ..compiled import formula
from ..records import recorded
from .memory import H_PREV, KNOWN
from .status import STEPS

#: Steps of one length after which the predictor knows the motion.
FAMILIAR = 3.0


@recorded
class Scheme(NamedTuple):
    """Coefficients of the Newmark family."""

    beta: float
    gamma: float
    alpha_m: float
    alpha_f: float

    def of(self, h: float) -> tuple[float, float]:
        """B and G of a step h, as :func:`coefficients` has them in kernels."""
        c = (1.0 - self.alpha_f) / (1.0 - self.alpha_m)
        return self.beta * h * h * c, self.gamma * h * c


@formula
def coefficients(h, scheme):
    """B and G of a step h."""
    c = (1.0 - scheme.alpha_f) / (1.0 - scheme.alpha_m)
    return scheme.beta * h * h * c, scheme.gamma * h * c


@formula
def predict(s, h, scheme, keep):
    """Accelerations extrapolated from the last four steps; q, v at the end of the step.

    2 (a_n - a_n-2) + a_n-3 is exact for accelerations that are quadratic in time and for vibrations that
    the step does not resolve, which change their sign from step to step: extrapolating the smooth part
    alone would triple them.  With fewer steps known it is a_n + a_n-1 - a_n-2, or a_n-1.  keep = 0 is the
    cautious guess of no acceleration.
    """
    predict_rows(s, h, scheme, keep, 0, s.q.shape[0])


@formula
def predict_rows(s, h, scheme, keep, first, last):
    """The same for some of the unknowns alone."""
    am, af = scheme.alpha_m, scheme.alpha_f
    c1, c2, c3 = (1.0 - af) / (1.0 - am), af / (1.0 - am), -am / (1.0 - am)
    hh, be, ga = h * h, scheme.beta, scheme.gamma
    known = s.memo[KNOWN] if s.memo[H_PREV] == h else 0.0
    w0, w1, w2, w3 = keep, 0.0, 0.0, 0.0
    if known >= FAMILIAR:
        w0, w2, w3 = 2.0 * keep, -2.0 * keep, keep
    elif known >= 2.0:
        w1, w2 = keep, -keep
    elif known >= 1.0:
        w0, w1 = 0.0, keep
    for i in range(first, last):
        q, v, a = s.q[i], s.v[i], s.a[i]
        s.q0[i], s.v0[i], s.a0[i] = q, v, a
        guess = w0 * a + w1 * s.a1[i] + w2 * s.a2[i] + w3 * s.a3[i]
        bar = s.abar[i]
        bar_new = c1 * guess + c2 * a + c3 * bar
        s.a[i] = guess
        s.q[i] = q + h * v + hh * ((0.5 - be) * bar + be * bar_new)
        s.v[i] = v + h * ((1.0 - ga) * bar + ga * bar_new)


@formula
def restore(s):
    """Back to the start of the step."""
    restore_rows(s, 0, s.q.shape[0])


@formula
def restore_rows(s, first, last):
    """The same for some of the unknowns alone."""
    for i in range(first, last):
        s.q[i], s.v[i], s.a[i] = s.q0[i], s.v0[i], s.a0[i]


@formula
def finish(s, h, scheme):
    """Accept the step: algorithmic acceleration and memory of the predictor."""
    finish_rows(s, scheme, 0, s.a.shape[0])
    note_step(s, h)


@formula
def finish_rows(s, scheme, first, last):
    """The same for some of the unknowns alone, without counting the step."""
    am, af = scheme.alpha_m, scheme.alpha_f
    c1, c2, c3 = (1.0 - af) / (1.0 - am), af / (1.0 - am), -am / (1.0 - am)
    for i in range(first, last):
        s.abar[i] = c1 * s.a[i] + c2 * s.a0[i] + c3 * s.abar[i]
        s.a3[i] = s.a2[i]
        s.a2[i] = s.a1[i]
        s.a1[i] = s.a0[i]


@formula
def note_step(s, h):
    """Count a step of this length."""
    s.memo[KNOWN] = s.memo[KNOWN] + 1.0 if s.memo[H_PREV] == h else 1.0
    s.memo[H_PREV] = h
    s.counts[STEPS] += 1
