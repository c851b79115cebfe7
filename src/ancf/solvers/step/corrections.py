"""What a solve has found, taken from the state: eight unknowns at a time, with the norm of the correction.

The norm is the largest entry, positions in sizes of the model, slopes as they are.
"""

from __future__ import annotations

import numpy as np

from ...compiled import formula
from ...simd import LANES, absolute, every, greatest, load, store, total

UNLIMITED = 1e300


@formula
def most(x):
    """The greatest of eight numbers."""
    return max(max(max(x[0], x[1]), max(x[2], x[3])), max(max(x[4], x[5]), max(x[6], x[7])))


@formula
def update(s, weight, gb, ib):
    """Take the correction in s.r from q, v, a; returns its norm (NaN when it is not finite)."""
    n = weight.shape[0]
    sizes, sums, whole = every(0.0), every(0.0), n - n % LANES
    for i in range(0, whole, LANES):
        d = load(s.r, i)
        store(load(s.q, i) - d, s.q, i)
        store(load(s.v, i) - gb * d, s.v, i)
        store(load(s.a, i) - ib * d, s.a, i)
        x = absolute(d) * load(weight, i)
        sizes, sums = greatest(x, sizes), sums + x
    norm, added = most(sizes), total(sums)
    for i in range(whole, n):
        d = s.r[i]
        s.q[i] -= d
        s.v[i] -= gb * d
        s.a[i] -= ib * d
        x = abs(d) * weight[i]
        norm, added = max(norm, x), added + x
    return norm if added < UNLIMITED else np.nan


@formula
def shift(q, r, mask, weight):
    """Take r, where the mask is 0, from q; its norm."""
    n = weight.shape[0]
    sizes, whole = every(0.0), n - n % LANES
    for i in range(0, whole, LANES):
        d = load(r, i) * (1.0 - load(mask, i))
        store(load(q, i) - d, q, i)
        sizes = greatest(absolute(d) * load(weight, i), sizes)
    norm = most(sizes)
    for i in range(whole, n):
        d = r[i] * (1.0 - mask[i])
        q[i] -= d
        norm = max(norm, abs(d) * weight[i])
    return norm


@formula
def largest(x, weight):
    """Largest entry by size, weighted."""
    n = weight.shape[0]
    sizes, whole = every(0.0), n - n % LANES
    for i in range(0, whole, LANES):
        sizes = greatest(absolute(load(x, i)) * load(weight, i), sizes)
    size = most(sizes)
    for i in range(whole, n):
        size = max(size, abs(x[i]) * weight[i])
    return size
