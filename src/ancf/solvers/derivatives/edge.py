"""Sensitivities through few rows of joints and contacts, at once: what factors of a step lack is of low rank.

The factors are of A, in which the tangents of joints leave out what velocities and friction do, and
contacts are not: the matrix of the step is T = A + E P with few columns E, see ``lacking``.  Of joints
these are columns of the unit matrix.  A formulation that shifts positions adds W_m gamma to them, where W =
A^-1 E and W_m are its columns for the multipliers, so that C_q s_q + C_p = 0.  A correction c = c_0 - W eta
- V gamma, with c_0 = A^-1 r and V = A^-1 T_q W_m, is then that of both equations if

    eta = P c,      C_q (c + W_m gamma) = C_q s_q + C_p,

a few numbers by parameter (Woodbury's formula, with the shift inside).  W, V and the inverse of the small
matrix are made once a step for all parameters; the columns of W and V are the lanes of what sensitivities
are kept in.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray
from ...batches import BESIDE
from ...compiled import formula, inline_kernel
from ...linalg.eight import lane_rows
from ...linalg.lanes import multiply_abreast, multiply_both_abreast, solve_abreast
from ...records import recorded
from ...simd import LANES, every, load, store
from ..rare import add_slopes_along
from .lacking import Columns, along_columns, beside, columns_for, none, to_local_abreast, with_rates
from .sensitivity import Matrices


@recorded
class Edge(NamedTuple):
    """What the few columns of a step do."""

    W: FloatArray  # (3, size, 8) columns, and what they move velocities and accelerations by
    V: FloatArray  # (3, size, 8)
    c: FloatArray  # (3, size, 8) corrections by parameter
    small: FloatArray  # (16, 32) matrix of eta and gamma, reduced, and behind it its inverse
    columns: Columns
    given: FloatArray  # (16, 8) P c_0 and C_q s_q + C_p by parameter
    found: FloatArray  # (16, 8) eta and gamma


def edge_for(size: int, m: Matrices) -> Edge:
    """Room for a model with its matrices; none where more is lacking than few columns."""
    known = len(m.joined.table) > 0 and bool(np.all(m.joined.table[:, BESIDE]))
    columns = columns_for(size if known else 0, m.edge, m.touching)
    size = size if known and (m.touching or columns.number[0]) and len(m.edge) <= LANES else 0
    W, V, c = (lane_rows(3 * size).reshape(3, size, LANES) for _ in range(3))
    given, found = lane_rows(2 * LANES), lane_rows(2 * LANES)
    return Edge(W, V, c, np.zeros((2 * LANES, 4 * LANES)), columns, given, found)


@formula
def to_shadows_abreast(supports, r):
    """Add the rows that products with matrices have at unknowns along local axes to those of the shadows."""
    for k in range(supports.rot_slot.shape[0]):
        for c in range(3):
            i, j = supports.rot_slot[k] + c, supports.rot_shadow[k] + c
            store(load(r, j) + load(r, i), r, j)
            store(every(0.0), r, i)


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
        store(load(r, i), x, 0, i)
    with_rates(core, x, by_v, by_a)


@inline_kernel
def positions(core, m, x, joined, d, r):
    """r = C_q d in the rows of the multipliers."""
    level = core.joints.level
    none(r)
    level[0], level[1], level[2] = 1.0, 0.0, 0.0
    add_slopes_along(m.joined, x[0], x[1], x[2], d, r, core.ws)
    level[0], level[1], level[2] = joined.w0, joined.w1, joined.w2


@formula
def multiply_stiffness(core, matrices, x, room):
    """Add K x, and W x if there is some, to r."""
    if matrices[2].shape[0] > 0:
        multiply_both_abreast(core.factor, matrices[0], matrices[2], x, room.r, core.joints.first, room.block)
    else:
        multiply_abreast(core.factor, matrices[0], x, room.r, core.joints.first)


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
    multiply_stiffness(core, matrices, room.seen, room)
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
    r, W, V, A, part, columns = room.r, edge.W, edge.V, edge.small, edge.given, edge.columns
    count, own = columns.number[0], core.joints.multipliers.shape[0] if joined.projects else 0
    none(r)
    for i in range(columns.number[1]):
        for k in range(count):
            r[columns.row[i], k] = columns.base[i, k]
    solve_rows(m, factor, room)
    spread(core, r, W, by_v, by_a)
    beside(core, m, x, W, r)
    along_columns(columns, r, part)
    for i in range(count):
        for j in range(count):
            A[i, j] = part[i, j] + (1.0 if i == j else 0.0)
    if own == 0:
        return invert(A, count)
    spread(core, W[0], V, 0.0, 0.0)
    for k in range(core.joints.multipliers.shape[0]):  # the shift is none of multipliers
        store(every(0.0), V, 0, core.joints.multipliers[k])
    stiffened(core, m, matrices, x, V, room)
    solve_rows(m, factor, room)
    spread(core, r, V, by_v, by_a)
    beside(core, m, x, V, r)
    along_columns(columns, r, part)
    for i in range(count):
        for j in range(own):
            A[i, count + j] = part[i, j]
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
    r, d, c, count = room.r, room.d, edge.c, edge.columns.number[0]
    own = core.joints.multipliers.shape[0] if joined.projects else 0
    solve_rows(m, factor, room)
    spread(core, r, c, by_v, by_a)
    beside(core, m, x, c, r)
    along_columns(edge.columns, r, edge.given)
    if own > 0:
        add_gaps(core, m, x, gap, n, first, lanes, joined, edge, room, own)
    for i in range(count + own):
        total = every(0.0)
        for j in range(count + own):
            total = total + edge.small[i, count + own + j] * load(edge.given, j)
        store(total, edge.found, i)
    for i in range(core.weight.shape[0]):
        change, shift = load(c, 0, i), every(0.0)
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


@inline_kernel
def add_gaps(core, m, x, gap, n, first, lanes, joined, edge, room, own):
    """Take the correction c from d, and put what the constraints are off by then behind what is given."""
    r, d, c, count = room.r, room.d, edge.c, edge.columns.number[0]
    for k in range(3):
        for i in range(d.shape[1]):
            store(load(d, k, i) - load(c, k, i), d, k, i)
    for i in range(d.shape[1]):
        store(every(0.0), c, 0, i)
    positions(core, m, x, joined, d, r)
    for k in range(own):
        for lane in range(lanes):
            r[m.edge[k], lane] += gap[first + lane, n, m.edge[k]]
        store(load(r, m.edge[k]), edge.given, count + k)
