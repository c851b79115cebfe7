"""Normal forces of cables on cables, per reference length.

At points of a zone of one cable, at the distance d from the nearest place of the other and with the normal n
from there,

    N = pressure(g, dg/dt) / 2,   g = R_a + R_b - d,

acts on the point along n, and the opposite force on that place: both in one line, so that momentum and
angular momentum are kept.  Each of the two cables has zones, with one half of the force: it does not matter
which was named first.  Cables that cross press on each other by 4/3 k sqrt(2 (R_a + R_b)) g^(3/2)/sin(alpha),
as the patch of contact grows; those that lie side by side by k g per length, and all between without a seam.
The elastic part is stored energy; what damping takes is dissipated.
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import inline_kernel, kernel
from ..records import Located, beginning
from ..vectors import dot
from .near import LIVE, anything, keep, look, look_ahead, look_back, look_if_live
from .strand import (
    CONTACT,
    ELEMENT,
    FROM,
    GAUSS_W,
    GAUSS_X,
    POINTS,
    REACH,
    START,
    STIFFNESS,
    TO,
    StrandBatch,
    apart,
    clearance,
    cubic,
    find_zones,
    less,
    may_reach,
    nearest,
    on_cubic,
)
from .touch import pressure

#: Columns of ``found``: force of all points, N, and the largest depth, m.
FORCE, DEPTH = range(2)
#: Parts of the sum of the radii: down to which two axes may come, and which they may move past each other.
PASSED, FAR = 0.5, 0.5


@inline_kernel
def factors(x, h):
    """Factors of r, r_x, r, r_x of an element in the place at xi = x."""
    y = 1.0 - x
    return y * y * (1.0 + 2.0 * x), h * x * y * y, x * x * (1.0 + 2.0 * y), -h * x * x * y


@beginning(StrandBatch)
def from_slots(batch, e, s, q):
    """Sum of the vectors of an element with these factors."""
    x, y, z = 0.0, 0.0, 0.0
    for k in range(4):
        i = batch.base[e, k]
        x += s[k] * q[i]
        y += s[k] * q[i + 1]
        z += s[k] * q[i + 2]
    return x, y, z


@beginning(StrandBatch)
def add_force_on(batch, e, s, f, r):
    """Subtract a force on the place with these factors from the residual r."""
    for k in range(4):
        i = batch.base[e, k]
        r[i] -= s[k] * f[0]
        r[i + 1] -= s[k] * f[1]
        r[i + 2] -= s[k] * f[2]


@beginning(StrandBatch)
def met(batch, z, p, q):
    """Point p of zone z: its xi, half of its length of cable, element and xi that it meets, depth, normal."""
    zone = batch.zone[z]
    e, wide = int(zone[ELEMENT]), zone[TO] - zone[FROM]
    x = zone[FROM] + GAUSS_X[p] * wide
    r = on_cubic(cubic(batch, e, q), x)
    b, y = nearest(batch, q, r, int(zone[START]))
    way = less(r, on_cubic(cubic(batch, b, q), y))
    d = math.sqrt(dot(way, way))
    s = 1.0 / d if d > 0.0 else 0.0
    n = way[0] * s, way[1] * s, way[2] * s
    if not apart(batch, e, x, b, y):
        d = 2.0 * zone[REACH]
    return x, 0.5 * GAUSS_W[p] * wide * batch.length[e], b, y, zone[REACH] - d, n


@beginning(StrandBatch)
def pressed_at(batch, z, p, q, v):
    """The same, with factors of both places, the force on the point and its derivatives by depth and rate."""
    e = int(batch.zone[z, ELEMENT])
    x, weight, b, y, g, n = met(batch, z, p, q)
    sa, sb = factors(x, batch.length[e]), factors(y, batch.length[b])
    u, w = from_slots(batch, e, sa, v), from_slots(batch, b, sb, v)
    N, by_g, by_rate = pressure(batch.data[int(batch.zone[z, CONTACT])], g, -dot(less(u, w), n))
    return e, b, sa, sb, g, n, weight * N, weight * by_g, weight * by_rate


@beginning(StrandBatch)
def cross_force(batch, q, v, a, r, ws):
    """Subtract the normal forces from r."""
    look_if_live(batch, q)
    for z in range(find_zones(batch, q)):
        for p in range(POINTS):
            e, b, sa, sb, _, n, N, _, _ = pressed_at(batch, z, p, q, v)
            if N > 0.0:
                add_force_on(batch, e, sa, (N * n[0], N * n[1], N * n[2]), r)
                add_force_on(batch, b, sb, (-N * n[0], -N * n[1], -N * n[2]), r)


@beginning(StrandBatch)
def not_in_matrix(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """What cables do to each other stays out of the matrix, see :mod:`ancf.solvers.step.entwined`."""


@beginning(StrandBatch)
def cross_energy(batch, q, ws):
    """Energy of the depths, J."""
    look_if_live(batch, q)
    energy = 0.0
    for z in range(find_zones(batch, q)):
        k = batch.data[int(batch.zone[z, CONTACT]), STIFFNESS]
        for p in range(POINTS):
            _, weight, _, _, g, _ = met(batch, z, p, q)
            energy += 0.5 * weight * k * max(g, 0.0) ** 2
    return energy


@beginning(StrandBatch)
def cross_measure(batch, q, v):
    """Fill ``found`` for the state (q, v)."""
    look(batch, q)
    for j in range(batch.found.shape[0]):
        batch.found[j, FORCE], batch.found[j, DEPTH] = 0.0, -np.inf
    for z in range(find_zones(batch, q)):
        j = int(batch.zone[z, CONTACT])
        for p in range(POINTS):
            _, _, _, _, _, _, N, _, _ = pressed_at(batch, z, p, q, v)
            batch.found[j, FORCE] += N
    for e in range(batch.base.shape[0]):
        if batch.first[e] < batch.first[e + 1]:
            measure_gap(batch, e, q)


@beginning(StrandBatch)
def measure_gap(batch, e, q):
    """Largest depths of element e in cables that are near."""
    ca, half = cubic(batch, e, q), 0.5 / batch.cells[0]
    for cell in range(batch.cells[0]):
        middle = (2 * cell + 1) * half
        for k in range(batch.first[e], batch.first[e + 1]):
            b = batch.near[k]
            reach = batch.radius[e] + batch.radius[b]
            mean, o, y = clearance(batch, q, e, ca, middle, b, reach)
            if apart(batch, e, middle, o, y):
                low, _, _ = clearance(batch, q, e, ca, middle - half, o, reach)
                high, _, _ = clearance(batch, q, e, ca, middle + half, o, reach)
                linear, square = 0.5 * (high - low), 0.5 * (high + low) - mean
                least = min(low, mean, high)
                if 2.0 * square > abs(linear):
                    at = middle - half * linear / (2.0 * square)
                    least = min(least, clearance(batch, q, e, ca, at, o, reach)[0])
                depth = reach - math.sqrt(max(least + reach * reach, 0.0))
                j = batch.law[batch.cable[e], batch.cable[b]]
                batch.found[j, DEPTH] = max(batch.found[j, DEPTH], depth)


@beginning(StrandBatch)
def cross_remember(batch, q, v):
    """Keep where everything is: from there the next step is judged."""
    look_ahead(batch, q)
    if anything(batch):
        keep(batch, q, batch.last)


@beginning(StrandBatch)
def cross_passed(batch, q, ws):
    """Slot of the first node of an element that may have gone through a cable since the last step, else -1.

    It is deeper than half of the sum of the radii, or the two have moved past each other by as much, so
    near that they may have met.
    """
    if look_back(batch, q):
        return batch.base[0, 0]
    for z in range(find_zones(batch, q)):
        for p in range(POINTS):
            _, _, _, _, g, _ = met(batch, z, p, q)
            if g > PASSED * batch.zone[z, REACH]:
                return batch.base[int(batch.zone[z, ELEMENT]), 0]
    for e in range(batch.base.shape[0]):
        for k in range(batch.first[e], batch.first[e + 1]):
            b = batch.near[k]
            reach = batch.radius[e] + batch.radius[b]
            way = moved_past(batch, e, b, q)
            if way > FAR * reach and came_near(batch, e, b, q, way + reach):
                return batch.base[e, 0]
    return -1


@beginning(StrandBatch)
def moved_past(batch, e, b, q):
    """Bound of how far two elements have moved against each other since the last step."""
    if not batch.last[e, 0] < np.inf:
        return 0.0
    most = 0.0
    for k in range(0, 4, 2):
        for m in range(0, 4, 2):
            square = 0.0
            for c in range(3):
                x = q[batch.base[e, k] + c] - batch.last[e, 3 * k + c]
                y = q[batch.base[b, m] + c] - batch.last[b, 3 * m + c]
                square += (x - y) ** 2
            most = max(most, square)
    return math.sqrt(most)


@beginning(StrandBatch)
def came_near(batch, e, b, q, reach):
    """Whether some cell of element e is within reach of element b."""
    ca, half = cubic(batch, e, q), 0.5 / batch.cells[0]
    for cell in range(batch.cells[0]):
        x = (2 * cell + 1) * half
        if may_reach(batch, q, on_cubic(ca, x), half * batch.length[e], b, reach):
            far, o, y = clearance(batch, q, e, ca, x, b, reach + half * batch.length[e])
            if far < 0.0 and apart(batch, e, x, o, y):
                return True
    return False


@kernel
def cross_lost(batch):
    """Forget where things were: the steps of an equilibrium are long."""
    batch.last[:, :], batch.room[LIVE] = np.inf, 1.0


def look_everywhere(batch, q, holds):
    """See :func:`cross_lost`; there is nothing that it could hold."""
    cross_lost(Located(batch))
    return False
