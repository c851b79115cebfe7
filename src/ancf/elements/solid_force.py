"""Kernels of the two fully parameterised beams for LANES elements at a time: from a state to the force.

An element is described by nine vectors without dimension, with xi = x/L,

    d = (r_2 - r_1)/L,  t1 = r_x(0),  t2 = r_x(L),
    b1 = r_y(0),  db = r_y(L) - r_y(0),  bx = L r_yx(0)   and the same of r_z: c1, dc, cx,

so that at a Gauss point, one row of the table ``gp``: cd c1 c2 n2 n3 p2 p3 weight,

    a = r_x = cd d + c1 t1 + c2 t2,   b = r_y = b1 + n2 db + n3 bx,   B = L r_yx = p2 db + p3 bx

and c, C likewise from r_z.  The ``original`` element has n3 = p3 = 0.  Powers of L are in the constants.

The energy per length is W = e.s(e)/2 with the scalars of :func:`strains` and their linear stresses.  It is
that of the Green-Lagrange strains in the whole volume, integrated over the section by its moments, which is
exact for sections with two axes of symmetry.
"""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..compiled import formula, inline_kernel
from ..simd import zero
from ..vectors import dot
from .shapes import gauss
from .workspace import add_rows, row, rows, set_rows

# rows of the workspace: the ten vectors of base, three rows each, of which the one of r_2 is not used ...
D, T1, B1, C1, R2, T2, DB, DC, BX, CX = range(0, 30, 3)
VECTORS = 30
FORCE, RATE, ACCELERATION = 30, 60, 90  # ... forces on them, their rates, accelerations of the unknowns
NATURAL = 120  # 15 scalars of the natural shape
# constants of the elements
LENGTH, INV_L, D_A, LAM_A = 135, 136, 137, 138  # D A L, lambda A L
M_Y, M_Z, M_YY, M_ZZ, M_YZ, L_Y, L_Z = 139, 140, 141, 142, 143, 144, 145
G_XY, G_XZ, G_YZ, G_BB, G_CC, G_BC, G_CB = 146, 147, 148, 149, 150, 151, 152
AXIAL, BENDING = 153, 154  # damping
MASS, MASS_Y, MASS_Z, VISCOUS = 155, 156, 157, 158  # rhoA L/420, rho I_z L/60, rho I_y L/60, damping/rhoA
CONSTANTS = 24  # rows from LENGTH to VISCOUS
TANGENT = 159  # see solid_tangent


def gauss_table(points: int, internal: bool) -> FloatArray:
    """Rows of gp, shape (points, 14): behind the weight the factors of r_y1, r_y2 and L r_yx in b and B."""
    x, weight = gauss(points)
    zero, one = np.zeros_like(x), np.ones_like(x)
    n2, n3, p2, p3 = (x * x, x - x * x, 2 * x, 1 - 2 * x) if internal else (x, zero, one, zero)
    axis = (6 * x * (1 - x), 1 - 4 * x + 3 * x * x, 3 * x * x - 2 * x)
    columns = (*axis, n2, n3, p2, p3, weight, 1 - n2, n2, n3, -p2, p2, p3)
    return np.ascontiguousarray(np.stack(columns, axis=1))


@formula
def point(gp, g):
    """Coefficients and weight of Gauss point g."""
    return gp[g, 0], gp[g, 1], gp[g, 2], gp[g, 3], gp[g, 4], gp[g, 5], gp[g, 6], gp[g, 7]


@formula
def vectors(ws, at, first):
    """a, b, B, c, C at a Gauss point of the vectors from row `first` on: D, or RATE for their rates."""
    cd, c1, c2, n2, n3, p2, p3, _ = at
    db, bx, dc, cx = rows(ws, first + DB), rows(ws, first + BX), rows(ws, first + DC), rows(ws, first + CX)
    return (
        cd * rows(ws, first + D) + c1 * rows(ws, first + T1) + c2 * rows(ws, first + T2),
        rows(ws, first + B1) + n2 * db + n3 * bx,
        p2 * db + p3 * bx,
        rows(ws, first + C1) + n2 * dc + n3 * cx,
        p2 * dc + p3 * cx,
    )


