"""Kelvin-Voigt and slope damping of the cable for LANES elements at a time.

Axial: N = EA eps + D_a d(eps)/dt.  Bending: the curvature vector n = (r_xx - t (t.r_xx))/|r_x|^k lies
in the normal plane (k = 2 for paper strains, 1 for material ones, |n| = kappa).  Its rate seen from a
frame that does not spin about the tangent is the normal part of dn/dt, here y; it is linear in the
velocities and smooth for a straight cable.  The cable has no torsional stiffness, so a spin of n about
the tangent must not be damped: of y only the part along n counts once the cable is bent,

    power = D_b y . X y,   X = (delta^2 I + n n^T) / (kappa^2 + delta^2),   delta = STRAIGHT / L.

Slopes: power = c int |v_x|^2 dx, exactly integrated; c L/30 is the row SLOPE and the matrix on the rates of
(d, t1, t2) is c L/30 (36 -3 -3; -3 4 -1; -3 -1 4).
"""

from __future__ import annotations

import math

from ..compiled import inline_kernel
from ..vectors import dot
from .lanes import (
    DA_L,
    DB_L,
    EA_L,
    F1,
    F2,
    FD,
    INV_L,
    K11,
    K12,
    K22,
    KD1,
    KD2,
    KDD,
    KPP,
    KPS,
    KSS,
    LANES,
    LENGTH,
    REFERENCE,
    SLOPE,
    STRAIGHT,
    V1,
    V2,
    VD,
    D,
)


@inline_kernel
def shape_at(ws, gp, g, first, m):
    """r_x and r_xx (or their rates) of lane m at Gauss point g, from the nine rows at ``first``."""
    cd, c1, c2, ed, e1, e2 = gp[g, 0], gp[g, 1], gp[g, 2], gp[g, 3], gp[g, 4], gp[g, 5]
    il = ws[INV_L * LANES + m]
    dx, dy, dz = ws[first * LANES + m], ws[(first + 1) * LANES + m], ws[(first + 2) * LANES + m]
    ux, uy, uz = ws[(first + 3) * LANES + m], ws[(first + 4) * LANES + m], ws[(first + 5) * LANES + m]
    wx, wy, wz = ws[(first + 6) * LANES + m], ws[(first + 7) * LANES + m], ws[(first + 8) * LANES + m]
    p = (cd * dx + c1 * ux + c2 * wx, cd * dy + c1 * uy + c2 * wy, cd * dz + c1 * uz + c2 * wz)
    s = (
        (ed * dx + e1 * ux + e2 * wx) * il,
        (ed * dy + e1 * uy + e2 * wy) * il,
        (ed * dz + e1 * uz + e2 * wz) * il,
    )
    return p, s


@inline_kernel
def bending_rate(p, s, dp, ds, paper, length):
    """X y of the curvature vector's rate y, and the numbers that the force needs."""
    a = dot(p, p)
    b = dot(p, s)
    ba = b / a
    z = (s[0] - ba * p[0], s[1] - ba * p[1], s[2] - ba * p[2])
    k = 2.0 if paper else 1.0
    g = 1.0 / a if paper else 1.0 / math.sqrt(a)
    pdp, pds = dot(p, dp) / a, dot(p, ds) / a
    f = pds - ba * pdp  # projects ds - (b/a) dp on the normal plane
    y = (
        g * (ds[0] - ba * dp[0] - f * p[0] - k * pdp * z[0]),
        g * (ds[1] - ba * dp[1] - f * p[1] - k * pdp * z[1]),
        g * (ds[2] - ba * dp[2] - f * p[2] - k * pdp * z[2]),
    )
    delta = STRAIGHT / length
    nu = 1.0 / (g * g * dot(z, z) + delta * delta)
    along = g * g * nu * dot(z, y)
    e = delta * delta * nu
    xy = (e * y[0] + along * z[0], e * y[1] + along * z[1], e * y[2] + along * z[2])
    return xy, z, a, ba, g, k, nu


