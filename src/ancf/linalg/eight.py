"""Factors of eight matrices with one pattern at once, a matrix in each lane.

Where the states of many steps are known beforehand, so are their matrices: eight of them are factorised
with the operations of :mod:`ancf.linalg.block_ldl` on :mod:`ancf.simd` values, in little more time than one.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..arrays import FloatArray, IntArray
from ..compiled import formula, inline_kernel, kernel
from ..records import recorded
from ..simd import LANES, absolute, every, gather_lanes, load, put_lanes, store, total
from .block import SINGULAR
from .block_ldl import Factor, factorise

#: Least size of a pivot beside that of the first lane, which chooses the order for all.
LIKE = 1e-2
#: Where the numbers of a block stand in the transposed one.
TURNED = np.arange(36).reshape(6, 6).T.ravel()


@recorded
class Eight(NamedTuple):
    """Values and factors of eight matrices, of each by itself and lane by lane; sizes as in ``Factor``."""

    A: FloatArray  # (8, 36 (n + m)) values
    L: FloatArray  # (8, 36 m) factors
    LT: FloatArray  # (8, 36 m)
    D_inv: FloatArray  # (8, 36 n)
    a: FloatArray  # (36, 8) lanes of a block on the diagonal
    low: FloatArray  # (36 m, 8) factors by lanes
    d: FloatArray  # (36 n, 8)
    t: FloatArray  # (36 longest row, 8) workspace
    begin: IntArray  # (3, 8) where each matrix begins in A, L and D_inv


def allocate_eight(factor: Factor) -> Eight:
    """Room for eight matrices with the pattern of a factor."""
    n, m, longest = factor.D_inv.size, factor.L.size, factor.T.size
    A, L, LT, D_inv = (np.zeros((LANES, size)) for size in (n + m, m, m, n))
    a, low, d, t = (lane_rows(size) for size in (36, m, n, longest))
    return Eight(A, L, LT, D_inv, a, low, d, t, np.outer((n + m, m, n), np.arange(LANES)))


def lane_rows(size: int) -> FloatArray:
    """Zeros (size, 8), each row in a line of the cache of its own."""
    spare = np.zeros((size + 1) * LANES)
    begin = -(spare.ctypes.data // 8) % LANES
    return spare[begin : begin + size * LANES].reshape(size, LANES)


@formula
def six(X, i):
    """Six rows from row i on."""
    return load(X, i), load(X, i + 1), load(X, i + 2), load(X, i + 3), load(X, i + 4), load(X, i + 5)


@formula
def product(a, B, b):
    """Scalar product of six lanes and those from ``B[b]`` on."""
    one = a[0] * load(B, b) + a[1] * load(B, b + 1) + a[2] * load(B, b + 2)
    return one + (a[3] * load(B, b + 3) + a[4] * load(B, b + 4) + a[5] * load(B, b + 5))


@formula
def summed(a, b):
    """Scalar product of six lanes and six lanes."""
    return (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) + (a[3] * b[3] + a[4] * b[4] + a[5] * b[5])


@formula
def times_rows(A, a, B, b, C, c):
    """C = A B^T of blocks: three rows of A at a time, so that those of B are read twice and not six times."""
    for m in range(0, 36, 18):
        x, y, z = six(A, a + m), six(A, a + m + 6), six(A, a + m + 12)
        for k in range(6):
            other = six(B, b + 6 * k)
            store(summed(x, other), C, c + m + k)
            store(summed(y, other), C, c + m + 6 + k)
            store(summed(z, other), C, c + m + 12 + k)


@formula
def less_rows(A, a, B, b, C, c, lower):
    """C -= A B^T of blocks; of a ``lower`` one what is above the diagonal is no number that counts."""
    for m in range(0, 36, 18):
        x, y, z = six(A, a + m), six(A, a + m + 6), six(A, a + m + 12)
        for k in range(3 if lower and m == 0 else 6):
            other, o = six(B, b + 6 * k), c + m + k
            store(load(C, o) - summed(x, other), C, o)
            store(load(C, o + 6) - summed(y, other), C, o + 6)
            store(load(C, o + 12) - summed(z, other), C, o + 12)


@formula
def lower(o, i, j):
    """Place of an entry of a symmetric block, of which the lower half is kept."""
    return o + 6 * max(i, j) + min(i, j)


@formula
def all_positive(x):
    """Whether all lanes are; not if one is no number."""
    size = total(absolute(x))
    return size > 0.0 and size == total(x)


@formula
def sweep(A, o, p):
    """Sweep the symmetric blocks at ``A[o]`` on pivot p."""
    x0, x1, x2 = load(A, lower(o, 0, p)), load(A, lower(o, 1, p)), load(A, lower(o, 2, p))
    x3, x4, x5 = load(A, lower(o, 3, p)), load(A, lower(o, 4, p)), load(A, lower(o, 5, p))
    x, inverse = (x0, x1, x2, x3, x4, x5), 1.0 / load(A, o + 7 * p)
    for i in range(6):
        f = x[i] * inverse
        for j in range(i + 1):
            store(load(A, o + 6 * i + j) - f * x[j], A, o + 6 * i + j)
    for i in range(6):
        store(x[i] * inverse, A, lower(o, i, p))
    store(-inverse, A, o + 7 * p)


@inline_kernel
def next_pivot(A, o, original, done):
    """The largest in the first lane of those that are not done; -1 if it will not do in all lanes."""
    p, largest = -1, -1.0
    for i in range(6):
        if not (done >> i) & 1 and abs(A[o + 7 * i, 0]) > largest * (1.0 + 1e-9):
            p, largest = i, abs(A[o + 7 * i, 0])
    if p < 0:
        return -1
    size, before = absolute(load(A, o + 7 * p)), absolute(load(original, 7 * p))
    good = all_positive(size - SINGULAR * before) and all_positive(size - every(LIKE * largest))
    return p if good else -1


@formula
def clear(A, o, original, p):
    """What the pivots p exceed those by that count as zero."""
    return load(A, o + 7 * p) - SINGULAR * absolute(load(original, 7 * p))


@formula
def smaller(x, y):
    """The smaller ones of eight and eight numbers; no number if one is none."""
    return 0.5 * (x + y - absolute(x - y))


@inline_kernel
def sweep_in_order(A, o, original):
    """Sweep the symmetric blocks at ``A[o]`` on all pivots, one after the other; whether all are positive.

    Nothing is decided in between, so that the blocks stay in registers.
    """
    # a plain 0 is a type of its own for numba, for which it would translate everything anew
    least = clear(A, o, original, np.int64(0))
    sweep(A, o, np.int64(0))
    least = smaller(least, clear(A, o, original, np.int64(1)))
    sweep(A, o, np.int64(1))
    least = smaller(least, clear(A, o, original, np.int64(2)))
    sweep(A, o, np.int64(2))
    least = smaller(least, clear(A, o, original, np.int64(3)))
    sweep(A, o, np.int64(3))
    least = smaller(least, clear(A, o, original, np.int64(4)))
    sweep(A, o, np.int64(4))
    least = smaller(least, clear(A, o, original, np.int64(5)))
    sweep(A, o, np.int64(5))
    return all_positive(least)


@inline_kernel
def invert_eight(A, o, original, definite):
    """Invert the symmetric blocks at ``A[o]`` in place by sweeps; whether that is possible in one order."""
    done = 0
    if definite:
        if not sweep_in_order(A, o, original):
            return False
    else:
        for _ in range(6):
            p = next_pivot(A, o, original, done)
            if p < 0:
                return False
            done |= 1 << p
            sweep(A, o, p)
    for i in range(6):
        for j in range(i + 1):
            x = -load(A, o + 6 * i + j)
            store(x, A, o + 6 * i + j)
            store(x, A, o + 6 * j + i)
    return True


@inline_kernel
def all_zero(A, o):
    """Whether the blocks at ``A[o]`` are, in all lanes."""
    i = o
    while i < o + 36 and total(absolute(load(A, i))) == 0.0:
        i += 1
    return i == o + 36


@formula
def turned_in(rows, begin, k, X, o):
    """Copy a block from place k of eight rows, which begin at these places, to the lanes from ``X[o]`` on."""
    for c in range(5):
        i = min(LANES * c, 36 - LANES)  # some numbers twice
        x = gather_lanes(rows[k + i :], begin, 0)
        for m in range(LANES):
            store(x[m], X, o + i + m)


@formula
def turned_out(X, o, rows, begin, k):
    """Copy the lanes of a block to place k of eight rows."""
    for c in range(5):
        i = min(LANES * c, 36 - LANES)
        x0, x1, x2, x3 = load(X, o + i), load(X, o + i + 1), load(X, o + i + 2), load(X, o + i + 3)
        x4, x5, x6, x7 = load(X, o + i + 4), load(X, o + i + 5), load(X, o + i + 6), load(X, o + i + 7)
        put_lanes(x0, x1, x2, x3, x4, x5, x6, x7, rows[k + i :], begin, 0)


@formula
def turned_over(X, o, column, rows, begin, k):
    """The same of the transposed block; ``column``: its numbers' rows of the block."""
    for c in range(5):
        i = min(LANES * c, 36 - LANES)
        x0, x1, x2, x3 = (
            load(X, o + column[i]),
            load(X, o + column[i + 1]),
            load(X, o + column[i + 2]),
            load(X, o + column[i + 3]),
        )
        x4, x5, x6, x7 = (
            load(X, o + column[i + 4]),
            load(X, o + column[i + 5]),
            load(X, o + column[i + 6]),
            load(X, o + column[i + 7]),
        )
        put_lanes(x0, x1, x2, x3, x4, x5, x6, x7, rows[k + i :], begin, 0)


