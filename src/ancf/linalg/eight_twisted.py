"""Factors of eight matrices that are not symmetric, with one pattern, a matrix in each lane.

What velocities add to a stiffness is antisymmetric in part: A = S + W with the lower blocks of both, so that
a block below the diagonal is S + W and the one across from it the transpose of S - W.  With A = L D U the
rows of L and, transposed, the columns of U follow from each other as those of L alone in
:mod:`ancf.linalg.eight`:

    t = L D:  t_ij = A_ij - sum t_ih U_hj,      u = (D U)^T:  u_ij = A_ji^T - sum u_ih L_jh^T,
    L_ij = t_ij D_j^-1,      U_ji^T = u_ij D_j^-T,      D_i = A_ii - sum t_ij U_ji.

``LT`` of ``Eight`` has the blocks U_ji^T then.  There is no search for pivots: the symmetric part of the
matrices of time steps is positive definite, and so are all D_i.
"""

from __future__ import annotations

from typing import NamedTuple

from ..arrays import FloatArray
from ..compiled import formula, inline_kernel, kernel
from ..records import recorded
from ..simd import LANES, absolute, every, load, store
from .block import SINGULAR
from .block_ldl import Factor
from .eight import (
    all_positive,
    all_zero,
    lane_rows,
    less_rows,
    lower,
    smaller,
    times_rows,
    turned_in,
    turned_out,
)


@recorded
class Twisted(NamedTuple):
    """Lanes that factors have more of where matrices are not symmetric; sizes as in ``Factor``."""

    up: FloatArray  # (36 m, 8) U, as L its rows
    d: FloatArray  # (36 n, 8) D^-T
    u: FloatArray  # (36 longest row, 8) workspace
    w: FloatArray  # (36, 8) lanes of a block of W


def allocate_twisted(factor: Factor, used: bool) -> Twisted:
    """Room for the pattern of a factor; none if it is not ``used``."""
    n, m, longest = (x.size if used else 0 for x in (factor.D_inv, factor.L, factor.T))
    return Twisted(lane_rows(m), lane_rows(n), lane_rows(longest), lane_rows(36 if used else 0))


@formula
def swept(A, o, p):
    """One step of the inversion in place of the blocks at ``A[o]`` (Gauss-Jordan) with pivot p."""
    inverse = 1.0 / load(A, o + 7 * p)
    store(every(1.0), A, o + 7 * p)
    row = o + 6 * p
    x0, x1, x2 = inverse * load(A, row), inverse * load(A, row + 1), inverse * load(A, row + 2)
    x3, x4, x5 = inverse * load(A, row + 3), inverse * load(A, row + 4), inverse * load(A, row + 5)
    x = (x0, x1, x2, x3, x4, x5)
    for k in range(6):
        store(x[k], A, row + k)
    for i in range(6):
        if i != p:
            f = load(A, o + 6 * i + p)
            store(every(0.0), A, o + 6 * i + p)
            for k in range(6):
                store(load(A, o + 6 * i + k) - f * x[k], A, o + 6 * i + k)


@inline_kernel
def inverted(A, o, original):
    """Invert the blocks at ``A[o]`` in place; whether all pivots are positive in all lanes."""
    least = every(1.0)
    for p in range(6):
        left = load(A, o + 7 * p)
        least = smaller(least, left - SINGULAR * absolute(load(original, 7 * p)))
        swept(A, o, p)
    return all_positive(least)


@formula
def turned_both(e, W, room, k, o):
    """Copy block k of S + W and of S - W to the lanes from ``o`` on of both workspaces."""
    turned_in(e.A.reshape(-1), e.begin[0:1], 36 * k, e.t, o)
    turned_in(W, e.begin[0:1], 36 * k, room.w, 0)
    for m in range(36):
        s, w = load(e.t, o + m), load(room.w, m)
        store(s + w, e.t, o + m)
        store(s - w, room.u, o + m)


@inline_kernel
def twisted_row(factor, e, room, W, i):
    """Row i of L, U and D; whether its pivots are positive."""
    row_start, column, place = factor.row_start, factor.column, factor.place
    n, first, d, t, u = row_start.shape[0] - 1, row_start[i], 36 * i, e.t, room.u
    turned_in(e.A.reshape(-1), e.begin[0:1], d, e.a, 0)
    turned_in(W, e.begin[0:1], d, room.w, 0)
    for k in range(6):
        for m in range(6):  # of symmetric blocks the lower half is kept
            store(load(e.a, lower(0, k, m)) + load(room.w, 6 * k + m), e.d, d + 6 * k + m)
    leading = True  # zeros at the left of a row stay zeros
    for k in range(first, row_start[i + 1]):
        j, c, o = column[k], 36 * (k - first), 36 * k
        turned_both(e, W, room, n + k, c)
        leading = leading and all_zero(t, c) and all_zero(u, c)
        if leading:
            for m in range(36):
                store(every(0.0), e.low, o + m)
                store(every(0.0), room.up, o + m)
        else:
            for h in range(row_start[j], row_start[j + 1]):
                if place[column[h]] >= 0:
                    less_rows(t, 36 * place[column[h]], room.up, 36 * h, t, c, False)
                    less_rows(u, 36 * place[column[h]], e.low, 36 * h, u, c, False)
            times_rows(t, c, room.d, 36 * j, e.low, o)
            times_rows(u, c, e.d, 36 * j, room.up, o)
            less_rows(t, c, room.up, o, e.d, d, False)
        turned_out(e.low, o, e.L.reshape(-1), e.begin[1:2], o)
        turned_out(room.up, o, e.LT.reshape(-1), e.begin[1:2], o)
    good = inverted(e.d, d, e.a)
    for k in range(6):
        for m in range(6):
            store(load(e.d, d + 6 * m + k), room.d, d + 6 * k + m)
    turned_out(e.d, d, e.D_inv.reshape(-1), e.begin[2:3], d)
    return good


@kernel
def factorise_twisted(factor, e, room, W, count):
    """Fill the factors of the first ``count`` matrices; whether all pivots are positive.

    ``factor`` gives the pattern; ``W``: (8, 36 (n + m)) what is antisymmetric.
    """
    row_start, column, place = factor.row_start, factor.column, factor.place
    for m in range(count, LANES):
        for k in range(e.A.shape[1]):
            e.A[m, k], W[m, k] = e.A[count - 1, k], W[count - 1, k]
    good = True
    for i in range(row_start.shape[0] - 1):
        for k in range(row_start[i], row_start[i + 1]):
            place[column[k]] = k - row_start[i]
        good = good and twisted_row(factor, e, room, W.reshape(-1), i)
        for k in range(row_start[i], row_start[i + 1]):
            place[column[k]] = -1
        if not good:
            return False
    return good
