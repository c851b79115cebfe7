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
from ..simd import every, vector
from .cable_strain import dyads
from .solid_force import (
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
    D,
    point,
    strains,
    stresses,
    vectors,
)
from .workspace import ROWS, add_row, row, set_rows

# 3x3 blocks of a Gauss point, nine rows each, in the order in which spread_tangent needs them
A_A, A_B, A_BB, A_C, A_CC = (TANGENT + 9 * k for k in range(5))
B_B, B_BB, BB_B, BB_BB = (TANGENT + 9 * k for k in range(5, 9))
C_C, C_CC, CC_C, CC_CC = (TANGENT + 9 * k for k in range(9, 13))
B_C, B_CC, BB_C, BB_CC = (TANGENT + 9 * k for k in range(13, 17))
#: 3x3 blocks of the element's vectors d t1 t2 b1 b2 bx c1 c2 cx, those on and above the diagonal.
OF_POINT = 9 * 17
ELEMENT = TANGENT + OF_POINT
BLOCKS = 45
if ELEMENT + 9 * BLOCKS > ROWS:
    raise AssertionError("the workspace is too small")


@formula
def put(ws, first, T, H, h, x, y):
    """Block T I + H x y^T + h y x^T in the nine rows from `first` on."""
    none = every(0.0)
    put_rows(ws, first, dyads(T, x, y, none, H, h, none))


@formula
def put_rows(ws, first, block):
    """A block, three rows of a matrix."""
    set_rows(ws, first, block[0])
    set_rows(ws, first + 3, block[1])
    set_rows(ws, first + 6, block[2])


@formula
def put_diagonal(ws, first, T, ha, hb, hB, hc, hC, x):
    """Block T I + sum of moduli times the squares of the five vectors."""
    a, b, B, c, C = x
    ua, ub, uB, uc, uC, none = ha * a, hb * b, hB * B, hc * c, hC * C, every(0.0)
    put_rows(
        ws,
        first,
        (
            ua[0] * a + ub[0] * b + uB[0] * B + uc[0] * c + uC[0] * C + vector(T, none, none),
            ua[1] * a + ub[1] * b + uB[1] * B + uc[1] * c + uC[1] * C + vector(none, T, none),
            ua[2] * a + ub[2] * b + uB[2] * B + uc[2] * c + uC[2] * C + vector(none, none, T),
        ),
    )


@inline_kernel
def diagonal_blocks(ws, gp, g, w, damping):
    """Blocks of a Gauss point of one vector; ``w``: its weight, ``damping``: that of the dampers."""
    x = vectors(ws, point(gp, g), D)
    s = stresses(ws, w, strains(ws, x))
    da = w * row(ws, D_A)
    ab, ac, bc = w * row(ws, G_XY), w * row(ws, G_XZ), w * row(ws, G_YZ)
    bB, cC, bC, cB = w * row(ws, G_BB), w * row(ws, G_CC), w * row(ws, G_BC), w * row(ws, G_CB)
    BB, BC, CC = w * row(ws, M_YY), w * row(ws, M_YZ), w * row(ws, M_ZZ)
    aa, bend = da + damping * row(ws, AXIAL), damping * row(ws, BENDING)
    aB, aC = w * row(ws, M_Y) + bend, w * row(ws, M_Z) + bend
    put_diagonal(ws, A_A, s[0], aa, ab, aB, ac, aC, x)
    put_diagonal(ws, B_B, s[1], ab, da, bB, bc, bC, x)
    put_diagonal(ws, C_C, s[2], ac, bc, cB, da, cC, x)
    put_diagonal(ws, BB_BB, 2.0 * s[3], aB, bB, BB, cB, BC, x)
    put_diagonal(ws, CC_CC, 2.0 * s[4], aC, bC, BC, cC, CC, x)


