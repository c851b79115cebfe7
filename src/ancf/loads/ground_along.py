"""Derivatives of the forces of grounds, and of what friction remembers, along eight directions at a time.

With N, n, w, T and the limit L of :mod:`ancf.loads.ground`, x = k_t (r - anchor) + c_t v and its part w along
the ground, a change of place, velocity, anchor and limit does

    dN = N_g dg + N_g' dg',    dg = -n.dr,    dg' = -n.dv - v.dn,
    dw = P dx - (x.n) dn - (x.dn) n,    dx = k_t (dr - danchor) + c_t dv,

    dT = -d dw  of what sticks,    -L/|w| (dw - w (w.dw)/w^2) - dL w/|w|  of what slips.

On a table of heights the normal turns with the place, and dg has a share of that.  A step leaves

    dL = mu dN,    danchor = dr + dT/(d k_t) of what slips,    dr of what does not touch,

with T of the spring alone, c_t = 0, and that of what sticks, or whose spring is within the limit, as it was.

Here a memory is all anchors, then all limits, as :func:`ground_choice` writes them.
"""

from __future__ import annotations

import math

from ..compiled import formula, inline_kernel
from ..simd import every, load, store
from ..vectors import both, dot
from .along import in_lanes
from .ground_points import drawn_at, left_at, pressed_at, pulled_at, touch_at
from .relief import DRAG, FRICTION, STICK, twist_at

#: Part of a limit by which a force is not beyond it, and a limit that nothing reaches, N/m.
JUST, HELD = 1e-7, 1e100
ZERO = (0.0, 0.0, 0.0)


@formula
def places_of(batch, e, p):
    """Where in a memory the anchor of point p of row e begins, and where its limit is."""
    point = e * batch.weight.shape[1] + p
    return 3 * point, 3 * batch.weight.size + point


@formula
def turning(batch, e, at, g, dr):
    """What depth and normal at a place change by, beside -n.dr, if it moves by dr."""
    zx, zy, twist = twist_at(batch, batch.ground[e], at[0], at[1])
    b = 1.0 / math.sqrt(1.0 + zx * zx + zy * zy)
    dzx, dzy = twist * dr[1], twist * dr[0]
    db = (-b * b * b) * (zx * dzx + zy * dzy)
    return (g / b) * db, (-b * dzx - zx * db, -b * dzy - zy * db, db)


@formula
def along_ground(n, x, dn, dx):
    """Change dw of the part w of x along the ground."""
    along, turned = dot(n, dx) + dot(x, dn), dot(x, n)
    return (
        dx[0] - along * n[0] - turned * dn[0],
        dx[1] - along * n[1] - turned * dn[1],
        dx[2] - along * n[2] - turned * dn[2],
    )


@formula
def rubbed(w, size, f, slips, dw, dL):
    """Change dT of the friction -f w as w and the limit do."""
    if not slips:
        return -f * dw[0], -f * dw[1], -f * dw[2]
    inverse = 1.0 / size
    c = (inverse * inverse * f) * dot(w, dw) - inverse * dL
    return c * w[0] - f * dw[0], c * w[1] - f * dw[1], c * w[2] - f * dw[2]


@formula
def add_lanes(batch, e, p, f, r):
    """Subtract forces f in eight lanes on point p of row e, per reference length, from the residual r."""
    for k in range(batch.base.shape[1]):
        i, w = batch.base[e, k], batch.weight[e, p] * batch.shape[e, p, k]
        if i >= 0:
            for c in range(3):
                store(load(r, i + c) - w * f[c], r, i + c)


@formula
def both_forces(n, N, dn, dN, dT):
    """Change of N n + T."""
    return (
        dN * n[0] + N * dn[0] + dT[0],
        dN * n[1] + N * dn[1] + dT[1],
        dN * n[2] + N * dn[2] + dT[2],
    )


