"""Where rigid bodies meet: the places of contact of spheres and capsules, their depths and normals.

A row is one place where two bodies may touch: a sphere and a capsule, where their axes are nearest (a sphere
is a capsule without length), an end of a capsule and a surface, or one of the places of a capsule along a
surface of revolution that :mod:`ancf.contact.lay` finds, also along another capsule.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import formula, inline_kernel
from ..vectors import dot
from .lay import AT_END, AT_HEIGHT, OFF_FIRST, OTHER, SHALLOW, lay
from .profiles import profile_of
from .strand import less
from .touch import EX, EY, EZ, at_slot, carried, cylindrical, in_body

#: Kinds of rows: nearest places of two segments, an end of the first and a surface of revolution, a place
#: along the first and such a surface.
SEGMENTS, PROFILE, ALONG = range(3)
#: Columns of ``ends``: both ends of the first segment and of the second, body axes, and both radii.
FIRST, SECOND, RADII = 0, 6, 12


class BumpBatch(NamedTuple):
    """All places where rigid bodies may touch."""

    base: NDArray[np.int64]  # (n, 8) slots of both bodies, -1 for the ground
    dest: NDArray[np.int64]  # (n, 64)
    kind: NDArray[np.int64]  # (n,)
    part: NDArray[np.int64]  # (n,) which place along the first, see :mod:`ancf.contact.lay`
    ends: FloatArray  # (n, 14) columns FIRST ... RADII
    contact: NDArray[np.int64]  # (n,) which contact
    surface: FloatArray  # (n, 10) of a surface: its place, its axis in body axes, its numbers
    shape_of: NDArray[np.int64]  # (n,) number of its profile
    data: FloatArray  # (contacts, 6) as of surfaces: RADIUS ... DRAG
    found: FloatArray  # (contacts, 4) what was measured last
    last: FloatArray  # (n, 9) memory: where the two were after the last step, columns WAY and WERE
    rough: FloatArray  # (n, 10) memory: of friction, see :mod:`ancf.contact.roll`


@formula
def body_of(batch, e, side, q, ground):
    """Place and directions of a body, or their rates; what stands for those of the ground."""
    i = 4 * side
    if batch.base[e, i] < 0:
        return ground
    return (
        at_slot(q, np.uint64(batch.base[e, i])),
        at_slot(q, np.uint64(batch.base[e, i + 1])),
        at_slot(q, np.uint64(batch.base[e, i + 2])),
        at_slot(q, np.uint64(batch.base[e, i + 3])),
    )


@formula
def both(batch, e, q):
    """Places and directions of both bodies."""
    ground = (0.0, 0.0, 0.0), EX, EY, EZ
    return body_of(batch, e, 0, q, ground), body_of(batch, e, 1, q, ground)


@formula
def both_rates(batch, e, v):
    """Their rates."""
    zero = 0.0, 0.0, 0.0
    ground = zero, zero, zero, zero
    return body_of(batch, e, 0, v, ground), body_of(batch, e, 1, v, ground)


@formula
def end_of(batch, e, body, column):
    """Global place of an end."""
    x = batch.ends[e]
    return carried(body, x[column], x[column + 1], x[column + 2])


@inline_kernel
def between(a, s, b):
    """Place at the share s of the way from a to b."""
    return a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2])


@inline_kernel
def share(x, size):
    """Share of a way, 0 to 1; 0 of one without length."""
    return min(max(x / size, 0.0), 1.0) if size > 0.0 else 0.0


@inline_kernel
def nearest_two(p, u, r, w):
    """Nearest places of the segments from p to u and from r to w (Ericson 2005, section 5.1.9)."""
    d, e, way = less(u, p), less(w, r), less(p, r)
    a, b, c = dot(d, d), dot(d, e), dot(e, e)
    f, g = dot(d, way), dot(e, way)
    rest = a * c - b * b
    s = share(b * g - c * f, rest) if rest > 1e-14 * a * c else 0.0
    t = share(b * s + g, c)
    s = share(b * t - f, a)
    return between(p, s, u), between(r, share(b * s + g, c), w)


@formula
def place_along(batch, e, p, u, at, axis):
    """A place of a capsule along a surface: where, what its end is, shares of force, losses and energy."""
    d, way = less(u, p), less(p, at)
    h0, hd = dot(way, axis), dot(d, axis)
    x = way[0] - h0 * axis[0], way[1] - h0 * axis[1], way[2] - h0 * axis[2]
    y = d[0] - hd * axis[0], d[1] - hd * axis[1], d[2] - hd * axis[2]
    line = h0, hd, dot(x, x), dot(x, y), dot(y, y)
    s, what, w, lost, energy = lay(
        batch.shape_of[e],
        batch.surface[e, 6:],
        line,
        math.sqrt(dot(d, d)),
        batch.ends[e, RADII],
        batch.part[e],
    )
    return between(p, s, u), d, what, w, lost, energy


@inline_kernel
def is_off(part):
    """Whether a part of a row is what happens where a capsule leaves the end of a surface."""
    return part != SHALLOW and part % OTHER >= OFF_FIRST


@inline_kernel
def across(n, c, d):
    """The vector across d that is n but for a part of c, along which the place is fixed; and its size."""
    s = dot(n, d) / dot(c, d)
    m = n[0] - s * c[0], n[1] - s * c[1], n[2] - s * c[2]
    size = math.sqrt(dot(m, m))
    return (m[0] / size, m[1] / size, m[2] / size), size


@formula
def meet(batch, e, one, two):
    """Depth, normal, place of contact, way between the middles, and shares of force, losses and energy."""
    a, b = batch.ends[e, RADII], batch.ends[e, RADII + 1]
    p = end_of(batch, e, one, FIRST)
    w, lost, energy = 1.0, 1.0, 1.0
    if batch.kind[e] == SEGMENTS:
        u = end_of(batch, e, one, FIRST + 3)
        p, r = nearest_two(p, u, end_of(batch, e, two, SECOND), end_of(batch, e, two, SECOND + 3))
        way = less(p, r)
        d = math.sqrt(dot(way, way))
        s = 1.0 / d if d > 0.0 else 0.0
        n = way[0] * s, way[1] * s, way[2] * s
        g = a + b - d
    else:
        x = batch.surface[e]
        at = carried(two, x[0], x[1], x[2])
        tip = carried(two, x[0] + x[3], x[1] + x[4], x[2] + x[5])
        axis = less(tip, at)
        what, line = AT_END, axis
        if batch.kind[e] == ALONG:
            u = end_of(batch, e, one, FIRST + 3)
            p, line, what, w, lost, energy = place_along(batch, e, p, u, at, axis)
        h, rho, away = cylindrical(p, at, axis)
        d, n_rho, n_z, _ = profile_of(batch.shape_of[e], x[6:], rho, h)
        n = n_rho * away[0] + n_z * axis[0], n_rho * away[1] + n_z * axis[1], n_rho * away[2] + n_z * axis[2]
        way, g = (d * n[0], d * n[1], d * n[2]), a - d
        if what != AT_END:
            fixed = axis if what == AT_HEIGHT else away
            if is_off(batch.part[e]):
                return g, fixed, p, way, w / dot(fixed, line), 0.0, energy
            n, more = across(n, fixed, line)
            w, lost = w * more, lost * more
    k = a - 0.5 * g
    return g, n, (p[0] - k * n[0], p[1] - k * n[1], p[2] - k * n[2]), way, w, lost, energy


@inline_kernel
def apart_at(one, two, moving, other, c):
    """Velocity of the first body past the second one in a place, and the place in the axes of both."""
    x, y = in_body(one, c), in_body(two, c)
    u = less(carried(moving, x[0], x[1], x[2]), carried(other, y[0], y[1], y[2]))
    return u, x, y


@inline_kernel
def factor_in(k, x, y):
    """Factor of slot k of a row in the way of the first body past the second, at x and y in their axes."""
    if k < 4:
        return 1.0 if k == 0 else x[k - 1]
    return -1.0 if k == 4 else -y[k - 5]
