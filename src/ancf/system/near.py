"""Forces in some ranges of blocks alone: what Newton's method asks for where it has not converged.

Cable elements are evaluated in those chunks that touch a range; all other batches, which are small beside
them, as a whole.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..arrays import FloatArray, IntArray
from ..batches import Batches, add_forces
from ..compiled import inline_kernel
from ..elements.cable import CableBatch
from ..elements.cable_columns import BEGIN, END
from ..linalg.block_ldl import Factor
from ..linalg.reach import clear, spread_of
from ..records import recorded

#: Blocks whose largest correction is kept together.
SEGMENT = 16


@recorded
class Near(NamedTuple):
    """Room for ranges of blocks, and batches that are evaluated near them."""

    batches: Batches  # those of the system, the cables' with `groups` of their own
    every: IntArray  # (k, 8) groups of all cable elements
    groups: IntArray  # (runs, 8) runs of chunks that touch a range
    touched: IntArray  # (chunks, 2) first block that a chunk touches, and the one behind the last
    low: IntArray  # (blocks/2 + 2,) the ranges
    high: IntArray
    peak: FloatArray  # (segments,) largest correction in the last iteration
    spread: int  # largest distance of a block of L from the diagonal


def near_of(batches: tuple[Any, ...], factor: Factor, shadows: IntArray, n: int) -> tuple[Near, ...]:
    """Of batches among which are cables, one item; none without.

    Parameters
    ----------
    batches : tuple
    factor : Factor
    shadows : (k,) int
        Slots whose shadows follow the n unknowns.
    n : int
        Unknowns.
    """
    cables = [k for k, batch in enumerate(batches) if isinstance(batch, CableBatch) and len(batch.base)]
    if len(cables) != 1:
        return ()
    batch = batches[cables[0]]
    slot = batch.lane_base.reshape(len(batch.lane_base), -1)
    slot = np.where(slot < n, slot, np.append(shadows, 0)[np.clip((slot - n) // 3, 0, len(shadows))])
    touched = np.stack([slot.min(axis=1), slot.max(axis=1) + 6], axis=1) // 6
    groups = np.zeros((len(batch.groups) + len(touched) // 2 + 1, batch.groups.shape[1]), dtype=np.int64)
    some = list(batches)
    some[cables[0]] = batch._replace(groups=groups)
    low, high = (np.zeros(n // 12 + 2, dtype=np.int64) for _ in range(2))  # as many as blocks let there be
    peak = np.zeros(-(-n // (6 * SEGMENT)))
    near = Near(
        Batches(some), batch.groups, groups, np.ascontiguousarray(touched), low, high, peak, spread_of(factor)
    )
    return (near,)


@inline_kernel
def is_touched(near, chunk, count):
    """Whether a chunk touches one of the ranges, which ascend."""
    low, high = 0, count
    while low < high:  # the first range that ends behind where the chunk begins
        k = (low + high) // 2
        if near.high[k] > near.touched[chunk, 0]:
            high = k
        else:
            low = k + 1
    return low < count and near.low[low] < near.touched[chunk, 1]


@inline_kernel
def choose(near, count):
    """Let the cables have those chunks that touch the ranges."""
    run, groups = 0, near.groups
    for g in range(near.every.shape[0]):
        open_run = False
        for chunk in range(near.every[g, BEGIN], near.every[g, END]):
            wanted = is_touched(near, chunk, count)
            if wanted and not open_run:
                for c in range(groups.shape[1]):
                    groups[run, c] = near.every[g, c]
                groups[run, BEGIN] = chunk
                run += 1
            if wanted:
                groups[run - 1, END] = chunk + 1
            open_run = wanted
    for k in range(run, groups.shape[0]):
        groups[k, BEGIN] = groups[k, END] = 0


@inline_kernel
def residual_near(near, count, n, ws, q, v, a, f, r):
    """r = M a + internal forces - f in the ranges and behind the n unknowns; elsewhere it means nothing."""
    choose(near, count)
    for k in range(count):
        for i in range(6 * near.low[k], 6 * near.high[k]):
            r[i] = -f[i]
    for i in range(n, r.shape[0]):
        r[i] = -f[i]
    add_forces(near.batches, q, v, a, r, ws)


@inline_kernel
def clear_beyond(near, count, n, r):
    """Zero in all blocks beyond the ranges."""
    end = 0
    for k in range(count):
        clear(r, end, near.low[k])
        end = near.high[k]
    clear(r, end, n)
