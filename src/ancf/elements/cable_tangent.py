"""The tangent of the cable for LANES elements at a time: from Gauss points to the blocks of the matrix."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..compiled import formula, inline_kernel
from ..simd import LANES, every, load, scatter_nodes, store, vector
from .cable_columns import INV_L, LENGTH
from .cable_damping import SLOPES
from .workspace import add_row, add_rows

# rows of the workspace: 3x3 blocks between d, t1 and t2, row by row
KDD, KD1, KD2, K11, K12, K22 = 0, 9, 18, 27, 36, 45
BLOCKS = 54
#: The blocks and the parts of the element's shape, d, t1 and t2, between which they are.
PAIRS = ((KDD, 0, 0), (KD1, 0, 1), (KD2, 0, 2), (K11, 1, 1), (K12, 1, 2), (K22, 2, 2))


@formula
def spread_slope(ws, gp, g, pp):
    """Add the matrix on p of a Gauss point, three rows, to the blocks."""
    for block, x, y in PAIRS:
        c = gp[g, x] * gp[g, y]
        add_rows(ws, block, c * pp[0])
        add_rows(ws, block + 3, c * pp[1])
        add_rows(ws, block + 6, c * pp[2])


@formula
def spread(ws, gp, g, inv_l, matrices):
    """Add the matrices of a Gauss point by p p, p s, s p and s s, three rows each, to the blocks."""
    pp, ps, sp, ss = matrices
    spread_row(ws, gp, g, inv_l, 0, pp[0], ps[0], sp[0], ss[0])
    spread_row(ws, gp, g, inv_l, 3, pp[1], ps[1], sp[1], ss[1])
    spread_row(ws, gp, g, inv_l, 6, pp[2], ps[2], sp[2], ss[2])


@inline_kernel
def spread_row(ws, gp, g, inv_l, first, pp, ps, sp, ss):
    """Rows of the blocks that begin ``first`` rows behind the first row of each."""
    for block, x, y in PAIRS:
        cx, cy, ex, ey = gp[g, x], gp[g, y], gp[g, 3 + x] * inv_l, gp[g, 3 + y] * inv_l
        add_rows(ws, block + first, cy * (cx * pp + ex * sp) + ey * (cx * ps + ex * ss))


@formula
def spread_slope_damping(ws, c):
    """Add the matrix of the slope damping on the rates of (d, t1, t2)."""
    for block, x, y in PAIRS:
        for i in range(3):
            add_row(ws, block + 4 * i, c * SLOPES[x][y])


@inline_kernel
def add_block(A, place, ws, origin, m, scale, mass):
    """Add scale times a 3x3 block of lane m, and mass times the unit matrix, to A at ``place``."""
    first, row, column = origin[0] * LANES + m, origin[1] * LANES, origin[2] * LANES
    if min(place, first, row, column) < 0:
        return  # never: but now the compiler knows that no index counts from the end
    if mass != 0.0:
        for i in range(3):
            A[place + 7 * i] += mass
    for i in range(3):
        for j in range(3):
            A[place + 6 * i + j] += scale * ws[first + i * row + j * column]


def _places() -> NDArray[np.int64]:
    """First row and strides of the 3x3 block between slots x and y of (r1, r_x1, r2, r_x2), shape (16, 3)."""
    blocks = {(x, y): block for block, x, y in PAIRS}
    part = (0, 1, 0, 2)  # r1 and r2 act through d
    rows = []
    for x in range(4):
        for y in range(4):
            i, j = part[x], part[y]
            rows.append((blocks[i, j], 3, 1) if i <= j else (blocks[j, i], 1, 3))
    return np.array(rows, dtype=np.int64)


PLACES = _places()

#: 420/(rhoA L) times the consistent mass (eq. 23) between the slots, times L for each slope.
MASSES = np.array(
    [
        [156.0, 22.0, 54.0, -13.0],
        [22.0, 4.0, 13.0, -3.0],
        [54.0, 13.0, 156.0, -22.0],
        [-13.0, -3.0, -22.0, 4.0],
    ]
)
UNIT = np.eye(3)


@formula
def block_row(ws, x, y, i, scale, mass):
    """Row i of the 3x3 block between two slots: scale times the tangent, and mass times the unit matrix."""
    origin = PLACES[4 * x + y]
    k, c = (origin[0] + i * origin[1]) * LANES, origin[2] * LANES
    return vector(
        scale * load(ws, k) + UNIT[i, 0] * mass,
        scale * load(ws, k + c) + UNIT[i, 1] * mass,
        scale * load(ws, k + 2 * c) + UNIT[i, 2] * mass,
    )


@inline_kernel
def add_nodes(A, place, chunk, row, ws, a, b, scale, mass):
    """Add the 6x6 blocks between the nodes a and b of eight elements to A, row by row.

    ``scale`` are the factors of the four slots, ``mass`` that of the mass and its products by L and L^2.
    """
    for half in range(2):
        x, y = 2 * a + half, 2 * b
        for i in range(3):
            first = block_row(ws, x, y, i, scale[x] * scale[y], MASSES[x, y] * mass[half])
            second = block_row(ws, x, y + 1, i, scale[x] * scale[y + 1], MASSES[x, y + 1] * mass[half + 1])
            scatter_nodes(first, second, A[18 * half + 6 * i :], place, chunk, row)


@inline_kernel
def add_chunk(A, place, order, chunk, ws, scale, mass):
    """Add stiffness blocks and mass of eight elements, whose nodes are blocks of the matrix, to A.

    Rows of ``place`` are those of the first and the second node, and that between them, the rows of which
    belong to the second node where ``order`` is 1.
    """
    add_nodes(A, place, chunk, 0, ws, 0, 0, scale, mass)
    add_nodes(A, place, chunk, 1, ws, 1, 1, scale, mass)
    if order == 1:
        add_nodes(A, place, chunk, 2, ws, 1, 0, scale, mass)
    else:
        add_nodes(A, place, chunk, 2, ws, 0, 1, scale, mass)


def whole_blocks(dest: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Where the nodes of elements are blocks of the matrix.

    Parameters
    ----------
    dest : (n, 16)
        Places of the 3x3 blocks between the slots.

    Returns
    -------
    place : (n, 3)
        Of the 6x6 blocks of both nodes and between them.
    order : (n,)
        1 where the rows of the last one belong to the second node, 2 where to the first, 0 where nodes are
        no blocks.
    """
    d = dest.reshape(-1, 2, 2, 2, 2).transpose(0, 1, 3, 2, 4).reshape(-1, 2, 2, 4)  # by node and node
    whole = (d >= 0).all(axis=3) & (d - d[..., :1] == (0, 3, 18, 21)).all(axis=3)
    both = whole[:, 0, 0] & whole[:, 1, 1]
    order = np.where(both & whole[:, 1, 0], 1, np.where(both & whole[:, 0, 1], 2, 0))
    between = np.where(order == 1, d[:, 1, 0, 0], d[:, 0, 1, 0])
    return np.stack([d[:, 0, 0, 0], d[:, 1, 1, 0], between], axis=1), order


