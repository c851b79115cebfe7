"""How places of a capsule along a surface, and their shares of the force, move.

See :mod:`ancf.contact.lay`.  The distance D(s) of a place at the share s of a line has

    D' = n_rho rho' + n_z h',      D'' = n_rho rho'' + b (n_rho h' - n_z rho')^2,

with the curvature b of the profile.  Where D turns, ds = -dD'/D''; at a fixed height ds = -dh/h', at a fixed
radius -drho/rho', and at an end of the line it does not move.  All else are products.
"""

from __future__ import annotations

import math

from ..compiled import inline_kernel, separate_kernel
from .lay import (
    AT_END,
    AT_HEIGHT,
    FIRST,
    LAST,
    OFF_FIRST,
    OFF_LAST,
    OTHER,
    SHALLOW,
    SHEAVE,
    TORUS,
    depth_at,
    flat_part,
    halved_at,
    nearest_on,
    shallowest,
)
from .profiles import profile_of

#: Shares nearer to each other are one place; part of the length by which a slope is none.
ONE, NONE = 1e-12, 1e-7


@inline_kernel
def moved_at(shape, numbers, line, dline, s):
    """Of a place at the share s that stays: slope and bend of the distance, change of it and of its slope."""
    h0, hd, b0, b1, b2 = line
    rho = math.sqrt(max(b0 + s * (2.0 * b1 + s * b2), 0.0))
    _, n_rho, n_z, bend = profile_of(shape, numbers, rho, h0 + s * hd)
    inverse = 1.0 / rho if rho > 0.0 else 0.0
    away = (b1 + b2 * s) * inverse
    drho = (0.5 * dline[2] + s * (dline[3] + 0.5 * s * dline[4])) * inverse
    dh, daway = dline[0] + s * dline[1], (dline[3] + s * dline[4] - away * drho) * inverse
    turned = n_rho * hd - n_z * away
    turn = bend * (n_rho * dh - n_z * drho)
    bent = n_rho * (b2 - away * away) * inverse + bend * turned * turned
    slope = n_rho * away + n_z * hd
    return slope, bent, n_rho * drho + n_z * dh, n_rho * daway + n_z * dline[1] + turn * turned


@inline_kernel
def turning_moves(shape, numbers, line, dline, s):
    """What the share where the distance turns moves by."""
    _, bent, _, steeper = moved_at(shape, numbers, line, dline, s)
    return -steeper / bent if bent != 0.0 else 0.0


@inline_kernel
def half_moves(shape, line, dline, middle):
    """What the share where the second half begins moves by."""
    if not 0.0 < middle < 1.0:
        return 0.0
    if shape == TORUS:
        return -(dline[3] + middle * dline[4]) / line[4]
    return -(dline[0] + middle * dline[1]) / line[1]


@inline_kernel
def end_moves(line, dline, s, what, middle, dmiddle):
    """What an end of a stretch moves by, which is of that kind."""
    if what == AT_END:
        return dmiddle if abs(s - middle) < ONE else 0.0
    if what == AT_HEIGHT:
        return -(dline[0] + s * dline[1]) / line[1]
    return -(0.5 * dline[2] + s * (dline[3] + 0.5 * s * dline[4])) / (line[3] + s * line[4])


@inline_kernel
def nearest_moves(shape, numbers, line, dline, s, lo, hi, middle, dmiddle):
    """What the nearest share between two others moves by."""
    if abs(s - lo) < ONE or abs(s - hi) < ONE:
        return end_moves(line, dline, s, AT_END, middle, dmiddle)
    return turning_moves(shape, numbers, line, dline, s)


@inline_kernel
def shallowest_moves(shape, numbers, line, dline, top, dmiddle):
    """What the shallowest share moves by; the distance has an edge in the middle of a groove."""
    slope, _, _, _ = moved_at(shape, numbers, line, dline, top)
    if abs(slope) > NONE * math.sqrt(line[1] * line[1] + line[4]):
        return dmiddle
    return turning_moves(shape, numbers, line, dline, top)


@inline_kernel
def depth_moves(shape, numbers, line, dline, radius, s, ds):
    """Depth of a place that moves by ds, none below zero, and what it changes by."""
    g = depth_at(shape, numbers, line, radius, s)
    slope, _, further, _ = moved_at(shape, numbers, line, dline, s)
    return g, (-(further + slope * ds) if g > 0.0 else 0.0)