@inline_kernel
def other_blocks(ws, gp, g, w, damping):
    """Blocks of a Gauss point of two different vectors."""
    x = vectors(ws, point(gp, g), D)
    s = stresses(ws, w, strains(ws, x))
    a, b, B, c, C = x
    la, bend = w * row(ws, LAM_A), damping * row(ws, BENDING)
    my, mz, yz = w * row(ws, M_Y), w * row(ws, M_Z), w * row(ws, M_YZ)
    ly, lz = w * row(ws, L_Y), w * row(ws, L_Z)
    bB, cC = w * row(ws, G_BB), w * row(ws, G_CC)
    put(ws, A_B, s[8], la, w * row(ws, G_XY), a, b)
    put(ws, A_C, s[9], la, w * row(ws, G_XZ), a, c)
    put(ws, B_C, s[10], la, w * row(ws, G_YZ), b, c)
    put(ws, A_BB, s[6], my, my + bend, a, B)
    put(ws, A_CC, s[7], mz, mz + bend, a, C)
    put(ws, BB_CC, s[5], yz, yz, B, C)
    put(ws, B_BB, s[11], ly, bB, b, B)
    put(ws, BB_B, s[11], ly, bB, B, b)
    put(ws, C_CC, s[12], lz, cC, c, C)
    put(ws, CC_C, s[12], lz, cC, C, c)
    put(ws, B_CC, s[13], lz, w * row(ws, G_BC), b, C)
    put(ws, BB_C, s[14], ly, w * row(ws, G_CB), B, c)


@inline_kernel
def damping_blocks(ws, gp, g, damping):
    """Blocks of a Gauss point of the dampers alone, see :func:`spread_dampers`."""
    at, none = point(gp, g), every(0.0)
    a, _, B, _, C = vectors(ws, at, D)
    axial, bend = damping * row(ws, AXIAL), damping * row(ws, BENDING)
    put_diagonal(ws, A_A, none, axial, none, bend, none, bend, (a, a, B, a, C))
    put(ws, A_BB, none, none, bend, a, B)
    put(ws, A_CC, none, none, bend, a, C)
    put(ws, BB_BB, none, bend, none, a, a)
    put(ws, CC_CC, none, bend, none, a, a)


@formula
def element_row(x, y):
    """First row of the block of the element's vectors x <= y."""
    return ELEMENT + 9 * (x * (17 - x) // 2 + y)


@inline_kernel
def add2(ws, to, first, s, t):
    """Add s and t times the blocks at rows ``first`` and next to it to the block at row ``to``."""
    for n in range(9):
        add_row(ws, to + n, s * row(ws, first + n) + t * row(ws, first + 9 + n))


@inline_kernel
def add4(ws, to, first, s, S, t, T):
    """Add s t, s T, S t and S T times four blocks from row ``first`` on to the block at row ``to``."""
    for n in range(9):
        x = t * row(ws, first + n) + T * row(ws, first + 9 + n)
        y = t * row(ws, first + 18 + n) + T * row(ws, first + 27 + n)
        add_row(ws, to + n, s * x + S * y)


@inline_kernel
def spread_tangent(ws, gp, g, own):
    """Add the blocks of Gauss point g to those of the element; ``own``: vectors of r_y, 2 or 3."""
    for x in range(3):
        s = gp[g, x]
        for y in range(x, 3):
            add2(ws, element_row(x, y), A_A, s * gp[g, y], 0.0)
        for axis in range(2):
            for y in range(own):
                to = element_row(x, 3 + 3 * axis + y)
                add2(ws, to, A_B + 18 * axis, s * gp[g, 8 + y], s * gp[g, 11 + y])
    for pair in range(3):  # of r_y with itself, of r_z with itself, of r_y with r_z
        first, second = (6 if pair == 1 else 3), (3 if pair == 0 else 6)
        for x in range(own):
            for y in range(0 if pair == 2 else x, own):
                to = element_row(first + x, second + y)
                add4(ws, to, B_B + 36 * pair, gp[g, 8 + x], gp[g, 11 + x], gp[g, 8 + y], gp[g, 11 + y])


@inline_kernel
def add1(ws, to, first, s):
    """Add s times the block at row ``first`` to the block at row ``to``."""
    for n in range(9):
        add_row(ws, to + n, s * row(ws, first + n))


@inline_kernel
def spread_dampers(ws, gp, g, own):
    """As :func:`spread_tangent`, where there are no blocks of r_y and r_z but those of their slopes."""
    for x in range(3):
        s = gp[g, x]
        for y in range(x, 3):
            add1(ws, element_row(x, y), A_A, s * gp[g, y])
        for axis in range(2):
            for y in range(own):
                add1(ws, element_row(x, 3 + 3 * axis + y), A_BB + 18 * axis, s * gp[g, 11 + y])
    for axis in range(2):
        first = 3 + 3 * axis
        for x in range(own):
            for y in range(x, own):
                to = element_row(first + x, first + y)
                add1(ws, to, BB_BB + 36 * axis, gp[g, 11 + x] * gp[g, 11 + y])


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
