"""Steps of what is awake of a line of which parts sleep, see :mod:`ancf.solvers.sleeping.far`."""

from __future__ import annotations

from ...batches import add_tangents
from ...choices import optional
from ...compiled import inline_kernel, separate_kernel
from ...linalg.block_ldl import factorise_row
from ...linalg.reach import solve_ranges
from ...simd import LANES
from ...system.core import add_patterns, restrict, to_local
from ...system.far import ASLEEP, COLUMN, EDGES, ENTRY, HIGH, KIND, RANGES, SLEEPING, add_far
from ...system.near import choose, residual_near
from ..step.low_rank import corrected
from ..step.near import take
from ..step.scheme import finish_rows, note_step, predict_rows, restore_rows


def _load_awake(items, loads, load, f, shadows):
    far = items[0]
    if far.counts[SLEEPING] == 0 or loads.hung_slot.shape[0] > 0:
        return False
    for k in range(far.counts[RANGES]):
        for i in range(6 * far.range[k, 0], 6 * far.range[k, 1]):
            f[i] = loads.gravity[i]
    for i in range(shadows, f.shape[0]):
        f[i] = loads.gravity[i]
    for m in range(loads.start[-1]):
        for i in range(loads.slot[m], loads.slot[m] + 3):
            f[i] = loads.gravity[i]
    add_patterns(loads, load, f)
    return True


def _predict_awake(items, s, h, scheme, keep, shadows):
    far = items[0]
    if far.counts[SLEEPING] == 0:
        return False
    for k in range(far.counts[RANGES]):
        predict_rows(s, h, scheme, keep, 6 * far.range[k, 0], 6 * far.range[k, 1])
    predict_rows(s, h, scheme, keep, shadows, s.q.shape[0])
    return True


def _restore_awake(items, s, shadows):
    far = items[0]
    if far.counts[SLEEPING] == 0:
        return False
    for k in range(far.counts[RANGES]):
        restore_rows(s, 6 * far.range[k, 0], 6 * far.range[k, 1])
    restore_rows(s, shadows, s.q.shape[0])
    return True


def _finish_awake(items, s, h, scheme, shadows):
    far = items[0]
    if far.counts[SLEEPING] == 0:
        return False
    for k in range(far.counts[RANGES]):
        finish_rows(s, scheme, 6 * far.range[k, 0], 6 * far.range[k, 1])
    finish_rows(s, scheme, shadows, s.q.shape[0])
    note_step(s, h)
    return True


def _asleep(items):
    return items[0].counts[SLEEPING] > 0


@inline_kernel
def take_awake(far, near):
    """Ranges of what is awake, in those of :mod:`ancf.system.near`; their number."""
    count = far.counts[RANGES]
    for k in range(count):
        near.low[k], near.high[k] = far.range[k, 0], far.range[k, 1]
    return count


@separate_kernel
def iterate_awake(core, s, gb, ib, correct):
    """Correct what is awake; its norm. `correct` is an address, see
    :func:`ancf.solvers.step.low_rank.corrected`.
    """
    far, near, n = core.far[0], core.near[0], core.weight.shape[0]
    count = take_awake(far, near)
    residual_near(near, count, n, core.ws, s.q, s.v, s.a, s.f, s.r)
    add_far(far, s)
    to_local(core.supports, s.r)
    solve_ranges(core.factor, s.r, near.low, near.high, count)
    corrected(correct, core, s, gb)
    return take(near, s, core.weight, gb, ib, count)


@inline_kernel
def clear_matrix(far, factor, A):
    """Zero in the rows of what is awake."""
    n = factor.row_start.shape[0] - 1
    for r in range(far.counts[RANGES]):
        low, high = far.range[r, 0], far.range[r, 1]
        for m in range(36 * low, 36 * high):
            A[m] = 0.0
        for m in range(36 * (n + factor.row_start[low]), 36 * (n + factor.row_start[high])):
            A[m] = 0.0


@inline_kernel
def isolate(far, factor, A):
    """Nothing is coupled to what sleeps; boundaries feel the parts."""
    n = factor.row_start.shape[0] - 1
    for r in range(far.counts[RANGES]):
        for k in range(factor.row_start[far.range[r, 0]], factor.row_start[far.range[r, 1]]):
            if far.sleeps[factor.column[k]] != 0:
                for m in range(36):
                    A[36 * (n + k) + m] = 0.0
    for p in range(far.part.shape[0]):
        if far.part[p, ASLEEP] != 0:
            t = far.part[p, KIND]
            n = far.kind[t, EDGES]
            for i in range(n):
                for j in range(n):
                    place, row = far.entry[far.part[p, ENTRY] + n * i + j], far.kind[t, HIGH] * i + j // LANES
                    if place >= 0:
                        A[place] += far.matrix[far.kind[t, COLUMN] + row, j % LANES]


@separate_kernel
def matrix_awake(core, s, gb, ib):
    """Make and factorise the rows of what is awake of the matrix; -(block + 1) if singular.

    Rows of what sleeps are those of the identity in the factors, see
    :meth:`ancf.solvers.sleeping.spans.FarSpans.turn`, and count nowhere else.
    """
    far, near, A, factor = core.far[0], core.near[0], core.A, core.factor
    clear_matrix(far, factor, A)
    choose(near, take_awake(far, near))
    add_tangents(near.batches, s.q, s.v, A, ib, gb, 1.0, core.ws)
    restrict(core.supports, A)
    isolate(far, factor, A)
    for r in range(far.counts[RANGES]):
        for i in range(far.range[r, 0], far.range[r, 1]):
            if factorise_row(A, factor, i) < 0:
                return -(i + 1)
    return 0


#: ``load_awake(core.far, loads, load, f, shadows)``: the load vector on what is awake, if something sleeps.
load_awake = optional(_load_awake, False)
#: ``predict_awake(core.far, s, h, scheme, keep, shadows)``: predict what is awake, if something sleeps.
predict_awake = optional(_predict_awake, False)
#: ``restore_awake(core.far, s, shadows)``: it is as at the start of the step, likewise.
restore_awake = optional(_restore_awake, False)
#: ``finish_awake(core.far, s, h, scheme, shadows)``: accept the step, likewise.
finish_awake = optional(_finish_awake, False)
#: ``asleep(core.far)``: whether a part sleeps.
asleep = optional(_asleep, False)