@inline_kernel
def damped_axial_force(ws, gp, g, paper):
    """Add the elastic and the damping force along the axis of Gauss point g, see ``axial_force``."""
    cd, c1, c2, w = gp[g, 0], gp[g, 1], gp[g, 2], gp[g, 6]
    for m in range(LANES):
        px = cd * ws[0 * LANES + m] + c1 * ws[3 * LANES + m] + c2 * ws[6 * LANES + m]
        py = cd * ws[1 * LANES + m] + c1 * ws[4 * LANES + m] + c2 * ws[7 * LANES + m]
        pz = cd * ws[2 * LANES + m] + c1 * ws[5 * LANES + m] + c2 * ws[8 * LANES + m]
        ux = cd * ws[18 * LANES + m] + c1 * ws[21 * LANES + m] + c2 * ws[24 * LANES + m]
        uy = cd * ws[19 * LANES + m] + c1 * ws[22 * LANES + m] + c2 * ws[25 * LANES + m]
        uz = cd * ws[20 * LANES + m] + c1 * ws[23 * LANES + m] + c2 * ws[26 * LANES + m]
        a = px * px + py * py + pz * pz
        e0 = ws[REFERENCE * LANES + m]
        f = ws[EA_L * LANES + m] * (0.5 * (a - 1.0) - e0 if paper else 1.0 - (1.0 + e0) / math.sqrt(a))
        f += ws[DA_L * LANES + m] * (px * ux + py * uy + pz * uz) * (1.0 if paper else 1.0 / a)
        f *= w
        px *= f
        py *= f
        pz *= f
        ws[9 * LANES + m] += cd * px
        ws[10 * LANES + m] += cd * py
        ws[11 * LANES + m] += cd * pz
        ws[12 * LANES + m] += c1 * px
        ws[13 * LANES + m] += c1 * py
        ws[14 * LANES + m] += c1 * pz
        ws[15 * LANES + m] += c2 * px
        ws[16 * LANES + m] += c2 * py
        ws[17 * LANES + m] += c2 * pz


@inline_kernel
def bending_damping(ws, gp, g, paper):
    """Add the bending damping force of Gauss point g; names as in ``bending_rate``."""
    cd, c1, c2, ed, e1, e2, w = gp[g, 0], gp[g, 1], gp[g, 2], gp[g, 3], gp[g, 4], gp[g, 5], gp[g, 6]
    k = 2.0 if paper else 1.0
    for m in range(LANES):
        il = ws[INV_L * LANES + m]
        px = cd * ws[0 * LANES + m] + c1 * ws[3 * LANES + m] + c2 * ws[6 * LANES + m]
        py = cd * ws[1 * LANES + m] + c1 * ws[4 * LANES + m] + c2 * ws[7 * LANES + m]
        pz = cd * ws[2 * LANES + m] + c1 * ws[5 * LANES + m] + c2 * ws[8 * LANES + m]
        sx = (ed * ws[0 * LANES + m] + e1 * ws[3 * LANES + m] + e2 * ws[6 * LANES + m]) * il
        sy = (ed * ws[1 * LANES + m] + e1 * ws[4 * LANES + m] + e2 * ws[7 * LANES + m]) * il
        sz = (ed * ws[2 * LANES + m] + e1 * ws[5 * LANES + m] + e2 * ws[8 * LANES + m]) * il
        ux = cd * ws[18 * LANES + m] + c1 * ws[21 * LANES + m] + c2 * ws[24 * LANES + m]
        uy = cd * ws[19 * LANES + m] + c1 * ws[22 * LANES + m] + c2 * ws[25 * LANES + m]
        uz = cd * ws[20 * LANES + m] + c1 * ws[23 * LANES + m] + c2 * ws[26 * LANES + m]
        tx = (ed * ws[18 * LANES + m] + e1 * ws[21 * LANES + m] + e2 * ws[24 * LANES + m]) * il
        ty = (ed * ws[19 * LANES + m] + e1 * ws[22 * LANES + m] + e2 * ws[25 * LANES + m]) * il
        tz = (ed * ws[20 * LANES + m] + e1 * ws[23 * LANES + m] + e2 * ws[26 * LANES + m]) * il
        a = px * px + py * py + pz * pz
        ia = 1.0 / a
        ba = (px * sx + py * sy + pz * sz) * ia
        zx, zy, zz = sx - ba * px, sy - ba * py, sz - ba * pz
        gg = ia * ia if paper else ia  # g^2
        pdp = (px * ux + py * uy + pz * uz) * ia
        f = (px * tx + py * ty + pz * tz) * ia - ba * pdp
        yx = tx - ba * ux - f * px - k * pdp * zx  # y/g
        yy = ty - ba * uy - f * py - k * pdp * zy
        yz = tz - ba * uz - f * pz - k * pdp * zz
        z2 = zx * zx + zy * zy + zz * zz
        e = STRAIGHT * STRAIGHT * il * il
        nu = 1.0 / (gg * z2 + e)
        along = gg * nu * (zx * yx + zy * yy + zz * yz)
        e *= nu
        q = w * ws[DB_L * LANES + m] * gg
        bx = q * (e * yx + along * zx)
        by = q * (e * yy + along * zy)
        bz = q * (e * yz + along * zz)
        h = -k * (zx * bx + zy * by + zz * bz) * ia
        ax, ay, az = h * px - ba * bx, h * py - ba * by, h * pz - ba * bz
        bx *= il
        by *= il
        bz *= il
        ws[9 * LANES + m] += cd * ax + ed * bx
        ws[10 * LANES + m] += cd * ay + ed * by
        ws[11 * LANES + m] += cd * az + ed * bz
        ws[12 * LANES + m] += c1 * ax + e1 * bx
        ws[13 * LANES + m] += c1 * ay + e1 * by
        ws[14 * LANES + m] += c1 * az + e1 * bz
        ws[15 * LANES + m] += c2 * ax + e2 * bx
        ws[16 * LANES + m] += c2 * ay + e2 * by
        ws[17 * LANES + m] += c2 * az + e2 * bz


