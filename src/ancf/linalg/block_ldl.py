"""Factorisation A = L D L^T of a symmetric matrix in 6x6 blocks, one block per node.

A chain of cable elements couples each node with the next, so its matrix is block tridiagonal; wires
that run side by side give a narrow block band, nets a general sparse pattern.  One code serves all:
L keeps exactly the blocks that the ordering fills (see :mod:`ancf.linalg.ordering`).  6x6 blocks keep
the inner loops free of indices.  There is no pivoting between blocks, which is safe for the positive
definite matrices of a time step; pivots are chosen inside the diagonal blocks and the number of
negative ones tells how far from positive definite the matrix is (Sylvester's law of inertia).

Values: block k of a matrix is ``A[36 k : 36 k + 36]``, row by row; the diagonal blocks come first,
then the blocks below the diagonal, row by row.  The six unknowns of a node are one value, as the
products of a block and a vector add up its columns; for them L is kept by columns as well.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import formula, inline_kernel
from ..records import recorded
from ..simd import absolute, every, load_six, store_six, total

#: A pivot below this fraction of its original diagonal entry counts as zero.
SINGULAR = 1e-14


@recorded
class Factor(NamedTuple):
    """Pattern and values of a factorisation; ``n`` diagonal blocks, ``m`` blocks below the diagonal."""

    row_start: NDArray[np.int64]  # (n + 1,) first block of each row
    column: NDArray[np.int64]  # (m,) column of each block, ascending in a row
    L: FloatArray  # (36 m,) row by row
    LT: FloatArray  # (36 m,) column by column
    D_inv: FloatArray  # (36 n,)
    T: FloatArray  # (36 longest row,) workspace, L D of one row
    place: NDArray[np.int64]  # (n,) workspace, place of a column in the row at hand


def allocate(row_start: NDArray[np.int64], column: NDArray[np.int64]) -> Factor:
    """Factor with the pattern of L given by rows, values not yet computed."""
    n = len(row_start) - 1
    longest = int(np.max(np.diff(row_start), initial=1))
    return Factor(
        np.ascontiguousarray(row_start, dtype=np.int64),
        np.ascontiguousarray(column, dtype=np.int64),
        np.zeros(36 * len(column)),
        np.zeros(36 * len(column)),
        np.zeros(36 * n),
        np.zeros(36 * max(longest, 1)),
        np.full(n, -1, dtype=np.int64),
    )


@inline_kernel
def invert_symmetric(A, o, original):
    """Invert the 6x6 block at ``A[o]`` in place by sweeps; number of negative pivots, -1 if singular."""
    negative = 0
    done = 0
    for _ in range(6):
        p, largest = -1, -1.0
        for i in range(6):
            if not (done >> i) & 1 and abs(A[o + 7 * i]) > largest * (1.0 + 1e-9):
                p, largest = i, abs(A[o + 7 * i])
        if p < 0 or not largest > SINGULAR * abs(original[o + 7 * p]):
            return -1
        done |= 1 << p
        d = A[o + 7 * p]
        negative += d < 0.0
        for i in range(6):
            if i != p:
                f = A[o + 6 * i + p] / d
                for j in range(i + 1):
                    if j != p:
                        A[o + 6 * i + j] -= f * A[o + 6 * p + j]
                        A[o + 6 * j + i] = A[o + 6 * i + j]
        for i in range(6):
            A[o + 6 * i + p] /= d
            A[o + 6 * p + i] = A[o + 6 * i + p]
        A[o + 7 * p] = -1.0 / d
    for i in range(36):
        A[o + i] = -A[o + i]
    return negative


@formula
def columns(A, o, f0, f1, f2, f3, f4, f5):
    """Sum of six columns, which stand one after the other from ``A[o]`` on, with these factors."""
    first = load_six(A, o) * f0 + load_six(A, o + 6) * f1
    second = load_six(A, o + 12) * f2 + load_six(A, o + 18) * f3
    return first + second + (load_six(A, o + 24) * f4 + load_six(A, o + 30) * f5)


@formula
def times(A, o, x, i):
    """Product of the block whose columns stand from ``A[o]`` on and the six numbers x[i] ... x[i + 5]."""
    return columns(
        A, o, every(x[i]), every(x[i + 1]), every(x[i + 2]), every(x[i + 3]), every(x[i + 4]), every(x[i + 5])
    )


@inline_kernel
def subtract_product(C, oc, A, oa, B, ob):
    """C -= A B for 6x6 blocks, row by row, at the given offsets."""
    for i in range(0, 36, 6):
        store_six(load_six(C, oc + i) - times(B, ob, A, oa + i), C, oc + i)


@inline_kernel
def mirror(C, o):
    """Make a block that is symmetric but for round-off exactly so.

    Along a chain of many nodes an antisymmetric error would grow.
    """
    for i in range(6):
        for j in range(i):
            C[o + 6 * j + i] = C[o + 6 * i + j]


@inline_kernel
def transpose(A, B, o):
    """B = A^T for the blocks at ``A[o]`` and ``B[o]``."""
    for i in range(6):
        for j in range(6):
            B[o + 6 * j + i] = A[o + 6 * i + j]


@inline_kernel
def is_zero(T, t):
    """Whether the block at ``T[t]`` is zero."""
    first = absolute(load_six(T, t)) + absolute(load_six(T, t + 6)) + absolute(load_six(T, t + 12))
    second = absolute(load_six(T, t + 18)) + absolute(load_six(T, t + 24)) + absolute(load_six(T, t + 30))
    return total(first + second) == 0.0


@inline_kernel
def factorise_row(A, factor, i):
    """Fill row i of ``factor`` from the values A and the rows before; negative pivots, -1 if singular."""
    row_start, column, place = factor.row_start, factor.column, factor.place
    L, LT, D_inv, T = factor.L, factor.LT, factor.D_inv, factor.T
    n = row_start.shape[0] - 1
    first, last = row_start[i], row_start[i + 1]
    for k in range(first, last):
        place[column[k]] = k - first
    for m in range(6):
        for c in range(6):
            D_inv[36 * i + 6 * m + c] = A[36 * i + 6 * max(m, c) + min(m, c)]
    leading = True  # zeros at the left of a row stay zeros
    for k in range(first, last):
        j, t = column[k], 36 * (k - first)
        for m in range(36):
            T[t + m] = A[36 * (n + k) + m]
            L[36 * k + m] = LT[36 * k + m] = 0.0
        if leading:
            leading = is_zero(T, t)
            if leading:
                continue
        for h in range(row_start[j], row_start[j + 1]):
            c = place[column[h]]
            if c >= 0:
                subtract_product(T, t, T, 36 * c, LT, 36 * h)
        for m in range(0, 36, 6):
            store_six(times(D_inv, 36 * j, T, t + m), L, 36 * k + m)
        transpose(L, LT, 36 * k)
        subtract_product(D_inv, 36 * i, T, t, LT, 36 * k)
        mirror(D_inv, 36 * i)
    for k in range(first, last):
        place[column[k]] = -1
    return invert_symmetric(D_inv, 36 * i, A)


@inline_kernel
def factorise(A, factor, last):
    """Fill ``factor`` from the values A; number of negative pivots, or -(block + 1) if singular.

    Rows from block ``last`` on are left out: see :mod:`ancf.linalg.border`.
    """
    negative = 0
    for i in range(last):
        bad = factorise_row(A, factor, i)
        if bad < 0:
            return -(i + 1)
        negative += bad
    return negative


@formula
def solve_rows(factor, x, first, n):
    """Replace the first n blocks of the right-hand side x, which is zero before block ``first``."""
    row_start, column, L, LT, D_inv = factor.row_start, factor.column, factor.L, factor.LT, factor.D_inv
    for i in range(first, n):
        if row_start[i] < row_start[i + 1]:
            s = load_six(x, 6 * i)
            for k in range(row_start[i], row_start[i + 1]):
                s = s - times(LT, 36 * k, x, 6 * column[k])
            store_six(s, x, 6 * i)
    for i in range(first, n):
        store_six(times(D_inv, 36 * i, x, 6 * i), x, 6 * i)  # D_inv is symmetric: rows serve as columns
    for i in range(n - 1, -1, -1):
        if row_start[i] < row_start[i + 1]:
            f0, f1, f2 = every(x[6 * i]), every(x[6 * i + 1]), every(x[6 * i + 2])
            f3, f4, f5 = every(x[6 * i + 3]), every(x[6 * i + 4]), every(x[6 * i + 5])
            for k in range(row_start[i], row_start[i + 1]):
                j = 6 * column[k]
                store_six(load_six(x, j) - columns(L, 36 * k, f0, f1, f2, f3, f4, f5), x, j)
