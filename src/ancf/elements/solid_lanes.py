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
from ..vectors import dot
from .lanes import LANES
from .shapes import gauss

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
    """Coefficients and weight of Gauss point g.  A loop over lanes that reads gp itself is not vectorised."""
    return gp[g, 0], gp[g, 1], gp[g, 2], gp[g, 3], gp[g, 4], gp[g, 5], gp[g, 6], gp[g, 7]


@formula
def add(u, x, v):
    """Vector u + x v."""
    return u[0] + x * v[0], u[1] + x * v[1], u[2] + x * v[2]


@formula
def scaled(x, v):
    """Vector x v."""
    return x * v[0], x * v[1], x * v[2]


@formula
def row(ws, i):
    """Vector of one lane that starts at i."""
    return ws[i], ws[i + LANES], ws[i + 2 * LANES]


@formula
def vectors(ws, at, o):
    """a, b, B, c, C at a Gauss point; ``o``: lane, plus RATE * LANES for their rates."""
    cd, c1, c2, n2, n3, p2, p3, _ = at
    a = scaled(cd, row(ws, o + D * LANES))
    a = add(add(a, c1, row(ws, o + T1 * LANES)), c2, row(ws, o + T2 * LANES))
    db, bx, dc, cx = (
        row(ws, o + DB * LANES),
        row(ws, o + BX * LANES),
        row(ws, o + DC * LANES),
        row(ws, o + CX * LANES),
    )
    b = add(add(row(ws, o + B1 * LANES), n2, db), n3, bx)
    c = add(add(row(ws, o + C1 * LANES), n2, dc), n3, cx)
    return a, b, add(scaled(p2, db), p3, bx), c, add(scaled(p2, dc), p3, cx)


@formula
def strains(ws, x, m):
    """Fifteen scalars, those of the natural shape subtracted.

    eps_0, eps_yy, eps_zz, k_11 = B.B, k_22 = C.C, k_12 = B.C, e_1 = a.B, e_2 = a.C, gamma_xy = a.b,
    gamma_xz = a.c, gamma_yz = b.c, b.B, c.C, b.C, c.B
    """
    a, b, B, c, C = x
    return (
        0.5 * (dot(a, a) - 1.0) - ws[NATURAL * LANES + m],
        0.5 * (dot(b, b) - 1.0) - ws[(NATURAL + 1) * LANES + m],
        0.5 * (dot(c, c) - 1.0) - ws[(NATURAL + 2) * LANES + m],
        dot(B, B) - ws[(NATURAL + 3) * LANES + m],
        dot(C, C) - ws[(NATURAL + 4) * LANES + m],
        dot(B, C) - ws[(NATURAL + 5) * LANES + m],
        dot(a, B) - ws[(NATURAL + 6) * LANES + m],
        dot(a, C) - ws[(NATURAL + 7) * LANES + m],
        dot(a, b) - ws[(NATURAL + 8) * LANES + m],
        dot(a, c) - ws[(NATURAL + 9) * LANES + m],
        dot(b, c) - ws[(NATURAL + 10) * LANES + m],
        dot(b, B) - ws[(NATURAL + 11) * LANES + m],
        dot(c, C) - ws[(NATURAL + 12) * LANES + m],
        dot(b, C) - ws[(NATURAL + 13) * LANES + m],
        dot(c, B) - ws[(NATURAL + 14) * LANES + m],
    )


@formula
def stresses(ws, w, e, m):
    """w dW/de for each of the scalars, times the length."""
    da, la = w * ws[D_A * LANES + m], w * ws[LAM_A * LANES + m]
    my, mz = w * ws[M_Y * LANES + m], w * ws[M_Z * LANES + m]
    ly, lz = w * ws[L_Y * LANES + m], w * ws[L_Z * LANES + m]
    yz = w * ws[M_YZ * LANES + m]
    e0, ey, ez, k11, k22 = e[0], e[1], e[2], e[3], e[4]
    thick = 0.5 * (ly * k11 + lz * k22)
    return (
        da * e0 + la * (ey + ez) + 0.5 * (my * k11 + mz * k22),
        da * ey + la * (e0 + ez) + thick,
        da * ez + la * (e0 + ey) + thick,
        0.5 * (my * e0 + ly * (ey + ez)) + 0.25 * (w * ws[M_YY * LANES + m] * k11 + yz * k22),
        0.5 * (mz * e0 + lz * (ey + ez)) + 0.25 * (w * ws[M_ZZ * LANES + m] * k22 + yz * k11),
        yz * e[5],
        my * e[6],
        mz * e[7],
        w * ws[G_XY * LANES + m] * e[8],
        w * ws[G_XZ * LANES + m] * e[9],
        w * ws[G_YZ * LANES + m] * e[10],
        w * ws[G_BB * LANES + m] * e[11],
        w * ws[G_CC * LANES + m] * e[12],
        w * ws[G_BC * LANES + m] * e[13],
        w * ws[G_CB * LANES + m] * e[14],
    )