@inline_kernel
def factorise_row(factor, e, rows, i, definite, both):
    """Row i of L and D; whether its pivots may be taken in one order."""
    row_start, column, place = factor.row_start, factor.column, factor.place
    n, first, d, (A, L, LT, D_inv) = row_start.shape[0] - 1, row_start[i], 36 * i, rows
    turned_in(A, e.begin[0:1], d, e.a, 0)
    for m in range(36):
        store(load(e.a, m), e.d, d + m)
    leading = True  # zeros at the left of a row stay zeros
    for k in range(first, row_start[i + 1]):
        j, t, o = column[k], 36 * (k - first), 36 * k
        turned_in(A, e.begin[0:1], 36 * n + o, e.t, t)
        leading = leading and all_zero(e.t, t)
        if leading:
            for m in range(36):
                store(every(0.0), e.low, o + m)
        else:
            for h in range(row_start[j], row_start[j + 1]):
                if place[column[h]] >= 0:
                    less_rows(e.t, 36 * place[column[h]], e.low, 36 * h, e.t, t, False)
            times_rows(e.t, t, e.d, 36 * j, e.low, o)  # D is symmetric
            less_rows(e.t, t, e.low, o, e.d, d, True)
        turned_out(e.low, o, L, e.begin[1:2], o)
        if both:
            turned_over(e.low, o, TURNED, LT, e.begin[1:2], o)
    good = invert_eight(e.d, d, e.a, definite)
    turned_out(e.d, d, D_inv, e.begin[2:3], d)
    return good


