"""The Newmark family's formulas: coefficients, prediction, and what an accepted step leaves to the next."""

from __future__ import annotations

from typing import NamedTuple

from ...compiled import formula
from ...records import recorded
from ...simd import LANES, load, store
from ..status import STEPS
from .memory import H_PREV, KNOWN

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
def plain(scheme):
    """Whether the equations of motion hold at the ends of steps: the algorithmic acceleration is a."""
    return scheme.alpha_m == 0.0 and scheme.alpha_f == 0.0


@formula
def weights(s, h, keep):
    """Of a, a0, a1 and a2, as they are before a prediction, in the accelerations that it expects."""
    if keep == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    known = s.memo[KNOWN] if s.memo[H_PREV] == h else 0.0
    if known >= FAMILIAR:
        return 2.0, 0.0, -2.0, 1.0
    if known >= 2.0:
        return 1.0, 1.0, -1.0, 0.0
    if known >= 1.0:
        return 0.0, 1.0, 0.0, 0.0
    return 1.0, 0.0, 0.0, 0.0


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
    """The same for some of the unknowns alone, eight at a time.

    This also moves the memory of accelerations on; :func:`restore` moves it back.
    """
    am, af = scheme.alpha_m, scheme.alpha_f
    c1, c2, c3 = (1.0 - af) / (1.0 - am), af / (1.0 - am), -am / (1.0 - am)
    bars = not plain(scheme)
    w0, w1, w2, w3 = weights(s, h, keep)
    old, new = h * h * (0.5 - scheme.beta), h * h * scheme.beta
    slow, fast = h * (1.0 - scheme.gamma), h * scheme.gamma
    whole = last - (last - first) % LANES
    for i in range(first, whole, LANES):
        q, v, a = load(s.q, i), load(s.v, i), load(s.a, i)
        a0, a1, a2 = load(s.a0, i), load(s.a1, i), load(s.a2, i)
        guess = (w0 * a + w1 * a0) + (w2 * a1 + w3 * a2)
        bar = load(s.abar, i) if bars else a
        bar_new = c1 * guess + c2 * a + c3 * bar if bars else guess
        store(q, s.q0, i)
        store(v, s.v0, i)
        store(a, s.a0, i)
        store(a0, s.a1, i)
        store(a1, s.a2, i)
        store(a2, s.a3, i)
        store(guess, s.a, i)
        store(q + h * v + (old * bar + new * bar_new), s.q, i)
        store(v + (slow * bar + fast * bar_new), s.v, i)
    for i in range(whole, last):
        q, v, a = s.q[i], s.v[i], s.a[i]
        guess = (w0 * a + w1 * s.a0[i]) + (w2 * s.a1[i] + w3 * s.a2[i])
        bar = s.abar[i] if bars else a
        bar_new = c1 * guess + c2 * a + c3 * bar if bars else guess
        s.a3[i], s.a2[i], s.a1[i] = s.a2[i], s.a1[i], s.a0[i]
        s.q0[i], s.v0[i], s.a0[i] = q, v, a
        s.a[i] = guess
        s.q[i] = q + h * v + (old * bar + new * bar_new)
        s.v[i] = v + (slow * bar + fast * bar_new)


@formula
def restore(s):
    """Back to the start of the step, also what the prediction has moved on; a3 is kept for this alone."""
    restore_rows(s, 0, s.q.shape[0])


@formula
def restore_rows(s, first, last):
    """The same for some of the unknowns alone."""
    for i in range(first, last):
        s.q[i], s.v[i], s.a[i] = s.q0[i], s.v0[i], s.a0[i]
        s.a0[i], s.a1[i], s.a2[i] = s.a1[i], s.a2[i], s.a3[i]


@formula
def finish(s, h, scheme):
    """Accept the step: algorithmic acceleration and memory of the predictor."""
    finish_rows(s, scheme, 0, s.a.shape[0])
    note_step(s, h)


@formula
def finish_rows(s, scheme, first, last):
    """The same for some of the unknowns alone, without counting the step."""
    if plain(scheme):  # see show_bars
        return
    am, af = scheme.alpha_m, scheme.alpha_f
    c1, c2, c3 = (1.0 - af) / (1.0 - am), af / (1.0 - am), -am / (1.0 - am)
    for i in range(first, last):
        s.abar[i] = c1 * s.a[i] + c2 * s.a0[i] + c3 * s.abar[i]


@formula
def show_bars(s, scheme):
    """Algorithmic accelerations for those who ask between blocks, where steps do without."""
    if plain(scheme):
        for i in range(s.a.shape[0]):
            s.abar[i] = s.a[i]


@formula
def note_step(s, h):
    """Count a step of this length."""
    s.memo[KNOWN] = s.memo[KNOWN] + 1.0 if s.memo[H_PREV] == h else 1.0
    s.memo[H_PREV] = h
    s.counts[STEPS] += 1
