"""How depth, normal, place and shares of contacts between bodies change along eight directions at a time.

Of two segments, p + s d and r + t e, with the way w between the nearest places, where both are inside,

    (w.d)' = 0,  (w.e)' = 0:      d.d ds - d.e dt = -(dw_0.d + w.dd),    d.e ds - e.e dt = -(dw_0.e + w.de),

with dw_0 for fixed s and t; at an end of a segment these stay.  Of a place at a surface of revolution see
:mod:`ancf.contact.ways`, of those along a capsule :mod:`ancf.contact.lay_along`.
"""

from __future__ import annotations

import math

from ..compiled import formula, inline_kernel
from ..simd import every
from ..vectors import both as sum_of
from ..vectors import dot
from .lay import AT_END, AT_HEIGHT
from .lay_along import lay_moves
from .meeting import (
    ALONG,
    FIRST,
    RADII,
    SECOND,
    SEGMENTS,
    end_of,
    is_off,
    place_along,
    share,
)
from .profiles import profile_of
from .strand import less
from .touch import carried, cylindrical
from .ways import at_place, no_way, scaled


@formula
def body_along(batch, e, side, d, n):
    """Changes of place and directions of a body, along eight directions n; none of the ground."""
    i = 4 * side
    if batch.base[e, i] < 0:
        return no_way(), no_way(), no_way(), no_way()
    b = batch.base[e]
    return at_place(d, n, b[i]), at_place(d, n, b[i + 1]), at_place(d, n, b[i + 2]), at_place(d, n, b[i + 3])


@formula
def end_along(batch, e, moving, column):
    """Change of the global place of an end."""
    x = batch.ends[e]
    return carried(moving, x[column], x[column + 1], x[column + 2])


@inline_kernel
def shares_of(p, d, r, e):
    """Shares of the nearest places of two segments, as :func:`ancf.contact.meeting.nearest_two` has them."""
    way = less(p, r)
    a, b, c = dot(d, d), dot(d, e), dot(e, e)
    f, g = dot(d, way), dot(e, way)
    rest = a * c - b * b
    s = share(b * g - c * f, rest) if rest > 1e-14 * a * c else 0.0
    t = share(b * s + g, c)
    s = share(b * t - f, a)
    return s, share(b * s + g, c)


@inline_kernel
def shares_along(s, t, d, e, by_d, by_e):
    """What both shares change by; ``by_d`` and ``by_e``: right sides of the two equations."""
    a, b, c = dot(d, d), dot(d, e), dot(e, e)
    rest = a * c - b * b
    inside, other = 0.0 < s < 1.0, 0.0 < t < 1.0
    if inside and other and rest > 1e-14 * a * c:
        return (1.0 / rest) * (c * by_d - b * by_e), (1.0 / rest) * (b * by_d - a * by_e)
    if other:
        return every(0.0), (-1.0 / c) * by_e
    if inside:
        return (1.0 / a) * by_d, every(0.0)
    return every(0.0), every(0.0)


@formula
def segments_along(batch, e, one, two, ways):
    """Change of the place on the first of two segments, and of the way from the second."""
    p, r = end_of(batch, e, one, FIRST), end_of(batch, e, two, SECOND)
    d, f = less(end_of(batch, e, one, FIRST + 3), p), less(end_of(batch, e, two, SECOND + 3), r)
    dp, dr = end_along(batch, e, ways[0], FIRST), end_along(batch, e, ways[1], SECOND)
    dd = sum_of(1.0, end_along(batch, e, ways[0], FIRST + 3), -1.0, dp)
    df = sum_of(1.0, end_along(batch, e, ways[1], SECOND + 3), -1.0, dr)
    s, t = shares_of(p, d, r, f)
    way = sum_of(1.0, sum_of(1.0, p, s, d), -1.0, sum_of(1.0, r, t, f))
    dp, dr = sum_of(1.0, dp, s, dd), sum_of(1.0, dr, t, df)
    past = sum_of(1.0, dp, -1.0, dr)
    by_d, by_f = -1.0 * (dot(d, past) + dot(way, dd)), -1.0 * (dot(f, past) + dot(way, df))
    ds, dt = shares_along(s, t, d, f, by_d, by_f)
    dp = sum_of(1.0, dp, 1.0, scaled(ds, d))
    return dp, sum_of(1.0, dp, -1.0, sum_of(1.0, dr, 1.0, scaled(dt, f)))


