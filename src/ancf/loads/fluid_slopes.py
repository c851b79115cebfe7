"""Derivatives of x . force of fluids by the state, in a step of time.

At a point with the unit tangent t, the velocity w of the fluid past it, its normal part n, and X of x there,

    g = D_n |n| n.X + D_t |w_t| w_t t.X - s A g.X
      + A [(1 + C_An) a_f.X - C_An a.X + (C_At - C_An) (a_f - a).t t.X]

times the density and the wetted share is the work of the force; see :mod:`ancf.loads.fluid`.
"""

from __future__ import annotations

import math

from ..compiled import formula, inline_kernel
from ..simd import load, store
from ..vectors import both, dot
from .along import in_lanes, place_at, tangent_at
from .flow import (
    AREA,
    CLOCK,
    DENSITY,
    DIAMETER,
    DRAG_N,
    DRAG_T,
    GRAVITY,
    HIGH,
    LOW,
    MASS_N,
    MASS_T,
    STILL,
    apart,
    below,
)
from .flow_slopes import BY_PLACE, FORCES, MOVING, RATE_BY_PLACE, RISE_BY_X, RISE_BY_Y, feel
from .waves import RATE, RISE, SPEED


@formula
def three(x, i):
    """Three entries of a vector."""
    return x[i], x[i + 1], x[i + 2]


@formula
def sum4(a, x, b, y, c, z, d, u):
    """a x + b y + c z + d u."""
    return (
        a * x[0] + b * y[0] + c * z[0] + d * u[0],
        a * x[1] + b * y[1] + c * z[1] + d * u[1],
        a * x[2] + b * y[2] + c * z[2] + d * u[2],
    )


@formula
def wetted_slopes(batch, e, p, z, t, size, rise):
    """Share of the piece of point p inside its fluid, with derivatives by z, lower and upper surface.

    And those by the vertical component of r_x, by that of t at a fixed length, by the diameter and the height
    of the piece.
    """
    k = batch.fluid[e]
    low, high = batch.fluids[k, LOW], batch.fluids[k, HIGH]
    if low == -math.inf and high == math.inf:
        return 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if batch.under[k] >= 0:
        low += rise
    else:
        high += rise
    d, weight, shift = batch.data[e, DIAMETER], batch.weight[e, p], batch.shift[e, p]
    level = math.sqrt(max(1.0 - t[2] * t[2], 0.0))
    tall, middle = weight * size * abs(t[2]) + d * level, z + shift * size * t[2]
    top, by_high = below(middle, tall, high)
    bottom, by_low = below(middle, tall, low)
    by_z = by_low - by_high
    by_tall = by_low * (low - middle) / tall if by_low != 0.0 else 0.0
    by_tall -= by_high * (high - middle) / tall if by_high != 0.0 else 0.0
    by_length = by_tall * weight * (1.0 if t[2] > 0.0 else -1.0) + by_z * shift
    turning = -by_tall * d * t[2] / level if level > 0.0 else 0.0
    return top - bottom, by_z, -by_low, by_high, by_length, turning, by_tall * level, by_tall


@formula
def work_at(batch, e, p, t, past, du, own, X):
    """The work g, and its derivatives by the velocity past the point, by a_f, by a and by t."""
    data, fluid = batch.data[e], batch.fluids[batch.fluid[e]]
    share, area, mn = batch.value[batch.fluid[e], CLOCK, 1], data[AREA], data[MASS_N]
    wt, n, speed = apart(past, t)
    tau, nX, more = dot(t, X), dot(n, X), data[MASS_T] - mn
    gain = dot(du, t) - dot(own, t)
    dn, dt, fast = data[DRAG_N], data[DRAG_T], abs(wt)
    s = dn * nX / speed if speed > STILL else 0.0
    along = 2.0 * dt * fast * tau
    by_past = sum4(s, n, dn * speed, X, along - dn * speed * tau, t, 0.0, t)
    m = area * more
    by_du, by_own = both(area * (1.0 + mn), X, m * tau, t), both(-area * mn, X, -m * tau, t)
    with_x, with_past = (dt * fast - dn * speed) * wt + m * gain, along - dn * speed * tau
    turn = sum4(-wt * s, n, with_x, X, with_past, past, 0.0, t)
    turn = sum4(1.0, turn, m * tau, du, -m * tau, own, 0.0, t)
    lift = share * area * dot(three(fluid, GRAVITY), X)
    work = dn * speed * nX + dt * fast * wt * tau - lift
    work += area * ((1.0 + mn) * dot(du, X) - mn * dot(own, X) + more * gain * tau)
    return work, by_past, by_du, by_own, turn


@formula
def through_place(felt, first, f):
    """f times the derivatives by the place, row by row, that begin there."""
    return (
        f[0] * felt[first] + f[1] * felt[first + 3] + f[2] * felt[first + 6],
        f[0] * felt[first + 1] + f[1] * felt[first + 4] + f[2] * felt[first + 7],
        f[0] * felt[first + 2] + f[1] * felt[first + 5] + f[2] * felt[first + 8],
    )


@formula
def found_at(batch, e, p, q, v, a):
    """Velocity, acceleration, tangent, size of r_x at point p; whether it was felt anew, what is wetted."""
    at, own, b = place_at(batch, e, p, q), place_at(batch, e, p, v), place_at(batch, e, p, a)
    t, size = tangent_at(batch, e, p, q)
    fresh = feel(batch, e, p, batch.fluid[e], at, own)
    return own, b, t, size, fresh, wetted_slopes(batch, e, p, at[2], t, size, batch.felt[e, p, RISE])