@inline_kernel
def shares_move(shape, numbers, line, dline, size, dsize, radius, lo, hi, c, dc, place, middle, dmiddle):
    """What the place and its share of the force of :func:`ancf.contact.lay.shares` change by; that share."""
    a, of_a, b, of_b = flat_part(shape, numbers, line, lo, hi)
    x, y, dx, dy, on, don, rate, drate = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    da = end_moves(line, dline, a, of_a, middle, dmiddle)
    db = end_moves(line, dline, b, of_b, middle, dmiddle)
    deep, ddeep = depth_moves(shape, numbers, line, dline, radius, c, dc)
    if b > a and deep > 0.0:
        g, dg = depth_moves(shape, numbers, line, dline, radius, a, da)
        x, dx = g / deep, (dg - g / deep * ddeep) / deep
        g, dg = depth_moves(shape, numbers, line, dline, radius, b, db)
        y, dy = g / deep, (dg - g / deep * ddeep) / deep
        size, dsize = size / radius, dsize / radius
        t, dt = (b - a) * size, (db - da) * size + (b - a) * dsize
        if t >= 1.0:
            t, dt = 1.0, 0.0
        on, don = t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t) * dt
        rate = 6.0 * t * (1.0 - t) * size
        drate = 6.0 * (1.0 - 2.0 * t) * dt * size + 6.0 * t * (1.0 - t) * dsize
    if place == FIRST:
        return da, on * y * y, don * y * y + 2.0 * on * y * dy
    if place == LAST:
        return db, on * x * x, don * x * x + 2.0 * on * x * dx
    if place == OFF_FIRST:
        w, more = rate * deep, drate * deep + rate * ddeep
        more = more * x * y * y + w * (dx * y * y + 2.0 * x * y * dy)
        return da, -0.5 * w * x * y * y, (-0.5 * more if of_a != AT_END else 0.0)
    if place == OFF_LAST:
        w, more = rate * deep, drate * deep + rate * ddeep
        more = more * x * x * y + w * (2.0 * x * dx * y + x * x * dy)
        return db, 0.5 * w * x * x * y, (0.5 * more if of_b != AT_END else 0.0)
    xy, dxy = x * y, dx * y + x * dy
    return dc, 1.0 - on * xy * xy, -(don * xy * xy + 2.0 * on * xy * dxy)


@separate_kernel
def lay_moves(shape, numbers, line, dline, size, dsize, radius, part):
    """What the share of the axis, and shares of force and losses, change by with a line and its length."""
    middle = halved_at(shape, line)
    dmiddle = half_moves(shape, line, dline, middle)
    c = nearest_on(shape, numbers, line, 0.0, middle)
    dc = nearest_moves(shape, numbers, line, dline, c, 0.0, middle, middle, dmiddle)
    if shape != TORUS and shape != SHEAVE:
        own = size, dsize, radius, 0.0, 1.0, c, dc, part, 1.0, 0.0
        ds, _, dw = shares_move(shape, numbers, line, dline, *own)
        return ds, dw, dw
    other = nearest_on(shape, numbers, line, middle, 1.0)
    dother = nearest_moves(shape, numbers, line, dline, other, middle, 1.0, middle, dmiddle)
    top = shallowest(shape, numbers, line, middle, c, other)
    dtop = dmiddle if top == middle else shallowest_moves(shape, numbers, line, dline, top, dmiddle)
    if part == SHALLOW:
        return dtop, 0.0, 0.0
    lo, hi, place = 0.0, middle, part
    if part >= OTHER:
        c, dc, other, dother = other, dother, c, dc
        lo, hi, place = middle, 1.0, part - OTHER
    own = size, dsize, radius, lo, hi, c, dc, place, middle, dmiddle
    ds, w, dw = shares_move(shape, numbers, line, dline, *own)
    least, dleast = depth_moves(shape, numbers, line, dline, radius, top, dtop)
    if least == 0.0:
        return ds, dw, dw
    deep, ddeep = depth_moves(shape, numbers, line, dline, radius, c, dc)
    shallow, dshallow = depth_moves(shape, numbers, line, dline, radius, other, dother)
    x, y = least / deep, least / shallow
    dx, dy = (dleast - x * ddeep) / deep, (dleast - y * dshallow) / shallow
    lost = 1.0 - x * x + 0.5 * x * x * y * y
    dlost = -2.0 * x * dx + x * dx * y * y + x * x * y * dy
    return ds, dw, dw * lost + w * dlost
