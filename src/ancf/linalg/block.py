"""Blocks of 6 x 6 numbers, of one node each: products, and the inverse of a symmetric one.

A block is six rows of six numbers, which stand one after the other in an array; in registers it is six
:mod:`ancf.simd` values.  Six columns that stand so are the rows of the transposed block.
"""

from __future__ import annotations

import numpy as np

from ..compiled import formula, inline_kernel
from ..simd import absolute, every, load_six, replaced, store_columns, store_six

#: A pivot below this fraction of its original diagonal entry counts as zero.
SINGULAR = 1e-14
#: Above this fraction pivots are taken in the order of the unknowns, as long as they are positive.
CLEAR = 1e-8


@formula
def six(A, o):
    """The rows of the block at ``A[o]``."""
    return (
        load_six(A, o),
        load_six(A, o + 6),
        load_six(A, o + 12),
        load_six(A, o + 18),
        load_six(A, o + 24),
        load_six(A, o + 30),
    )


@formula
def put_six(rows, A, o):
    """Write rows to the block at ``A[o]``."""
    x0, x1, x2, x3, x4, x5 = rows
    store_six(x0, A, o)
    store_six(x1, A, o + 6)
    store_six(x2, A, o + 12)
    store_six(x3, A, o + 18)
    store_six(x4, A, o + 24)
    store_six(x5, A, o + 30)


@formula
def copy(A, a, B, b):
    """Copy a block from ``A[a]`` to ``B[b]``."""
    put_six(six(A, a), B, b)


@formula
def turn(A, a, B, b):
    """Write the transposed of a block at ``A[a]`` to ``B[b]``."""
    x0, x1, x2, x3, x4, x5 = six(A, a)
    store_columns(x0, x1, x2, x3, x4, x5, B, b)


@formula
def is_zero(A, o):
    """Whether the block at ``A[o]`` is zero."""
    a, b, c, d, e, f = six(A, o)
    x = (absolute(a) + absolute(b) + absolute(c)) + (absolute(d) + absolute(e) + absolute(f))
    return ((x[0] + x[1]) + (x[2] + x[3])) + (x[4] + x[5]) == 0.0  # by pairs: total() adds one by one


@formula
def mirror(C, o):
    """Make a block that is symmetric but for round-off exactly so.

    Along a chain of many nodes an antisymmetric error would grow.
    """
    for i in range(6):
        for j in range(i):
            C[o + 6 * j + i] = C[o + 6 * i + j]


@formula
def sixfold(x, i):
    """The numbers x[i] ... x[i + 5], each in all lanes."""
    return every(x[i]), every(x[i + 1]), every(x[i + 2]), every(x[i + 3]), every(x[i + 4]), every(x[i + 5])


@formula
def combined(rows, factors):
    """Sum of six rows with these factors."""
    r0, r1, r2, r3, r4, r5 = rows
    f0, f1, f2, f3, f4, f5 = factors
    return (r0 * f0 + r1 * f1) + (r2 * f2 + r3 * f3) + (r4 * f4 + r5 * f5)


@formula
def times(A, o, x, i):
    """Product of the block whose columns stand from ``A[o]`` on and the six numbers x[i] ... x[i + 5]."""
    return combined(six(A, o), sixfold(x, i))


@formula
def subtract_product(C, oc, A, oa, B, ob):
    """C -= A B for 6x6 blocks, row by row, at the given offsets."""
    rows = six(B, ob)
    for i in range(0, 36, 6):
        store_six(load_six(C, oc + i) - combined(rows, sixfold(A, oa + i)), C, oc + i)


@formula
def multiply(A, oa, B, ob, C, CT, oc):
    """C = A B by rows and by columns."""
    rows = six(B, ob)
    x0, x1 = combined(rows, sixfold(A, oa)), combined(rows, sixfold(A, oa + 6))
    x2, x3 = combined(rows, sixfold(A, oa + 12)), combined(rows, sixfold(A, oa + 18))
    x4, x5 = combined(rows, sixfold(A, oa + 24)), combined(rows, sixfold(A, oa + 30))
    put_six((x0, x1, x2, x3, x4, x5), C, oc)
    store_columns(x0, x1, x2, x3, x4, x5, CT, oc)


