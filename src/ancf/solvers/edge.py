"""Sensitivities through few rows of joints, solved at once: what the factors of a step lack is of low rank.

The factors are of A, in which the tangents of the joints leave out what velocities and friction do, in the
rows of multipliers and of places of sliding joints alone: the matrix of the step is T = A + E N, with E the
columns of the unit matrix for these rows.  A formulation that shifts positions adds W_m gamma to them, where
W = A^-1 E and W_m are its columns for the multipliers, so that C_q s_q + C_p = 0.  A correction c = c_0 - W
eta - V gamma, with c_0 = A^-1 r and V = A^-1 T_q W_m, is then that of both equations if

    eta = N c,      C_q (c + W_m gamma) = C_q s_q + C_p,

a few numbers by parameter (Woodbury's formula, with the shift inside).  W, V and the inverse of the small
matrix are made once a step for all parameters; the columns of W and V are the lanes of what sensitivities
are kept in.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..arrays import FloatArray
from ..compiled import formula, inline_kernel
from ..linalg.eight import lane_rows
from ..linalg.lanes import multiply_abreast, multiply_twisted_abreast, solve_abreast
from ..records import recorded
from ..simd import LANES, every, load, store
from .abreast_room import follow_abreast
from .rare import add_slopes_along, add_slopes_beside_all


@recorded
class Edge(NamedTuple):
    """What the few rows of a step do."""

    W: FloatArray  # (3, size, 8) columns, and what they move velocities and accelerations by
    V: FloatArray  # (3, size, 8)
    c: FloatArray  # (3, size, 8) corrections by parameter
    small: FloatArray  # (16, 32) matrix of eta and gamma, reduced, and behind it its inverse
    given: FloatArray  # (16, 8) N c_0 and C_q s_q + C_p by parameter
    found: FloatArray  # (16, 8) eta and gamma


def edge_for(size: int, rows: int) -> Edge:
    """Room for a model with so many rows; none for those with none or too many."""
    size = size if 0 < rows <= LANES else 0
    W, V, c = (lane_rows(3 * size).reshape(3, size, LANES) for _ in range(3))
    given, found = lane_rows(2 * LANES), lane_rows(2 * LANES)
    return Edge(W, V, c, np.zeros((2 * LANES, 4 * LANES)), given, found)


@formula
def none(r):
    """Set all lanes to zero."""
    for i in range(r.shape[0]):
        store(every(0.0), r, i)


@formula
def to_shadows_abreast(supports, r):
    """Add the rows that products with matrices have at unknowns along local axes to those of the shadows."""
    for k in range(supports.rot_slot.shape[0]):
        for c in range(3):
            i, j = supports.rot_slot[k] + c, supports.rot_shadow[k] + c
            store(load(r, j) + load(r, i), r, j)
            store(every(0.0), r, i)


@formula
def to_local_abreast(supports, r):
    """Components along local axes, as :func:`ancf.system.core.to_local`."""
    for k in range(supports.rot_slot.shape[0]):
        i, j = supports.rot_slot[k], supports.rot_shadow[k]
        for c in range(3):
            R = supports.rot_R[k, 0]
            store(R[0, c] * load(r, j) + R[1, c] * load(r, j + 1) + R[2, c] * load(r, j + 2), r, i + c)


@formula
def solve_rows(m, factor, room):
    """Solve for r; the factors are of a matrix with alpha C_q^T C_q, which multipliers make up for."""
    r, rows = room.r, room.rows
    for k in range(m.row.shape[0]):
        store(load(r, m.row[k]), rows, k)
    solve_abreast(factor, r)
    for k in range(m.row.shape[0]):
        store(load(r, m.row[k]) + m.alpha[k] * load(rows, k), r, m.row[k])


@formula
def spread(core, r, x, by_v, by_a):
    """x = r as a change of positions, with its share in velocities and accelerations; shadows follow."""
    for i in range(core.weight.shape[0]):
        c = load(r, i)
        store(c, x, 0, i)
        store(by_v * c, x, 1, i)
        store(by_a * c, x, 2, i)
    for k in range(core.joints.multipliers.shape[0]):
        store(every(0.0), x, 1, core.joints.multipliers[k])
        store(every(0.0), x, 2, core.joints.multipliers[k])
    follow_abreast(core.supports, x)


@inline_kernel
def beside(core, m, x, d, r):
    """r = N d."""
    none(r)
    add_slopes_beside_all(m.joined, x[0], x[1], x[2], d, r, core.ws)


@inline_kernel
def positions(core, m, x, joined, d, r):
    """r = C_q d in the rows of the multipliers."""
    level = core.joints.level
    none(r)
    level[0], level[1], level[2] = 1.0, 0.0, 0.0
    add_slopes_along(m.joined, x[0], x[1], x[2], d, r, core.ws)
    level[0], level[1], level[2] = joined.w0, joined.w1, joined.w2


@inline_kernel
def stiffened(core, m, matrices, x, d, room):
    """r = T_q d in components of the solve, of a change d of positions alone; whose shadows are filled."""
    r, supports = room.r, core.supports
    none(r)
    for i in range(r.shape[0]):
        store(load(d, 0, i), room.seen, i)
    for k in range(supports.rot_slot.shape[0]):
        for c in range(3):
            store(load(d, 0, supports.rot_shadow[k] + c), room.seen, supports.rot_slot[k] + c)
    multiply_abreast(core.factor, matrices[0], room.seen, r, core.joints.first)
    if matrices[2].shape[0] > 0:
        multiply_twisted_abreast(core.factor, matrices[2], room.seen, r, core.joints.first)
    to_shadows_abreast(supports, r)
    add_slopes_along(m.joined, x[0], x[1], x[2], d, r, core.ws)
    to_local_abreast(supports, r)
    for k in range(supports.held.shape[0]):
        store(every(0.0), r, supports.held[k])


@inline_kernel
def invert(A, n):
    """Fill columns n to 2n of A with the inverse of its leading part (Gauss-Jordan), if it has one."""
    for i in range(n):
        for j in range(n):
            A[i, n + j] = 1.0 if i == j else 0.0
    for k in range(n):
        p = k
        for i in range(k + 1, n):
            if abs(A[i, k]) > abs(A[p, k]):
                p = i
        if not abs(A[p, k]) > 0.0:
            return False
        for j in range(2 * n):
            A[k, j], A[p, j] = A[p, j], A[k, j]
        pivot = A[k, k]
        for j in range(2 * n):
            A[k, j] /= pivot
        for i in range(n):
            f = A[i, k]
            if i != k and f != 0.0:
                for j in range(2 * n):
                    A[i, j] -= f * A[k, j]
    return True


@inline_kernel
def edge_anew(core, m, factor, matrices, x, joined, edge, room, by_v, by_a):
    """Make W, V and the small inverse of a step; whether they exist."""
    r, W, V, A, count = room.r, edge.W, edge.V, edge.small, m.edge.shape[0]
    own = core.joints.multipliers.shape[0] if joined.projects else 0
    none(r)
    for k in range(count):
        r[m.edge[k], k] = 1.0
    solve_rows(m, factor, room)
    spread(core, r, W, by_v, by_a)
    beside(core, m, x, W, r)
    for i in range(count):
        for j in range(count):
            A[i, j] = r[m.edge[i], j] + (1.0 if i == j else 0.0)
    if own == 0:
        return invert(A, count)
    spread(core, W[0], V, 0.0, 0.0)
    for k in range(core.joints.multipliers.shape[0]):  # the shift is none of multipliers
        store(every(0.0), V, 0, core.joints.multipliers[k])
    stiffened(core, m, matrices, x, V, room)
    solve_rows(m, factor, room)
    spread(core, r, V, by_v, by_a)
    beside(core, m, x, V, r)
    for i in range(count):
        for j in range(own):
            A[i, count + j] = r[m.edge[i], j]
    positions(core, m, x, joined, V, r)
    for i in range(own):
        for j in range(own):
            A[count + i, count + j] = -r[m.edge[i], j]
    positions(core, m, x, joined, W, r)
    for i in range(own):
        for j in range(own):
            A[count + i, count + j] += r[m.edge[i], j]
        for j in range(count):
            A[count + i, j] = -r[m.edge[i], j]
    return invert(A, count + own)


@inline_kernel
def corrected_at_edge(core, m, factor, x, gap, n, first, lanes, joined, edge, room, by_v, by_a):
    """Correct the sensitivities d, which are out of balance by r, for both equations."""
    r, d, c, count = room.r, room.d, edge.c, m.edge.shape[0]
    own = core.joints.multipliers.shape[0] if joined.projects else 0
    solve_rows(m, factor, room)
    spread(core, r, c, by_v, by_a)
    for k in range(3):
        for i in range(d.shape[1]):
            store(load(d, k, i) - load(c, k, i), d, k, i)
    beside(core, m, x, c, r)
    for k in range(count):
        store(load(r, m.edge[k]), edge.given, k)
    if own > 0:
        positions(core, m, x, joined, d, r)
        for k in range(own):
            for lane in range(lanes):
                r[m.edge[k], lane] += gap[first + lane, n, m.edge[k]]
            store(load(r, m.edge[k]), edge.given, count + k)
    for i in range(count + own):
        total = every(0.0)
        for j in range(count + own):
            total = total + edge.small[i, count + own + j] * load(edge.given, j)
        store(total, edge.found, i)
    for i in range(core.weight.shape[0]):
        change, shift = every(0.0), every(0.0)
        for k in range(count):
            change = change - edge.W[0, i, k] * load(edge.found, k)
        for k in range(own):
            gamma = load(edge.found, count + k)
            change = change - edge.V[0, i, k] * gamma
            shift = shift + edge.W[0, i, k] * gamma
        if core.joints.mask[i] > 0.0:
            store(load(d, 0, i) - change, d, 0, i)
        else:
            store(load(d, 0, i) - change - shift, d, 0, i)
            store(load(d, 1, i) - by_v * change, d, 1, i)
            store(load(d, 2, i) - by_a * change, d, 2, i)
