"""Derivatives of the forces of cable elements along changes of their constants, for LANES elements at a time.

The shape is looked at once for the changes by all parameters.  Forces are linear in stiffnesses, dampings and
masses.  The length acts through d = (r_2 - r_1)/L and 1/L in b and c, see :mod:`ancf.elements.cable_numbers`:
with R = 2 dW/dG the derivative of the forces along l, d along itself and u1, u2 against it, is

    forces(R, u)' = forces(R', u) + forces(R, l),

and the nodes feel 1/L of the force on d.
"""

from __future__ import annotations

import numpy as np

from ..compiled import formula, inline_kernel
from ..simd import LANES, every, load, zero
from .cable_columns import (
    AXIAL,
    AXIALLY,
    BEGIN,
    BENDING,
    CURVATURE,
    CURVED,
    DA_L,
    DAMPED,
    DB_L,
    EA_L,
    EI_L,
    END,
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
from .cable_nodes import add_to_nodes, nodes
from .cable_numbers import CHANGE, CHANGES, ROWS, along_length, apart, by_length, in_elements, row
from .cable_strain import (
    WEIGHT,
    a_of,
    add_a,
    add_abc,
    axial_force,
    axial_slope,
    b_of,
    bend,
    bending_force,
    c_of,
    curvature_slopes,
    forces,
    product_rates,
    products,
    slope,
)
from .workspace import rows, set_rows

#: Bits of the kinds of a change: of the rows of the constants, and of the damping of slopes.
IN_EA, IN_EI, IN_DA, IN_DB, IN_INV_L, IN_SLOPES = (1 << k for k in (EA_L, EI_L, DA_L, DB_L, INV_L, ROWS))
#: Places in the workspace of what they do.
ALONG, ACROSS, DAMPED_ALONG, DAMPED_ACROSS, OF_SLOPES, LONGER = range(6)
IN_LENGTH, IN_MASS = 1 << LENGTH, (1 << MASS) | (1 << VISCOUS)


def kinds_of(batch, rates):
    """Which rows of the constants of each chunk a change has, as bits; see :class:`ancf.compiled.Traits`."""
    chunks = len(batch.lane_data)
    data, slopes = np.split(rates.reshape(-1, LANES), [ROWS * chunks])
    rows = np.hstack([data.reshape(chunks, ROWS, LANES).any(axis=2), slopes.any(axis=1)[:, None]])
    return rows @ (1 << np.arange(ROWS + 1))


@formula
def plus(x, y):
    """Sum of three and three vectors."""
    return x[0] + y[0], x[1] + y[1], x[2] + y[2]


@formula
def times(w, x):
    """Lanes times three vectors."""
    return w * x[0], w * x[1], w * x[2]


@formula
def nothing():
    """No forces on d, t1 and t2."""
    return zero(), zero(), zero()


@formula
def no_sums():
    """R of no Gauss point."""
    none = every(0.0)
    return none, none, none, none, none, none


@formula
def stretched(batch, group, chunk, u):
    """Forces on d, t1 and t2 of the axial strain per EA L."""
    G, R, paper = products(u), no_sums(), group[PAPER] != 0
    for k in range(group[AXIAL]):
        at, eps0 = batch.gp[group[FIRST] + k], row(batch, chunk, k, group[CURVED] != 0)
        R = add_a(R, at, at[WEIGHT] * axial_force(a_of(at, G), eps0, paper))
    return forces(R, u)


@formula
def bent(batch, group, chunk, u, inv_l):
    """The same of the curvature per EI L."""
    G, R, inv_l2, paper, curved = products(u), no_sums(), inv_l * inv_l, group[PAPER] != 0, group[CURVED] != 0
    for k in range(group[BENDING]):
        at, kappa0 = batch.gp[group[FIRST] + group[AXIAL] + k], row(batch, chunk, CURVATURE + k, curved)
        a, b, c = a_of(at, G), inv_l * b_of(at, G), inv_l2 * c_of(at, G)
        wa, wb, wc = bending_force(a, b, c, kappa0, paper, curved)
        R = add_abc(R, at, at[WEIGHT] * wa, at[WEIGHT] * inv_l * wb, at[WEIGHT] * inv_l2 * wc)
    return forces(R, u)


@formula
def damped_axially(batch, group, u, rates):
    """The same of the axial damping per D_a L; ``rates`` of d, u1 and u2."""
    G, dG, R = products(u), product_rates(u, rates), no_sums()
    for k in range(group[AXIAL]):
        at = batch.gp[group[FIRST] + k]
        R = add_a(R, at, at[WEIGHT] * axial_damping(a_of(at, G), a_of(at, dG), group[PAPER] != 0))
    return forces(R, u)


@formula
def damped_in_bending(batch, group, q, v, inv_l):
    """The same of the damping of bending per D_b L."""
    gp, first, (fd, f1, f2) = batch.gp, group[FIRST] + group[AXIAL], nothing()
    (d, t1, t2), (vd, v1, v2) = in_elements(q, inv_l), in_elements(v, inv_l)
    for g in range(first, first + group[BENDING]):
        p, s = slope(gp, g, d, t1, t2), bend(gp, g, d, t1, t2, inv_l)
        dp, ds = slope(gp, g, vd, v1, v2), bend(gp, g, vd, v1, v2, inv_l)
        n, m = bending_damping(p, s, dp, ds, group[PAPER] != 0, inv_l)
        n, m = gp[g, WEIGHT] * n, gp[g, WEIGHT] * inv_l * m
        fd = fd + gp[g, 0] * n + gp[g, 3] * m
        f1 = f1 + gp[g, 1] * n + gp[g, 4] * m
        f2 = f2 + gp[g, 2] * n + gp[g, 5] * m
    return fd, f1, f2


@formula
def stretched_longer(batch, group, chunk, u, rates, ea, da):
    """R of the axial strain and its damping, and its derivative along l."""
    gp, paper, G, dG = batch.gp, group[PAPER] != 0, products(u), product_rates(u, rates)
    lG, ldG, R, along = along_length(G), along_length(dG), no_sums(), no_sums()
    damped = group[DAMPED] & AXIALLY != 0
    for k in range(group[AXIAL]):
        at, eps0 = gp[group[FIRST] + k], row(batch, chunk, k, group[CURVED] != 0)
        a, la, w = a_of(at, G), a_of(at, lG), at[WEIGHT] * ea
        R = add_a(R, at, w * axial_force(a, eps0, paper))
        along = add_a(along, at, w * axial_slope(a, eps0, paper) * la)
        if damped:
            w = at[WEIGHT] * da
            f, lf = axial_damping(a, a_of(at, dG), paper), axial_damping(a, a_of(at, ldG), paper)
            if not paper:
                lf = lf - f * la / a
            R, along = add_a(R, at, w * f), add_a(along, at, w * lf)
    return R, along


@formula
def bent_longer(batch, group, chunk, u, inv_l, ei):
    """R of the curvature and its derivative along l."""
    gp, paper, curved, inv_l2 = batch.gp, group[PAPER] != 0, group[CURVED] != 0, inv_l * inv_l
    G, R, along = products(u), no_sums(), no_sums()
    lG = along_length(G)
    for k in range(group[BENDING]):
        at, kappa0 = gp[group[FIRST] + group[AXIAL] + k], row(batch, chunk, CURVATURE + k, curved)
        a, b, c = a_of(at, G), inv_l * b_of(at, G), inv_l2 * c_of(at, G)
        la, lb, lc = a_of(at, lG), b + inv_l * b_of(at, lG), 2.0 * c + inv_l2 * c_of(at, lG)
        first, second = curvature_slopes(a, b, c, kappa0, ei, paper, curved)
        (wa, wb, wc), (haa, hab, hac, hbb, hbc, hcc), w = first, second, 2.0 * at[WEIGHT]
        R = add_abc(R, at, w * wa, w * inv_l * wb, w * inv_l2 * wc)
        lwa = haa * la + hab * lb + hac * lc
        lwb = hab * la + hbb * lb + hbc * lc + wb
        lwc = hac * la + hbc * lb + hcc * lc + 2.0 * wc
        along = add_abc(along, at, w * lwa, w * inv_l * lwb, w * inv_l2 * lwc)
    return R, along


@formula
def longer(batch, group, chunk, q, v):
    """Derivative by ln(1/L) of the forces on d, divided by L, t1 and t2, times L on d."""
    data, damped, inv_l = batch.lane_data, group[DAMPED], load(batch.lane_data, chunk, INV_L)
    u, rates = apart(in_elements(q, inv_l)), in_elements(v, inv_l)
    ea, da = load(data, chunk, EA_L), load(data, chunk, DA_L)
    R, along = stretched_longer(batch, group, chunk, u, apart(rates), ea, da)
    found = plus(plus(forces(along, u), forces(R, by_length(u))), (forces(R, u)[0], zero(), zero()))
    R, along = bent_longer(batch, group, chunk, u, inv_l, load(data, chunk, EI_L))
    found = plus(found, plus(forces(along, u), forces(R, by_length(u))))
    found = plus(found, (forces(R, u)[0], zero(), zero()))
    if damped & IN_BENDING:
        for k in range(4):
            place, weight = CHANGES[k]
            factor = 1.0 + CHANGE * place
            fd, f1, f2 = damped_in_bending(batch, group, q, v, factor * inv_l)
            w = (weight / CHANGE) * load(data, chunk, DB_L)
            found = plus(found, times(w, (factor * fd, f1, f2)))
    if damped & IN_SLOPE:
        c, (vd, v1, v2) = load(batch.lane_slope, chunk, 0), rates
        nd, _, _ = slope_damping(c, vd, v1, v2)
        found = plus(found, slope_damping(c, vd, zero(), zero()))
        found = plus(found, (nd, zero(), zero()))
    return found


@formula
def put(ws, k, x):
    """Keep the forces of a kind in the workspace."""
    set_rows(ws, 9 * k, x[0])
    set_rows(ws, 9 * k + 3, x[1])
    set_rows(ws, 9 * k + 6, x[2])


@formula
def kept(ws, k):
    """What :func:`put` has kept."""
    return rows(ws, 9 * k), rows(ws, 9 * k + 3), rows(ws, 9 * k + 6)


@formula
def all_forces(batch, group, chunk, q, v, needed, ws):
    """Keep what a change of each kind that is ``needed`` does on d, t1 and t2."""
    inv_l = load(batch.lane_data, chunk, INV_L)
    u, rates = apart(in_elements(q, inv_l)), in_elements(v, inv_l)
    if needed & IN_EA:
        put(ws, ALONG, stretched(batch, group, chunk, u))
    if needed & IN_EI:
        put(ws, ACROSS, bent(batch, group, chunk, u, inv_l))
    if needed & IN_DA:
        put(ws, DAMPED_ALONG, damped_axially(batch, group, u, apart(rates)))
    if needed & IN_DB:
        put(ws, DAMPED_ACROSS, damped_in_bending(batch, group, q, v, inv_l))
    if needed & IN_SLOPES:
        put(ws, OF_SLOPES, slope_damping(every(1.0), *rates))
    if needed & IN_INV_L:
        put(ws, LONGER, longer(batch, group, chunk, q, v))


@formula
def inertia(a, h):
    """Forces on the four slots per rhoA L/420 of accelerations of them (eq. 23)."""
    a1, s1, a2, s2 = a
    s1, s2 = h * s1, h * s2
    return (
        156.0 * a1 + 22.0 * s1 + 54.0 * a2 - 13.0 * s2,
        h * (22.0 * a1 + 4.0 * s1 + 13.0 * a2 - 3.0 * s2),
        54.0 * a1 + 13.0 * s1 + 156.0 * a2 - 22.0 * s2,
        h * (4.0 * s2 - 13.0 * a1 - 3.0 * s1 - 22.0 * a2),
    )


@formula
def inertia_longer(a, h):
    """Their derivatives by L."""
    a1, s1, a2, s2 = a
    return (
        22.0 * s1 - 13.0 * s2,
        22.0 * a1 + 13.0 * a2 + (2.0 * h) * (4.0 * s1 - 3.0 * s2),
        13.0 * s1 - 22.0 * s2,
        (2.0 * h) * (4.0 * s2 - 3.0 * s1) - 13.0 * a1 - 22.0 * a2,
    )


@formula
def both(w, x, c, y):
    """w x + c y of four vectors each."""
    return w * x[0] + c * y[0], w * x[1] + c * y[1], w * x[2] + c * y[2], w * x[3] + c * y[3]


@formula
def rate(rates, chunk, k):
    """A row of a change of the constants."""
    return load(rates, LANES * (ROWS * chunk + k))


@formula
def add_change(batch, group, chunk, states, rates, kind, out, ws):
    """Add what a change of these kinds does, of which :func:`all_forces` keeps the parts."""
    (_, v, a), data, f = states, batch.lane_data, nothing()
    h, inv_l = load(data, chunk, LENGTH), load(data, chunk, INV_L)
    if kind & IN_EA:
        f = plus(f, times(rate(rates, chunk, EA_L), kept(ws, ALONG)))
    if kind & IN_EI:
        f = plus(f, times(rate(rates, chunk, EI_L), kept(ws, ACROSS)))
    if kind & IN_DA:
        f = plus(f, times(rate(rates, chunk, DA_L), kept(ws, DAMPED_ALONG)))
    if kind & IN_DB:
        f = plus(f, times(rate(rates, chunk, DB_L), kept(ws, DAMPED_ACROSS)))
    if kind & IN_SLOPES:
        f = plus(f, times(load(rates, LANES * (ROWS * data.shape[0] + chunk)), kept(ws, OF_SLOPES)))
    if kind & IN_INV_L:
        f = plus(f, times(h * rate(rates, chunk, INV_L), kept(ws, LONGER)))
    end = inv_l * f[0]
    forced = -1.0 * end, f[1], end, f[2]
    if kind & IN_MASS:
        moved = both(rate(rates, chunk, MASS), a, rate(rates, chunk, VISCOUS), v)
        forced = both(1.0, forced, 1.0, inertia(moved, h))
    if kind & IN_LENGTH:
        moved = a
        if group[DAMPED] & VISCOUSLY:
            moved = both(1.0, a, load(data, chunk, VISCOUS), v)
        w = load(data, chunk, MASS) * rate(rates, chunk, LENGTH)
        forced = both(1.0, forced, w, inertia_longer(moved, h))
    add_to_nodes(batch, out, chunk, forced)


@inline_kernel
def cable_changes(batch, q, v, a, rates, kinds, begin, out, ws):
    """See :func:`ancf.compiled.add_changes`."""
    chunks, count = batch.lane_data.shape[0], begin.shape[0]
    numbers = (ROWS + 1) * LANES * chunks
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        for chunk in range(group[BEGIN], group[END]):
            needed = 0
            for p in range(count):
                needed |= kinds[p * chunks + chunk]
            if needed == 0:
                continue
            states = nodes(batch, q, chunk), nodes(batch, v, chunk), nodes(batch, a, chunk)
            all_forces(batch, group, chunk, states[0], states[1], needed, ws)
            for p in range(count):
                kind, own = kinds[p * chunks + chunk], rates[p * numbers : (p + 1) * numbers]
                if kind != 0:
                    add_change(batch, group, chunk, states, own, kind, out[begin[p] :], ws)
