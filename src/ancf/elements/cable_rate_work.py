"""Derivatives by the shape of x . force of damped cables at fixed rates, for LANES elements at a time.

The power of the damping with rates x in the place of one of the two is P = x . force, a symmetric form of
both rates.  At a Gauss point of the axial damping it is D_a/4 times the rates of a = p.p, over a for material
strains.  Of bending, with z, g and nu of :mod:`ancf.elements.cable_damping`,

    P = D_b g^2 nu (delta^2 (y.w - (p.y)(p.w)/a) + g^2 (z.y)(z.w)),

where y and w, made of dp, ds and of x alike, have not lost their parts along p, which do not count.
"""

from __future__ import annotations

from ..compiled import formula, inline_kernel
from ..simd import every, load, zero
from ..vectors import dot
from .cable_columns import AXIAL, AXIALLY, BENDING, DA_L, DAMPED, DB_L, FIRST, IN_BENDING, INV_L, PAPER
from .cable_damping import normal
from .cable_strain import WEIGHT, a_of, add_a, bend, forces, product_rates, products, slope


@formula
def along_axis(batch, group, chunk, u, v, x):
    """Derivatives by d, t1 and t2 of the axial part; shape, rates and x as d, u1 and u2."""
    none = every(0.0)
    Ru = Rv = Rx = none, none, none, none, none, none
    G, dG, xG = products(u), product_rates(u, v), product_rates(u, x)
    da = load(batch.lane_data, chunk, DA_L)
    for g in range(group[FIRST], group[FIRST] + group[AXIAL]):
        at = batch.gp[g]
        w, av, ax = 0.5 * at[WEIGHT] * da, a_of(at, dG), a_of(at, xG)
        if group[PAPER] != 0:
            Rv, Rx = add_a(Rv, at, w * ax), add_a(Rx, at, w * av)
        else:
            w = w / a_of(at, G)
            Rv, Rx = add_a(Rv, at, w * ax), add_a(Rx, at, w * av)
            Ru = add_a(Ru, at, -1.0 * w * av * ax / a_of(at, G))
    (d, one, two), (e, f, g1), (i, j, k) = forces(Ru, u), forces(Rv, v), forces(Rx, x)
    return d + e + i, one + f + j, two + g1 + k


@formula
def of_bending(p, s, rates, moved, paper, inv_l):
    """Derivatives of P by p and s per damping; ``rates`` and ``moved``: those of p and s, and of x."""
    (dp, ds), (xp, xs) = rates, moved
    z, ba, ia, gg, e, nu = normal(p, s, paper, inv_l)
    k, delta2, zz = 2.0 if paper else 1.0, e / nu, dot(z, z)
    vp, wp = dot(p, dp) * ia, dot(p, xp) * ia
    y, w = ds - ba * dp - (k * vp) * z, xs - ba * xp - (k * wp) * z
    py, pw, zy, zw = dot(p, y), dot(p, w), dot(z, y), dot(z, w)
    c = gg * nu
    form = delta2 * (dot(y, w) - ia * py * pw) + gg * zy * zw
    by_nu, along, across = form * gg, c * delta2, c * gg
    by_gg = form * nu + c * zy * zw - by_nu * nu * nu * zz
    by_y = (across * zw) * z + along * w - (along * ia * pw) * p
    by_w = (across * zy) * z + along * y - (along * ia * py) * p
    zby_y, zby_w = dot(z, by_y), dot(z, by_w)
    by_z = (across * zw) * y + (across * zy) * w - (2.0 * by_nu * nu * nu * gg) * z
    by_z = by_z - (k * vp) * by_y - (k * wp) * by_w
    by_ba = -1.0 * (dot(dp, by_y) + dot(xp, by_w) + dot(p, by_z))
    by_vp, by_wp = -k * zby_y, -k * zby_w
    by_ia = by_ba * dot(p, s) + by_vp * dot(p, dp) + by_wp * dot(p, xp) - along * py * pw
    by_ia = by_ia + (2.0 * ia * by_gg if paper else by_gg)
    by_p = (by_ba * ia) * s + (by_vp * ia) * dp + (by_wp * ia) * xp - ba * by_z
    by_p = by_p - (along * ia * pw) * y - (along * ia * py) * w - (2.0 * ia * ia * by_ia) * p
    return by_p, by_z + (by_ba * ia) * p


@inline_kernel
def along_bends(batch, group, chunk, q, v, x, made):
    """Add the derivatives of the damping of bending by d, t1 and t2, as which q, v and x are given."""
    (d, t1, t2), (vd, v1, v2), (xd, x1, x2), (fd, f1, f2) = q, v, x, made
    gp, first = batch.gp, group[FIRST] + group[AXIAL]
    db, inv_l = load(batch.lane_data, chunk, DB_L), load(batch.lane_data, chunk, INV_L)
    for g in range(first, first + group[BENDING]):
        p, s = slope(gp, g, d, t1, t2), bend(gp, g, d, t1, t2, inv_l)
        rates = slope(gp, g, vd, v1, v2), bend(gp, g, vd, v1, v2, inv_l)
        moved = slope(gp, g, xd, x1, x2), bend(gp, g, xd, x1, x2, inv_l)
        n, m = of_bending(p, s, rates, moved, group[PAPER] != 0, inv_l)
        n, m = gp[g, WEIGHT] * db * n, gp[g, WEIGHT] * db * inv_l * m
        fd = fd + gp[g, 0] * n + gp[g, 3] * m
        f1 = f1 + gp[g, 1] * n + gp[g, 4] * m
        f2 = f2 + gp[g, 2] * n + gp[g, 5] * m
    return fd, f1, f2


@formula
def apart(x):
    """d, u1 and u2 of d, t1 and t2."""
    d, t1, t2 = x
    return d, t1 - d, t2 - d


@inline_kernel
def rate_work(batch, group, chunk, q, v, x):
    """Derivatives of x . force by d, t1 and t2, as which q, v and x are given."""
    made = zero(), zero(), zero()
    if group[DAMPED] & AXIALLY:
        made = along_axis(batch, group, chunk, apart(q), apart(v), apart(x))
    if group[DAMPED] & IN_BENDING:
        made = along_bends(batch, group, chunk, q, v, x, made)
    return made
