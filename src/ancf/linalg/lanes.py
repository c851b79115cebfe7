"""Products and solutions of eight vectors abreast: one in each lane of every unknown."""

from __future__ import annotations

from typing import NamedTuple

from ..arrays import FloatArray, IntArray
from ..compiled import formula, kernel
from ..simd import load, store
from .eight import six


class Rows(NamedTuple):
    """Factors L D U of a matrix, see :mod:`ancf.linalg.eight_twisted`; U is L again of symmetric ones."""

    row_start: IntArray  # (n + 1,) first block of each row
    column: IntArray  # (m,)
    L: FloatArray  # (36 m,)
    U: FloatArray  # (36 m,) transposed blocks
    D_inv: FloatArray  # (36 n,)


@formula
def rows_of(factor, e, m, twisted):
    """The factors of matrix m of :class:`ancf.linalg.eight.Eight`; ``twisted``: it is not symmetric."""
    upper = e.LT[m] if twisted else e.L[m]
    return Rows(factor.row_start, factor.column, e.L[m], upper, e.D_inv[m])


@formula
def row_times(block, i, step, x):
    """Product of six numbers of a block, ``step`` apart from the i-th on, and six lanes."""
    one = block[i] * x[0] + block[i + step] * x[1] + block[i + 2 * step] * x[2]
    return one + (block[i + 3 * step] * x[3] + block[i + 4 * step] * x[4] + block[i + 5 * step] * x[5])


@formula
def add_times(block, first, step, x, sign, X, i):
    """Add the product of a block, or its transpose, and six lanes to six rows of X."""
    for c in range(6):
        store(load(X, i + c) + sign * row_times(block, first * c, step, x), X, i + c)


@formula
def multiply(factor, values, above, X, Y, rows):
    """Add the product of a matrix and X to Y: above the diagonal are the blocks below it, times a sign."""
    n = factor.row_start.shape[0] - 1
    for i in range(rows):
        x = six(X, 6 * i)
        add_times(values[36 * i : 36 * i + 36], 6, 1, x, 1.0, Y, 6 * i)
        for k in range(factor.row_start[i], factor.row_start[i + 1]):
            j, block = 6 * factor.column[k], values[36 * (n + k) : 36 * (n + k) + 36]
            add_times(block, 6, 1, six(X, j), 1.0, Y, 6 * i)
            add_times(block, 1, 6, x, above, Y, j)


@kernel
def multiply_abreast(factor, values, X, Y, rows):
    """Add the product of the symmetric matrix of these block values and X to Y.

    From block ``rows`` on its rows are zero.
    """
    multiply(factor, values, 1.0, X, Y, rows)


@kernel
def multiply_both_abreast(factor, values, twisted, X, Y, rows, room):
    """The same of the sum of a symmetric and an antisymmetric matrix; ``room``: (2, 36)."""
    n = factor.row_start.shape[0] - 1
    for i in range(rows):
        x = six(X, 6 * i)
        summed(values, twisted, 36 * i, room)
        add_times(room[0], 6, 1, x, 1.0, Y, 6 * i)
        for k in range(factor.row_start[i], factor.row_start[i + 1]):
            j = 6 * factor.column[k]
            summed(values, twisted, 36 * (n + k), room)
            add_times(room[0], 6, 1, six(X, j), 1.0, Y, 6 * i)
            add_times(room[1], 1, 6, x, 1.0, Y, j)


@formula
def summed(values, twisted, o, room):
    """The block at o of the sum, and of the difference: what is across the diagonal, transposed."""
    for m in range(36):
        s, w = values[o + m], twisted[o + m]
        room[0, m], room[1, m] = s + w, s - w


@kernel
def multiply_twisted_abreast(factor, values, X, Y, rows):
    """The same of the antisymmetric matrix of these block values."""
    multiply(factor, values, -1.0, X, Y, rows)


@kernel
def solve_abreast(factor, X):
    """Replace right-hand sides by the solutions, with :class:`Rows`."""
    row_start, column, L, U, D_inv = factor.row_start, factor.column, factor.L, factor.U, factor.D_inv
    n = row_start.shape[0] - 1
    for i in range(n):
        for k in range(row_start[i], row_start[i + 1]):
            add_times(L[36 * k : 36 * k + 36], 6, 1, six(X, 6 * column[k]), -1.0, X, 6 * i)
    for i in range(n - 1, -1, -1):
        x, block = six(X, 6 * i), D_inv[36 * i : 36 * i + 36]
        for c in range(6):
            store(row_times(block, 6 * c, 1, x), X, 6 * i + c)
    for i in range(n - 1, -1, -1):
        x = six(X, 6 * i)
        for k in range(row_start[i], row_start[i + 1]):
            add_times(U[36 * k : 36 * k + 36], 1, 6, x, -1.0, X, 6 * column[k])