@inline_kernel
def mass_entry(x, y, length):
    """420/(rhoA L) times the integral of S_x S_y of eq. 23."""
    power = x % 2 + y % 2
    return MASSES[x, y] * (1.0 if power == 0 else (length if power == 1 else length * length))


@inline_kernel
def store_tangent(batch, A, ws, chunk, mass):
    """Add stiffness blocks of a chunk, and its mass by the factors rhoA L/420, to the block values A."""
    data = batch.lane_data
    inv_l, length, one = load(data, chunk, INV_L), load(data, chunk, LENGTH), every(1.0)
    if batch.order[chunk] > 0:
        scale, masses = (-inv_l, one, inv_l, one), (mass, mass * length, mass * length * length)
        add_chunk(A, batch.lane_block, batch.order[chunk], chunk, ws, scale, masses)
        return
    store(mass, ws, BLOCKS * LANES)
    for m in range(batch.first[chunk + 1] - batch.first[chunk]):
        e, il, h = batch.first[chunk] + m, data[chunk, INV_L, m], data[chunk, LENGTH, m]
        for x in range(4):
            for y in range(4):
                place = batch.dest[e, 4 * x + y]
                if place >= 0:
                    scale = (il * (x - 1.0) if x % 2 == 0 else 1.0) * (il * (y - 1.0) if y % 2 == 0 else 1.0)
                    own = ws[BLOCKS * LANES + m] * mass_entry(x, y, h)
                    add_block(A, place, ws, PLACES[4 * x + y], m, scale, own)
