"""Factorisation A = L D L^T of a symmetric matrix in 6x6 blocks, one block per node.

A chain of cable elements couples each node with the next, so its matrix is block tridiagonal; wires
that run side by side give a narrow block band, nets a general sparse pattern.  One code serves all:
L keeps exactly the blocks that the ordering fills (see :mod:`ancf.linalg.ordering`).  6x6 blocks keep
the inner loops free of indices.  There is no pivoting between blocks, which is safe for the positive
definite matrices of a time step; inside the diagonal blocks pivots are chosen where their own order
will not do (:mod:`ancf.linalg.block`), and the number of negative ones tells how far from positive
definite the matrix is (Sylvester's law of inertia).

Values: block k of a matrix is ``A[36 k : 36 k + 36]``, row by row; the diagonal blocks come first,
then the blocks below the diagonal, row by row.  The six unknowns of a node are one value, as the
products of a block and a vector add up its columns; for them L is kept by columns as well.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numba import types
from numpy.typing import NDArray

from .. import addresses
from ..addresses import caller
from ..arrays import FloatArray
from ..compiled import VECTOR, formula, inline_kernel, separate_kernel
from ..records import recorded, type_of
from ..simd import load_six, store_six
from .block import (
    combined,
    copy,
    invert_symmetric,
    is_zero,
    mirror,
    multiply,
    six,
    sixfold,
    subtract_product,
    times,
)


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
    fill: int  # address of factorise_at
    in_order: bool  # pivots in a block come in the order of its unknowns, see invert_symmetric


def allocate(row_start: NDArray[np.int64], column: NDArray[np.int64], in_order: bool = False) -> Factor:
    """Factor with the pattern of L given by rows, values not yet computed."""
    n = len(row_start) - 1
    longest = int(np.max(np.diff(row_start), initial=1))
    factor = Factor(
        np.ascontiguousarray(row_start, dtype=np.int64),
        np.ascontiguousarray(column, dtype=np.int64),
        np.zeros(36 * len(column)),
        np.zeros(36 * len(column)),
        np.zeros(36 * n),
        np.zeros(36 * max(longest, 1)),
        np.full(n, -1, dtype=np.int64),
        0,
        in_order,
    )
    return factor._replace(fill=addresses.address_of(factorise_at, _given(), types.int64))


@cache
def _given() -> tuple[Any, ...]:
    """Types of what :func:`factorise_at` takes: to ask each factor for its own takes longer than all else."""
    index, vector = np.zeros(0, dtype=np.int64), np.zeros(0)
    return VECTOR, type_of(Factor(index, index, *4 * (vector,), index, 0, False)), types.int64


@inline_kernel
def factorise_row(A, factor, i):
    """Fill row i of ``factor`` from the values A and the rows before; negative pivots, -1 if singular."""
    row_start, column, place = factor.row_start, factor.column, factor.place
    L, LT, D_inv, T = factor.L, factor.LT, factor.D_inv, factor.T
    n = row_start.shape[0] - 1
    first, last = row_start[i], row_start[i + 1]
    for k in range(first, last):
        place[column[k]] = k - first
    copy(A, 36 * i, D_inv, 36 * i)
    mirror(D_inv, 36 * i)
    leading = True  # zeros at the left of a row stay zeros
    for k in range(first, last):
        j, t = column[k], 36 * (k - first)
        copy(A, 36 * (n + k), T, t)
        leading = leading and is_zero(T, t)
        if leading:
            for m in range(36 * k, 36 * k + 36):
                L[m] = LT[m] = 0.0
            continue
        for h in range(row_start[j], row_start[j + 1]):
            c = place[column[h]]
            if c >= 0:
                subtract_product(T, t, T, 36 * c, LT, 36 * h)
        multiply(T, t, D_inv, 36 * j, L, LT, 36 * k)
        subtract_product(D_inv, 36 * i, T, t, LT, 36 * k)
        mirror(D_inv, 36 * i)
    for k in range(first, last):
        place[column[k]] = -1
    return invert_symmetric(D_inv, 36 * i, A, factor.in_order)


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


@separate_kernel
def factorise_at(A, factor, last):
    """See :func:`factorise`: one for all that need factors, as it takes long to compile."""
    return factorise(A, factor, last)


_fill = caller(types.int64)


@formula
def fill(A, factor, last):
    """:func:`factorise` by its address."""
    return _fill(factor.fill, (A, factor, last))


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
            factors = sixfold(x, 6 * i)
            for k in range(row_start[i], row_start[i + 1]):
                j = 6 * column[k]
                store_six(load_six(x, j) - combined(six(L, 36 * k), factors), x, j)
