"""Solutions of a factorised system near their right-hand side.

The inverse of the matrix of a time step decays away from its diagonal: within a step a force is felt no
further than waves run.  A right-hand side that is zero but in some ranges of rows then has a solution that
is nothing beyond some rows around them.  Forward and backward passes go on beyond a range until as many
rows as the matrix is wide are nothing, and no further, whatever the order of the rows is.  Nothing is what is
small beside the largest number; corrections of a step are small beside the state already.
"""

from __future__ import annotations

from ..compiled import formula, inline_kernel
from ..simd import load_six, store_six
from .block import combined, six, sixfold, times
from .block_ldl import Factor

#: Share of the largest number below which the numbers of a row are nothing.
NOTHING = 1e-8


@formula
def size_of(x, i):
    """Largest of the six numbers of a row by size."""
    size = 0.0
    for c in range(6):
        size = max(size, abs(x[6 * i + c]))
    return size


@formula
def clear(x, first, last):
    """Set rows to zero."""
    for i in range(6 * first, 6 * last):
        x[i] = 0.0


@inline_kernel
def forward(factor, n, x, low, high, count, spread):
    """The forward pass; the ranges grow and join, their number is returned."""
    row_start, column, LT = factor.row_start, factor.column, factor.LT
    pieces, end, largest = 0, 0, 0.0
    for k in range(count):
        i, last = low[k], high[k]
        stop = low[k + 1] if k + 1 < count else n
        if pieces == 0 or i > end:
            clear(x, max(i - spread, end), i)
            low[pieces] = i
            pieces += 1
        quiet = 0
        while i < stop and (i < last or quiet < spread):
            if i >= last:
                clear(x, i, i + 1)
            s = load_six(x, 6 * i)
            for m in range(row_start[i], row_start[i + 1]):
                s = s - times(LT, 36 * m, x, 6 * column[m])
            store_six(s, x, 6 * i)
            size = size_of(x, i)
            largest = max(largest, size)
            quiet = 0 if size > NOTHING * largest else quiet + 1
            i += 1
        high[pieces - 1] = end = i
    return pieces


@inline_kernel
def backward(factor, x, low, high, pieces, spread):
    """The backward pass; the ranges grow."""
    row_start, column, L = factor.row_start, factor.column, factor.L
    largest = 0.0
    for p in range(pieces - 1, -1, -1):
        bottom = high[p - 1] if p > 0 else 0
        begin, clean, quiet, i = low[p], low[p], 0, high[p] - 1
        while i >= bottom and (i >= begin or quiet < spread):
            lowest = max(i - spread, bottom)
            if lowest < clean:
                clear(x, lowest, clean)
                clean = lowest
            factors = sixfold(x, 6 * i)
            for m in range(row_start[i], row_start[i + 1]):
                j = 6 * column[m]
                store_six(load_six(x, j) - combined(six(L, 36 * m), factors), x, j)
            size = size_of(x, i)
            largest = max(largest, size)
            quiet = 0 if size > NOTHING * largest else quiet + 1
            i -= 1
        low[p] = i + 1
        clear(x, clean, i + 1)


@inline_kernel
def solve_near(factor, n, x, low, high, count, spread):
    """Replace a right-hand side that counts in some ranges of rows alone by the solution near them.

    Parameters
    ----------
    factor : Factor
    n : int
        Rows that are there: those before the border, see :mod:`ancf.linalg.border`.
    x : (6 n,) or more
        Right-hand side in the rows low[k] <= i < high[k], which ascend and do not overlap; what else it
        holds does not matter.
    low, high : (count,) or more
        Ranges, which are replaced by those where x is the solution; beyond these it is left as it was, but
        for rows beside them, which are zero.
    count : int
    spread : int
        Largest distance of a block of L from the diagonal, see :func:`spread_of`.

    Returns
    -------
    int
        Number of ranges.

    """
    pieces = forward(factor, n, x, low, high, count, spread)
    for p in range(pieces):
        for i in range(low[p], high[p]):
            store_six(times(factor.D_inv, 36 * i, x, 6 * i), x, 6 * i)
    backward(factor, x, low, high, pieces, spread)
    return pieces


@inline_kernel
def solve_ranges(factor, x, low, high, count):
    """The same where the rows between the ranges are coupled to nothing; the ranges stay as they are."""
    row_start, column, L = factor.row_start, factor.column, factor.L
    LT, D_inv = factor.LT, factor.D_inv
    for k in range(count):
        for i in range(low[k], high[k]):
            s = load_six(x, 6 * i)
            for m in range(row_start[i], row_start[i + 1]):
                s = s - times(LT, 36 * m, x, 6 * column[m])
            store_six(s, x, 6 * i)
    for k in range(count):
        for i in range(low[k], high[k]):
            store_six(times(D_inv, 36 * i, x, 6 * i), x, 6 * i)
    for k in range(count - 1, -1, -1):
        for i in range(high[k] - 1, low[k] - 1, -1):
            factors = sixfold(x, 6 * i)
            for m in range(row_start[i], row_start[i + 1]):
                j = 6 * column[m]
                store_six(load_six(x, j) - combined(six(L, 36 * m), factors), x, j)


def spread_of(factor: Factor, n: int | None = None) -> int:
    """Largest distance of a block of L from the diagonal, at least 1; of its first n rows alone if given."""
    rows = range(len(factor.row_start) - 1 if n is None else n)
    first = [(i, factor.column[factor.row_start[i] : factor.row_start[i + 1]]) for i in rows]
    return max([1, *(int(i - found[0]) for i, found in first if len(found))])