@formula
def axis_along(batch, e, ways):
    """Change of place and axis of the surface of a row."""
    x = batch.surface[e]
    at = carried(ways[1], x[0], x[1], x[2])
    tip = carried(ways[1], x[0] + x[3], x[1] + x[4], x[2] + x[5])
    return at, sum_of(1.0, tip, -1.0, at)


@formula
def line_along(way, d, axis, dway, dd, daxis):
    """The numbers of a line over an axis, see :func:`ancf.contact.lay.along`, and what they change by."""
    h0, hd = dot(way, axis), dot(d, axis)
    x, y = sum_of(1.0, way, -h0, axis), sum_of(1.0, d, -hd, axis)
    dh0, dhd = dot(axis, dway) + dot(way, daxis), dot(axis, dd) + dot(d, daxis)
    dx = sum_of(1.0, sum_of(1.0, dway, -h0, daxis), -1.0, scaled(dh0, axis))
    dy = sum_of(1.0, sum_of(1.0, dd, -hd, daxis), -1.0, scaled(dhd, axis))
    line = h0, hd, dot(x, x), dot(x, y), dot(y, y)
    return line, (dh0, dhd, 2.0 * dot(x, dx), dot(x, dy) + dot(y, dx), 2.0 * dot(y, dy))


@formula
def laid_along(batch, e, line, dline, size, dsize):
    """Changes of the share of the axis, and of shares of force and losses: by each number of a line."""
    ds, dw, dlost = every(0.0), every(0.0), every(0.0)
    for k in range(6):
        own = (
            1.0 if k == 0 else 0.0,
            1.0 if k == 1 else 0.0,
            1.0 if k == 2 else 0.0,
            1.0 if k == 3 else 0.0,
            1.0 if k == 4 else 0.0,
        )
        x, y, z = lay_moves(
            batch.shape_of[e],
            batch.surface[e, 6:],
            line,
            own,
            size,
            1.0 if k == 5 else 0.0,
            batch.ends[e, RADII],
            batch.part[e],
        )
        by = dsize
        if k == 0:
            by = dline[0]
        elif k == 1:
            by = dline[1]
        elif k == 2:
            by = dline[2]
        elif k == 3:
            by = dline[3]
        elif k == 4:
            by = dline[4]
        ds, dw, dlost = ds + x * by, dw + y * by, dlost + z * by
    return ds, dw, dlost


@formula
def across_along(n, c, d, dn, dc, dd):
    """Changes of the vector across d of :func:`ancf.contact.meeting.across`, and of its size."""
    nd, cd = dot(n, d), dot(c, d)
    s = nd / cd
    ds = (1.0 / cd) * (dot(d, dn) + dot(n, dd) - s * (dot(d, dc) + dot(c, dd)))
    m = sum_of(1.0, n, -s, c)
    size = math.sqrt(dot(m, m))
    u = m[0] / size, m[1] / size, m[2] / size
    dm = sum_of(1.0, sum_of(1.0, dn, -s, dc), -1.0, scaled(ds, c))
    dsize = dot(u, dm)
    return u, size, sum_of(1.0 / size, dm, -1.0 / size, scaled(dsize, u)), dsize


@formula
def segment_meets_along(batch, e, one, two, ways):
    """See :func:`meet_along`, of two segments."""
    dp, dway = segments_along(batch, e, one, two, ways)
    p, r = end_of(batch, e, one, FIRST), end_of(batch, e, two, SECOND)
    d, f = less(end_of(batch, e, one, FIRST + 3), p), less(end_of(batch, e, two, SECOND + 3), r)
    s, t = shares_of(p, d, r, f)
    way = sum_of(1.0, sum_of(1.0, p, s, d), -1.0, sum_of(1.0, r, t, f))
    size = math.sqrt(dot(way, way))
    inverse = 1.0 / size if size > 0.0 else 0.0
    n = way[0] * inverse, way[1] * inverse, way[2] * inverse
    dg = -1.0 * dot(n, dway)
    dn = sum_of(inverse, dway, inverse, scaled(dg, n))
    k = batch.ends[e, RADII] - 0.5 * (batch.ends[e, RADII] + batch.ends[e, RADII + 1] - size)
    dc = sum_of(1.0, sum_of(1.0, dp, -k, dn), 0.5, scaled(dg, n))
    return dg, dn, dc, every(0.0), every(0.0)


