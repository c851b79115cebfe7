"""Derivatives of the normal forces of cables on cables by radii, stiffness and damping of contacts.

A sum R of radii that changes by dR moves the ends of zones where the two touch, |way| = R, by
dx = R dR/(way.t_a), with which points of quadrature and the places that they meet move; and
dN = (dN/dg) dg + (dN/dg') dg' + g dk + on g' dc, where the depth over which damping comes on is a part of
the smaller radius; see :mod:`ancf.contact.cross_along`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..compiled import inline_kernel
from ..records import beginning
from ..vectors import both, dot
from .cross import add_force_on, factors, from_slots, met
from .cross_along import curved_at, pressed_by
from .grip import slopes
from .near import look_if_live
from .strand import (
    AT_FROM,
    AT_TO,
    CONTACT,
    DAMPING,
    ELEMENT,
    FROM,
    GAUSS_W,
    GAUSS_X,
    POINTS,
    RADIUS,
    REACH,
    START,
    STIFFNESS,
    TO,
    TOUCHING,
    StrandBatch,
    along_cubic,
    beyond,
    cubic,
    find_zones,
    less,
    nearest,
    on_cubic,
)
from .touch import SOFT

#: Columns of ``data`` on which normal forces depend.
OWN = DAMPING + 1


def numbers_of(batch: Any) -> FloatArray:
    """Those of :func:`cross_changes`: radius, stiffness and damping of contacts, radii of elements."""
    return np.concatenate([batch.data[:, :OWN].ravel(), batch.radius])


def kinds_of(batch: Any, rates: Any) -> list[int]:
    """Whether a change has some of the radii."""
    return [int(np.any(rates[OWN * len(batch.data) :]))]


@beginning(StrandBatch)
def end_with_reach(batch, q, e, x, fixed, start, reach):
    """What the end x of a zone moves by with the sum of the radii."""
    if fixed != TOUCHING:
        return 0.0
    c = cubic(batch, e, q)
    b, y = nearest(batch, q, on_cubic(c, x), start)
    return reach / dot(less(on_cubic(c, x), on_cubic(cubic(batch, b, q), y)), along_cubic(c, x))


@beginning(StrandBatch)
def place_with_reach(batch, q, b, y, way, moved):
    """What xi of the place that a point meets moves by as the point moves."""
    if beyond(batch, b, y) > 0.0:
        return 0.0
    c = cubic(batch, b, q)
    t = along_cubic(c, y)
    return dot(t, moved) / (dot(t, t) - dot(way, curved_at(c, y)))


@beginning(StrandBatch)
def pressed_with(batch, z, g, rate, own):
    """Change of the force per length as radius, stiffness and damping change by ``own``."""
    data = batch.data[int(batch.zone[z, CONTACT])]
    on = g / (SOFT * data[RADIUS])
    if on < 1.0:
        return g * own[STIFFNESS] + on * rate * (own[DAMPING] - data[DAMPING] * own[RADIUS] / data[RADIUS])
    return g * own[STIFFNESS] + rate * own[DAMPING]


@beginning(StrandBatch)
def add_point_change(batch, z, p, q, v, ends, own, dreach, out):
    """Add what point p of zone z does; ``ends``: what the zone's move by with the sum of the radii."""
    e = int(batch.zone[z, ELEMENT])
    x, weight, b, y, g, n = met(batch, z, p, q)
    if g <= 0.0:
        return
    sa, sb = factors(x, batch.length[e]), factors(y, batch.length[b])
    ta, tb = slopes(x, batch.length[e]), slopes(y, batch.length[b])
    u = less(from_slots(batch, e, sa, v), from_slots(batch, b, sb, v))
    rate = -dot(u, n)
    N, by_g, by_rate = pressed_by(batch, z, g, rate)
    if N <= 0.0:
        return
    away, wide = batch.zone[z, REACH] - g, dreach * (ends[1] - ends[0])
    dx, t = dreach * ends[0] + GAUSS_X[p] * wide, from_slots(batch, e, ta, q)
    moved = dx * t[0], dx * t[1], dx * t[2]
    dy = place_with_reach(batch, q, b, y, (away * n[0], away * n[1], away * n[2]), moved)
    moved = both(1.0, moved, -dy, from_slots(batch, b, tb, q))
    du = both(dx, from_slots(batch, e, ta, v), -dy, from_slots(batch, b, tb, v))
    along = dot(n, moved)
    dn = both(1.0 / away, moved, -along / away, n)
    dN = by_g * (dreach - along) - by_rate * (dot(n, du) + dot(u, dn)) + pressed_with(batch, z, g, rate, own)
    dN = weight * dN + 0.5 * GAUSS_W[p] * batch.length[e] * wide * N
    df, f = both(dN, n, weight * N, dn), (weight * N * n[0], weight * N * n[1], weight * N * n[2])
    add_force_on(batch, e, sa, df, out)
    add_force_on(batch, b, sb, (-df[0], -df[1], -df[2]), out)
    add_force_on(batch, e, ta, (dx * f[0], dx * f[1], dx * f[2]), out)
    add_force_on(batch, b, tb, (-dy * f[0], -dy * f[1], -dy * f[2]), out)


@inline_kernel
def cross_changes(batch, q, v, a, rates, kinds, begin, out, ws):
    """See :func:`ancf.compiled.add_changes`."""
    look_if_live(batch, q)
    of_each, radii = rates.shape[0] // begin.shape[0], OWN * batch.data.shape[0]
    for z in range(find_zones(batch, q)):
        zone = batch.zone[z]
        e, start, first = int(zone[ELEMENT]), int(zone[START]), OWN * int(zone[CONTACT])
        ends = (
            end_with_reach(batch, q, e, zone[FROM], zone[AT_FROM], start, zone[REACH]),
            end_with_reach(batch, q, e, zone[TO], zone[AT_TO], start, zone[REACH]),
        )
        for m in range(begin.shape[0]):
            of = rates[m * of_each : (m + 1) * of_each]
            dreach = of[radii + e] + of[radii + start] if kinds[m] != 0 else 0.0
            for p in range(POINTS):
                own = of[first : first + OWN]
                add_point_change(batch, z, p, q, v, ends, own, dreach, out[begin[m] :])
