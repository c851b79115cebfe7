"""Derivatives of pressures along eight directions at a time, and by numbers, see :mod:`ancf.contact.press`.

With N = k g + c on(g) g', g' = -n.u, the force N n changes by dN n + N dn with

    dN = N_g dg + N_g' dg',    dg = dR - dd,    dg' = -n.du - u.dn,

see :mod:`ancf.contact.ways` for the rest; numbers add g dk + on g' dc, and the radius R what ``on`` has of
it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..compiled import formula, inline_kernel
from ..records import beginning
from ..vectors import both, dot
from .press_slopes import OWN
from .touch import (
    DAMPING,
    RADIUS,
    SOFT,
    STIFFNESS,
    ZERO,
    look_around,
    outside,
    place_on,
    pressure,
    row_of,
    turning,
)
from .touching import Touching
from .ways import (
    add_change,
    add_lanes,
    apart,
    inside,
    leaned,
    met,
    moved_by,
    past,
    ways_along,
)

#: A body that no number moves.
STILL = ZERO, ZERO, ZERO, ZERO


def kinds_of(batch: Any, rates: Any) -> list[int]:
    """Whether a change has some of weights and factors."""
    return [int(np.any(rates[OWN * len(batch.data) :]))]


@formula
def pressed_along(here, du, dd, dn):
    """Change of N."""
    _, _, _, u, n, _, by_g, by_rate = here
    return -by_g * dd - by_rate * (dot(n, du) + dot(u, dn))


@beginning(Touching)
def followed(batch, e, p, row, here, ways, fast):
    """Of a point that moves: dr, dx, dv, du, dd and dn."""
    _, r, x, _, _, _, _, _ = here
    dr, dv = place_on(batch, e, p, ways[0]), place_on(batch, e, p, fast[0])
    dx = inside(batch, e, row, r, dr, ways[1])
    dd, dn = leaned(batch, e, p, row, r, dr, ways[1])
    return dr, dx, dv, past(batch, e, row, x, dv, dx, fast[1]), dd, dn


@inline_kernel
def press_slopes_along(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_force_slopes`."""
    for e in range(batch.base.shape[0]):
        if look_around(batch, e, q):
            continue
        row, (ways, fast) = row_of(batch, e, q, v), ways_along(batch, e, d)
        for p in range(batch.weight.shape[1]):
            here = met(batch, e, p, row)
            x, n, N = here[2], here[4], here[5]
            if N == 0.0:
                continue
            _, dx, _, du, dd, dn = followed(batch, e, p, row, here, ways, fast)
            dN = pressed_along(here, du, dd, dn)
            df = dN * n[0] + N * dn[0], dN * n[1] + N * dn[1], dN * n[2] + N * dn[2]
            add_lanes(batch, e, p, x, both(N, n, 0.0, n), df, dx, r)


@inline_kernel
def press_slopes_beside(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_slopes_beside`: how velocities, bodies and damping that pulls matter."""
    for e in range(batch.base.shape[0]):
        if look_around(batch, e, q):
            continue
        row, (ways, fast) = row_of(batch, e, q, v), ways_along(batch, e, d)
        for p in range(batch.weight.shape[1]):
            here = met(batch, e, p, row)
            g, place, x, u, n, N, _, by_rate = here
            if N == 0.0:
                continue
            dr, dx, dv, du, dd, dn = followed(batch, e, p, row, here, ways, fast)
            dN = pressed_along(here, du, dd, dn)
            _, by_g, _ = pressure(batch.data[batch.contact[e]], g, -dot(u, n))
            y, dy = apart(batch, e, x, dr, ways[1]), apart(batch, e, x, dv, fast[1])
            dN = dN + by_g * dot(n, y) + by_rate * dot(n, dy)
            _, _, along, bend, about = outside(batch, e, p, row[2], row[4], row[5], place)
            t = turning(N, n, along, bend, about)
            df = (
                dN * n[0] + N * dn[0] - dot(t[0], y),
                dN * n[1] + N * dn[1] - dot(t[1], y),
                dN * n[2] + N * dn[2] - dot(t[2], y),
            )
            add_lanes(batch, e, p, x, both(N, n, 0.0, n), df, dx, r)


@beginning(Touching)
def pressed_by(batch, e, here, du, dd, dn, own):
    """Change of N as a point moves and as radius, stiffness and damping change by ``own``."""
    g, _, _, u, n, N, by_g, _ = here
    if N == 0.0:
        return 0.0
    data, rate = batch.data[batch.contact[e]], -dot(u, n)
    on, radius = g / (SOFT * data[RADIUS]), data[RADIUS]
    dN = pressed_along(here, du, dd, dn) + by_g * own[RADIUS] + g * own[STIFFNESS]
    if on < 1.0:
        return dN + on * rate * (own[DAMPING] - data[DAMPING] * own[RADIUS] / radius)
    return dN + rate * own[DAMPING]


@beginning(Touching)
def shaped(batch, e, p, row, here, rates):
    """What changes of factors move a point by, see :func:`followed`."""
    _, r, x, _, _, _, _, _ = here
    dr, dv = moved_by(batch, e, p, row[0], rates), moved_by(batch, e, p, row[1], rates)
    dx = inside(batch, e, row, r, dr, STILL)
    dd, dn = leaned(batch, e, p, row, r, dr, STILL)
    return dr, dx, past(batch, e, row, x, dv, dx, STILL), dd, dn


@formula
def of_point(batch, e, p, of, own):
    """Changes of the weight and of the factors of a point in those of the numbers, ``own`` of a contact."""
    points, slots = batch.weight.shape[1], batch.shape.shape[2]
    weights = own * batch.data.shape[0]
    first = weights + batch.weight.size + slots * (points * e + p)
    return of[weights + points * e + p], of[first : first + slots]


@inline_kernel
def press_changes(batch, q, v, a, rates, kinds, begin, out, ws):
    """See :func:`ancf.compiled.add_changes`."""
    of_each = rates.shape[0] // begin.shape[0]
    for e in range(batch.base.shape[0]):
        if look_around(batch, e, q):
            continue
        row, first = row_of(batch, e, q, v), OWN * batch.contact[e]
        for p in range(batch.weight.shape[1]):
            here = met(batch, e, p, row)
            x, n, N = here[2], here[4], here[5]
            if N == 0.0:
                continue
            f = both(N, n, 0.0, n)
            for m in range(begin.shape[0]):
                of = rates[m * of_each : (m + 1) * of_each]
                dx, du, dd, dn = ZERO, ZERO, 0.0, ZERO
                more, factors = of_point(batch, e, p, of, OWN)
                if kinds[m] != 0:
                    _, dx, du, dd, dn = shaped(batch, e, p, row, here, factors)
                dN = pressed_by(batch, e, here, du, dd, dn, of[first : first + OWN])
                df = both(dN, n, N, dn)
                add_change(batch, e, p, x, f, df, dx, more, factors, out[begin[m] :])
