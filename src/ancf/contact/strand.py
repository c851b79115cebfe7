"""Cables as curves: elements as cubics, places that are nearest, zones of contact between two cables.

A row of a batch is one element of a cable that may touch cables.  Its ``base`` has the slots of r and r_x of
its nodes, so that with xi from 0 to 1 and the reference length h

    r(xi) = c0 + c1 xi + c2 xi^2 + c3 xi^3.

Each element is cut into cells of one length.  On a cell the square of the distance from another cable is
nearly quadratic in xi, for straight cables it is exactly so; its zone is where that is less than the sum of
the radii.  Points of quadrature cover the zone and move with it, so that no force depends on where they lie.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import types
from numpy.typing import NDArray

from ..addresses import caller
from ..arrays import FloatArray
from ..compiled import VECTOR, formula, inline_kernel, separate_kernel
from ..records import beginning
from ..vectors import dot

#: Columns of ``data``: as those of surfaces, see :mod:`ancf.contact.touch`; the radius is the smaller one.
RADIUS, STIFFNESS, DAMPING, FRICTION, STICK, DRAG = range(6)
#: Columns of ``zone``: element, cell, xi from and to, element where the search begins, sum of radii, contact,
#: arc length on the other cable, what fixes both xi.
ELEMENT, CELL, FROM, TO, START, REACH, CONTACT, MET, AT_FROM, AT_TO = range(10)
#: What fixes a xi of a zone: that the two touch there, or the border of a cell; else it is where an element
#: passes the end of a cable at xi = y of element b, 2 b + y.
TOUCHING, BORDER = -2.0, -1.0
#: Place of ``room``: how many zones are held as they are, -1: they are found anew in each state.
HELD = 6
#: Gauss points of a zone and their weights: with three the energy of a crossing is 1e-3 off its force.
POINTS = 5
GAUSS_X = tuple((0.5 + 0.5 * np.polynomial.legendre.leggauss(POINTS)[0]).tolist())
GAUSS_W = tuple((0.5 * np.polynomial.legendre.leggauss(POINTS)[1]).tolist())
#: Elements that a search walks along a cable, its iterations in each, and the change of xi that is none.
WALK, ITERATIONS, STILL = 12, 25, 1e-13
#: Iterations for the end of a zone, and the share of the square of the radii that counts as none.
SEARCH, CLOSE = 20, 1e-10
#: Factor of the reference length by which an element may be longer; diameters of arc that never touch itself.
STRETCHED, APART = 1.3, 2.0


class StrandBatch(NamedTuple):
    """All elements of cables that may touch cables, and which of them are near each other."""

    base: NDArray[np.int64]  # (n, 4) slots of r, r_x, r, r_x
    length: FloatArray  # (n,) reference lengths, m
    place: FloatArray  # (n,) reference arc length of the first node on its cable, m
    radius: FloatArray  # (n,) m
    cable: NDArray[np.int64]  # (n,) which cable
    beside: NDArray[np.int64]  # (n, 2) elements before and behind, -1: an end
    law: NDArray[np.int64]  # (cables, cables) which contact, -1: none
    data: FloatArray  # (contacts, 6) columns RADIUS ... DRAG
    found: FloatArray  # (contacts, 4) what was measured last
    cells: NDArray[np.int64]  # (1,) of an element
    seen: FloatArray  # (n, 12) the unknowns of base when the list was made
    room: FloatArray  # (7,) when it is to be made again, see :mod:`ancf.contact.near`, and HELD
    first: NDArray[np.int64]  # (n + 1,) first entry of ``near`` of each element
    near: NDArray[np.int64]  # (room,) elements that are near, ascending for each element
    piece: NDArray[np.int64]  # (pieces + 1,) first element of each piece of a cable, and the end
    box: FloatArray  # (pieces, 6) workspace of the list: least and largest coordinates of pieces
    middle: FloatArray  # (n, 4) workspace of the list: balls about the elements
    head: NDArray[np.int64]  # (buckets,) workspace of the list
    link: NDArray[np.int64]  # (n,) the same
    last: FloatArray  # (n, 12) memory: the unknowns of base after the last step
    grip: FloatArray  # (room, 9) memory: rows of friction, see :mod:`ancf.contact.grip`
    older: FloatArray  # (room, 9) workspace, these rows before a step
    zone: FloatArray  # (room, 10) workspace
    at: NDArray[np.int64]  # (room, 2) elements of rows of the matrix
    row: FloatArray  # (room, 25) these rows, and their stiffness
    basis: FloatArray  # (room, size) workspace of the solver
    small: FloatArray  # (room, room) the same
    search: int  # address of find_zones_at


@beginning(StrandBatch)
def cubic(batch, e, q):
    """Coefficients c0 ... c3 of element e."""
    i, j, k, m = batch.base[e, 0], batch.base[e, 1], batch.base[e, 2], batch.base[e, 3]
    h = batch.length[e]
    ax, ay, az = q[i], q[i + 1], q[i + 2]
    bx, by, bz = h * q[j], h * q[j + 1], h * q[j + 2]
    cx, cy, cz = q[k] - ax, q[k + 1] - ay, q[k + 2] - az
    dx, dy, dz = h * q[m], h * q[m + 1], h * q[m + 2]
    return (
        (ax, ay, az),
        (bx, by, bz),
        (3.0 * cx - 2.0 * bx - dx, 3.0 * cy - 2.0 * by - dy, 3.0 * cz - 2.0 * bz - dz),
        (bx + dx - 2.0 * cx, by + dy - 2.0 * cy, bz + dz - 2.0 * cz),
    )


@inline_kernel
def on_cubic(c, x):
    """Place at xi = x."""
    a, b, d, e = c
    return (
        a[0] + x * (b[0] + x * (d[0] + x * e[0])),
        a[1] + x * (b[1] + x * (d[1] + x * e[1])),
        a[2] + x * (b[2] + x * (d[2] + x * e[2])),
    )


@inline_kernel
def along_cubic(c, x):
    """Derivative by xi."""
    _, b, d, e = c
    return (
        b[0] + x * (2.0 * d[0] + 3.0 * x * e[0]),
        b[1] + x * (2.0 * d[1] + 3.0 * x * e[1]),
        b[2] + x * (2.0 * d[2] + 3.0 * x * e[2]),
    )


@inline_kernel
def less(a, b):
    """a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@inline_kernel
