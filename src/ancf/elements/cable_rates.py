"""What velocities do to the stiffness of a damped cable: the derivative of its damping forces by the shape.

At a Gauss point the damping forces on p and s follow from p and s and their rates (:mod:`cable_damping`).
Their derivative N by p and s, at the same rates, is not symmetric.  It is found column by column, along the
six unit vectors of (p, s), and parted into halves (N + N^T)/2 and (N - N^T)/2, which are spread over the
blocks between d, t1 and t2 as the tangent is.
"""

from __future__ import annotations

import numpy as np

from ..compiled import formula, inline_kernel
from ..simd import LANES, every, load, scatter_nodes, vector, zero
from ..vectors import dot
from .cable_damping import normal
from .cable_strain import WEIGHT, bend, slope
from .cable_tangent import PLACES, spread, spread_slope
from .workspace import rows, set_rows

#: First rows of the workspace: the blocks of the antisymmetric half, and the columns of N on p and on s.
TWIST, COLUMNS = 60, 120


@formula
def axial_columns(p, dp, damping, paper):
    """Columns of the derivative by p of the axial damping's force on p."""
    a, u = dot(p, p), dot(p, dp)
    rate, g = u, dp
    if not paper:
        rate, g = u / a, (1.0 / a) * dp - (2.0 * u / (a * a)) * p
    rate, g, none = damping * rate, damping * g, every(0.0)
    return (
        g[0] * p + vector(rate, none, none),
        g[1] * p + vector(none, rate, none),
        g[2] * p + vector(none, none, rate),
    )


@inline_kernel
def bending_state(p, s, dp, ds, paper, inv_l):
    """What the derivatives of :func:`ancf.elements.cable_damping.bending_damping` share."""
    z, ba, ia, gg, e, nu = normal(p, s, paper, inv_l)
    pdp = dot(p, dp) * ia
    f = dot(p, ds) * ia - ba * pdp
    y = ds - ba * dp - f * p - ((2.0 if paper else 1.0) * pdp) * z
    g = gg * nu
    inner = e * y + (g * dot(z, y)) * z
    b = gg * inner
    return z, y, inner, b, ba, ia, gg, e, nu, pdp, f, g, dot(z, y), dot(z, z), dot(z, b)


@formula
def changed_force(x, z_, y_, ba_, ia_, gg_, paper, p, p_):
    """Changes of the forces on p and s, where z, y, (p.s)/a, 1/a and g^2 change by these."""
    z, y, inner, b, ba, ia, gg, e, nu, _, _, g, zy, zz, zb = x
    k = 2.0 if paper else 1.0
    nu_ = -nu * nu * (gg_ * zz + 2.0 * gg * dot(z, z_))
    g_, zy_ = gg_ * nu + gg * nu_, dot(z_, y) + dot(z, y_)
    b_ = gg_ * inner + gg * ((e * (nu_ / nu)) * y + e * y_ + (g_ * zy + g * zy_) * z + (g * zy) * z_)
    zb_ = dot(z_, b) + dot(z, b_)
    return (-k * (ia_ * zb + ia * zb_)) * p - (k * ia * zb) * p_ - ba_ * b - ba * b_, b_


@inline_kernel
def along_p(x, p, dp, own, one, paper):
    """Changes of both forces along a unit vector ``one`` of p; ``own``: parts of p, s, dp, ds along it."""
    z, _, _, _, ba, ia, _, _, _, pdp, f = x[:11]
    pi, si, dpi, dsi = own
    k = 2.0 if paper else 1.0
    ia_ = -2.0 * ia * ia * pi
    ba_ = si * ia - 2.0 * ba * ia * pi
    pdp_ = dpi * ia - 2.0 * pdp * ia * pi
    f_ = dsi * ia - 2.0 * (f + ba * pdp) * ia * pi - ba_ * pdp - ba * pdp_
    z_ = -ba_ * p - ba * one
    y_ = -ba_ * dp - f_ * p - f * one - (k * pdp_) * z - (k * pdp) * z_
    return changed_force(x, z_, y_, ba_, ia_, 2.0 * ia * ia_ if paper else ia_, paper, p, one)


@inline_kernel
def along_s(x, p, dp, pi, one, paper):
    """The same along a unit vector of s; ``pi``: component of p along it."""
    pdp, none = x[9], every(0.0)
    ba_ = pi * x[5]
    z_ = one - ba_ * p
    y_ = (ba_ * pdp) * p - ba_ * dp - ((2.0 if paper else 1.0) * pdp) * z_
    return changed_force(x, z_, y_, ba_, none, none, paper, p, zero())


@inline_kernel
def keep(ws, at, w, force):
    """Keep the weighted column of both forces in the workspace."""
    set_rows(ws, at, w * force[0])
    set_rows(ws, at + 9, w * force[1])


@inline_kernel
def bending_columns(ws, p, s, dp, ds, w, paper, inv_l):
    """Keep the columns of the derivative of bending's damping forces in the workspace."""
    x, none, one = bending_state(p, s, dp, ds, paper, inv_l), every(0.0), every(1.0)
    ex, ey, ez = vector(one, none, none), vector(none, one, none), vector(none, none, one)
    keep(ws, COLUMNS, w, along_p(x, p, dp, (p[0], s[0], dp[0], ds[0]), ex, paper))
    keep(ws, COLUMNS + 3, w, along_p(x, p, dp, (p[1], s[1], dp[1], ds[1]), ey, paper))
    keep(ws, COLUMNS + 6, w, along_p(x, p, dp, (p[2], s[2], dp[2], ds[2]), ez, paper))
    keep(ws, COLUMNS + 18, w, along_s(x, p, dp, p[0], ex, paper))
    keep(ws, COLUMNS + 21, w, along_s(x, p, dp, p[1], ey, paper))
    keep(ws, COLUMNS + 24, w, along_s(x, p, dp, p[2], ez, paper))


