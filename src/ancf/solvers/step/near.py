"""Newton's iteration where it has not converged.

Along a line of wires a few places decide how many iterations a step takes: where a strip pushes, a dropper
goes slack, a clamp is passed.  Everywhere else the first correction is already small enough by the rule that
ends the iteration.  So the first iteration of a step is of the whole line; the next ones evaluate forces and
solve in the blocks whose last correction was larger, and in what these reach within a step
(:mod:`ancf.linalg.reach`).  The step is the same within the tolerance.
"""

from __future__ import annotations

import math

import numpy as np

from ...choices import optional
from ...compiled import inline_kernel, separate_kernel
from ...linalg.reach import solve_near
from ...system.core import to_local
from ...system.far import add_far_near, clear_settled, hush
from ...system.near import SEGMENT, residual_near
from .low_rank import corrected

#: Share of the correction that ends the iteration up to which a block has settled: what it leaves is then
#: noise of the accelerations that the predictor does not feel.
SETTLED = 0.1
UNLIMITED = 1e300


@inline_kernel
def take_blocks(s, weight, gb, ib, first, last):
    """Take the correction in blocks from q, v, a; its norm, and its sum, finite only if all of it is.

    The six unknowns have sums of their own, which do not wait for each other.
    """
    m0 = m1 = m2 = m3 = m4 = m5 = 0.0
    t0 = t1 = t2 = t3 = t4 = t5 = 0.0
    for b in range(first, last):
        i = 6 * b
        for c in range(6):
            d = s.r[i + c]
            s.q[i + c] -= d
            s.v[i + c] -= gb * d
            s.a[i + c] -= ib * d
        x0, x1 = abs(s.r[i]) * weight[i], abs(s.r[i + 1]) * weight[i + 1]
        x2, x3 = abs(s.r[i + 2]) * weight[i + 2], abs(s.r[i + 3]) * weight[i + 3]
        x4, x5 = abs(s.r[i + 4]) * weight[i + 4], abs(s.r[i + 5]) * weight[i + 5]
        t0, t1, t2, t3, t4, t5 = t0 + x0, t1 + x1, t2 + x2, t3 + x3, t4 + x4, t5 + x5
        m0, m1, m2 = max(m0, x0), max(m1, x1), max(m2, x2)
        m3, m4, m5 = max(m3, x3), max(m4, x4), max(m5, x5)
    return max(max(m0, m1), max(m2, m3), max(m4, m5)), (t0 + t1) + (t2 + t3) + (t4 + t5)


@inline_kernel
def take(near, s, weight, gb, ib, count):
    """Take the correction in the ranges, and keep how large it is; its norm (NaN when it is not finite)."""
    peak, largest, total = near.peak, 0.0, 0.0
    for k in range(peak.shape[0]):
        peak[k] = 0.0
    for p in range(count):
        b = near.low[p]
        while b < near.high[p]:
            k = b // SEGMENT
            last = min(near.high[p], SEGMENT * (k + 1))
            size, sum_of = take_blocks(s, weight, gb, ib, b, last)
            peak[k] = max(peak[k], size)
            largest, total = max(largest, size), total + sum_of
            b = last
    return largest if total < UNLIMITED else np.nan


@inline_kernel
def unsettled(near, limit, n):
    """Ranges of the blocks whose last correction was above a limit, with what they are coupled to."""
    count = 0
    for k in range(near.peak.shape[0]):
        if near.peak[k] > limit:
            first, last = max(SEGMENT * k - near.spread, 0), min(SEGMENT * (k + 1) + near.spread, n)
            if count > 0 and first <= near.high[count - 1]:
                near.high[count - 1] = last
            else:
                near.low[count], near.high[count] = first, last
                count += 1
    return count


def _take_all(nearby, s, weight, gb, ib):
    near = nearby[0]
    near.low[0], near.high[0] = 0, weight.shape[0] // 6
    return take(near, s, weight, gb, ib, 1)


@separate_kernel
def iterate(core, s, limit, gb, ib, correct):
    """Correct what is above a limit; its norm. `correct` is an address, see
    :func:`ancf.solvers.step.low_rank.corrected`.
    """
    near, n = core.near[0], core.weight.shape[0]
    count = unsettled(near, SETTLED * limit, n // 6)
    residual_near(near, count, n, core.ws, s.q, s.v, s.a, s.f, s.r)
    add_far_near(core.far[0], near, count, s)
    hush(core.far[0], near.low, near.high, count, s.r)
    to_local(core.supports, s.r)
    clear_settled(core.far[0], near, count, n // 6, s.r)
    count = solve_near(core.factor, core.joints.first, s.r, near.low, near.high, count, near.spread)
    corrected(correct, core, s, gb)
    return take(near, s, core.weight, gb, ib, count)


#: ``take_all(core.near, s, weight, gb, ib)``: take the whole correction; its norm, infinite without `near`.
take_all = optional(_take_all, math.inf)
