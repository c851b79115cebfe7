"""Derivatives of x . force by the constants of cable elements, for LANES elements at a time.

With the shape and its products G as in :mod:`ancf.elements.cable_strain`, x moves G by dG, and forces do

    x . force = 1/2 sum 2 dW/dG dG,

a sum over the Gauss points of numbers: a, b, c and what x does to them.  Stiffnesses, dampings and masses are
factors of that.  The length acts through d = (r_2 - r_1)/L and 1/L in b and c; its derivatives are those
along a direction l, times 1/L: of d along d itself, of u1 = t1 - d and u2 = t2 - d against it.  It changes
the products, and what x does to them, by sums of these themselves.
"""

from __future__ import annotations

import numpy as np

from ..compiled import formula, inline_kernel
from ..simd import LANES, absolute, every, load, store, total
from ..vectors import dot
from .cable_columns import (
    AXIAL,
    AXIALLY,
    BENDING,
    CURVATURE,
    CURVED,
    DA_L,
    DAMPED,
    DB_L,
    EA_L,
    EI_L,
    FIRST,
    IN_BENDING,
    IN_SLOPE,
    INV_L,
    LENGTH,
    MASS,
    PAPER,
    VISCOUS,
    VISCOUSLY,
)
from .cable_damping import axial_damping, bending_damping, slope_damping
from .cable_strain import (
    WEIGHT,
    a_of,
    axial_force,
    axial_slope,
    b_of,
    bend,
    c_of,
    curvature_slopes,
    product_rates,
    products,
    slope,
)

#: Rows of the constants.
ROWS = 8
#: Relative change of 1/L, and weights, of the difference of order four of the damping of bending.
CHANGE = 5e-4
CHANGES = ((-2.0, 1.0 / 12.0), (-1.0, -8.0 / 12.0), (1.0, 8.0 / 12.0), (2.0, -1.0 / 12.0))


def numbers(batch):
    """The constants, lane by lane, and those of the damping of slopes; external damping as damping L/420."""
    data = batch.lane_data.copy()
    data[:, VISCOUS] *= data[:, MASS]
    return np.concatenate([data.ravel(), batch.lane_slope.ravel()])


def joined(batch, other):
    """The batch with the kinds of damping that it or another one has, see :class:`ancf.compiled.Traits`."""
    groups = batch.groups.copy()
    if groups.shape != other.groups.shape:
        return batch
    groups[:, DAMPED] |= other.groups[:, DAMPED]
    return batch._replace(groups=groups)


@formula
def in_elements(nodes, inv_l):
    """d, t1 and t2 of the four slots r, r_x, r, r_x."""
    r1, t1, r2, t2 = nodes
    return inv_l * (r2 - r1), t1, t2


@formula
def apart(x):
    """d, u1 and u2 of d, t1 and t2."""
    d, t1, t2 = x
    return d, t1 - d, t2 - d


@formula
def by_length(x):
    """Derivative of d, u1 and u2 along l."""
    d, _, _ = x
    return d, -1.0 * d, -1.0 * d


@formula
def along_length(G):
    """Derivative along l of products of d, u1 and u2, or of what something does to them."""
    return 2.0 * G[0], G[1] - G[0], G[2] - G[0], -2.0 * G[1], -1.0 * (G[1] + G[2]), -2.0 * G[2]


@formula
def row(batch, chunk, k, curved):
    """A row of the reference strains; zero for a straight reference."""
    return load(batch.lane_reference, chunk, k) if curved else every(0.0)


@formula
def axial_work(batch, group, chunk, moved, ea):
    """Of the axial strain per EA L, and its derivative along l; ``moved``: G, dG, and both along l."""
    gp, paper, curved = batch.gp, group[PAPER] != 0, group[CURVED] != 0
    G, dG, lG, ldG = moved
    work, along = every(0.0), every(0.0)
    for k in range(group[AXIAL]):
        at, eps0 = gp[group[FIRST] + k], row(batch, chunk, k, curved)
        a, da, w = a_of(at, G), a_of(at, dG), 0.5 * at[WEIGHT]
        f = axial_force(a, eps0, paper)
        work = work + w * f * da
        along = along + w * (f * a_of(at, ldG) + axial_slope(a, eps0, paper) * a_of(at, lG) * da)
    return work, ea * along


