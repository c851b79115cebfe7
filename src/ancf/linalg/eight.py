"""Factors of eight matrices with one pattern at once, a matrix in each lane.

Where the states of many steps are known beforehand, so are their matrices: eight of them are factorised
with the operations of :mod:`ancf.linalg.block_ldl` on :mod:`ancf.simd` values, in little more time than one.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..arrays import FloatArray, IntArray
from ..compiled import formula, inline_kernel, kernel
from ..simd import LANES, absolute, every, gather_nodes, load, put_nodes, store, total, vector
from .block import SINGULAR
from .block_ldl import Factor, factorise

#: Least size of a pivot beside that of the first lane, which chooses the order for all.
LIKE = 1e-2


class Eight(NamedTuple):
    """Values and factors of eight matrices, of each by itself and lane by lane; sizes as in ``Factor``."""

    A: FloatArray  # (8, 36 (n + m)) values
    L: FloatArray  # (8, 36 m) factors
    LT: FloatArray  # (8, 36 m)
    D_inv: FloatArray  # (8, 36 n)
    a: FloatArray  # (36 (n + m), 8) the same by lanes
    low: FloatArray  # (36 m, 8)
    d: FloatArray  # (36 n, 8)
    t: FloatArray  # (36 longest row, 8) workspace
    begin: IntArray  # (3, 8) where each matrix begins in A, L and D_inv


def allocate_eight(factor: Factor) -> Eight:
    """Room for eight matrices with the pattern of a factor."""
    n, m, longest = factor.D_inv.size, factor.L.size, factor.T.size
    A, L, LT, D_inv = (np.zeros((LANES, size)) for size in (n + m, m, m, n))
    a, low, d, t = (np.zeros((size, LANES)) for size in (n + m, m, n, longest))
    return Eight(A, L, LT, D_inv, a, low, d, t, np.outer((n + m, m, n), np.arange(LANES)))


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
    size, before = absolute(load(A, o + 7 * p)), absolute(load(original, o + 7 * p))
    good = all_positive(size - SINGULAR * before) and all_positive(size - every(LIKE * largest))
    return p if good else -1


@inline_kernel
def invert_eight(A, o, original, definite):
    """Invert the symmetric blocks at ``A[o]`` in place by sweeps; whether that is possible in one order."""
    done = 0
    for k in range(6):
        if definite:
            if not all_positive(load(A, o + 7 * k) - SINGULAR * absolute(load(original, o + 7 * k))):
                return False
            sweep(A, o, k)
        else:
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


@inline_kernel
def factorise_row(factor, e, i, definite):
    """Row i of L and D; whether its pivots may be taken in one order."""
    row_start, column, place = factor.row_start, factor.column, factor.place
    n, first, d = row_start.shape[0] - 1, row_start[i], 36 * i
    for m in range(6):
        for c in range(m + 1):
            store(load(e.a, d + 6 * m + c), e.d, d + 6 * m + c)
    leading = True  # zeros at the left of a row stay zeros
    for k in range(first, row_start[i + 1]):
        j, t, o = column[k], 36 * (k - first), 36 * k
        for m in range(36):
            store(load(e.a, 36 * n + o + m), e.t, t + m)
            store(every(0.0), e.low, o + m)
        if leading:
            leading = all_zero(e.t, t)
            if leading:
                continue
        for h in range(row_start[j], row_start[j + 1]):
            if place[column[h]] >= 0:
                for m in range(0, 36, 6):
                    a = six(e.t, 36 * place[column[h]] + m)
                    for c in range(6):
                        x = load(e.t, t + m + c) - product(a, e.low, 36 * h + 6 * c)
                        store(x, e.t, t + m + c)
        for m in range(0, 36, 6):
            a = six(e.t, t + m)
            for c in range(6):  # D is symmetric
                store(product(a, e.d, 36 * j + 6 * c), e.low, o + m + c)
        for m in range(6):
            a = six(e.t, t + 6 * m)
            for c in range(m + 1):
                x = load(e.d, d + 6 * m + c) - product(a, e.low, o + 6 * c)
                store(x, e.d, d + 6 * m + c)
    return invert_eight(e.d, d, e.a, definite)


@inline_kernel
def factorise_lanes(factor, e, definite):
    """Fill the factors by lanes from the values by lanes; whether one order of pivots does for all."""
    row_start, column, place = factor.row_start, factor.column, factor.place
    for i in range(row_start.shape[0] - 1):
        for k in range(row_start[i], row_start[i + 1]):
            place[column[k]] = k - row_start[i]
        good = factorise_row(factor, e, i, definite)
        for k in range(row_start[i], row_start[i + 1]):
            place[column[k]] = -1
        if not good:
            return False
    return True


@formula
def factor_of(factor, e, m):
    """The factors of matrix m."""
    return Factor(factor.row_start, factor.column, e.L[m], e.LT[m], e.D_inv[m], factor.T, factor.place)


@formula
def turned_in(rows, begin, k, X):
    """Copy six numbers from place k of eight rows to the lanes of X."""
    first, second = gather_nodes(rows.reshape(-1)[k:], begin, 0)
    store(first[0], X, k)
    store(first[1], X, k + 1)
    store(first[2], X, k + 2)
    store(second[0], X, k + 3)
    store(second[1], X, k + 4)
    store(second[2], X, k + 5)


@formula
def turned_out(X, o, step, rows, begin, k):
    """Copy six rows of X, ``step`` apart, to place k of eight rows."""
    first = vector(load(X, o), load(X, o + step), load(X, o + 2 * step))
    second = vector(load(X, o + 3 * step), load(X, o + 4 * step), load(X, o + 5 * step))
    put_nodes(first, second, rows.reshape(-1)[k:], begin, 0)


@kernel
def factorise_eight(factor, e, count, definite, both):
    """Fill the factors of the first ``count`` matrices; the number of the first that is singular, or -1.

    ``factor`` gives the pattern and room.  Matrices that should be positive ``definite`` are taken without
    search for pivots; ``both``: LT is wanted.
    """
    for m in range(count, LANES):
        for k in range(e.A.shape[1]):
            e.A[m, k] = e.A[count - 1, k]
    for k in range(0, e.a.shape[0], 6):
        turned_in(e.A, e.begin[0:1], k, e.a)
    if not factorise_lanes(factor, e, definite):
        for m in range(count):
            if factorise(e.A[m], factor_of(factor, e, m), factor.row_start.shape[0] - 1) < 0:
                return m
        return -1
    for k in range(0, e.low.shape[0], 36):
        for i in range(6):
            turned_out(e.low, k + 6 * i, 1, e.L, e.begin[1:2], k + 6 * i)
        if both:
            for i in range(6):
                turned_out(e.low, k + i, 6, e.LT, e.begin[1:2], k + 6 * i)
    for k in range(0, e.d.shape[0], 6):
        turned_out(e.d, k, 1, e.D_inv, e.begin[2:3], k)
    return -1
