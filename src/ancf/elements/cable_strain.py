"""The cable at a Gauss point: what its strain energy gives there, for LANES elements at a time.

An element is described by d = (r_2 - r_1)/L, t1 = r_x(0), t2 = r_x(L), or with u1 = t1 - d and u2 = t2 - d

    p  =  r_x   =  cd d + c1 t1 + c2 t2       =  d + c1 u1 + c2 u2
    s  =  r_xx  =  (ed d + e1 t1 + e2 t2)/L   =  (e1 u1 + e2 u2)/L.

The strain energies per stiffness are those of :mod:`ancf.elements.measures`,

    axial    (eps - eps0)^2/2,       eps = (a - 1)/2  (paper)  or  sqrt(a) - 1,      a = p.p
    bending  (kappa - kappa0)^2/2,   kappa^2 = (a c - b^2)/a^k,  k = 3 (paper) or 2, b = p.s,  c = s.s.

They know the shape by its six scalar products G = (d.d, d.u1, d.u2, u1.u1, u1.u2, u2.u2) alone: a, b and c
are linear in G with factors that a row of the table ``gp`` holds.  A kernel of the force adds up R = 2 dW/dG,
six sums instead of nine components, and nothing is lost: the products of the small u are small.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from ..arrays import FloatArray
from ..compiled import formula
from ..simd import absolute, every, sqrt, vector
from ..vectors import dot
from .shapes import gauss

#: A curved reference needs kappa itself; it is rounded off below this fraction of kappa0.
SMOOTHING = 1e-4
SCALE = math.sqrt(1.0 + SMOOTHING * SMOOTHING)
TINY = 1e-200  # keeps the square root of a straight cable from zero
#: Column of the weight in ``gp``.
WEIGHT = 6


@cache
def gauss_table(axial: int, bending: int) -> FloatArray:
    """Coefficients at the axial, then the bending Gauss points, shape (n, 20).

    cd c1 c2 ed e1 e2 weight; the factors of the last five of G in a, of the last five in b and of the last
    three in c.  The factor of d.d in a is 1, the others are 0.
    """
    rows = []
    for points in (axial, bending):
        x, weight = gauss(points)
        cd, c1, c2 = 6 * x * (1 - x), 1 - 4 * x + 3 * x * x, 3 * x * x - 2 * x
        ed, e1, e2 = 6 - 12 * x, 6 * x - 4, 6 * x - 2
        in_a = 2 * c1, 2 * c2, c1 * c1, 2 * c1 * c2, c2 * c2
        in_b = e1, e2, c1 * e1, c1 * e2 + c2 * e1, c2 * e2
        in_c = e1 * e1, 2 * e1 * e2, e2 * e2
        rows.append(np.stack([cd, c1, c2, ed, e1, e2, weight, *in_a, *in_b, *in_c], axis=1))
    table = np.ascontiguousarray(np.concatenate(rows))
    table.flags.writeable = False  # everybody gets it
    return table


@formula
def slope(gp, g, d, t1, t2):
    """p = r_x."""
    return gp[g, 0] * d + gp[g, 1] * t1 + gp[g, 2] * t2


@formula
def bend(gp, g, d, t1, t2, inv_l):
    """s = r_xx, 1/m."""
    return inv_l * (gp[g, 3] * d + gp[g, 4] * t1 + gp[g, 5] * t2)


@formula
def products(x):
    """G of d, u1, u2."""
    d, u1, u2 = x
    return dot(d, d), dot(d, u1), dot(d, u2), dot(u1, u1), dot(u1, u2), dot(u2, u2)


@formula
def product_rates(x, v):
    """The rates of G; v are those of d, u1, u2."""
    (d, u1, u2), (vd, v1, v2) = x, v
    return (
        2.0 * dot(d, vd),
        dot(d, v1) + dot(u1, vd),
        dot(d, v2) + dot(u2, vd),
        2.0 * dot(u1, v1),
        dot(u1, v2) + dot(u2, v1),
        2.0 * dot(u2, v2),
    )


@formula
def forces(R, x):
    """Forces on d, t1 and t2 of R = 2 dW/dG at d, u1, u2."""
    d, u1, u2 = x
    r1, r2, r12 = 0.5 * R[1], 0.5 * R[2], 0.5 * R[4]
    f1 = r1 * d + R[3] * u1 + r12 * u2
    f2 = r2 * d + r12 * u1 + R[5] * u2
    return R[0] * d + r1 * u1 + r2 * u2 - f1 - f2, f1, f2


@formula
def a_of(at, G):
    """a = p.p at a row of gp, or its rate."""
    return G[0] + at[7] * G[1] + at[8] * G[2] + at[9] * G[3] + at[10] * G[4] + at[11] * G[5]


@formula
def b_of(at, G):
    """L b = L p.s."""
    return at[12] * G[1] + at[13] * G[2] + at[14] * G[3] + at[15] * G[4] + at[16] * G[5]


@formula
def c_of(at, G):
    """L^2 c = L^2 s.s."""
    return at[17] * G[3] + at[18] * G[4] + at[19] * G[5]


@formula
def add_a(R, at, wa):
    """Add to R what wa = 2 dW/da gives."""
    R0, R1, R2, R3, R4, R5 = R
    return (
        R0 + wa,
        R1 + at[7] * wa,
        R2 + at[8] * wa,
        R3 + at[9] * wa,
        R4 + at[10] * wa,
        R5 + at[11] * wa,
    )


@formula
def add_abc(R, at, wa, wb, wc):
    """Add to R what twice the derivatives by a, L b and L^2 c give."""
    R0, R1, R2, R3, R4, R5 = add_a(R, at, wa)
    return (
        R0,
        R1 + at[12] * wb,
        R2 + at[13] * wb,
        R3 + at[14] * wb + at[17] * wc,
        R4 + at[15] * wb + at[18] * wc,
        R5 + at[16] * wb + at[19] * wc,
    )


@formula
def axial_force(a, eps0, paper):
    """Twice the derivative by a (eqs. 25, 27, B-1)."""
    return 0.5 * (a - 1.0) - eps0 if paper else 1.0 - (1.0 + eps0) / sqrt(a)


@formula
def squared_curvature(a, b, c, paper):
    """1/a, 1/a^k and kappa^2 (eq. 26)."""
    ia = 1.0 / a
    im = ia * ia * ia if paper else ia * ia
    return ia, im, (a * c - b * b) * im


@formula
def bending_force(a, b, c, kappa0, paper, curved):
    """Twice the derivatives by a, b and c (eqs. 26, 27)."""
    ia, im, k2 = squared_curvature(a, b, c, paper)
    f = every(1.0)
    if curved:
        f = 1.0 - SCALE * kappa0 / sqrt(absolute(k2) + (SMOOTHING * kappa0) * (SMOOTHING * kappa0) + TINY)
    return f * (c * im - (3.0 if paper else 2.0) * k2 * ia), -2.0 * f * b * im, f * a * im


@formula
def dyads(x, p, s, pp, ps, sp, ss):
    """Three rows of the matrix x I + pp p p^T + ps p s^T + sp s p^T + ss s s^T."""
    u, v, none = pp * p + sp * s, ps * p + ss * s, every(0.0)
    return (
        u[0] * p + v[0] * s + vector(x, none, none),
        u[1] * p + v[1] * s + vector(none, x, none),
        u[2] * p + v[2] * s + vector(none, none, x),
    )


@formula
def axial_slope(a, eps0, paper):
    """Derivative of :func:`axial_force` by a."""
    return every(0.5) if paper else 0.5 * (1.0 + eps0) / (a * sqrt(a))


@formula
def curvature_slopes(a, b, c, kappa0, ei, paper, curved):
    """First derivatives of EI/2 (kappa - kappa0)^2 by a, b and c, and second: aa, ab, ac, bb, bc, cc."""
    ia, im, k2 = squared_curvature(a, b, c, paper)
    power = 3.0 if paper else 2.0
    wu, wuu = 0.5 * ei, every(0.0)  # dW/d(kappa^2), and its derivative
    if curved:
        khat2 = absolute(k2) + (SMOOTHING * kappa0) * (SMOOTHING * kappa0) + TINY
        ratio = SCALE * kappa0 / sqrt(khat2)
        wuu = 0.5 * wu * ratio / khat2
        wu = wu * (1.0 - ratio)
    ua = c * im - power * k2 * ia
    ub = -2.0 * b * im
    uc = a * im
    haa = wu * (power * (power + 1.0) * k2 * ia - 2.0 * power * c * im) * ia + wuu * ua * ua
    hab = wu * 2.0 * power * b * im * ia + wuu * ua * ub
    hac = wu * (1.0 - power) * im + wuu * ua * uc
    hbb = -2.0 * wu * im + wuu * ub * ub
    hbc = wuu * ub * uc
    hcc = wuu * uc * uc
    return (wu * ua, wu * ub, wu * uc), (haa, hab, hac, hbb, hbc, hcc)


@formula
def axial_energy(a, eps0, paper):
    """(eps - eps0)^2/2."""
    eps = 0.5 * (a - 1.0) - eps0 if paper else sqrt(a) - 1.0 - eps0
    return 0.5 * eps * eps


@formula
def bending_energy(a, b, c, kappa0, paper):
    """(kappa - kappa0)^2/2, rounded off as the force is."""
    _, _, k2 = squared_curvature(a, b, c, paper)
    k2 = 0.5 * (k2 + absolute(k2))
    khat = sqrt((1.0 + SMOOTHING**2) * (k2 + (SMOOTHING * kappa0) * (SMOOTHING * kappa0)))
    return 0.5 * (k2 - 2.0 * kappa0 * khat + (1.0 + 2.0 * SMOOTHING**2) * kappa0 * kappa0)