@formula
def surface_meets_along(batch, e, one, two, ways):
    """See :func:`meet_along`, of a place at a surface."""
    x = batch.surface[e]
    at = carried(two, x[0], x[1], x[2])
    axis = less(carried(two, x[0] + x[3], x[1] + x[4], x[2] + x[5]), at)
    dat, daxis = axis_along(batch, e, ways)
    p, dp = end_of(batch, e, one, FIRST), end_along(batch, e, ways[0], FIRST)
    what, d, dd, w, lost = AT_END, axis, daxis, 1.0, 1.0
    dw, dlost = every(0.0), every(0.0)
    if batch.kind[e] == ALONG:
        u = end_of(batch, e, one, FIRST + 3)
        dd = sum_of(1.0, end_along(batch, e, ways[0], FIRST + 3), -1.0, dp)
        past = sum_of(1.0, dp, -1.0, dat)
        line, dline = line_along(less(p, at), less(u, p), axis, past, dd, daxis)
        start = p
        p, d, what, w, lost, _ = place_along(batch, e, start, u, at, axis)
        size = math.sqrt(dot(d, d))
        ds, dw, dlost = laid_along(batch, e, line, dline, size, (1.0 / size) * dot(d, dd))
        s = dot(less(p, start), d) / (size * size)
        dp = sum_of(1.0, sum_of(1.0, dp, s, dd), 1.0, scaled(ds, d))
    h, rho, away = cylindrical(p, at, axis)
    far, n_rho, n_z, bend = profile_of(batch.shape_of[e], x[6:], rho, h)
    n = n_rho * away[0] + n_z * axis[0], n_rho * away[1] + n_z * axis[1], n_rho * away[2] + n_z * axis[2]
    y, dy = less(p, at), sum_of(1.0, dp, -1.0, dat)
    dh = dot(axis, dy) + dot(y, daxis)
    aside = sum_of(1.0, sum_of(1.0, dy, -h, daxis), -1.0, scaled(dh, axis))
    drho, inverse = dot(away, aside), 1.0 / rho if rho > 0.0 else 0.0
    daway = sum_of(inverse, aside, -inverse, scaled(drho, away))
    about = n_rho * inverse if rho > 0.0 else bend
    turn = bend * (n_rho * dh - n_z * drho)
    dn = sum_of(1.0, scaled(turn * n_rho, axis), -1.0, scaled(turn * n_z + about * drho, away))
    dn = sum_of(1.0, dn, 1.0, sum_of(about, aside, n_z, daxis))
    dg, g = -1.0 * (n_rho * drho + n_z * dh), batch.ends[e, RADII] - far
    if what != AT_END:
        fixed = axis if what == AT_HEIGHT else away
        dfixed = daxis if what == AT_HEIGHT else daway
        if is_off(batch.part[e]):
            long = dot(fixed, d)
            dlong = dot(d, dfixed) + dot(fixed, dd)
            return dg, dfixed, dp, (1.0 / long) * (dw - (w / long) * dlong), every(0.0)
        n, more, dn, dmore = across_along(n, fixed, d, dn, dfixed, dd)
        dw, dlost = more * dw + w * dmore, more * dlost + lost * dmore
    k = batch.ends[e, RADII] - 0.5 * g
    return dg, dn, sum_of(1.0, sum_of(1.0, dp, -k, dn), 0.5, scaled(dg, n)), dw, dlost


@formula
def meet_along(batch, e, one, two, ways):
    """Changes of depth, normal, place of contact and shares of force and losses, of a row that touches.

    ``one``, ``two``: place and directions of both bodies; ``ways``: what these change by.
    """
    if batch.kind[e] == SEGMENTS:
        return segment_meets_along(batch, e, one, two, ways)
    return surface_meets_along(batch, e, one, two, ways)