@formula
def half(block, other, sign):
    """Three rows of (N + N^T)/2, or with the sign -1 of (N - N^T)/2, of a 3x3 block given by its columns.

    ``other`` are the columns of the block on the other side of the diagonal.
    """
    (x, y, z), (u, v, w) = block, other
    return (
        0.5 * (vector(x[0], y[0], z[0]) + sign * u),
        0.5 * (vector(x[1], y[1], z[1]) + sign * v),
        0.5 * (vector(x[2], y[2], z[2]) + sign * w),
    )


@formula
def columns(ws, k):
    """Three columns that were kept from row k of the workspace on."""
    return rows(ws, k), rows(ws, k + 3), rows(ws, k + 6)


@inline_kernel
def spread_half(ws, to, gp, g, inv_l, sign):
    """Add one half of the derivative of bending at a Gauss point to the blocks."""
    pp, sp = columns(ws, COLUMNS), columns(ws, COLUMNS + 9)
    ps, ss = columns(ws, COLUMNS + 18), columns(ws, COLUMNS + 27)
    made = half(pp, pp, sign), half(ps, sp, sign), half(sp, ps, sign), half(ss, ss, sign)
    spread(to, gp, g, inv_l, made)


@inline_kernel
def rate_blocks(ws, gp, x, v, da, db, inv_l, paper, axial, bending):
    """Add both halves of the derivatives by the shape x = (d, t1, t2) with the rates v to the blocks.

    ``da`` and ``db``: constants of damping; ``axial`` and ``bending``: their rows of ``gp``, from and to.
    """
    (d, t1, t2), (vd, v1, v2) = x, v
    twist = ws[TWIST * LANES :]
    for g in range(axial[0], axial[1]):
        p, dp = slope(gp, g, d, t1, t2), slope(gp, g, vd, v1, v2)
        own = axial_columns(p, dp, gp[g, WEIGHT] * da, paper)
        spread_slope(ws, gp, g, half(own, own, 1.0))
        spread_slope(twist, gp, g, half(own, own, -1.0))
    for g in range(bending[0], bending[1]):
        p, s = slope(gp, g, d, t1, t2), bend(gp, g, d, t1, t2, inv_l)
        dp, ds = slope(gp, g, vd, v1, v2), bend(gp, g, vd, v1, v2, inv_l)
        bending_columns(ws, p, s, dp, ds, gp[g, WEIGHT] * db, paper, inv_l)
        spread_half(ws, ws, gp, g, inv_l, 1.0)
        spread_half(ws, twist, gp, g, inv_l, -1.0)


#: Signs of the blocks between two slots: those that are kept on the other side of the diagonal change theirs.
SIGNS = np.where(PLACES[:, 1] == 3, 1.0, -1.0)


@inline_kernel
def store_twist(batch, W, ws, chunk, m, inv_l):
    """Add the antisymmetric half of lane m of a chunk to the block values W."""
    e = batch.first[chunk] + m
    for x in range(4):
        for y in range(4):
            place = batch.dest[e, 4 * x + y]
            if place < 0:
                continue
            scale = (inv_l * (x - 1.0) if x % 2 == 0 else 1.0) * (inv_l * (y - 1.0) if y % 2 == 0 else 1.0)
            scale *= SIGNS[4 * x + y]
            origin = PLACES[4 * x + y]
            first, row, column = (TWIST + origin[0]) * LANES + m, origin[1] * LANES, origin[2] * LANES
            for i in range(3):
                for j in range(3):
                    W[place + 6 * i + j] += scale * ws[first + i * row + j * column]


@formula
def twisted_row(ws, x, y, i, scale):
    """Row i of the antisymmetric block between two slots, with its factor."""
    origin = PLACES[4 * x + y]
    k, c = (TWIST + origin[0] + i * origin[1]) * LANES, origin[2] * LANES
    return (SIGNS[4 * x + y] * scale) * vector(load(ws, k), load(ws, k + c), load(ws, k + 2 * c))


@inline_kernel
def add_twisted_nodes(W, place, chunk, row, ws, a, b, scale):
    """As :func:`ancf.elements.cable_tangent.add_nodes`, of the antisymmetric half."""
    for k in range(2):
        x, y = 2 * a + k, 2 * b
        for i in range(3):
            first = twisted_row(ws, x, y, i, scale[x] * scale[y])
            second = twisted_row(ws, x, y + 1, i, scale[x] * scale[y + 1])
            scatter_nodes(first, second, W[18 * k + 6 * i :], place, chunk, row)


@inline_kernel
def store_twists(batch, W, ws, chunk, inv_l):
    """Add the antisymmetric half of a chunk to the block values W."""
    order, place, one = batch.order[chunk], batch.lane_block, every(1.0)
    if order == 0:
        for m in range(batch.first[chunk + 1] - batch.first[chunk]):
            store_twist(batch, W, ws, chunk, m, batch.lane_data[chunk, 1, m])
        return
    scale = (-inv_l, one, inv_l, one)
    add_twisted_nodes(W, place, chunk, 0, ws, 0, 0, scale)
    add_twisted_nodes(W, place, chunk, 1, ws, 1, 1, scale)
    if order == 1:
        add_twisted_nodes(W, place, chunk, 2, ws, 1, 0, scale)
    else:
        add_twisted_nodes(W, place, chunk, 2, ws, 0, 1, scale)