@formula
def bending_work(batch, group, chunk, moved, inv_l, ei):
    """The same of the curvature, per EI L."""
    gp, paper, curved = batch.gp, group[PAPER] != 0, group[CURVED] != 0
    G, dG, lG, ldG = moved
    work, along, inv_l2 = every(0.0), every(0.0), inv_l * inv_l
    for k in range(group[BENDING]):
        at, kappa0 = gp[group[FIRST] + group[AXIAL] + k], row(batch, chunk, CURVATURE + k, curved)
        a, b, c = a_of(at, G), inv_l * b_of(at, G), inv_l2 * c_of(at, G)
        da, db, dc = a_of(at, dG), inv_l * b_of(at, dG), inv_l2 * c_of(at, dG)
        la, lb, lc = a_of(at, lG), b + inv_l * b_of(at, lG), 2.0 * c + inv_l2 * c_of(at, lG)
        lda, ldb, ldc = a_of(at, ldG), db + inv_l * b_of(at, ldG), 2.0 * dc + inv_l2 * c_of(at, ldG)
        first, second = curvature_slopes(a, b, c, kappa0, every(1.0), paper, curved)
        (wa, wb, wc), (haa, hab, hac, hbb, hbc, hcc) = first, second
        work = work + at[WEIGHT] * (wa * da + wb * db + wc * dc)
        bent = da * (haa * la + hab * lb + hac * lc) + db * (hab * la + hbb * lb + hbc * lc)
        bent = bent + dc * (hac * la + hbc * lb + hcc * lc) + wa * lda + wb * ldb + wc * ldc
        along = along + at[WEIGHT] * bent
    return work, ei * along


@formula
def axial_loss(batch, group, G, dG, vG):
    """Of the axial damping per D_a L; vG are the rates of G."""
    gp, work = batch.gp, every(0.0)
    for k in range(group[AXIAL]):
        at = gp[group[FIRST] + k]
        f = axial_damping(a_of(at, G), a_of(at, vG), group[PAPER] != 0)
        work = work + 0.5 * at[WEIGHT] * f * a_of(at, dG)
    return work


@inline_kernel
def axial_loss_along(batch, group, moved, vG, da_l):
    """Derivative of that along l, times D_a L."""
    gp, paper, along = batch.gp, group[PAPER] != 0, every(0.0)
    (G, dG, lG, ldG), lvG = moved, along_length(vG)
    for k in range(group[AXIAL]):
        at = gp[group[FIRST] + k]
        a = a_of(at, G)
        f, lf = axial_damping(a, a_of(at, vG), paper), axial_damping(a, a_of(at, lvG), paper)
        if not paper:
            lf = lf - f * a_of(at, lG) / a
        along = along + 0.5 * at[WEIGHT] * (f * a_of(at, ldG) + lf * a_of(at, dG))
    return da_l * along


@inline_kernel
def bending_loss(batch, group, q, v, x, inv_l):
    """Of the damping of bending per D_b L."""
    gp, paper, first = batch.gp, group[PAPER] != 0, group[FIRST] + group[AXIAL]
    (d, t1, t2), (vd, v1, v2) = in_elements(q, inv_l), in_elements(v, inv_l)
    xd, x1, x2 = in_elements(x, inv_l)
    work = every(0.0)
    for g in range(first, first + group[BENDING]):
        p, s = slope(gp, g, d, t1, t2), bend(gp, g, d, t1, t2, inv_l)
        dp, ds = slope(gp, g, vd, v1, v2), bend(gp, g, vd, v1, v2, inv_l)
        n, m = bending_damping(p, s, dp, ds, paper, inv_l)
        moved = dot(n, slope(gp, g, xd, x1, x2)) + dot(m, bend(gp, g, xd, x1, x2, inv_l))
        work = work + gp[g, WEIGHT] * moved
    return work


