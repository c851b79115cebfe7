"""Derivatives of friction on surfaces, and of what it remembers, along eight directions at a time.

With N, n, w, T = -f w and the limit L of :mod:`ancf.contact.rub`, x = k_t (r - a) + c_t u, a change does

    dw = P dx - (x.n) dn - (x.dn) n,    dx = k_t (dr - da) + c_t du,
    dT = -dw  of what sticks,    -L/|w| (dw - w (w.dw)/w^2) - dL w/|w|  of what slips,

where the anchor a goes with what carries the surface, see :mod:`ancf.contact.ways`.  A step leaves, with the
force N' of the step before,

    dL = mu (dN by_N + dN' by_N'),    da = dr + dT/k_t  of what slips,    dr  of what does not touch,

in the axes of what carries the surface, with T of the spring alone, c_t = 0; and that of what sticks, or
whose spring is within the limit, as it was.

Here a memory is all anchors, then all limits, then all forces before, then ``most``, which has no derivative.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..compiled import formula, inline_kernel
from ..loads.ground_along import HELD, JUST, along_ground, rubbed
from ..records import beginning
from ..simd import LANES, every, load, store
from ..vectors import both, dot
from .press_along import STILL, followed, of_point, pressed_along, pressed_by, shaped
from .rubbed import GROWS, ahead
from .touch import DRAG, FRICTION, NODES, STICK, ZERO, carried, look_around, row_of
from .touching import Touching
from .ways import add_change, add_lanes, apart, inside, met, ways_along

#: Columns of ``data`` on which friction depends.
OWN = DRAG + 1


def numbers_of(batch: Any) -> Any:
    """Those of the contacts, weights and factors of points."""
    return np.concatenate([batch.data[:, :OWN].ravel(), batch.weight.ravel(), batch.shape.ravel()])


def kinds_of(batch: Any, rates: Any) -> list[int]:
    """Whether a change has some of weights and factors."""
    return [int(np.any(rates[OWN * len(batch.data) :]))]


@formula
def places_of(batch, e, p):
    """Where in a memory the anchor of point p of row e begins, and where its limit and its force are."""
    point, all_points = e * batch.weight.shape[1] + p, batch.weight.size
    return 3 * point, 3 * all_points + point, 4 * all_points + point


@formula
def grown_by(N, before):
    """Derivatives of the normal force a step later, see :func:`ancf.contact.rubbed.ahead`."""
    if before == 0.0:
        return 1.0, 0.0
    if 2.0 * N - before < (1.0 - GROWS) * N:
        return 1.0 - GROWS, 0.0
    if 2.0 * N - before > (1.0 + GROWS) * N:
        return 1.0 + GROWS, 0.0
    return 2.0, -1.0


@formula
def drawn_here(batch, e, p, row, here):
    """Of the friction at a point: x, w, its size, the factor f, whether it slips; r - a and the anchor."""
    _, r, _, u, n, _, _, _ = here
    data, z = batch.data[batch.contact[e]], batch.anchor[e, p]
    anchor = z[0], z[1], z[2]
    way = both(1.0, r, -1.0, carried(row[2], anchor[0], anchor[1], anchor[2]))
    x = both(data[STICK], way, data[DRAG], u)
    w = both(1.0, x, -dot(x, n), n)
    size = np.sqrt(dot(w, w))
    if size > batch.limit[e, p]:
        return x, w, size, abs(batch.limit[e, p]) / size, True, way, anchor
    return x, w, size, 1.0, False, way, anchor


@formula
def left_here(batch, e, p, row, here):
    """The same of the spring alone, f the factor of what a step leaves in it; whether its anchor moves."""
    _, _, _, _, slips, way, anchor = drawn_here(batch, e, p, row, here)
    stick, n, limit = batch.data[batch.contact[e], STICK], here[4], abs(batch.limit[e, p])
    x = stick * way[0], stick * way[1], stick * way[2]
    w = both(1.0, x, -dot(x, n), n)
    size = np.sqrt(dot(w, w))
    if slips and size > limit:
        return x, w, size, limit / size, True, way, anchor
    return x, w, size, 1.0, False, way, anchor


@beginning(Touching)
def carried_along(batch, e, anchor, carrying, dr):
    """What of the way dr from a place in body axes, which goes with what carries the surface, is left."""
    if batch.base[e, NODES] < 0:
        return dr
    s = carried(carrying, anchor[0], anchor[1], anchor[2])
    return dr[0] - s[0], dr[1] - s[1], dr[2] - s[2]


@inline_kernel
def rub_slopes_along(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_force_slopes`."""
    for e in range(batch.base.shape[0]):
        if batch.most[e] == 0.0:
            continue
        data, row = batch.data[batch.contact[e]], row_of(batch, e, q, v)
        ways, fast = ways_along(batch, e, d)
        for p in range(batch.weight.shape[1]):
            if batch.limit[e, p] == 0.0:
                continue
            here = met(batch, e, p, row)
            n = here[4]
            x, w, size, f, slips, _, anchor = drawn_here(batch, e, p, row, here)
            dr, inner, _, du, _, dn = followed(batch, e, p, row, here, ways, fast)
            dx = both(data[STICK], carried_along(batch, e, anchor, ways[1], dr), data[DRAG], du)
            dT = rubbed(w, size, f, slips, along_ground(n, x, dn, dx), every(0.0))
            add_lanes(batch, e, p, here[2], both(-f, w, 0.0, w), dT, inner, r)


