"""Derivatives of the normal forces of cables on cables along eight directions at a time.

A point of a zone stands at xi = x on its cable and meets the other one at xi = y, where both move:

    x = x_0 + s (x_1 - x_0),      way = r_a(x) - r_b(y),      way . t_b = 0,

with r' = t by xi.  The ends x_0, x_1 of a zone stay at borders of cells; where the two touch there,
way . dway = 0, and where an element passes the end of a cable, (r_a - r_b) . t_b = 0 with a fixed y.  So

    dx = -way.(dr_a - dr_b)/(way.t_a)   or   -((dr_a - dr_b).t_b + way.dt_b)/(t_a.t_b),
    dy = ((dr_a - dr_b).t_b + way.dt_b)/(t_b.t_b - way.t_b'),     0 at the end of a cable,

dr_a with t_a dx, and with the normal n, the depth g and the rates u of both places

    dg = -n.dway,    dn = (dway + dg n)/|way|,    dg' = -n.du - u.dn.

The force acts with factors of both places, which change with x and y, and so does the length of the zone.
"""

from __future__ import annotations

from ..compiled import inline_kernel
from ..records import beginning
from ..simd import every, load, store
from ..vectors import both, dot
from .cross import factors, from_slots, met
from .grip import slopes
from .near import look_if_live
from .strand import (
    AT_FROM,
    AT_TO,
    BORDER,
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
from .touch import SOFT, pressure


@beginning(StrandBatch)
def at_slots(batch, e, s, d, n):
    """Sum of the vectors of an element with these factors, of eight directions n."""
    x, y, z = every(0.0), every(0.0), every(0.0)
    for k in range(4):
        i = batch.base[e, k]
        x = x + s[k] * load(d, n, i)
        y = y + s[k] * load(d, n, i + 1)
        z = z + s[k] * load(d, n, i + 2)
    return x, y, z


@inline_kernel
def curved_at(c, x):
    """Second derivative by xi."""
    _, _, b, d = c
    return (
        2.0 * b[0] + 6.0 * x * d[0],
        2.0 * b[1] + 6.0 * x * d[1],
        2.0 * b[2] + 6.0 * x * d[2],
    )


@beginning(StrandBatch)
def end_along(batch, q, d, e, x, fixed, start):
    """What the end x of a zone of element e moves by; ``fixed``: what holds it there."""
    if fixed == BORDER:
        return every(0.0)
    h, c = batch.length[e], cubic(batch, e, q)
    r, t, dr = on_cubic(c, x), along_cubic(c, x), at_slots(batch, e, factors(x, h), d, 0)
    b, y = int(fixed) // 2, fixed % 2.0
    if fixed == TOUCHING:
        b, y = nearest(batch, q, r, start)
    o, h = cubic(batch, b, q), batch.length[b]
    way, moved = less(r, on_cubic(o, y)), both(1.0, dr, -1.0, at_slots(batch, b, factors(y, h), d, 0))
    if fixed == TOUCHING:
        return (-1.0 / dot(way, t)) * dot(way, moved)
    tb = along_cubic(o, y)
    turned = at_slots(batch, b, slopes(y, h), d, 0)
    return (-1.0 / dot(t, tb)) * (dot(tb, moved) + dot(way, turned))


@beginning(StrandBatch)
def nearest_along(batch, q, d, b, y, way, moved):
    """What the place that a point meets moves by, as the point moves by ``moved`` past it."""
    if beyond(batch, b, y) > 0.0:
        return every(0.0)
    c = cubic(batch, b, q)
    t, turned = along_cubic(c, y), at_slots(batch, b, slopes(y, batch.length[b]), d, 0)
    return (1.0 / (dot(t, t) - dot(way, curved_at(c, y)))) * (dot(t, moved) + dot(way, turned))


@beginning(StrandBatch)
def add_lanes_on(batch, e, s, ds, dx, f, df, r):
    """Subtract changes df of a force f on a place that moves by dx, which its factors s do by ds, from r."""
    for k in range(4):
        i = batch.base[e, k]
        for c in range(3):
            store(load(r, i + c) - (s[k] * df[c] + (ds[k] * f[c]) * dx), r, i + c)


@beginning(StrandBatch)
def pressed_by(batch, z, g, rate):
    """Force per length, and what it changes by with the depth, of pulling damping as well, and its rate."""
    data = batch.data[int(batch.zone[z, CONTACT])]
    N, by_g, by_rate = pressure(data, g, rate)
    soft = SOFT * data[RADIUS]
    if N > 0.0 and g < soft:
        by_g = data[STIFFNESS] + data[DAMPING] * rate / soft
    return N, by_g, by_rate


@beginning(StrandBatch)
def add_point_along(batch, z, p, q, v, d, ends, r):
    """Add what point p of zone z does, whose ends move by ``ends``."""
    e = int(batch.zone[z, ELEMENT])
    x, weight, b, y, g, n = met(batch, z, p, q)
    if g <= 0.0:
        return
    sa, sb = factors(x, batch.length[e]), factors(y, batch.length[b])
    u = less(from_slots(batch, e, sa, v), from_slots(batch, b, sb, v))
    N, by_g, by_rate = pressed_by(batch, z, g, -dot(u, n))
    if N <= 0.0:
        return
    ta, tb = slopes(x, batch.length[e]), slopes(y, batch.length[b])
    away = batch.zone[z, REACH] - g
    way, wide = (away * n[0], away * n[1], away * n[2]), ends[1] - ends[0]
    dx = ends[0] + GAUSS_X[p] * wide
    moved = both(1.0, at_slots(batch, e, sa, d, 0), -1.0, at_slots(batch, b, sb, d, 0))
    moved = both(1.0, moved, dx, from_slots(batch, e, ta, q))
    dy = nearest_along(batch, q, d, b, y, way, moved)
    moved = both(1.0, moved, -1.0 * dy, from_slots(batch, b, tb, q))
    du = both(1.0, at_slots(batch, e, sa, d, 1), -1.0, at_slots(batch, b, sb, d, 1))
    du = both(1.0, du, dx, from_slots(batch, e, ta, v))
    du = both(1.0, du, -1.0 * dy, from_slots(batch, b, tb, v))
    dg = -1.0 * dot(n, moved)
    dn = both(1.0 / away, moved, (1.0 / away) * dg, n)
    dN = (0.5 * GAUSS_W[p] * batch.length[e] * N) * wide
    dN = dN + (weight * by_g) * dg - (weight * by_rate) * (dot(n, du) + dot(u, dn))
    N = weight * N
    f, df = (N * n[0], N * n[1], N * n[2]), both(dN, n, N, dn)
    add_lanes_on(batch, e, sa, ta, dx, f, df, r)
    add_lanes_on(batch, b, sb, tb, dy, (-f[0], -f[1], -f[2]), both(-1.0, df, 0.0, n), r)


@inline_kernel
def cross_slopes_along(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_force_slopes`, and :func:`ancf.compiled.add_slopes_beside`: it is all."""
    look_if_live(batch, q)
    for z in range(find_zones(batch, q)):
        zone = batch.zone[z]
        e, start = int(zone[ELEMENT]), int(zone[START])
        ends = (
            end_along(batch, q, d, e, zone[FROM], zone[AT_FROM], start),
            end_along(batch, q, d, e, zone[TO], zone[AT_TO], start),
        )
        for p in range(POINTS):
            add_point_along(batch, z, p, q, v, d, ends, r)
