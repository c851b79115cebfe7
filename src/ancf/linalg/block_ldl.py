"""Factorisation A = L D L^T of a symmetric matrix in 6x6 blocks, one block per node.

A chain of cable elements couples each node with the next, so its matrix is block tridiagonal; wires
that run side by side give a narrow block band, nets a general sparse pattern.  One code serves all:
L keeps exactly the blocks that the ordering fills (see :mod:`ancf.linalg.ordering`).  6x6 blocks keep
the inner loops free of indices.  There is no pivoting between blocks, which is safe for the positive
definite matrices of a time step; pivots are chosen inside the diagonal blocks and the number of
negative ones tells how far from positive definite the matrix is (Sylvester's law of inertia).

Values: block k of a matrix is ``A[36 k : 36 k + 36]``, row by row; the diagonal blocks come first,
then the blocks below the diagonal, row by row.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import inline_kernel

#: A pivot below this fraction of its original diagonal entry counts as zero.
SINGULAR = 1e-14


class Factor(NamedTuple):
    """Pattern and values of a factorisation; ``n`` diagonal blocks, ``m`` blocks below the diagonal."""

    row_start: NDArray[np.int64]  # (n + 1,) first block of each row
    column: NDArray[np.int64]  # (m,) column of each block, ascending in a row
    L: FloatArray  # (36 m,)
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


@inline_kernel
def subtract_product_t(C, oc, A, oa, B, ob):
    """C -= A B^T for 6x6 blocks at the given offsets."""
    for i in range(6):
        for j in range(6):
            s = 0.0
            for k in range(6):
                s += A[oa + 6 * i + k] * B[ob + 6 * j + k]
            C[oc + 6 * i + j] -= s


@inline_kernel
def subtract_symmetric(C, oc, A, oa, B, ob):
    """C -= A B^T where the product is known to be symmetric.

    C must stay exactly symmetric: along a chain of many nodes an antisymmetric error would grow.
    """
    for i in range(6):
        for j in range(i + 1):
            s = 0.0
            for k in range(6):
                s += A[oa + 6 * i + k] * B[ob + 6 * j + k]
            C[oc + 6 * i + j] -= s
            C[oc + 6 * j + i] = C[oc + 6 * i + j]


@inline_kernel
def is_zero(T, t):
    """Whether the block at ``T[t]`` is zero."""
    largest = 0.0
    for m in range(t, t + 36):
        largest = max(largest, abs(T[m]))
    return largest == 0.0


@inline_kernel
def factorise(A, factor, start):
    """Fill ``factor`` from the values A; number of negative pivots, or -(block + 1) if singular.

    Rows before ``start`` are taken as they are: when A has changed in its last rows alone, these are all
    that has to be done again.
    """
    row_start, column, L, D_inv, T, place = factor
    n = row_start.shape[0] - 1
    negative = 0
    for i in range(start, n):
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
                L[36 * k + m] = 0.0
            if leading:
                leading = is_zero(T, t)
                if leading:
                    continue
            for h in range(row_start[j], row_start[j + 1]):
                c = place[column[h]]
                if c >= 0:
                    subtract_product_t(T, t, T, 36 * c, L, 36 * h)
            subtract_product_t(L, 36 * k, T, t, D_inv, 36 * j)  # D_inv is symmetric
            for m in range(36 * k, 36 * k + 36):
                L[m] = -L[m]
            subtract_symmetric(D_inv, 36 * i, T, t, L, 36 * k)
        for k in range(first, last):
            place[column[k]] = -1
        bad = invert_symmetric(D_inv, 36 * i, A)
        if bad < 0:
            return -(i + 1)
        negative += bad
    return negative


@inline_kernel
def solve(factor, x, first):
    """Replace the right-hand side x, shape (6 n,), which is zero before block ``first``, by the solution."""
    row_start, column, L, D_inv, _, _ = factor
    n = row_start.shape[0] - 1
    for i in range(first, n):
        s0, s1, s2, s3, s4, s5 = (
            x[6 * i],
            x[6 * i + 1],
            x[6 * i + 2],
            x[6 * i + 3],
            x[6 * i + 4],
            x[6 * i + 5],
        )
        for k in range(row_start[i], row_start[i + 1]):
            j, o = 6 * column[k], 36 * k
            for c in range(6):
                f = x[j + c]
                s0 -= L[o + c] * f
                s1 -= L[o + 6 + c] * f
                s2 -= L[o + 12 + c] * f
                s3 -= L[o + 18 + c] * f
                s4 -= L[o + 24 + c] * f
                s5 -= L[o + 30 + c] * f
        x[6 * i], x[6 * i + 1], x[6 * i + 2], x[6 * i + 3], x[6 * i + 4], x[6 * i + 5] = (
            s0,
            s1,
            s2,
            s3,
            s4,
            s5,
        )
    for i in range(n - 1, first - 1, -1):
        o = 36 * i
        s0, s1, s2, s3, s4, s5 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for c in range(6):  # D_inv is symmetric: rows serve as columns
            f = x[6 * i + c]
            s0 += D_inv[o + 6 * c] * f
            s1 += D_inv[o + 6 * c + 1] * f
            s2 += D_inv[o + 6 * c + 2] * f
            s3 += D_inv[o + 6 * c + 3] * f
            s4 += D_inv[o + 6 * c + 4] * f
            s5 += D_inv[o + 6 * c + 5] * f
        x[6 * i], x[6 * i + 1], x[6 * i + 2], x[6 * i + 3], x[6 * i + 4], x[6 * i + 5] = (
            s0,
            s1,
            s2,
            s3,
            s4,
            s5,
        )
    for i in range(n - 1, -1, -1):
        for k in range(row_start[i], row_start[i + 1]):
            j, o = 6 * column[k], 36 * k
            s0, s1, s2, s3, s4, s5 = x[j], x[j + 1], x[j + 2], x[j + 3], x[j + 4], x[j + 5]
            for c in range(6):
                f = x[6 * i + c]
                s0 -= L[o + 6 * c] * f
                s1 -= L[o + 6 * c + 1] * f
                s2 -= L[o + 6 * c + 2] * f
                s3 -= L[o + 6 * c + 3] * f
                s4 -= L[o + 6 * c + 4] * f
                s5 -= L[o + 6 * c + 5] * f
            x[j], x[j + 1], x[j + 2], x[j + 3], x[j + 4], x[j + 5] = s0, s1, s2, s3, s4, s5