@inline_kernel
def rub_slopes_beside(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_slopes_beside`: that normals turn, and bodies."""
    for e in range(batch.base.shape[0]):
        if batch.most[e] == 0.0:
            continue
        data, row = batch.data[batch.contact[e]], row_of(batch, e, q, v)
        ways, fast = ways_along(batch, e, d)
        for p in range(batch.weight.shape[1]):
            if batch.limit[e, p] == 0.0:
                continue
            here = met(batch, e, p, row)
            place, n = here[2], here[4]
            x, w, size, f, slips, _, anchor = drawn_here(batch, e, p, row, here)
            dr, inner, dv, du, _, dn = followed(batch, e, p, row, here, ways, fast)
            dx = both(data[STICK], carried_along(batch, e, anchor, ways[1], dr), data[DRAG], du)
            y, dy = apart(batch, e, place, dr, ways[1]), apart(batch, e, place, dv, fast[1])
            dx = both(1.0, dx, -1.0, both(data[STICK], y, data[DRAG], dy))
            dT = rubbed(w, size, f, slips, along_ground(n, x, dn, dx), every(0.0))
            add_lanes(batch, e, p, place, both(-f, w, 0.0, w), dT, inner, r)


@inline_kernel
def rub_choice(batch, q, v, out):
    """See :func:`ancf.compiled.choose_memory`."""
    for e in range(batch.base.shape[0]):
        lit, row = batch.most[e] > 0.0, row_of(batch, e, q, v)
        out[5 * batch.weight.size + e] = batch.most[e]
        for p in range(batch.weight.shape[1]):
            anchor, limit, before = places_of(batch, e, p)
            for c in range(3):
                out[anchor + c] = batch.anchor[e, p, c]
            out[limit], out[before] = batch.limit[e, p], batch.before[e, p]
            if lit and batch.limit[e, p] > 0.0:
                here = met(batch, e, p, row)
                if here[5] > 0.0:
                    size = drawn_here(batch, e, p, row, here)[2]
                    slips = size > (1.0 + JUST) * batch.limit[e, p]
                    out[limit] = -batch.limit[e, p] if slips else HELD


@formula
def remembered_in(batch, e, p, row, z):
    """Changes of the anchor of point p of row e as a global way, and of its limit, in eight lanes."""
    anchor, limit, _ = places_of(batch, e, p)
    x, y, w = load(z, anchor), load(z, anchor + 1), load(z, anchor + 2)
    if batch.base[e, NODES] < 0:
        return (x, y, w), load(z, limit)
    _, a, b, c = row[2]
    da = x * a[0] + y * b[0] + w * c[0], x * a[1] + y * b[1] + w * c[1], x * a[2] + y * b[2] + w * c[2]
    return da, load(z, limit)


@inline_kernel
def rub_memory_slopes(batch, q, v, z, r, ws):
    """See :func:`ancf.compiled.add_memory_slopes`."""
    for e in range(batch.base.shape[0]):
        if batch.most[e] == 0.0:
            continue
        stick, row = batch.data[batch.contact[e], STICK], row_of(batch, e, q, v)
        for p in range(batch.weight.shape[1]):
            if batch.limit[e, p] == 0.0:
                continue
            here = met(batch, e, p, row)
            _, w, size, f, slips, _, _ = drawn_here(batch, e, p, row, here)
            (da, dL), n = remembered_in(batch, e, p, row, z), here[4]
            along = dot(n, da)
            dw = (
                -stick * (da[0] - along * n[0]),
                -stick * (da[1] - along * n[1]),
                -stick * (da[2] - along * n[2]),
            )
            dT, none = rubbed(w, size, f, slips, dw, dL), every(0.0)
            add_lanes(batch, e, p, here[2], w, dT, (none, none, none), r)


@inline_kernel
def rub_remember_along(batch, q, v, d, z, ws):
    """See :func:`ancf.compiled.remember_along`."""
    for e in range(batch.base.shape[0]):
        if look_around(batch, e, q) and batch.most[e] == 0.0:
            continue
        data, row = batch.data[batch.contact[e]], row_of(batch, e, q, v)
        ways, fast = ways_along(batch, e, d)
        for p in range(batch.weight.shape[1]):
            anchor, limit, before = places_of(batch, e, p)
            here = met(batch, e, p, row)
            n, N = here[4], here[5]
            dr, inner, _, du, dd, dn = followed(batch, e, p, row, here, ways, fast)
            if N == 0.0:
                for c in range(3):
                    store(inner[c], z, anchor + c)
                store(every(0.0), z, limit)
                store(every(0.0), z, before)
                continue
            x, w, size, f, yields, _, own = left_here(batch, e, p, row, here)
            if yields:
                da, dL = remembered_in(batch, e, p, row, z)
                dx = both(data[STICK], carried_along(batch, e, own, ways[1], dr), -data[STICK], da)
                dT = rubbed(w, size, f, True, along_ground(n, x, dn, dx), dL)
                left, dr = both(1.0, here[1], -f / data[STICK], w), both(1.0, dr, 1.0 / data[STICK], dT)
                inner = inside(batch, e, row, left, dr, ways[1])
                for c in range(3):
                    store(inner[c], z, anchor + c)
            dN, (by_N, by_before) = pressed_along(here, du, dd, dn), grown_by(N, batch.before[e, p])
            dN_before = load(z, before)
            store(data[FRICTION] * (by_N * dN + by_before * dN_before), z, limit)
            store(dN, z, before)


@inline_kernel
def rub_changes(batch, q, v, a, rates, kinds, begin, out, ws):
    """See :func:`ancf.compiled.add_changes`."""
    of_each = rates.shape[0] // begin.shape[0]
    for e in range(batch.base.shape[0]):
        if batch.most[e] == 0.0:
            continue
        row, first = row_of(batch, e, q, v), OWN * batch.contact[e]
        for p in range(batch.weight.shape[1]):
            if batch.limit[e, p] == 0.0:
                continue
            here = met(batch, e, p, row)
            pull = drawn_here(batch, e, p, row, here)
            f = both(-pull[3], pull[1], 0.0, pull[1])
            for m in range(begin.shape[0]):
                of = rates[m * of_each : (m + 1) * of_each]
                dr, dx, du, dn = ZERO, ZERO, ZERO, ZERO
                more, factors = of_point(batch, e, p, of, OWN)
                if kinds[m] != 0:
                    dr, dx, du, _, dn = shaped(batch, e, p, row, here, factors)
                dT = rubbed_by(batch, e, here, pull, dr, du, dn, of[first : first + OWN])
                add_change(batch, e, p, here[2], f, dT, dx, more, factors, out[begin[m] :])


@formula
def rubbed_by(batch, e, here, pull, dr, du, dn, own):
    """What the friction at a point changes by as it moves and as numbers change by ``own``."""
    x, w, size, f, slips, way, _ = pull
    data = batch.data[batch.contact[e]]
    dx = both(data[STICK], dr, data[DRAG], du)
    dx = both(1.0, dx, 1.0, both(own[STICK], way, own[DRAG], here[3]))
    return rubbed(w, size, f, slips, along_ground(here[4], x, dn, dx), 0.0)


@inline_kernel
def rub_memory_changes(batch, q, v, rates, kinds, begin, out, ws):
    """See :func:`ancf.compiled.add_memory_changes`."""
    of_each = rates.shape[0] // begin.shape[0]
    for e in range(batch.base.shape[0]):
        if look_around(batch, e, q) and batch.most[e] == 0.0:
            continue
        row, first = row_of(batch, e, q, v), OWN * batch.contact[e]
        data = batch.data[batch.contact[e]]
        for p in range(batch.weight.shape[1]):
            anchor, limit, before = places_of(batch, e, p)
            here = met(batch, e, p, row)
            N, pull = here[5], left_here(batch, e, p, row, here)
            still = here[0], here[1], here[2], ZERO, here[4], N, here[6], here[7]
            by_N, _ = grown_by(N, batch.before[e, p])
            for m in range(begin.shape[0]):
                of, z = rates[m * of_each : (m + 1) * of_each], out[begin[m] :]
                own, (_, factors) = of[first : first + OWN], of_point(batch, e, p, of, OWN)
                dr, dx, du, dd, dn = ZERO, ZERO, ZERO, 0.0, ZERO
                if kinds[m] != 0:
                    dr, dx, du, dd, dn = shaped(batch, e, p, row, here, factors)
                if N > 0.0:
                    dN = pressed_by(batch, e, here, du, dd, dn, own)
                    following = ahead(N, batch.before[e, p])
                    z[LANES * limit] += own[FRICTION] * following + data[FRICTION] * by_N * dN
                    z[LANES * before] += dN
                    if not pull[4]:
                        continue
                    dT, w = rubbed_by(batch, e, still, pull, dr, ZERO, dn, own), pull[1]
                    stiff, shorter = data[STICK], pull[3] * own[STICK] / data[STICK]
                    dr = both(1.0, dr, 1.0 / stiff, both(1.0, dT, shorter, w))
                    dx = inside(batch, e, row, here[1], dr, STILL)
                for c in range(3):
                    z[LANES * (anchor + c)] += dx[c]