@inline_kernel
def bending_damping_tangent(ws, gp, g, paper, c_damping):
    """Add the derivative of the bending damping force by the velocities to rows KPP, KPS, KSS."""
    for m in range(LANES):
        p, s = shape_at(ws, gp, g, D, m)
        _, z, a, ba, gg, k, nu = bending_rate(p, s, p, s, paper, ws[LENGTH * LANES + m])
        f = c_damping * gp[g, 6] * ws[DB_L * LANES + m] * gg * gg
        delta = STRAIGHT / ws[LENGTH * LANES + m]
        e = delta * delta * nu
        zz, ka = dot(z, z), k / a
        n = 0
        for i in range(3):
            for j in range(3):
                x = (e if i == j else 0.0) - e * p[i] * p[j] / a + nu * gg * gg * z[i] * z[j]
                if j >= i:
                    pp = ba * ba * x + ba * ka * (z[i] * p[j] + p[i] * z[j]) + ka * ka * zz * p[i] * p[j]
                    ws[(KPP + n) * LANES + m] += f * pp
                    ws[(KSS + n) * LANES + m] += f * x
                    n += 1
                ws[(KPS + 3 * i + j) * LANES + m] -= f * (ba * x + ka * p[i] * z[j])


@inline_kernel
def slope_damping(ws):
    """Add the force of the slope damping to the rows FD, F1, F2."""
    for k in range(3):
        for m in range(LANES):
            c = ws[SLOPE * LANES + m]
            d, t1, t2 = ws[(VD + k) * LANES + m], ws[(V1 + k) * LANES + m], ws[(V2 + k) * LANES + m]
            ws[(FD + k) * LANES + m] += c * (36.0 * d - 3.0 * (t1 + t2))
            ws[(F1 + k) * LANES + m] += c * (4.0 * t1 - t2 - 3.0 * d)
            ws[(F2 + k) * LANES + m] += c * (4.0 * t2 - t1 - 3.0 * d)


@inline_kernel
def slope_damping_tangent(ws, c_damping):
    """Add the matrix of the slope damping to the 3x3 blocks of (d, t1, t2)."""
    for k in range(0, 9, 4):
        for m in range(LANES):
            c = c_damping * ws[SLOPE * LANES + m]
            ws[(KDD + k) * LANES + m] += 36.0 * c
            ws[(KD1 + k) * LANES + m] -= 3.0 * c
            ws[(KD2 + k) * LANES + m] -= 3.0 * c
            ws[(K11 + k) * LANES + m] += 4.0 * c
            ws[(K12 + k) * LANES + m] -= c
            ws[(K22 + k) * LANES + m] += 4.0 * c