@formula
def strains(ws, x):
    """Fifteen scalars, those of the natural shape subtracted.

    eps_0, eps_yy, eps_zz, k_11 = B.B, k_22 = C.C, k_12 = B.C, e_1 = a.B, e_2 = a.C, gamma_xy = a.b,
    gamma_xz = a.c, gamma_yz = b.c, b.B, c.C, b.C, c.B
    """
    a, b, B, c, C = x
    return (
        0.5 * (dot(a, a) - 1.0) - row(ws, NATURAL),
        0.5 * (dot(b, b) - 1.0) - row(ws, NATURAL + 1),
        0.5 * (dot(c, c) - 1.0) - row(ws, NATURAL + 2),
        dot(B, B) - row(ws, NATURAL + 3),
        dot(C, C) - row(ws, NATURAL + 4),
        dot(B, C) - row(ws, NATURAL + 5),
        dot(a, B) - row(ws, NATURAL + 6),
        dot(a, C) - row(ws, NATURAL + 7),
        dot(a, b) - row(ws, NATURAL + 8),
        dot(a, c) - row(ws, NATURAL + 9),
        dot(b, c) - row(ws, NATURAL + 10),
        dot(b, B) - row(ws, NATURAL + 11),
        dot(c, C) - row(ws, NATURAL + 12),
        dot(b, C) - row(ws, NATURAL + 13),
        dot(c, B) - row(ws, NATURAL + 14),
    )


@formula
def stresses(ws, w, e):
    """w dW/de for each of the scalars, times the length."""
    da, la = w * row(ws, D_A), w * row(ws, LAM_A)
    my, mz, ly, lz = w * row(ws, M_Y), w * row(ws, M_Z), w * row(ws, L_Y), w * row(ws, L_Z)
    yz = w * row(ws, M_YZ)
    e0, ey, ez, k11, k22 = e[0], e[1], e[2], e[3], e[4]
    thick = 0.5 * (ly * k11 + lz * k22)
    return (
        da * e0 + la * (ey + ez) + 0.5 * (my * k11 + mz * k22),
        da * ey + la * (e0 + ez) + thick,
        da * ez + la * (e0 + ey) + thick,
        0.5 * (my * e0 + ly * (ey + ez)) + 0.25 * (w * row(ws, M_YY) * k11 + yz * k22),
        0.5 * (mz * e0 + lz * (ey + ez)) + 0.25 * (w * row(ws, M_ZZ) * k22 + yz * k11),
        yz * e[5],
        my * e[6],
        mz * e[7],
        w * row(ws, G_XY) * e[8],
        w * row(ws, G_XZ) * e[9],
        w * row(ws, G_YZ) * e[10],
        w * row(ws, G_BB) * e[11],
        w * row(ws, G_CC) * e[12],
        w * row(ws, G_BC) * e[13],
        w * row(ws, G_CB) * e[14],
    )


@formula
def spread(ws, at, fa, fb, fB, fc, fC):
    """Add forces on a, b, B, c, C at a Gauss point to the rows FORCE."""
    cd, c1, c2, n2, n3, p2, p3, _ = at
    add_rows(ws, FORCE + D, cd * fa)
    add_rows(ws, FORCE + T1, c1 * fa)
    add_rows(ws, FORCE + T2, c2 * fa)
    add_rows(ws, FORCE + B1, fb)
    add_rows(ws, FORCE + DB, n2 * fb + p2 * fB)
    add_rows(ws, FORCE + BX, n3 * fb + p3 * fB)
    add_rows(ws, FORCE + C1, fc)
    add_rows(ws, FORCE + DC, n2 * fc + p2 * fC)
    add_rows(ws, FORCE + CX, n3 * fc + p3 * fC)