@formula
def sum5(x, s, t, u, v, w):
    """Sum of the five vectors with factors."""
    a, b, B, c, C = x
    return add(add(add(add(scaled(s, a), t, b), u, B), v, c), w, C)


@formula
def spread(ws, at, f, m):
    """Add forces on a, b, B, c, C at a Gauss point to the rows FORCE."""
    cd, c1, c2, n2, n3, p2, p3, _ = at
    fa, fb, fB, fc, fC = f
    for k in range(3):
        o = (FORCE + k) * LANES + m
        ws[o + D * LANES] += cd * fa[k]
        ws[o + T1 * LANES] += c1 * fa[k]
        ws[o + T2 * LANES] += c2 * fa[k]
        ws[o + B1 * LANES] += fb[k]
        ws[o + DB * LANES] += n2 * fb[k] + p2 * fB[k]
        ws[o + BX * LANES] += n3 * fb[k] + p3 * fB[k]
        ws[o + C1 * LANES] += fc[k]
        ws[o + DC * LANES] += n2 * fc[k] + p2 * fC[k]
        ws[o + CX * LANES] += n3 * fc[k] + p3 * fC[k]


@inline_kernel
def elastic_force(ws, gp, g):
    """Add the elastic force of Gauss point g to the rows FORCE."""
    at = point(gp, g)
    for m in range(LANES):
        x = vectors(ws, at, m)
        s = stresses(ws, at[7], strains(ws, x, m), m)
        fa = sum5(x, s[0], s[8], s[6], s[9], s[7])
        fb = sum5(x, s[8], s[1], s[11], s[10], s[13])
        fB = sum5(x, s[6], s[11], 2.0 * s[3], s[14], s[5])
        fc = sum5(x, s[9], s[10], s[14], s[2], s[12])
        fC = sum5(x, s[7], s[13], s[5], s[12], 2.0 * s[4])
        spread(ws, at, (fa, fb, fB, fc, fC), m)


@inline_kernel
def damping_force(ws, gp, g):
    """Add the force of the axial and bending damping of Gauss point g to the rows FORCE."""
    at = point(gp, g)
    for m in range(LANES):
        a, _, B, _, C = vectors(ws, at, m)
        da, _, dB, _, dC = vectors(ws, at, RATE * LANES + m)
        bending = at[7] * ws[BENDING * LANES + m]
        f0 = at[7] * ws[AXIAL * LANES + m] * dot(a, da)
        f1 = bending * (dot(a, dB) + dot(B, da))
        f2 = bending * (dot(a, dC) + dot(C, da))
        none = (0.0, 0.0, 0.0)
        fa = add(add(scaled(f0, a), f1, B), f2, C)
        spread(ws, at, (fa, none, scaled(f1, a), none, scaled(f2, a)), m)


@inline_kernel
def inertia_force(ws, mass):
    """Turn the rows FORCE into forces on the unknowns and add the mass times the rows ACCELERATION.

    ``mass``: see :class:`ancf.elements.solid.SolidBatch`; the centreline has the cable's matrix (eq. 23).
    """
    m11, m12, m22, m13, m23, m33 = mass[2, 2], mass[2, 6], mass[6, 6], mass[2, 8], mass[6, 8], mass[8, 8]
    for m in range(LANES):
        h, il, rho = ws[LENGTH * LANES + m], ws[INV_L * LANES + m], ws[MASS * LANES + m]
        for k in range(3):
            f, i = (FORCE + k) * LANES + m, (ACCELERATION + k) * LANES + m
            a1, s1 = ws[i + D * LANES], h * ws[i + T1 * LANES]
            a2, s2 = ws[i + R2 * LANES], h * ws[i + T2 * LANES]
            fd = il * ws[f + D * LANES]
            ws[f + D * LANES] = rho * (156 * a1 + 22 * s1 + 54 * a2 - 13 * s2) - fd
            ws[f + T1 * LANES] += rho * h * (22 * a1 + 4 * s1 + 13 * a2 - 3 * s2)
            ws[f + R2 * LANES] = rho * (54 * a1 + 13 * s1 + 156 * a2 - 22 * s2) + fd
            ws[f + T2 * LANES] += rho * h * (-13 * a1 - 3 * s1 - 22 * a2 + 4 * s2)
    for m in range(LANES):
        h = ws[LENGTH * LANES + m]
        for n in range(6):  # components of r_y, then of r_z
            rho = ws[(MASS_Y + n // 3) * LANES + m]
            f, i = (FORCE + n) * LANES + m, (ACCELERATION + n) * LANES + m
            x1, x2, x3 = ws[i + B1 * LANES], ws[i + DB * LANES], h * ws[i + BX * LANES]
            f2 = ws[f + DB * LANES]
            ws[f + B1 * LANES] += rho * (m11 * x1 + m12 * x2 + m13 * x3) - f2
            ws[f + DB * LANES] += rho * (m12 * x1 + m22 * x2 + m23 * x3)
            ws[f + BX * LANES] = h * (ws[f + BX * LANES] + rho * (m13 * x1 + m23 * x2 + m33 * x3))