@formula
def put(batch, e, p, by_place, by_slope, by_speed, by_own, by_q, by_v, by_a):
    """Add derivatives by the place of point p, its slope, velocity and acceleration to those by unknowns."""
    for k in range(batch.base.shape[1]):
        i, w, s = batch.base[e, k], batch.shape[e, p, k], batch.slope[e, p, k]
        if i >= 0:
            for c in range(3):
                by_q[i + c] += w * by_place[c] + s * by_slope[c]
                by_v[i + c] += w * by_speed[c]
                by_a[i + c] += w * by_own[c]


@formula
def acting(batch, e, p, t, own, b, X, wet):
    """Factors of what g and the wetted share change by, the derivative by the rise, and :func:`work_at`."""
    k, felt = batch.fluid[e], batch.felt[e, p]
    c = -batch.weight[e, p] * batch.fluids[k, DENSITY]
    past, du = both(1.0, three(felt, SPEED), -1.0, own), three(felt, RATE)
    work = work_at(batch, e, p, t, past, du, b, X)
    f, h = c * wet[0], c * work[0]
    return f, h, h * (wet[2] if batch.under[k] >= 0 else wet[3]), work


@formula
def slopes_at(batch, e, p, t, size, own, b, X, wet):
    """Derivatives of X . force at point p by its place, slope, velocity ``own`` and acceleration b."""
    felt, (_, by_z, _, _, by_length, turning, _, _) = batch.felt[e, p], wet
    f, h, by_rise, (_, by_past, by_du, by_own, turn) = acting(batch, e, p, t, own, b, X, wet)
    moved = through_place(felt, BY_PLACE, by_past)
    carried = through_place(felt, RATE_BY_PLACE, by_du)
    edge = (by_rise * felt[RISE_BY_X], by_rise * felt[RISE_BY_Y], h * by_z)
    by_place = sum4(f, moved, f, carried, 1.0, edge, 0.0, edge)
    inverse = 1.0 / size if size > 0.0 else 0.0
    r = (f * turn[0], f * turn[1], f * turn[2] + h * turning)
    r = both(inverse, r, -inverse * dot(r, t), t)
    by_slope = (r[0], r[1], r[2] + h * by_length)
    return by_place, by_slope, both(-f, by_past, 0.0, t), both(f, by_own, 0.0, t)


@inline_kernel
def fluid_work_slopes(batch, q, v, a, x, by_q, by_v, by_a, ws):
    """See :func:`ancf.compiled.add_work_slopes`."""
    for e in range(batch.base.shape[0]):
        for p in range(batch.weight.shape[1]):
            if batch.weight[e, p] == 0.0:
                continue
            own, b, t, size, _, wet = found_at(batch, e, p, q, v, a)
            if wet[0] == 0.0 and wet[1] == 0.0:
                continue
            X = place_at(batch, e, p, x)
            slopes = slopes_at(batch, e, p, t, size, own, b, X, wet)
            put(batch, e, p, slopes[0], slopes[1], slopes[2], slopes[3], by_q, by_v, by_a)


@formula
def along_axis(c):
    """Unit vector along axis c."""
    return 1.0 if c == 0 else 0.0, 1.0 if c == 1 else 0.0, 1.0 if c == 2 else 0.0


@formula
def know_slopes(batch, e, p, t, size, own, b, wet):
    """Let ``felt`` hold the derivatives of the three components of the force at point p by its motion."""
    felt = batch.felt[e, p]
    same = felt[MOVING] == own[0] and felt[MOVING + 1] == own[1] and felt[MOVING + 2] == own[2]
    same = same and felt[MOVING + 3] == b[0] and felt[MOVING + 4] == b[1] and felt[MOVING + 5] == b[2]
    if same:
        return
    for i in range(3):
        felt[MOVING + i], felt[MOVING + 3 + i] = own[i], b[i]
    for c in range(3):
        X = along_axis(c)
        by, first = slopes_at(batch, e, p, t, size, own, b, X, wet), FORCES + 12 * c
        for i in range(3):
            felt[first + i], felt[first + 3 + i] = by[0][i], by[1][i]
            felt[first + 6 + i], felt[first + 9 + i] = by[2][i], by[3][i]


@inline_kernel
def fluid_force_slopes(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_force_slopes`."""
    for e in range(batch.base.shape[0]):
        for p in range(batch.weight.shape[1]):
            if batch.weight[e, p] == 0.0:
                continue
            own, b, t, size, _, wet = found_at(batch, e, p, q, v, a)
            felt = batch.felt[e, p]
            if wet[0] == 0.0 and wet[1] == 0.0:
                continue
            know_slopes(batch, e, p, t, size, own, b, wet)
            moved = in_lanes(batch, e, p, batch.shape, d, 0), in_lanes(batch, e, p, batch.slope, d, 0)
            faster = in_lanes(batch, e, p, batch.shape, d, 1), in_lanes(batch, e, p, batch.shape, d, 2)
            for c in range(3):
                first = FORCES + 12 * c
                f = dot(three(felt, first), moved[0]) + dot(three(felt, first + 3), moved[1])
                f = f + dot(three(felt, first + 6), faster[0]) + dot(three(felt, first + 9), faster[1])
                for k in range(batch.base.shape[1]):
                    i, w = batch.base[e, k], batch.shape[e, p, k]
                    if i >= 0:
                        store(load(r, i + c) + w * f, r, i + c)
