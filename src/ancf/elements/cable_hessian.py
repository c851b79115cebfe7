"""Second derivatives of the cable's strain energy, for LANES elements at a time.

The energy W knows an element by the products G of d, u1 and u2 (:mod:`ancf.elements.cable_strain`).  Over the
Gauss points R = 2 dW/dG and H = d2W/dG2 are summed up, 6 and 21 numbers, H by rows i <= j.  The blocks
between d, t1 and t2 follow once from these: G_x^T H G_x with the derivatives G_x of the products by the
vectors, and R/2 times their second derivatives, which are multiples of the unit matrix.
"""

from __future__ import annotations

from ..compiled import formula
from ..simd import every, load, vector
from .cable_columns import AXIAL, BENDING, CURVATURE, CURVED, FIRST, INV_L, PAPER
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
    products,
)
from .cable_tangent import K11, K12, K22, KD1, KD2, KDD
from .workspace import add_rows


@formula
def plus_a(H, v, g):
    """H and v g^T, of a symmetric sum the entries i <= j, where g are all six numbers."""
    (
        (h00, h01, h02, h03, h04, h05),
        (h11, h12, h13, h14, h15),
        (h22, h23, h24, h25),
        (h33, h34, h35),
        (h44, h45),
        (h55,),
    ) = H
    return (
        (
            h00 + g[0] * v[0],
            h01 + g[1] * v[0],
            h02 + g[2] * v[0],
            h03 + g[3] * v[0],
            h04 + g[4] * v[0],
            h05 + g[5] * v[0],
        ),
        (h11 + g[1] * v[1], h12 + g[2] * v[1], h13 + g[3] * v[1], h14 + g[4] * v[1], h15 + g[5] * v[1]),
        (h22 + g[2] * v[2], h23 + g[3] * v[2], h24 + g[4] * v[2], h25 + g[5] * v[2]),
        (h33 + g[3] * v[3], h34 + g[4] * v[3], h35 + g[5] * v[3]),
        (h44 + g[4] * v[4], h45 + g[5] * v[4]),
        (h55 + g[5] * v[5],),
    )


@formula
def plus_b(H, v, g):
    """The same where g are the last five."""
    (
        (h00, h01, h02, h03, h04, h05),
        (h11, h12, h13, h14, h15),
        (h22, h23, h24, h25),
        (h33, h34, h35),
        (h44, h45),
        (h55,),
    ) = H
    return (
        (h00, h01 + g[0] * v[0], h02 + g[1] * v[0], h03 + g[2] * v[0], h04 + g[3] * v[0], h05 + g[4] * v[0]),
        (h11 + g[0] * v[1], h12 + g[1] * v[1], h13 + g[2] * v[1], h14 + g[3] * v[1], h15 + g[4] * v[1]),
        (h22 + g[1] * v[2], h23 + g[2] * v[2], h24 + g[3] * v[2], h25 + g[4] * v[2]),
        (h33 + g[2] * v[3], h34 + g[3] * v[3], h35 + g[4] * v[3]),
        (h44 + g[3] * v[4], h45 + g[4] * v[4]),
        (h55 + g[4] * v[5],),
    )


@formula
def plus_c(H, v, g):
    """The same where g are the last three."""
    (
        (h00, h01, h02, h03, h04, h05),
        (h11, h12, h13, h14, h15),
        (h22, h23, h24, h25),
        (h33, h34, h35),
        (h44, h45),
        (h55,),
    ) = H
    return (
        (h00, h01, h02, h03 + g[0] * v[0], h04 + g[1] * v[0], h05 + g[2] * v[0]),
        (h11, h12, h13 + g[0] * v[1], h14 + g[1] * v[1], h15 + g[2] * v[1]),
        (h22, h23 + g[0] * v[2], h24 + g[1] * v[2], h25 + g[2] * v[2]),
        (h33 + g[0] * v[3], h34 + g[1] * v[3], h35 + g[2] * v[3]),
        (h44 + g[1] * v[4], h45 + g[2] * v[4]),
        (h55 + g[2] * v[5],),
    )


@formula
def of_a(at):
    """Derivatives of a by G, at a row of ``gp``."""
    return 1.0, at[7], at[8], at[9], at[10], at[11]


@formula
def along(ha, hb, hc, at):
    """ha, hb and hc times the derivatives of a, L b and L^2 c by G."""
    return (
        ha,
        at[7] * ha + at[12] * hb,
        at[8] * ha + at[13] * hb,
        at[9] * ha + at[14] * hb + at[17] * hc,
        at[10] * ha + at[15] * hb + at[18] * hc,
        at[11] * ha + at[16] * hb + at[19] * hc,
    )


@formula
def axial_part(batch, group, chunk, G, sums, ea, da):
    """Add to R and H what the axial strain does, and to H the damping, whose constant is da."""
    gp, paper, curved = batch.gp, group[PAPER] != 0, group[CURVED] != 0
    R, H = sums
    for k in range(group[AXIAL]):
        at = gp[group[FIRST] + k]
        a, eps0 = a_of(at, G), load(batch.lane_reference, chunk, k) if curved else every(0.0)
        R = add_a(R, at, at[WEIGHT] * ea * axial_force(a, eps0, paper))
        lost = 0.25 * da if paper else 0.25 * da / a
        h = at[WEIGHT] * (0.5 * ea * axial_slope(a, eps0, paper) + lost)
        H = plus_a(H, along(h, every(0.0), every(0.0), at), of_a(at))
    return R, H


