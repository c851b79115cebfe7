"""Accelerations that a step can resolve.

A load that begins at once, or a start that is no rest, gives short stiff elements accelerations of a time
that is far below the step: at the pin of a cable that is let go the slope gets g/l, the shorter the element
the more.  The trapezoidal rule moves on with them, by h^2/4 a, which may be more than an element can bend,
and keeps them with alternating signs for ever.  Those that belong to the step are a with

    M a + F(q + B a, v + G a) = f,      (M + G C + B K) a = f - F(q, v),

in one linear step (B and G as in :mod:`ancf.solvers.newmark`).  Motions that the step resolves get theirs
to the order of h^2, and once, which no order of the method feels; those of stiff ones nearly vanish.
"""

from __future__ import annotations

import numpy as np

from ...system.core import (
    Core,
    Tables,
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
from ...system.system import System
from .memory import H_FACTOR, H_PREV, KNOWN, Memory
from .scheme import Scheme


def resolve(
    system: System, core: Core, memory: Memory, now: Tables, h: float, scheme: Scheme, least: float = 0.0
) -> bool:
    """Replace the accelerations of the state now by those that a step h resolves; whether that was possible.

    Parameters
    ----------
    system, core
    memory : Memory
        Its state, accelerations and predictor; the predictor then knows nothing.
    now : Tables
        Functions of time whose first row is now.
    h : float
        s.
    scheme : Scheme
    least : float
        Of a M a, what is to be left of it.  Where less is left the step is long for what begins to move as a
        whole, not only for short elements, and its motion would be another one.
    """
    if len(system.multipliers):
        return False
    m, share = memory, (1.0 - scheme.alpha_f) / (1.0 - scheme.alpha_m)
    B, G = scheme.beta * h * h * share, scheme.gamma * h * share
    a, r = np.zeros(system.size), np.zeros(system.size)
    apply_load(core.loads, now.value[0], m.f)
    place_supports(core.supports, core.loads.value, now, 0, m.q, m.v, a)
    residual(core.batches, core.ws, m.q, m.v, a, m.f, r)
    apply_supports(core.supports, r)
    force = -r[: system.n]
    assemble(core.batches, core.ws, m.q, m.v, core.A, 1.0 / B, G / B, 1.0)
    restrict(core.supports, core.A)
    m.memo[H_FACTOR] = m.memo[H_PREV] = m.memo[KNOWN] = 0.0
    if factorise_matrix(core.A, core.factor) < 0:
        return False
    solve_matrix(core.factor, r)
    a[: system.n] -= r[: system.n] / B
    with np.errstate(all="ignore"):
        enough = a[: system.n] @ force >= least * (m.a[: system.n] @ force)
    if not (enough and np.all(np.isfinite(a))):
        return False
    follow_supports(core.supports, m.q, m.v, a)
    m.a[:] = m.abar[:] = a
    return True