@formula
def slope_loss(rates, x):
    """Of the damping of slopes per its constant, and its derivative along l; both as d, t1 and t2."""
    (vd, v1, v2), (xd, x1, x2) = rates, x
    none, one = 0.0 * vd, every(1.0)
    nd, n1, n2 = slope_damping(one, vd, v1, v2)
    ld, l1, l2 = slope_damping(one, vd, none, none)
    return dot(nd, xd) + dot(n1, x1) + dot(n2, x2), dot(nd + ld, xd) + dot(l1, x1) + dot(l2, x2)


@formula
def inertia_work(a, x, h):
    """x . mass matrix . a per rhoA L/420, and its derivative by L."""
    (a1, s1, a2, s2), (r1, t1, r2, t2) = a, x
    none = dot(r1, 156.0 * a1 + 54.0 * a2) + dot(r2, 54.0 * a1 + 156.0 * a2)
    one = dot(r1, 22.0 * s1 - 13.0 * s2) + dot(r2, 13.0 * s1 - 22.0 * s2)
    one = one + dot(t1, 22.0 * a1 + 13.0 * a2) - dot(t2, 13.0 * a1 + 22.0 * a2)
    two = dot(t1, 4.0 * s1 - 3.0 * s2) + dot(t2, 4.0 * s2 - 3.0 * s1)
    return none + h * (one + h * two), one + 2.0 * h * two


@formula
def add_row(out, chunk, k, value):
    """Add to the derivatives by a row of the constants of a chunk."""
    at = LANES * (ROWS * chunk + k)
    store(load(out, at) + value, out, at)


@formula
def elements_work(batch, group, chunk, states, x, out):
    """Add the derivatives of a chunk; states q, v, a and x by the four slots r, r_x, r, r_x."""
    (q, v, a), data, damped = states, batch.lane_data, group[DAMPED]
    h, inv_l, mass = load(data, chunk, LENGTH), load(data, chunk, INV_L), load(data, chunk, MASS)
    u, y = apart(in_elements(q, inv_l)), apart(in_elements(x, inv_l))
    G, dG = products(u), product_rates(u, y)
    moved = G, dG, along_length(G), along_length(dG)
    work, along = axial_work(batch, group, chunk, moved, load(data, chunk, EA_L))
    add_row(out, chunk, EA_L, work)
    work, more = bending_work(batch, group, chunk, moved, inv_l, load(data, chunk, EI_L))
    add_row(out, chunk, EI_L, work)
    along = along + more
    if damped & AXIALLY:
        vG, da = product_rates(u, apart(in_elements(v, inv_l))), load(data, chunk, DA_L)
        add_row(out, chunk, DA_L, axial_loss(batch, group, G, dG, vG))
        if total(absolute(da)) > 0.0:
            along = along + axial_loss_along(batch, group, moved, vG, da)
    if damped & IN_BENDING:
        add_row(out, chunk, DB_L, bending_loss(batch, group, q, v, x, inv_l))
        db = load(data, chunk, DB_L)
        if total(absolute(db)) > 0.0:
            more = every(0.0)
            for k in range(4):
                place, weight = CHANGES[k]
                more = more + weight * bending_loss(batch, group, q, v, x, (1.0 + CHANGE * place) * inv_l)
            along = along + db * ((1.0 / CHANGE) * more)
    if damped & IN_SLOPE:
        work, more = slope_loss(in_elements(v, inv_l), in_elements(x, inv_l))
        at = LANES * (ROWS * data.shape[0] + chunk)
        store(load(out, at) + work, out, at)
        along = along + load(batch.lane_slope, chunk, 0) * more
    add_row(out, chunk, INV_L, h * along)
    work, more = inertia_work(a, x, h)
    if damped & VISCOUSLY:
        c, (lost, lost_more) = load(data, chunk, VISCOUS), inertia_work(v, x, h)
        add_row(out, chunk, VISCOUS, lost)
        more = more + c * lost_more
    add_row(out, chunk, MASS, work)
    add_row(out, chunk, LENGTH, mass * more)
