"""Kelvin-Voigt and slope damping of the cable at a Gauss point, for LANES elements at a time.

Axial: N = EA eps + D_a d(eps)/dt.  Bending: the curvature vector n = (r_xx - t (t.r_xx))/|r_x|^k lies
in the normal plane (k = 2 for paper strains, 1 for material ones, |n| = kappa).  Its rate seen from a
frame that does not spin about the tangent is the normal part of dn/dt, here y; it is linear in the
velocities and smooth for a straight cable.  The cable has no torsional stiffness, so a spin of n about
the tangent must not be damped: of y only the part along n counts once the cable is bent,

    power = D_b y . X y,   X = (delta^2 I + n n^T) / (kappa^2 + delta^2),   delta = STRAIGHT / L.

Slopes: power = c int |v_x|^2 dx, exactly integrated; with c L/30 the matrix on the rates of (d, t1, t2) is
c L/30 (36 -3 -3; -3 4 -1; -3 -1 4).
"""

from __future__ import annotations

from ..compiled import formula
from ..simd import every
from ..vectors import dot
from .cable_strain import dyads

#: Curvature times element length below which bending damping acts alike in all directions.
STRAIGHT = 1e-2
SLOPES = ((36.0, -3.0, -3.0), (-3.0, 4.0, -1.0), (-3.0, -1.0, 4.0))


@formula
def axial_damping(a, da, paper):
    """Twice the derivative by a, as that of the energy, per damping; da is the rate of a."""
    return 0.5 * da if paper else 0.5 * da / a


@formula
def normal(p, s, paper, inv_l):
    """The part z of s in the normal plane, (p.s)/a, 1/a, the factor g^2 of n = g z, e and nu of X.

    With them X = e (I - p p^T/a) + nu g^2 z z^T on the normal plane.
    """
    ia = 1.0 / dot(p, p)
    ba = dot(p, s) * ia
    z = s - ba * p
    gg = ia * ia if paper else ia
    delta2 = STRAIGHT * STRAIGHT * inv_l * inv_l
    nu = 1.0 / (gg * dot(z, z) + delta2)
    return z, ba, ia, gg, delta2 * nu, nu


@formula
def bending_damping(p, s, dp, ds, paper, inv_l):
    """Forces on p and on s, per damping; dp and ds are the rates of p and s."""
    z, ba, ia, gg, e, nu = normal(p, s, paper, inv_l)
    k = 2.0 if paper else 1.0
    pdp = dot(p, dp) * ia
    f = dot(p, ds) * ia - ba * pdp  # projects ds - (b/a) dp on the normal plane
    y = ds - ba * dp - f * p - k * pdp * z  # y/g
    b = gg * (e * y + gg * nu * dot(z, y) * z)
    return -k * ia * dot(z, b) * p - ba * b, b


@formula
def bending_damping_tangent(p, s, damping, paper, inv_l):
    """Rows of the derivatives of the forces by the rates: p by dp, p by ds, s by dp and s by ds."""
    z, ba, ia, gg, e, nu = normal(p, s, paper, inv_l)
    f, k, none = damping * gg, 2.0 * ia if paper else ia, every(0.0)
    e, h, zz, pz = f * e, -f * e * ia, f * gg * nu, f * k  # of I, p p^T and z z^T in f X, and of p z^T
    pp = dyads(ba * ba * e, p, z, ba * ba * h + pz * k * dot(z, z), ba * pz, ba * pz, ba * ba * zz)
    ps = dyads(-ba * e, p, z, -ba * h, -pz, none, -ba * zz)
    sp = dyads(-ba * e, p, z, -ba * h, none, -pz, -ba * zz)
    ss = dyads(e, p, z, h, none, none, zz)
    return pp, ps, sp, ss


@formula
def slope_damping(c, vd, v1, v2):
    """Forces on d, t1 and t2 from their rates."""
    return c * (36.0 * vd - 3.0 * (v1 + v2)), c * (4.0 * v1 - v2 - 3.0 * vd), c * (4.0 * v2 - v1 - 3.0 * vd)