def on_element(c, r, x):
    """The xi in 0 ... 1 near x where an element is nearest to r; -1 or 1: it goes on before or behind it."""
    for _ in range(ITERATIONS):
        way, t = less(on_cubic(c, x), r), along_cubic(c, x)
        slope, size = dot(way, t), dot(t, t)
        curved = size + 2.0 * dot(way, c[2]) + 6.0 * x * dot(way, c[3])
        step = slope / (curved if curved > 0.1 * size else size)
        new = min(max(x - min(max(step, -0.5), 0.5), 0.0), 1.0)
        if new == x:
            return x, -1 if slope > 0.0 and x == 0.0 else (1 if slope < 0.0 and x == 1.0 else 0)
        done = abs(new - x) < STILL
        x = new
        if done:
            return x, 0
    return x, 0


@beginning(StrandBatch)
def nearest(batch, q, r, b):
    """Element and xi of a place on the cable through element b that is nearest to r, next to b."""
    c = cubic(batch, b, q)
    chord = less(on_cubic(c, 1.0), c[0])
    x = min(max(dot(less(r, c[0]), chord) / max(dot(chord, chord), 1e-300), 0.0), 1.0)
    came = 0
    for _ in range(WALK):
        x, side = on_element(c, r, x)
        if side == 0 or side == -came:
            return b, x
        other = batch.beside[b, 0 if side < 0 else 1]
        if other < 0:
            return b, x
        b, came = other, side
        x = 1.0 if side < 0 else 0.0
        c = cubic(batch, b, q)
    return b, x


@beginning(StrandBatch)
def apart(batch, a, x, b, y):
    """Whether two places may touch: they are of two cables, or far from each other along one."""
    if batch.cable[a] != batch.cable[b]:
        return True
    way = batch.place[a] + x * batch.length[a] - batch.place[b] - y * batch.length[b]
    return abs(way) > APART * 2.0 * batch.radius[a]


@beginning(StrandBatch)
def clearance(batch, q, e, ca, x, b, reach):
    """Square of the distance at xi = x from the cable through b, less that of ``reach``, and the place there.

    Places that may not touch are far.
    """
    r = on_cubic(ca, x)
    o, y = nearest(batch, q, r, b)
    if not apart(batch, e, x, o, y):
        return reach * reach, o, y
    way = less(r, on_cubic(cubic(batch, o, q), y))
    return dot(way, way) - reach * reach, o, y


