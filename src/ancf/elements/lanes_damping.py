"""Kelvin-Voigt damping of the cable for LANES elements at a time.

Axial: N = EA eps + D_a d(eps)/dt.  Bending: the curvature vector n = (r_xx - t (t.r_xx))/|r_x|^k lies
in the normal plane (k = 2 for paper strains, 1 for material ones, |n| = kappa).  Its rate seen from a
frame that does not spin about the tangent is the normal part of dn/dt, here y; it is linear in the
velocities and smooth for a straight cable.  The cable has no torsional stiffness, so a spin of n about
the tangent must not be damped: of y only the part along n counts once the cable is bent,

    power = D_b y . X y,   X = (delta^2 I + n n^T) / (kappa^2 + delta^2),   delta = STRAIGHT / L.
"""

from __future__ import annotations

from ..compiled import inline_kernel
from .lanes import DA_L, DB_L, INV_L, KPP, KPS, KSS, LANES, LENGTH, STRAIGHT, VD, D


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
def dot(u, v):
    """Scalar product."""
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


@inline_kernel
def bending_rate(p, s, dp, ds, paper, length):
    """X y of the curvature vector's rate y, and the numbers that the force needs."""
    a = dot(p, p)
    b = dot(p, s)
    ba = b / a
    z = (s[0] - ba * p[0], s[1] - ba * p[1], s[2] - ba * p[2])
    k = 2.0 if paper else 1.0
    g = 1.0 / a if paper else 1.0 / a**0.5
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
def add_nodal(ws, gp, g, m, qp, qs):
    """Add generalised forces on r_x and r_xx to the rows FD, F1, F2 of lane m."""
    il = ws[INV_L * LANES + m]
    for k in range(3):
        s = qs[k] * il
        ws[(9 + k) * LANES + m] += gp[g, 0] * qp[k] + gp[g, 3] * s
        ws[(12 + k) * LANES + m] += gp[g, 1] * qp[k] + gp[g, 4] * s
        ws[(15 + k) * LANES + m] += gp[g, 2] * qp[k] + gp[g, 5] * s


@inline_kernel
def axial_damping(ws, gp, g, paper):
    """Add the axial damping force of Gauss point g."""
    for m in range(LANES):
        p, _ = shape_at(ws, gp, g, D, m)
        dp, _ = shape_at(ws, gp, g, VD, m)
        rate = dot(p, dp)
        f = gp[g, 6] * ws[DA_L * LANES + m] * rate
        if not paper:
            f /= dot(p, p)
        add_nodal(ws, gp, g, m, (f * p[0], f * p[1], f * p[2]), (0.0, 0.0, 0.0))


@inline_kernel
def bending_damping(ws, gp, g, paper):
    """Add the bending damping force of Gauss point g."""
    for m in range(LANES):
        p, s = shape_at(ws, gp, g, D, m)
        dp, ds = shape_at(ws, gp, g, VD, m)
        xy, z, a, ba, gg, k, _ = bending_rate(p, s, dp, ds, paper, ws[LENGTH * LANES + m])
        f = gp[g, 6] * ws[DB_L * LANES + m]
        h = -k * dot(z, xy) / a
        q = f * gg
        add_nodal(
            ws,
            gp,
            g,
            m,
            (q * (h * p[0] - ba * xy[0]), q * (h * p[1] - ba * xy[1]), q * (h * p[2] - ba * xy[2])),
            (q * xy[0], q * xy[1], q * xy[2]),
        )


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
