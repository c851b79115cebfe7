"""Rows at the border of a factorised matrix that change in every step: those of sliding joints.

With the kept factors of K the equations of a step are

    [ K  R^T ] [x]   [r]          S = D - R K^-1 R^T,
    [ R   D  ] [y] = [s],         S y = s - R K^-1 r,      x = K^-1 r - K^-1 R^T y.

D is block diagonal, and a row of R has entries under a few blocks of K alone: the sliding point's and those
of the element in which the joint is.  For each of these blocks the six columns of K^-1 are kept, as long as
the factors are.  A step then costs products of 6x6 blocks, whatever the length of the line, and new columns
only where a joint comes to another element.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numba import types

from .. import addresses
from ..addresses import caller
from ..arrays import FloatArray, IntArray
from ..compiled import formula, inline_kernel, kernel
from ..records import recorded, type_of
from ..simd import every, load_six, store_six
from .block import combined, copy, is_zero, put_six, six, sixfold, subtract_product, times, turn
from .block_ldl import Factor, allocate, fill, solve_rows

#: Blocks whose columns are kept for each row besides those that it may have at a time.
SPARE = 2


@recorded
class Border(NamedTuple):
    """t rows of blocks behind the n blocks of K, with at most w blocks each; room for m blocks of columns."""

    block: IntArray  # (m,) block of K whose columns are kept, -1: none
    inverse: FloatArray  # (m, 36 n) six columns of K^-1, for each block one after the other
    number: IntArray  # (t,) blocks in each row now
    kept: IntArray  # (t, w) which of the m they are
    place: IntArray  # (t, w) where they stand in the matrix
    R: FloatArray  # (36 t w,) row by row
    RT: FloatArray  # (36 t w,) column by column
    S: FloatArray  # values of the Schur complement, full
    small: Factor  # of it
    y: FloatArray  # (6 t,) workspace
    part: FloatArray  # (36,) workspace
    turned: FloatArray  # (6 t w,) workspace, R^T y block by block
    make: int  # addresses of make_border and solve_border, 0 without rows
    solve: int


def room_for_border(head: int, rows: int, widest: int) -> Border:
    """Border of ``rows`` blocks behind ``head`` ones; each row has at most ``widest`` blocks at a time."""
    return _room(head, rows, widest) if rows else _nothing()


@cache
def _nothing() -> Border:
    return _room(0, 0, 0)


def _room(head: int, rows: int, widest: int) -> Border:
    kept = rows * (widest + SPARE)
    start = np.arange(rows + 1) * (np.arange(rows + 1) - 1) // 2
    column = np.concatenate([np.zeros(0, dtype=np.int64), *(np.arange(t) for t in range(rows))])
    border = Border(
        block=np.full(kept, -1, dtype=np.int64),
        inverse=np.zeros((kept, 36 * head if rows else 0)),
        number=np.zeros(rows, dtype=np.int64),
        kept=np.zeros((rows, widest), dtype=np.int64),
        place=np.zeros((rows, widest), dtype=np.int64),
        R=np.zeros(36 * rows * widest),
        RT=np.zeros(36 * rows * widest),
        S=np.zeros(36 * (rows + len(column))),
        small=allocate(start.astype(np.int64), column.astype(np.int64), True),  # multipliers come before s
        y=np.zeros(6 * rows),
        part=np.zeros(36),
        turned=np.zeros(6 * rows * widest),
        make=0,
        solve=0,
    )
    if rows == 0:
        return border
    mine, vector = type_of(border), types.Array(types.float64, 1, "C")
    return border._replace(
        make=addresses.address_of(make_border, (mine, vector, type_of(border.small)), types.int64),
        solve=addresses.address_of(solve_border, (mine, vector), types.none),
    )


@inline_kernel
def unit_columns(factor, n, block, Z):
    """Z = K^-1 times the unit vectors of a block of the n blocks of K."""
    row_start, column, L, LT, D_inv = factor.row_start, factor.column, factor.L, factor.LT, factor.D_inv
    for i in range(36 * n):
        Z[i] = 0.0
    for c in range(6):
        Z[36 * block + 7 * c] = 1.0
    for i in range(block + 1, n):
        for k in range(row_start[i], row_start[i + 1]):
            if column[k] >= block:
                subtract_product(Z, 36 * i, Z, 36 * column[k], LT, 36 * k)
    for i in range(block, n):
        rows = six(D_inv, 36 * i)
        for c in range(36 * i, 36 * i + 36, 6):
            store_six(combined(rows, sixfold(Z, c)), Z, c)
    for i in range(n - 1, -1, -1):
        for k in range(row_start[i], row_start[i + 1]):
            subtract_product(Z, 36 * column[k], Z, 36 * i, L, 36 * k)


@inline_kernel
def in_use(border, m):
    """Whether the rows that are known already have the kept block m."""
    for t in range(border.number.shape[0]):
        for u in range(border.number[t]):
            if border.kept[t, u] == m:
                return True
    return False


@inline_kernel
def columns_of(border, factor, n, block):
    """Which of the kept blocks this one is; its columns are made if they are not there."""
    free = -1
    for m in range(border.block.shape[0]):
        if border.block[m] == block:
            return m
        if border.block[m] < 0 or (free < 0 and not in_use(border, m)):
            free = m
    border.block[free] = block
    unit_columns(factor, n, block, border.inverse[free])
    return free


@inline_kernel
def find_rows(border, A, factor):
    """Find where the rows have blocks in the matrix now that are not zero."""
    rows, blocks = border.number.shape[0], factor.row_start.shape[0] - 1
    for t in range(rows):
        border.number[t] = 0
        for k in range(factor.row_start[blocks - rows + t], factor.row_start[blocks - rows + t + 1]):
            a = 36 * (blocks + k)
            if factor.column[k] < blocks - rows and not is_zero(A, a):
                border.place[t, border.number[t]], border.kept[t, border.number[t]] = a, -1
                border.number[t] += 1


@inline_kernel
def read_row(border, A, factor, n, t):
    """Blocks of row t, from the matrix."""
    blocks, width = factor.row_start.shape[0] - 1, border.kept.shape[1]
    for u in range(border.number[t]):
        a, o = border.place[t, u], 36 * (t * width + u)
        copy(A, a, border.R, o)
        turn(A, a, border.RT, o)
        border.kept[t, u] = columns_of(border, factor, n, factor.column[a // 36 - blocks])


@inline_kernel
def subtract_inverse(border, t, h, o):
    """S -= R_t K^-1 R_h^T, for the block of S at ``o``."""
    width, part, R, none = border.kept.shape[1], border.part, border.R, every(0.0)
    for w in range(border.number[h]):
        at = 36 * border.block[border.kept[h, w]]
        s0, s1, s2, s3, s4, s5 = none, none, none, none, none, none
        for u in range(border.number[t]):
            rows, r = six(border.inverse[border.kept[t, u]], at), 36 * (t * width + u)
            s0, s1 = s0 + combined(rows, sixfold(R, r)), s1 + combined(rows, sixfold(R, r + 6))
            s2, s3 = s2 + combined(rows, sixfold(R, r + 12)), s3 + combined(rows, sixfold(R, r + 18))
            s4, s5 = s4 + combined(rows, sixfold(R, r + 24)), s5 + combined(rows, sixfold(R, r + 30))
        put_six((s0, s1, s2, s3, s4, s5), part, 0)
        subtract_product(border.S, o, part, 0, border.RT, 36 * (h * width + w))


@formula
def forget_columns(border):
    """The factors are new."""
    for m in range(border.block.shape[0]):
        border.block[m] = -1


@inline_kernel
def clear_rows(border, A, n):
    """Set what the rows have in the matrix, of which K has n blocks, to zero."""
    for t in range(border.number.shape[0]):
        for u in range(border.number[t]):
            clear_block(A, border.place[t, u])
        clear_block(A, 36 * (n + t))


@formula
def clear_block(A, o):
    """Set the block at ``A[o]`` to zero."""
    for k in range(0, 36, 6):
        store_six(every(0.0), A, o + k)


@kernel
def make_border(border, A, factor):
    """Take the rows, which :func:`find_rows` has found, from the matrix and factorise S.

    Returns the number of negative pivots, or -(row + 1) if S is singular.
    """
    rows = border.number.shape[0]
    n = factor.row_start.shape[0] - 1 - rows
    for t in range(rows):
        read_row(border, A, factor, n, t)
    for i in range(border.S.shape[0]):
        border.S[i] = 0.0
    for t in range(rows):
        copy(A, 36 * (n + t), border.S, 36 * t)
        subtract_inverse(border, t, t, 36 * t)
        for h in range(t):
            subtract_inverse(border, t, h, 36 * (rows + border.small.row_start[t] + h))
    return fill(border.S, border.small, rows)


@inline_kernel
def across(border, x, y):
    """y = R x."""
    width = border.kept.shape[1]
    for t in range(border.number.shape[0]):
        s = every(0.0)
        for u in range(border.number[t]):
            s = s + times(border.RT, 36 * (t * width + u), x, 6 * border.block[border.kept[t, u]])
        store_six(s, y, 6 * t)


@inline_kernel
def spread(border, y, x):
    """x -= K^-1 R^T y."""
    width, turned = border.kept.shape[1], border.turned
    for t in range(border.number.shape[0]):
        for u in range(border.number[t]):
            k = t * width + u
            store_six(times(border.R, 36 * k, y, 6 * t), turned, 6 * k)
    for i in range(border.inverse.shape[1] // 36):
        s = load_six(x, 6 * i)
        for t in range(border.number.shape[0]):
            for u in range(border.number[t]):
                Z = border.inverse[border.kept[t, u]]
                s = s - times(Z, 36 * i, turned, 6 * (t * width + u))
        store_six(s, x, 6 * i)


@inline_kernel
def solve_small(border, y):
    """y -> S^-1 y."""
    solve_rows(border.small, y, np.int64(0), border.number.shape[0])


@kernel
def solve_border(border, x):
    """Replace (K^-1 r, s) by the solution (x, y)."""
    y = border.y
    n = border.inverse.shape[1] // 6
    across(border, x, y)
    for i in range(y.shape[0]):
        y[i] = x[n + i] - y[i]
    solve_small(border, y)
    spread(border, y, x)
    for i in range(y.shape[0]):
        x[n + i] = y[i]


_make, _solve = caller(types.int64), caller(types.none)


@formula
def renew_border(border, A, factor):
    """:func:`make_border` by its address; 0 without rows."""
    return _make(border.make, (border, A, factor))


@formula
def apply_border(border, x):
    """:func:`solve_border` by its address."""
    _solve(border.solve, (border, x))