@beginning(StrandBatch)
def root(batch, q, e, ca, b, reach, middle, half, s, inside, f_in, outside, f_out):
    """Where the clearance vanishes between a place where it is negative and one where it is not.

    All in the cell's own coordinate from -1 to 1; s is a guess. False position with the Illinois rule stays
    between the two, also where cables are so curved that the parabola of the guess is wrong: a root that is
    missed would be a force that jumps, and a step without a solution.
    """
    came = 0
    for _ in range(SEARCH):
        f, _, _ = clearance(batch, q, e, ca, middle + half * s, b, reach)
        if abs(f) <= CLOSE * reach * reach:
            return s
        side = -1 if f < 0.0 else 1
        if side < 0:
            inside, f_in = s, f
            f_out *= 0.5 if came == side else 1.0
        else:
            outside, f_out = s, f
            f_in *= 0.5 if came == side else 1.0
        came = side
        s = inside + (outside - inside) * f_in / (f_in - f_out)
    return s


@inline_kernel
def bounds(low, mean, high):
    """Where a parabola through values at -1, 0 and 1 is negative: whether, from, to, and a place between."""
    linear, square = 0.5 * (high - low), 0.5 * (high + low) - mean
    if low <= 0.0 and high <= 0.0:
        return True, -1.0, 1.0, 0.0
    if low > 0.0 and high > 0.0:
        if square <= 0.0:
            return False, 0.0, 0.0, 0.0
        rest = linear * linear - 4.0 * square * mean
        if rest <= 0.0 or abs(linear) >= 2.0 * square:
            return False, 0.0, 0.0, 0.0
        least, wide = -0.5 * linear / square, 0.5 * math.sqrt(rest) / square
        return True, least - wide, least + wide, least
    rest = math.sqrt(max(linear * linear - 4.0 * square * mean, 0.0))
    # the root between the ends, in the form that does not cancel
    s = min(max(-2.0 * mean / (linear + (rest if linear > 0.0 else -rest)), -1.0), 1.0)
    if low <= 0.0:
        return True, -1.0, s, 0.0 if mean < 0.0 else -1.0
    return True, s, 1.0, 0.0 if mean < 0.0 else 1.0


@beginning(StrandBatch)
def may_reach(batch, q, r, half, b, reach):
    """Whether a piece of half that length about r may come within reach of element b."""
    i, j, k, m = batch.base[b, 0], batch.base[b, 1], batch.base[b, 2], batch.base[b, 3]
    h = 0.125 * batch.length[b]
    room = STRETCHED * (half + 4.0 * h) + reach
    away = 0.0
    for c in range(3):
        x = 0.5 * (q[i + c] + q[k + c]) + h * (q[j + c] - q[m + c]) - r[c]
        away += x * x
    return away < room * room


@beginning(StrandBatch)
def is_taken(batch, count, e, cell, b, met, reach):
    """Whether a place has been found for the cell already, from another element of its cable."""
    z = count - 1
    while z >= 0 and batch.zone[z, ELEMENT] == e and int(batch.zone[z, CELL]) == cell:
        same = batch.cable[int(batch.zone[z, START])] == batch.cable[b]
        if same and abs(batch.zone[z, MET] - met) < reach:
            return True
        z -= 1
    return False


@inline_kernel
def beyond(batch, b, y):
    """What of a cable a place is: none of its ends, its start, or its end, as a part of a cell's number."""
    if y == 0.0 and batch.beside[b, 0] < 0:
        return 0.25
    return 0.5 if y == 1.0 and batch.beside[b, 1] < 0 else 0.0


@beginning(StrandBatch)
def past_end(batch, q, ca, left, right, b, y):
    """Where an element passes the end of a cable, between two xi of which one is nearest to that end."""
    cb = cubic(batch, b, q)
    end, t = on_cubic(cb, y), along_cubic(cb, y)
    f0, f1 = dot(less(on_cubic(ca, left), end), t), dot(less(on_cubic(ca, right), end), t)
    came = 0
    for _ in range(SEARCH):
        if f0 == f1:
            break
        x = left + (right - left) * f0 / (f0 - f1)
        f = dot(less(on_cubic(ca, x), end), t)
        side = 1 if (f > 0.0) == (f1 > 0.0) else -1
        if side > 0:
            done, right, f1 = abs(right - x) < STILL, x, f
            f0 *= 0.5 if came == side else 1.0
        else:
            done, left, f0 = abs(left - x) < STILL, x, f
            f1 *= 0.5 if came == side else 1.0
        came = side
        if done or f == 0.0:
            return x
    return 0.5 * (left + right)


