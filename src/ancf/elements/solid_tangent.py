"""Kernels of the two fully parameterised beams for LANES elements at a time: the element's tangent.

With x_i the five vectors a, b, B, c, C of a Gauss point, T_ij the stresses of their scalar products and
H_ij, h_ij the moduli of the strains that belong to x_i and x_j alone and to their product,

    d2W/dx_i dx_j = T_ij I + H_ij x_i x_j^T + h_ij x_j x_i^T          (i != j)
    d2W/dx_i dx_i = T_ii I + H_ii x_i x_i^T + sum_j h_ij x_j x_j^T.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..compiled import formula, inline_kernel
from .lanes import LANES, ROWS
from .solid_lanes import (
    AXIAL,
    BENDING,
    D_A,
    G_BB,
    G_BC,
    G_CB,
    G_CC,
    G_XY,
    G_XZ,
    G_YZ,
    L_Y,
    L_Z,
    LAM_A,
    M_Y,
    M_YY,
    M_YZ,
    M_Z,
    M_ZZ,
    TANGENT,
    point,
    strains,
    stresses,
    vectors,
)

# 3x3 blocks of a Gauss point, nine rows each, in the order in which spread_tangent needs them
A_A, A_B, A_BB, A_C, A_CC = (TANGENT + 9 * k for k in range(5))
B_B, B_BB, BB_B, BB_BB = (TANGENT + 9 * k for k in range(5, 9))
C_C, C_CC, CC_C, CC_CC = (TANGENT + 9 * k for k in range(9, 13))
B_C, B_CC, BB_C, BB_CC = (TANGENT + 9 * k for k in range(13, 17))
#: 3x3 blocks of the element's vectors d t1 t2 b1 b2 bx c1 c2 cx, those on and above the diagonal.
ELEMENT = TANGENT + 9 * 17
BLOCKS = 45
if ELEMENT + 9 * BLOCKS > ROWS:
    raise AssertionError("the workspace is too small")


@formula
def put(ws, o, T, H, h, x, y):
    """Block T I + H x y^T + h y x^T of one lane, which starts at o."""
    for k in range(3):
        for n in range(3):
            ws[o + (3 * k + n) * LANES] = H * x[k] * y[n] + h * y[k] * x[n] + (T if k == n else 0.0)


@formula
def put_diagonal(ws, o, T, ha, hb, hB, hc, hC, x):
    """Block T I + sum of moduli times the squares of the five vectors."""
    a, b, B, c, C = x
    for k in range(3):
        for n in range(k, 3):
            value = ha * a[k] * a[n] + hb * b[k] * b[n] + hB * B[k] * B[n] + hc * c[k] * c[n]
            value += hC * C[k] * C[n] + (T if k == n else 0.0)
            ws[o + (3 * k + n) * LANES] = value
            ws[o + (3 * n + k) * LANES] = value


@inline_kernel
def diagonal_blocks(ws, gp, g, w, damping):
    """Blocks of a Gauss point of one vector; ``w``: its weight, ``damping``: that of the dampers."""
    at = point(gp, g)
    for m in range(LANES):
        x = vectors(ws, at, m)
        s = stresses(ws, w, strains(ws, x, m), m)
        da = w * ws[D_A * LANES + m]
        ab, ac, bc = w * ws[G_XY * LANES + m], w * ws[G_XZ * LANES + m], w * ws[G_YZ * LANES + m]
        bB, cC = w * ws[G_BB * LANES + m], w * ws[G_CC * LANES + m]
        bC, cB = w * ws[G_BC * LANES + m], w * ws[G_CB * LANES + m]
        BB, BC, CC = w * ws[M_YY * LANES + m], w * ws[M_YZ * LANES + m], w * ws[M_ZZ * LANES + m]
        aa, bend = da + damping * ws[AXIAL * LANES + m], damping * ws[BENDING * LANES + m]
        aB, aC = w * ws[M_Y * LANES + m] + bend, w * ws[M_Z * LANES + m] + bend
        put_diagonal(ws, A_A * LANES + m, s[0], aa, ab, aB, ac, aC, x)
        put_diagonal(ws, B_B * LANES + m, s[1], ab, da, bB, bc, bC, x)
        put_diagonal(ws, C_C * LANES + m, s[2], ac, bc, cB, da, cC, x)
        put_diagonal(ws, BB_BB * LANES + m, 2.0 * s[3], aB, bB, BB, cB, BC, x)
        put_diagonal(ws, CC_CC * LANES + m, 2.0 * s[4], aC, bC, BC, cC, CC, x)


@inline_kernel
def other_blocks(ws, gp, g, w, damping):
    """Blocks of a Gauss point of two different vectors."""
    at = point(gp, g)
    for m in range(LANES):
        x = vectors(ws, at, m)
        s = stresses(ws, w, strains(ws, x, m), m)
        a, b, B, c, C = x
        la, bend = w * ws[LAM_A * LANES + m], damping * ws[BENDING * LANES + m]
        my, mz, yz = w * ws[M_Y * LANES + m], w * ws[M_Z * LANES + m], w * ws[M_YZ * LANES + m]
        ly, lz = w * ws[L_Y * LANES + m], w * ws[L_Z * LANES + m]
        bB, cC = w * ws[G_BB * LANES + m], w * ws[G_CC * LANES + m]
        put(ws, A_B * LANES + m, s[8], la, w * ws[G_XY * LANES + m], a, b)
        put(ws, A_C * LANES + m, s[9], la, w * ws[G_XZ * LANES + m], a, c)
        put(ws, B_C * LANES + m, s[10], la, w * ws[G_YZ * LANES + m], b, c)
        put(ws, A_BB * LANES + m, s[6], my, my + bend, a, B)
        put(ws, A_CC * LANES + m, s[7], mz, mz + bend, a, C)
        put(ws, BB_CC * LANES + m, s[5], yz, yz, B, C)
        put(ws, B_BB * LANES + m, s[11], ly, bB, b, B)
        put(ws, BB_B * LANES + m, s[11], ly, bB, B, b)
        put(ws, C_CC * LANES + m, s[12], lz, cC, c, C)
        put(ws, CC_C * LANES + m, s[12], lz, cC, C, c)
        put(ws, B_CC * LANES + m, s[13], lz, w * ws[G_BC * LANES + m], b, C)
        put(ws, BB_C * LANES + m, s[14], ly, w * ws[G_CB * LANES + m], B, c)


@formula
def element_row(x, y):
    """First row of the block of the element's vectors x <= y."""
    return ELEMENT + 9 * (x * (17 - x) // 2 + y)


@formula
def unsigned(row):
    """Place of a row in ws.  Of an unsigned index the compiler knows that it does not count from the end."""
    return np.uint64(row * LANES)


@inline_kernel
def add2(ws, row, first, s, t):
    """Add s and t times the blocks at rows ``first`` and next to it to the block at ``row``."""
    i, j, k = unsigned(row), unsigned(first), unsigned(first + 9)
    for n in range(np.uint64(9 * LANES)):
        ws[i + n] += s * ws[j + n] + t * ws[k + n]


@inline_kernel
def add4(ws, row, first, s, S, t, T):
    """Add s t, s T, S t and S T times the blocks at rows ``first`` and behind it to the block at ``row``."""
    i, j, k = unsigned(row), unsigned(first), unsigned(first + 9)
    p, q = unsigned(first + 18), unsigned(first + 27)
    u, v, w, z = s * t, s * T, S * t, S * T
    for n in range(np.uint64(9 * LANES)):
        ws[i + n] += u * ws[j + n] + v * ws[k + n] + w * ws[p + n] + z * ws[q + n]


@inline_kernel
def spread_tangent(ws, gp, g, own):
    """Add the blocks of Gauss point g to those of the element; ``own``: vectors of r_y, 2 or 3."""
    for x in range(3):
        s = gp[g, x]
        for y in range(x, 3):
            add2(ws, element_row(x, y), A_A, s * gp[g, y], 0.0)
        for axis in range(2):
            for y in range(own):
                row = element_row(x, 3 + 3 * axis + y)
                add2(ws, row, A_B + 18 * axis, s * gp[g, 8 + y], s * gp[g, 11 + y])
    for pair in range(3):  # of r_y with itself, of r_z with itself, of r_y with r_z
        first, second = (6 if pair == 1 else 3), (3 if pair == 0 else 6)
        for x in range(own):
            for y in range(0 if pair == 2 else x, own):
                row = element_row(first + x, second + y)
                add4(ws, row, B_B + 36 * pair, gp[g, 8 + x], gp[g, 11 + x], gp[g, 8 + y], gp[g, 11 + y])


def _places() -> NDArray[np.int64]:
    """First row and strides of the block of the columns x and y of base, shape (10, 10, 3)."""
    part = (0, 1, 3, 6, 0, 2, 4, 7, 5, 8)  # r1 and r2 act through d
    places = np.empty((10, 10, 3), dtype=np.int64)
    for x, i in enumerate(part):
        for y, j in enumerate(part):
            low, high = min(i, j), max(i, j)
            row = ELEMENT + 9 * (low * (17 - low) // 2 + high)
            places[x, y] = (row, 3, 1) if i <= j else (row, 1, 3)
    return places


PLACES = _places()