@inline_kernel
def factorise_lanes(factor, e, definite, both):
    """Fill the factors from the values; whether one order of pivots does for all lanes."""
    row_start, column, place = factor.row_start, factor.column, factor.place
    rows = e.A.reshape(-1), e.L.reshape(-1), e.LT.reshape(-1), e.D_inv.reshape(-1)
    for i in range(row_start.shape[0] - 1):
        for k in range(row_start[i], row_start[i + 1]):
            place[column[k]] = k - row_start[i]
        good = factorise_row(factor, e, rows, i, definite, both)
        for k in range(row_start[i], row_start[i + 1]):
            place[column[k]] = -1
        if not good:
            return False
    return True


@formula
def factor_of(factor, e, m):
    """The factors of matrix m."""
    own = e.L[m], e.LT[m], e.D_inv[m]
    return Factor(factor.row_start, factor.column, *own, factor.T, factor.place, factor.fill, factor.in_order)


@formula
def factor_itself(factor):
    """The factors of a matrix that stands alone, as :func:`factor_of` gives them."""
    own = factor.L, factor.LT, factor.D_inv
    return Factor(factor.row_start, factor.column, *own, factor.T, factor.place, factor.fill, factor.in_order)


@kernel
def factorise_eight(factor, e, count, definite, both):
    """Fill the factors of the first ``count`` matrices; the number of the first that is singular, or -1.

    ``factor`` gives the pattern and room.  Matrices that should be positive ``definite`` are taken without
    search for pivots; ``both``: LT is wanted.
    """
    for m in range(count, LANES):
        for k in range(e.A.shape[1]):
            e.A[m, k] = e.A[count - 1, k]
    if factorise_lanes(factor, e, definite, both):
        return -1
    for m in range(count):
        if factorise(e.A[m], factor_of(factor, e, m), factor.row_start.shape[0] - 1) < 0:
            return m
    return -1
