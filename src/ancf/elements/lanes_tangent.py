"""Kernels of the cable for LANES elements at a time: from a Gauss point to the element's tangent."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..compiled import inline_kernel
from .lanes import INV_L, K11, K12, K22, KD1, KD2, KDD, KPP, KPS, KSS, LANES

BLOCKS = 54  # rows of the six 3x3 blocks that start at KDD


@inline_kernel
def symmetric_row(i, j):
    """Row of entry (i, j) in the six stored entries 00 01 02 11 12 22."""
    if i > j:
        i, j = j, i
    return j if i == 0 else i + j + 1


@inline_kernel
def spread_axial(ws, gp, g):
    """Add the rows KPP of Gauss point ``g`` to the 3x3 blocks of (d, t1, t2)."""
    cd, c1, c2 = gp[g, 0], gp[g, 1], gp[g, 2]
    dd, d1, d2, c11, c12, c22 = cd * cd, cd * c1, cd * c2, c1 * c1, c1 * c2, c2 * c2
    for i in range(3):
        for j in range(3):
            n = 3 * i + j
            k = KPP + symmetric_row(i, j)
            for m in range(LANES):
                h = ws[k * LANES + m]
                ws[(KDD + n) * LANES + m] += dd * h
                ws[(KD1 + n) * LANES + m] += d1 * h
                ws[(KD2 + n) * LANES + m] += d2 * h
                ws[(K11 + n) * LANES + m] += c11 * h
                ws[(K12 + n) * LANES + m] += c12 * h
                ws[(K22 + n) * LANES + m] += c22 * h


@inline_kernel
def spread_bending(ws, gp, g):
    """Add the rows KPP, KPS, KSS of Gauss point ``g`` to the 3x3 blocks of (d, t1, t2)."""
    cd, c1, c2, ed, e1, e2 = gp[g, 0], gp[g, 1], gp[g, 2], gp[g, 3], gp[g, 4], gp[g, 5]
    for i in range(3):
        for j in range(3):
            n = 3 * i + j
            row = symmetric_row(i, j)
            for m in range(LANES):
                il = ws[INV_L * LANES + m]
                pp = ws[(KPP + row) * LANES + m]
                ps = ws[(KPS + n) * LANES + m] * il
                sp = ws[(KPS + 3 * j + i) * LANES + m] * il
                ss = ws[(KSS + row) * LANES + m] * il * il
                pd, sd = cd * pp + ed * sp, cd * ps + ed * ss
                p1, s1 = c1 * pp + e1 * sp, c1 * ps + e1 * ss
                p2, s2 = c2 * pp + e2 * sp, c2 * ps + e2 * ss
                ws[(KDD + n) * LANES + m] += pd * cd + sd * ed
                ws[(KD1 + n) * LANES + m] += pd * c1 + sd * e1
                ws[(KD2 + n) * LANES + m] += pd * c2 + sd * e2
                ws[(K11 + n) * LANES + m] += p1 * c1 + s1 * e1
                ws[(K12 + n) * LANES + m] += p1 * c2 + s1 * e2
                ws[(K22 + n) * LANES + m] += p2 * c2 + s2 * e2


@inline_kernel
def add_block(A, place, ws, origin, m, scale, mass):
    """Add scale times a 3x3 block of lane m, and mass times the unit matrix, to A at ``place``."""
    first, row, column = origin[0] * LANES + m, origin[1] * LANES, origin[2] * LANES
    if min(place, first, row, column) < 0:
        return  # never: but now the compiler knows that no index counts from the end
    for i in range(3):
        A[place + 7 * i] += mass
        for j in range(3):
            A[place + 6 * i + j] += scale * ws[first + i * row + j * column]


def _places() -> NDArray[np.int64]:
    """First row and strides of the 3x3 block between slots x and y of (r1, r_x1, r2, r_x2), shape (16, 3)."""
    blocks = {(0, 0): KDD, (0, 1): KD1, (0, 2): KD2, (1, 1): K11, (1, 2): K12, (2, 2): K22}
    part = (0, 1, 0, 2)  # r1 and r2 act through d
    rows = []
    for x in range(4):
        for y in range(4):
            i, j = part[x], part[y]
            rows.append((blocks[i, j], 3, 1) if i <= j else (blocks[j, i], 1, 3))
    return np.array(rows, dtype=np.int64)


PLACES = _places()