@formula
def swept(rows, p):
    """The rows of a symmetric block swept on pivot p.

    It is known when a kernel is compiled, which leaves nothing to be decided.
    """
    a, b, c, d, e, f = rows
    x = rows[p]
    y = replaced(x, p, -1.0) * (1.0 / x[p])
    return (
        y if p == 0 else replaced(a, p, 0.0) - x[0] * y,
        y if p == 1 else replaced(b, p, 0.0) - x[1] * y,
        y if p == 2 else replaced(c, p, 0.0) - x[2] * y,
        y if p == 3 else replaced(d, p, 0.0) - x[3] * y,
        y if p == 4 else replaced(e, p, 0.0) - x[4] * y,
        y if p == 5 else replaced(f, p, 0.0) - x[5] * y,
    )


@formula
def invert_definite(A, o, original):
    """Invert the block at ``A[o]`` in place if all pivots are positive in their order; whether they are."""
    # a plain 0 is a type of its own for numba, for which it would translate everything anew
    rows = six(A, o)
    clear = rows[0][0] > CLEAR * original[o]
    rows = swept(rows, np.int64(0))
    clear = clear and rows[1][1] > CLEAR * original[o + 7]
    rows = swept(rows, np.int64(1))
    clear = clear and rows[2][2] > CLEAR * original[o + 14]
    rows = swept(rows, np.int64(2))
    clear = clear and rows[3][3] > CLEAR * original[o + 21]
    rows = swept(rows, np.int64(3))
    clear = clear and rows[4][4] > CLEAR * original[o + 28]
    rows = swept(rows, np.int64(4))
    clear = clear and rows[5][5] > CLEAR * original[o + 35]
    if not clear:
        return False
    x0, x1, x2, x3, x4, x5 = swept(rows, np.int64(5))
    put_six((-x0, -x1, -x2, -x3, -x4, -x5), A, o)
    mirror(A, o)
    return True


@inline_kernel
def sweep(A, o, p):
    """Sweep the symmetric block at ``A[o]`` on pivot p."""
    y = replaced(load_six(A, o + 6 * p), p, -1.0) * (1.0 / A[o + 7 * p])
    for i in range(6):
        if i != p:
            row = replaced(load_six(A, o + 6 * i), p, 0.0)
            store_six(row - every(A[o + 6 * p + i]) * y, A, o + 6 * i)
    store_six(y, A, o + 6 * p)


@formula
def swept_back(A, o):
    """From all pivots swept to the inverse."""
    for i in range(0, 36, 6):
        store_six(-load_six(A, o + i), A, o + i)
    mirror(A, o)


@inline_kernel
def invert_in_order(A, o):
    """Invert the block at ``A[o]`` in place by pivots in their order, of either sign.

    Returns the number of negative ones, or -1, with the block as it was, if one is too small beside what it
    was at first.
    """
    rows, negative = six(A, o), 0
    for p in range(6):
        d = A[o + 7 * p]
        if not abs(d) > CLEAR * abs(at(rows, p)):
            put_six(rows, A, o)
            return -1
        negative += d < 0.0
        sweep(A, o, p)
    swept_back(A, o)
    return negative


@formula
def at(rows, p):
    """Entry p of the diagonal of a block."""
    if p < 3:
        return rows[0][0] if p == 0 else (rows[1][1] if p == 1 else rows[2][2])
    return rows[3][3] if p == 3 else (rows[4][4] if p == 4 else rows[5][5])


@inline_kernel
def invert_symmetric(A, o, original, in_order):
    """Invert the 6x6 block at ``A[o]`` in place by sweeps; number of negative pivots, -1 if singular.

    The largest pivot comes first. ``in_order``: they come as they are, if that will do.
    """
    if invert_definite(A, o, original):
        return 0
    if in_order:
        negative = invert_in_order(A, o)
        if negative >= 0:
            return negative
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
        sweep(A, o, p)
    swept_back(A, o)
    return negative
