"""Axes that forces follow, and the derivatives of such forces by the state.

A unit vector u = x/|x| changes by (dx - u u.dx)/|x|.  With u_y and u_z along r_y and r_z the axes are

    e_2 = (s + d)/sqrt(2),  e_3 = (s - d)/sqrt(2),  e_1 = e_2 x e_3,      s ~ u_y + u_z,  d ~ u_y - u_z,

s and d of length one.  In the matrix of a step is the symmetric part of the derivatives.
"""

from __future__ import annotations

import math

from ..compiled import formula, inline_kernel
from ..simd import every, load, store
from ..vectors import both, cross, dot
from .at_points import at_point

HALF = math.sqrt(0.5)


@formula
def put_axes(batch, e, q):
    """r_x, r_y and r_z of point e into the scratch memory."""
    for d in range(3):
        for c in range(3):
            x = 0.0
            for k in range(batch.base.shape[1]):
                if batch.base[e, k] >= 0:
                    x += batch.slope[e, d, k] * q[batch.base[e, k] + c]
            batch.axes[e, 3 * d + c] = x


@inline_kernel
def unit(x, y, z):
    """Unit vector, and the length."""
    size = math.sqrt(x * x + y * y + z * z)
    inverse = 1.0 / size
    return (x * inverse, y * inverse, z * inverse), size


@inline_kernel
def section_of(a):
    """Unit vectors u_y, u_z, s and d of the axes that have been put, each with the length it came from."""
    y, z = unit(a[3], a[4], a[5]), unit(a[6], a[7], a[8])
    s = unit(y[0][0] + z[0][0], y[0][1] + z[0][1], y[0][2] + z[0][2])
    return y, z, s, unit(y[0][0] - z[0][0], y[0][1] - z[0][1], y[0][2] - z[0][2])


@inline_kernel
def section_axes(section):
    """e_1, e_2 and e_3."""
    s, d = section[2][0], section[3][0]
    y, z = both(HALF, s, HALF, d), both(HALF, s, -HALF, d)
    return cross(y, z), y, z


@inline_kernel
def unit_along(u, dx):
    """Change of a unit vector, given with the length it came from, with the vector."""
    x, along = u[0], dot(u[0], dx)
    return (dx[0] - along * x[0]) / u[1], (dx[1] - along * x[1]) / u[1], (dx[2] - along * x[2]) / u[1]


@inline_kernel
def axes_along(section, y, z, dry, drz):
    """Changes of e_1, e_2 and e_3 with r_y and r_z."""
    dy, dz = unit_along(section[0], dry), unit_along(section[1], drz)
    ds, dd = unit_along(section[2], both(1.0, dy, 1.0, dz)), unit_along(section[3], both(1.0, dy, -1.0, dz))
    dy, dz = both(HALF, ds, HALF, dd), both(HALF, ds, -HALF, dd)
    return both(1.0, cross(dy, z), 1.0, cross(y, dz)), dy, dz


@formula
def differentiate(batch, e):
    """Derivatives of the force by r_x, r_y and r_z."""
    a, F, zero = batch.axes[e], batch.value[e, 0], (0.0, 0.0, 0.0)
    framed = batch.framed[e]
    section = section_of(a) if framed else section_of((0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0))
    _, y, z = section_axes(section)
    for j in range(9):
        k = j % 3
        one = (1.0 if k == 0 else 0.0, 1.0 if k == 1 else 0.0, 1.0 if k == 2 else 0.0)
        dt, dy, dz = zero, zero, zero
        if framed and j > 2:
            dt, dy, dz = axes_along(section, y, z, one if j < 6 else zero, zero if j < 6 else one)
        elif not framed and j < 3:
            dt = unit_along(unit(a[0], a[1], a[2]), one)
        for i in range(3):
            batch.change[e, i, j] = F[0] * dt[i] + F[1] * dy[i] + F[2] * dz[i]


@inline_kernel
def follower_work_slopes(batch, q, v, a, x, by_q, by_v, by_a, ws):
    """See :func:`ancf.compiled.add_work_slopes`."""
    for e in range(batch.base.shape[0]):
        put_axes(batch, e, q)
        differentiate(batch, e)
        change, X = batch.change[e], at_point(batch, e, x)
        for j in range(9):
            by = X[0] * change[0, j] + X[1] * change[1, j] + X[2] * change[2, j]
            for k in range(batch.base.shape[1]):
                if batch.base[e, k] >= 0:
                    by_q[batch.base[e, k] + j % 3] -= batch.slope[e, j // 3, k] * by


@formula
def axis_in_lanes(batch, e, d, j):
    """What component j of r_x, r_y, r_z changes by along eight directions."""
    x = every(0.0)
    for k in range(batch.base.shape[1]):
        if batch.base[e, k] >= 0:
            x = x + batch.slope[e, j // 3, k] * load(d, 0, batch.base[e, k] + j % 3)
    return x


@formula
def add_change(batch, e, share, d, r):
    """Subtract a share of the change of the force from r."""
    change = batch.change[e]
    x, y, z = every(0.0), every(0.0), every(0.0)
    for j in range(9):
        by = share * axis_in_lanes(batch, e, d, j)
        x, y, z = x + change[0, j] * by, y + change[1, j] * by, z + change[2, j] * by
    for k in range(batch.base.shape[1]):
        i, w = batch.base[e, k], batch.factor[e, k]
        if i >= 0:
            store(load(r, i) - w * x, r, i)
            store(load(r, i + 1) - w * y, r, i + 1)
            store(load(r, i + 2) - w * z, r, i + 2)


@inline_kernel
def follower_slopes_along(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_force_slopes`."""
    for e in range(batch.base.shape[0]):
        put_axes(batch, e, q)
        differentiate(batch, e)
        add_change(batch, e, 1.0, d, r)


@inline_kernel
def follower_slopes_beside(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_slopes_beside`: the antisymmetric part."""
    for e in range(batch.base.shape[0]):
        put_axes(batch, e, q)
        differentiate(batch, e)
        add_change(batch, e, 0.5, d, r)
        change = batch.change[e]
        x, y, z = every(0.0), every(0.0), every(0.0)
        for k in range(batch.base.shape[1]):
            i, w = batch.base[e, k], batch.factor[e, k]
            if i >= 0:
                x, y, z = x + w * load(d, 0, i), y + w * load(d, 0, i + 1), z + w * load(d, 0, i + 2)
        for j in range(9):
            by = 0.5 * (change[0, j] * x + change[1, j] * y + change[2, j] * z)
            for k in range(batch.base.shape[1]):
                i = batch.base[e, k] + j % 3
                if batch.base[e, k] >= 0:
                    store(load(r, i) + batch.slope[e, j // 3, k] * by, r, i)