@inline_kernel
def ground_slopes_along(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_force_slopes`."""
    for e in range(batch.base.shape[0]):
        ground = batch.grounds[batch.ground[e]]
        for p in range(batch.weight.shape[1]):
            at, u, g, n, N, by_g, by_rate = pressed_at(batch, e, p, q, v)
            if N == 0.0 and batch.limit[e, p] == 0.0:
                continue
            dr, du = in_lanes(batch, e, p, batch.shape, d, 0), in_lanes(batch, e, p, batch.shape, d, 1)
            dg, dn = turning(batch, e, at, g, dr)
            dN = by_g * (dg - dot(n, dr)) - by_rate * (dot(n, du) + dot(u, dn))
            dT = every(0.0), every(0.0), every(0.0)
            if batch.limit[e, p] != 0.0:
                w, size, f, slips = drawn_at(batch, e, p, q, at, u, n)
                x, dx = pulled_at(batch, e, p, q, at, u), both(ground[STICK], dr, ground[DRAG], du)
                dT = rubbed(w, size, f, slips, along_ground(n, x, dn, dx), every(0.0))
            add_lanes(batch, e, p, both_forces(n, N, dn, dN, dT), r)


@inline_kernel
def ground_slopes_beside(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_slopes_beside`: that normals of tables turn."""
    for e in range(batch.base.shape[0]):
        for p in range(batch.weight.shape[1]):
            at, u, g, n, N, by_g, by_rate = pressed_at(batch, e, p, q, v)
            _, _, twist = twist_at(batch, batch.ground[e], at[0], at[1])
            if twist == 0.0 or (N == 0.0 and batch.limit[e, p] == 0.0):
                continue
            dr = in_lanes(batch, e, p, batch.shape, d, 0)
            dg, dn = turning(batch, e, at, g, dr)
            dN = by_g * dg - by_rate * dot(u, dn)
            dT = every(0.0), every(0.0), every(0.0)
            if batch.limit[e, p] != 0.0:
                w, size, f, slips = drawn_at(batch, e, p, q, at, u, n)
                x, still = pulled_at(batch, e, p, q, at, u), both(0.0, dr, 0.0, dr)
                dT = rubbed(w, size, f, slips, along_ground(n, x, dn, still), every(0.0))
            add_lanes(batch, e, p, both_forces(n, N, dn, dN, dT), r)


@inline_kernel
def ground_choice(batch, q, v, out):
    """See :func:`ancf.compiled.choose_memory`."""
    for e in range(batch.base.shape[0]):
        for p in range(batch.weight.shape[1]):
            anchor, limit = places_of(batch, e, p)
            for c in range(3):
                out[anchor + c] = batch.anchor[e, p, c]
            out[limit] = batch.limit[e, p]
            if batch.limit[e, p] > 0.0:
                at, u, n, N, _, _ = touch_at(batch, e, p, q, v)
                if N > 0.0:
                    _, size, _, _ = drawn_at(batch, e, p, q, at, u, n)
                    slips = batch.diameter[e] * size > (1.0 + JUST) * batch.limit[e, p]
                    out[limit] = -batch.limit[e, p] if slips else HELD


@formula
def anchor_in(batch, e, p, z):
    """Changes of the anchor of point p of row e and of its limit, in a memory in eight lanes."""
    anchor, limit = places_of(batch, e, p)
    return (load(z, anchor), load(z, anchor + 1), load(z, anchor + 2)), load(z, limit)


@inline_kernel
def ground_memory_slopes(batch, q, v, z, r, ws):
    """See :func:`ancf.compiled.add_memory_slopes`."""
    for e in range(batch.base.shape[0]):
        stick = batch.grounds[batch.ground[e], STICK]
        for p in range(batch.weight.shape[1]):
            if batch.limit[e, p] == 0.0:
                continue
            at, u, _, n, _, _, _ = pressed_at(batch, e, p, q, v)
            w, size, f, slips = drawn_at(batch, e, p, q, at, u, n)
            da, dL = anchor_in(batch, e, p, z)
            along = dot(n, da)
            dw = (
                -stick * (da[0] - along * n[0]),
                -stick * (da[1] - along * n[1]),
                -stick * (da[2] - along * n[2]),
            )
            add_lanes(batch, e, p, rubbed(w, size, f, slips, dw, dL), r)


@inline_kernel
def ground_remember_along(batch, q, v, d, z, ws):
    """See :func:`ancf.compiled.remember_along`."""
    for e in range(batch.base.shape[0]):
        ground = batch.grounds[batch.ground[e]]
        inverse = 1.0 / (batch.diameter[e] * ground[STICK])
        for p in range(batch.weight.shape[1]):
            anchor, limit = places_of(batch, e, p)
            at, u, g, n, N, by_g, by_rate = pressed_at(batch, e, p, q, v)
            dr = in_lanes(batch, e, p, batch.shape, d, 0)
            if N == 0.0:
                for c in range(3):
                    store(dr[c], z, anchor + c)
                store(every(0.0), z, limit)
                continue
            du, (dg, dn) = in_lanes(batch, e, p, batch.shape, d, 1), turning(batch, e, at, g, dr)
            w, size, f, yields = left_at(batch, e, p, q, at, u, n)
            if yields:
                da, dL = anchor_in(batch, e, p, z)
                x, dx = pulled_at(batch, e, p, q, at, ZERO), both(ground[STICK], dr, -ground[STICK], da)
                dT = rubbed(w, size, f, True, along_ground(n, x, dn, dx), dL)
                for c in range(3):
                    store(dr[c] + inverse * dT[c], z, anchor + c)
            dN = by_g * (dg - dot(n, dr)) - by_rate * (dot(n, du) + dot(u, dn))
            store(ground[FRICTION] * dN, z, limit)