@beginning(StrandBatch)
def add_zone(batch, q, e, ca, cell, o, reach, met, ends, left, right, low, mean, high, count):
    """Add the zone of a piece of a cell with these clearances, if there is one; the number of all zones.

    ``ends``: what fixes those of the piece.
    """
    there, s0, s1, s = bounds(low, mean, high)
    if not there or count == batch.zone.shape[0]:
        return count
    middle, half, least = 0.5 * (left + right), 0.5 * (right - left), mean
    if s != 0.0:
        least, _, _ = clearance(batch, q, e, ca, middle + half * s, o, reach)
    if s0 > -1.0 and least < 0.0:
        s0 = root(batch, q, e, ca, o, reach, middle, half, s0, s, least, -1.0, low)
    if s1 < 1.0 and least < 0.0:
        s1 = root(batch, q, e, ca, o, reach, middle, half, s1, s, least, 1.0, high)
    if s1 <= s0 or (least >= 0.0 and s0 > -1.0 and s1 < 1.0):
        return count
    z = batch.zone[count]
    z[ELEMENT], z[CELL], z[START], z[REACH] = e, cell, o, reach
    z[FROM], z[TO] = middle + half * s0, middle + half * s1
    z[CONTACT], z[MET] = batch.law[batch.cable[e], batch.cable[o]], met
    z[AT_FROM] = TOUCHING if s0 > -1.0 else ends[0]
    z[AT_TO] = TOUCHING if s1 < 1.0 else ends[1]
    return count + 1


@separate_kernel
def find_zones_at(batch, q):
    """Fill ``zone`` with the pieces of cables that touch others; their number.

    Where a cell passes the end of a cable, the distance has a kink: it is cut there.
    """
    count, cells = 0, batch.cells[0]
    if batch.room[HELD] >= 0.0:
        return int(batch.room[HELD])
    if batch.first[batch.base.shape[0]] == 0:
        return 0
    for e in range(batch.base.shape[0]):
        if batch.first[e] == batch.first[e + 1]:
            continue
        ca, half = cubic(batch, e, q), 0.5 / cells
        for cell in range(cells):
            x = (2 * cell + 1) * half
            r = on_cubic(ca, x)
            for k in range(batch.first[e], batch.first[e + 1]):
                b = batch.near[k]
                reach = batch.radius[e] + batch.radius[b]
                if not may_reach(batch, q, r, half * batch.length[e], b, reach):
                    continue
                mean, o, y = clearance(batch, q, e, ca, x, b, reach)
                met = batch.place[o] + y * batch.length[o]
                if not apart(batch, e, x, o, y) or is_taken(batch, count, e, cell, o, met, reach):
                    continue
                left, right = x - half, x + half
                low, ol, yl = clearance(batch, q, e, ca, left, o, reach)
                high, oh, yh = clearance(batch, q, e, ca, right, o, reach)
                part, start, stop = beyond(batch, o, y), beyond(batch, ol, yl), beyond(batch, oh, yh)
                before, behind = BORDER, BORDER
                if start != part:
                    b_end, y_end = (ol, yl) if start > 0.0 else (o, y)
                    before = 2.0 * b_end + y_end
                    cut = past_end(batch, q, ca, left, x, b_end, y_end)
                    f, _, _ = clearance(batch, q, e, ca, cut, o, reach)
                    m, _, _ = clearance(batch, q, e, ca, 0.5 * (left + cut), o, reach)
                    own = cell + start, o, reach, met, (BORDER, before)
                    count = add_zone(batch, q, e, ca, *own, left, cut, low, m, f, count)
                    left, low = cut, f
                if stop != part:
                    b_end, y_end = (oh, yh) if stop > 0.0 else (o, y)
                    behind = 2.0 * b_end + y_end
                    cut = past_end(batch, q, ca, x, right, b_end, y_end)
                    f, _, _ = clearance(batch, q, e, ca, cut, o, reach)
                    m, _, _ = clearance(batch, q, e, ca, 0.5 * (cut + right), o, reach)
                    own = cell + stop, o, reach, met, (behind, BORDER)
                    count = add_zone(batch, q, e, ca, *own, cut, right, f, m, high, count)
                    right, high = cut, f
                if start != part or stop != part:
                    mean, _, _ = clearance(batch, q, e, ca, 0.5 * (left + right), o, reach)
                own = cell + part, o, reach, met, (before, behind)
                count = add_zone(batch, q, e, ca, *own, left, right, low, mean, high, count)
    return count


_find = caller(types.int64, (types.voidptr, VECTOR))


@formula
def find_zones(batch, q):
    """:func:`find_zones_at` by its address: one for all that look for zones, as it takes long to compile."""
    return _find(batch.search, (batch, q))