@formula
def bending_part(batch, group, chunk, G, sums, ei):
    """Add to R and H what the curvature does."""
    gp, paper, curved = batch.gp, group[PAPER] != 0, group[CURVED] != 0
    (R, H), il = sums, load(batch.lane_data, chunk, INV_L)
    il2 = il * il
    for k in range(group[BENDING]):
        at = gp[group[FIRST] + group[AXIAL] + k]
        kappa0 = load(batch.lane_reference, chunk, CURVATURE + k) if curved else every(0.0)
        a, b, c = a_of(at, G), il * b_of(at, G), il2 * c_of(at, G)
        first, second = curvature_slopes(a, b, c, kappa0, at[WEIGHT] * ei, paper, curved)
        (wa, wb, wc), (haa, hab, hac, hbb, hbc, hcc) = first, second
        R = add_abc(R, at, 2.0 * wa, 2.0 * il * wb, 2.0 * il2 * wc)
        hab, hac, hbb, hbc, hcc = il * hab, il2 * hac, il2 * hbb, il * il2 * hbc, il2 * il2 * hcc
        H = plus_a(H, along(haa, hab, hac, at), of_a(at))
        H = plus_b(H, along(hab, hbb, hbc, at), at[12:17])
        H = plus_c(H, along(hac, hbc, hcc, at), at[17:20])
    return R, H


@formula
def rows_of(c, x, unit):
    """Rows of unit I + sum c_mn x_m x_n^T, a 3x3 block, with the vectors x = (d, u1, u2)."""
    (c0, c1, c2), (d, u1, u2), none = c, x, every(0.0)
    y0 = c0[0] * d + c0[1] * u1 + c0[2] * u2
    y1 = c1[0] * d + c1[1] * u1 + c1[2] * u2
    y2 = c2[0] * d + c2[1] * u1 + c2[2] * u2
    return (
        d[0] * y0 + u1[0] * y1 + u2[0] * y2 + vector(unit, none, none),
        d[1] * y0 + u1[1] * y1 + u2[1] * y2 + vector(none, unit, none),
        d[2] * y0 + u1[2] * y1 + u2[2] * y2 + vector(none, none, unit),
    )


@formula
def turned(A):
    """A^T."""
    x, y, z = A
    return vector(x[0], y[0], z[0]), vector(x[1], y[1], z[1]), vector(x[2], y[2], z[2])


@formula
def minus(A, B, C):
    """A - B - C."""
    return A[0] - B[0] - C[0], A[1] - B[1] - C[1], A[2] - B[2] - C[2]


@formula
def add_to(ws, block, A):
    """Add a 3x3 block to its rows of the workspace."""
    add_rows(ws, block, A[0])
    add_rows(ws, block + 3, A[1])
    add_rows(ws, block + 6, A[2])


@formula
def add_blocks(ws, x, R, H):
    """Add the blocks between d, t1 and t2 of R and H at x = (d, u1, u2): u1 = t1 - d and u2 = t2 - d."""
    (
        (h00, h01, h02, h03, h04, h05),
        (h11, h12, h13, h14, h15),
        (h22, h23, h24, h25),
        (h33, h34, h35),
        (h44, h45),
        (h55,),
    ) = H
    i02, i13, i15, i23, i25, i34, i45 = (
        2.0 * h02,
        2.0 * h13,
        2.0 * h15,
        2.0 * h23,
        2.0 * h25,
        2.0 * h34,
        2.0 * h45,
    )
    i01, i04 = 2.0 * h01, 2.0 * h04
    one = rows_of(((h11, i13, h14), (i13, 4.0 * h33, i34), (h14, i34, h44)), x, R[3])
    both = rows_of(((h12, h14, i15), (i23, i34, 4.0 * h35), (h24, h44, i45)), x, 0.5 * R[4])
    two = rows_of(((h22, h24, i25), (h24, h44, i45), (i25, i45, 4.0 * h55)), x, R[5])
    add_to(ws, K11, one)
    add_to(ws, K12, both)
    add_to(ws, K22, two)
    left = rows_of(((i01, 4.0 * h03, i04), (h11, i13, h14), (h12, i23, h24)), x, 0.5 * R[1])
    right = rows_of(((i02, i04, 4.0 * h05), (h12, h14, i15), (h22, h24, i25)), x, 0.5 * R[2])
    whole = rows_of(((4.0 * h00, i01, i02), (i01, h11, h12), (i02, h12, h22)), x, R[0])
    left_t, right_t = minus(left, one, turned(both)), minus(right, both, two)
    add_to(ws, KD1, left_t)
    add_to(ws, KD2, right_t)
    whole = minus(whole, turned(left), turned(right))
    add_to(ws, KDD, minus(whole, left_t, right_t))


@formula
def add_elastic(batch, group, chunk, x, ws, ea, ei, da, bends):
    """Add the tangents of both strains in the shape x = (d, u1, u2), and the axial damping, to the blocks.

    ``bends``: ei is not zero.
    """
    none, G = every(0.0), products(x)
    R = none, none, none, none, none, none
    three = none, none, none
    H = (*three, *three), (none, none, *three), (none, *three), three, (none, none), (none,)
    R, H = axial_part(batch, group, chunk, G, (R, H), ea, da)
    if bends:
        R, H = bending_part(batch, group, chunk, G, (R, H), ei)
    add_blocks(ws, x, R, H)
