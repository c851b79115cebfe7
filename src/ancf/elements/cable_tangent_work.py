"""Products of the stiffness of cables with a vector, without the matrix: for LANES elements at a time.

With R = 2 dW/dG of the products G of the shape, see :mod:`ancf.elements.cable_strain`, along a change y of
the shape forces change by forces(R', u) + forces(R, y): G moves by G', and R by R' = 2 d2W/dG2 G'.
"""

from __future__ import annotations

from ..compiled import formula, inline_kernel
from ..simd import every, load
from .cable_columns import AXIAL, BENDING, CURVATURE, CURVED, EA_L, EI_L, FIRST, INV_L, PAPER
from .cable_strain import (
    WEIGHT,
    a_of,
    add_a,
    add_abc,
    axial_force,
    axial_slope,
    b_of,
    c_of,
    curvature_slopes,
    forces,
    product_rates,
    products,
)


@formula
def reference(batch, chunk, k, curved):
    """Row k of the reference strains; zero for a straight reference."""
    return load(batch.lane_reference, chunk, k) if curved else every(0.0)


@inline_kernel
def elastic_along(batch, group, chunk, u, y):
    """Change of the elastic forces on d, t1 and t2 along y; both as d, u1 and u2."""
    gp, paper, curved, none = batch.gp, group[PAPER] != 0, group[CURVED] != 0, every(0.0)
    G, dG = products(u), product_rates(u, y)
    R = along = none, none, none, none, none, none
    ea, ei = load(batch.lane_data, chunk, EA_L), load(batch.lane_data, chunk, EI_L)
    for k in range(group[AXIAL]):
        at, eps0 = gp[group[FIRST] + k], reference(batch, chunk, k, curved)
        a, w = a_of(at, G), at[WEIGHT] * ea
        R = add_a(R, at, w * axial_force(a, eps0, paper))
        along = add_a(along, at, w * axial_slope(a, eps0, paper) * a_of(at, dG))
    inv_l = load(batch.lane_data, chunk, INV_L)
    inv_l2 = inv_l * inv_l
    for k in range(group[BENDING]):
        at, kappa0 = gp[group[FIRST] + group[AXIAL] + k], reference(batch, chunk, CURVATURE + k, curved)
        a, b, c = a_of(at, G), inv_l * b_of(at, G), inv_l2 * c_of(at, G)
        da, db, dc = a_of(at, dG), inv_l * b_of(at, dG), inv_l2 * c_of(at, dG)
        first, second = curvature_slopes(a, b, c, kappa0, (2.0 * at[WEIGHT]) * ei, paper, curved)
        (wa, wb, wc), (haa, hab, hac, hbb, hbc, hcc) = first, second
        R = add_abc(R, at, wa, inv_l * wb, inv_l2 * wc)
        dwa, dwb = haa * da + hab * db + hac * dc, hab * da + hbb * db + hbc * dc
        dwc = hac * da + hbc * db + hcc * dc
        along = add_abc(along, at, dwa, inv_l * dwb, inv_l2 * dwc)
    (fd, f1, f2), (ed, e1, e2) = forces(along, u), forces(R, y)
    return fd + ed, f1 + e1, f2 + e2