@formula
def pulled(s, x):
    """Forces of stresses s on a, b, B, c, C."""
    a, b, B, c, C = x
    return (
        s[0] * a + s[8] * b + s[6] * B + s[9] * c + s[7] * C,
        s[8] * a + s[1] * b + s[11] * B + s[10] * c + s[13] * C,
        s[6] * a + s[11] * b + 2.0 * s[3] * B + s[14] * c + s[5] * C,
        s[9] * a + s[10] * b + s[14] * B + s[2] * c + s[12] * C,
        s[7] * a + s[13] * b + s[5] * B + s[12] * c + 2.0 * s[4] * C,
    )


@inline_kernel
def elastic_force(ws, gp, g):
    """Add the elastic force of Gauss point g to the rows FORCE."""
    at = point(gp, g)
    x = vectors(ws, at, D)
    spread(ws, at, *pulled(stresses(ws, at[7], strains(ws, x)), x))


@inline_kernel
def damping_force(ws, gp, g, rates):
    """Add the force of the axial and bending damping of Gauss point g, of rates from a row on, to FORCE."""
    at = point(gp, g)
    a, _, B, _, C = vectors(ws, at, D)
    da, _, dB, _, dC = vectors(ws, at, rates)
    bending = at[7] * row(ws, BENDING)
    f0 = at[7] * row(ws, AXIAL) * dot(a, da)
    f1 = bending * (dot(a, dB) + dot(B, da))
    f2 = bending * (dot(a, dC) + dot(C, da))
    spread(ws, at, f0 * a + f1 * B + f2 * C, zero(), f1 * a, zero(), f2 * a)


@inline_kernel
def inertia_force(ws, mass):
    """Turn the rows FORCE into forces on the unknowns and add the mass times the rows ACCELERATION.

    ``mass``: see :class:`ancf.elements.solid.SolidBatch`; the centreline has the cable's matrix (eq. 23).
    """
    h, rho = row(ws, LENGTH), row(ws, MASS)
    a1, s1 = rows(ws, ACCELERATION + D), h * rows(ws, ACCELERATION + T1)
    a2, s2 = rows(ws, ACCELERATION + R2), h * rows(ws, ACCELERATION + T2)
    fd, rho_h = row(ws, INV_L) * rows(ws, FORCE + D), rho * h
    set_rows(ws, FORCE + D, rho * (156.0 * a1 + 22.0 * s1 + 54.0 * a2 - 13.0 * s2) - fd)
    add_rows(ws, FORCE + T1, rho_h * (22.0 * a1 + 4.0 * s1 + 13.0 * a2 - 3.0 * s2))
    set_rows(ws, FORCE + R2, rho * (54.0 * a1 + 13.0 * s1 + 156.0 * a2 - 22.0 * s2) + fd)
    add_rows(ws, FORCE + T2, rho_h * (4.0 * s2 - 13.0 * a1 - 3.0 * s1 - 22.0 * a2))
    section_inertia(ws, mass, row(ws, MASS_Y), 0)
    section_inertia(ws, mass, row(ws, MASS_Z), C1 - B1)


@formula
def section_inertia(ws, mass, rho, o):
    """The same for the unknowns of r_y, or those of r_z, which are `o` rows behind."""
    m11, m12, m22, m13, m23, m33 = mass[2, 2], mass[2, 6], mass[6, 6], mass[2, 8], mass[6, 8], mass[8, 8]
    h, first = row(ws, LENGTH), ACCELERATION + o
    x1, x2, x3 = rows(ws, first + B1), rows(ws, first + DB), h * rows(ws, first + BX)
    add_rows(ws, FORCE + o + B1, rho * (m11 * x1 + m12 * x2 + m13 * x3) - rows(ws, FORCE + o + DB))
    add_rows(ws, FORCE + o + DB, rho * (m12 * x1 + m22 * x2 + m23 * x3))
    fx = rows(ws, FORCE + o + BX) + rho * (m13 * x1 + m23 * x2 + m33 * x3)
    set_rows(ws, FORCE + o + BX, h * fx)
