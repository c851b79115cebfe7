"""Normal forces of surfaces on beams, per reference length, at points along elements.

With the depth g = radius of the beam - distance of its axis, and the normal n of the surface,

    N = max(0, k g + c on(g) dg/dt),   on = g over the first hundredths of the radius, then 1,

pushes, never pulls, and is continuous: it begins with g.  Its elastic part is stored energy, k g^2/2 per
length; what damping adds or takes is dissipated.  The surface receives the opposite force in the same
place, so that forces and moments are balanced.  The matrix has the stiffness along n, the turning of n by the
curvatures of the surface, and the damping; it leaves out how the surface turns under what it carries.
Along a cable with a winch lengths are those of the material, see :mod:`ancf.contact.reel`; the force on its
length L has the elastic part as the derivative of the energy, which is what the sum over the points has.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import types
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import VECTOR, Role, implements, inline_kernel, kernel
from ..records import Located, beginning
from ..vectors import dot
from .press_along import kinds_of, press_changes, press_slopes_along, press_slopes_beside
from .press_slopes import numbers_of, press_number_work, press_work_slopes
from .reel import stretched, swept
from .touch import (
    DAMPING,
    NARROW,
    RADIUS,
    ROOM,
    STIFFNESS,
    ZERO,
    add_pair_block,
    add_sums,
    carrier,
    first_node,
    in_body,
    is_far,
    lie,
    look_around,
    nodes_of,
    nothing,
    outside,
    place_on,
    pressure,
    relative,
    row_of,
    turning,
    with_force,
)
from .touching import Touching

#: Entries of ``near``: how many rows, whether the others are watched, then the rows.
COUNT, WATCHED, FIRST = range(3)
#: Columns of ``found``: force of all points, N, and the largest depth, m.
FORCE, DEPTH = range(2)
#: Gap in radii up to which a surface holds a point while the loads of an equilibrium come on.
BONDED = 0.01
#: Radii of a surface from which an element counts as long against it, most places looked at along it, and
#: the part of its length that is between a place on it and the next of its points.
LONG, MOST_PLACES, BETWEEN = 2.0, 40.0, 0.3
#: Share of the depth at which a surface has no sides that a beam may reach.
PASSED = 0.5


class PressBatch(NamedTuple):
    """All elements that may touch surfaces."""

    base: NDArray[np.int64]  # up to ``bond`` as in Touching
    dest: NDArray[np.int64]
    shape: FloatArray
    reach: FloatArray
    weight: FloatArray
    winch: NDArray[np.int64]
    unwound: FloatArray
    mesh: FloatArray
    contact: NDArray[np.int64]
    surface: NDArray[np.int64]
    data: FloatArray
    surfaces: FloatArray
    shape_of: NDArray[np.int64]
    found: FloatArray  # (contacts, 4) columns FORCE, DEPTH when it was measured last
    tree: FloatArray
    faces: FloatArray
    hint: NDArray[np.int64]
    far: FloatArray
    bond: NDArray[np.int64]
    near: NDArray[np.int64]  # (n + 2,) how many rows are not far, whether all are watched, and which they are
    lit: NDArray[np.int64]  # (n,) 1 if it is one of them


@beginning(Touching)
def pressed(batch, e, p, row):
    """Place of point p in body axes, normal force and its derivatives, normal and how it turns."""
    nodes, rates, body, moving, at, axis = row
    r = place_on(batch, e, p, nodes)
    d, n, a, bend, about = outside(batch, e, p, body, at, axis, r)
    data = batch.data[batch.contact[e]]
    g = data[RADIUS] - d
    if g <= 0.0 and batch.bond[e, p] == 0:
        return g, ZERO, 0.0, 0.0, 0.0, n, a, bend, about
    x = in_body(body, r)
    if g <= 0.0:
        return g, x, data[STIFFNESS] * g, data[STIFFNESS], 0.0, n, a, bend, about
    u = relative(place_on(batch, e, p, rates), moving, x)
    N, by_g, by_rate = pressure(data, g, -dot(u, n))
    return g, x, N, by_g, by_rate, n, a, bend, about


@inline_kernel
def press_force(batch, q, v, a, r, ws):
    """Subtract the normal forces from r."""
    for i in range(batch.near[COUNT]):
        e = batch.near[FIRST + i]
        if is_far(batch, e, q):
            continue
        row, sums, more = row_of(batch, e, q, v), nothing(), 0.0
        for p in range(batch.weight.shape[1]):
            g, x, N, _, _, n, _, _, _ = pressed(batch, e, p, row)
            if N != 0.0:
                sums = with_force(batch, e, p, x, (N * n[0], N * n[1], N * n[2]), sums)
            if batch.winch[e] >= 0:
                more += stored_less_work(batch, e, p, row[0], g, n)
        add_sums(batch, e, sums, row[0], more, q, r)


@beginning(Touching)
def stored_less_work(batch, e, p, nodes, g, n):
    """Energy of a depth in a piece of the mesh less the work that its elastic force does along D r, N m/m."""
    if g <= 0.0 and batch.bond[e, p] == 0:
        return 0.0
    work = dot(n, place_on(batch, e, p, swept(batch, e, nodes)))
    return batch.weight[e, p] * batch.data[batch.contact[e], STIFFNESS] * g * (0.5 * g - work)


@inline_kernel
def press_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add minus the derivatives by position and velocity."""
    for i in range(batch.near[COUNT]):
        e = batch.near[FIRST + i]
        if is_far(batch, e, q):
            continue
        row, lam = row_of(batch, e, q, v), stretched(batch, e, q)
        for p in range(batch.weight.shape[1]):
            _, x, N, by_g, by_rate, n, along, bend, about = pressed(batch, e, p, row)
            if N == 0.0:
                continue
            k = c_stiffness * by_g + c_damping * by_rate
            t = turning(-c_stiffness * N, n, along, bend, about)
            rows = (
                (t[0][0] + k * n[0] * n[0], t[0][1] + k * n[0] * n[1], t[0][2] + k * n[0] * n[2]),
                (t[1][0] + k * n[1] * n[0], t[1][1] + k * n[1] * n[1], t[1][2] + k * n[1] * n[2]),
                (t[2][0] + k * n[2] * n[0], t[2][1] + k * n[2] * n[1], t[2][2] + k * n[2] * n[2]),
            )
            add_pair_block(batch, e, p, x, lam, rows, A)


@inline_kernel
def press_energy(batch, q, ws):
    """Energy of the depths, J."""
    energy = 0.0
    for e in range(batch.base.shape[0]):
        if is_far(batch, e, q):
            continue
        body, nodes, data = carrier(batch, e, q), nodes_of(batch, e, q), batch.data[batch.contact[e]]
        (at, axis), lam = lie(batch, e, body), stretched(batch, e, q)
        for p in range(batch.weight.shape[1]):
            d, _, _, _, _ = outside(batch, e, p, body, at, axis, place_on(batch, e, p, nodes))
            g = max(data[RADIUS] - d, 0.0)
            energy += 0.5 * lam * batch.weight[e, p] * data[STIFFNESS] * g * g
    return energy


@inline_kernel
def press_measure(batch, q, v):
    """Fill ``found`` for the state (q, v)."""
    for j in range(batch.found.shape[0]):
        batch.found[j, FORCE], batch.found[j, DEPTH] = 0.0, -np.inf
    for e in range(batch.base.shape[0]):
        row, j, lam = row_of(batch, e, q, v), batch.contact[e], stretched(batch, e, q)
        for p in range(batch.weight.shape[1]):
            g, _, N, _, _, _, _, _, _ = pressed(batch, e, p, row)
            batch.found[j, FORCE] += lam * batch.weight[e, p] * N
            batch.found[j, DEPTH] = max(batch.found[j, DEPTH], g)


@inline_kernel
def press_remember(batch, q, v):
    """See which elements are far; the others are looked at until the next time.

    Those that leave their balls meanwhile are found by ``press_passed``, which has to watch for that: where
    nothing does, as in a method that does not ask, all are looked at.
    """
    watched, count = batch.near[WATCHED], 0
    for e in range(batch.base.shape[0]):
        far = look_around(batch, e, q) and watched == 1
        batch.lit[e] = 0 if far else 1
        if not far:
            batch.near[FIRST + count] = e
            count += 1
    batch.near[COUNT], batch.near[WATCHED] = count, 0


@inline_kernel
def deepest_between(batch, e, nodes, body, at, axis, narrow, least):
    """Least distance from a surface that is thinner than an element is long, at places all along it.

    Such a surface finds its way between the points of the element; infinite of others, and where the
    distance of all points shows that none can be inside.
    """
    middle = batch.weight.shape[1] // 2
    h = 8.0 * batch.shape[e, middle, 1]
    if h < LONG * narrow or least > BETWEEN * h:
        return math.inf
    a, b, c, d = nodes
    count = int(min(3.0 * h / narrow, MOST_PLACES))
    found = math.inf
    for k in range(count + 1):
        x = k / count
        s, u = (1.0 - x) * (1.0 - x), x * x
        f, g, i, j = s * (1.0 + 2.0 * x), h * x * s, u * (3.0 - 2.0 * x), h * u * (x - 1.0)
        r = (
            f * a[0] + g * b[0] + i * c[0] + j * d[0],
            f * a[1] + g * b[1] + i * c[1] + j * d[1],
            f * a[2] + g * b[2] + i * c[2] + j * d[2],
        )
        found = min(found, outside(batch, e, middle, body, at, axis, r)[0])
    return found


@inline_kernel
def press_passed(batch, q, ws):
    """Slot of the first node of an element that may have gone through a surface since the last step, else -1.

    It is deeper than half of where a surface has no sides, or has come as far near it in one step.  One that
    was far and is no more counts as well: the step was taken without it, the next attempt is with it.
    """
    found = -1
    for e in range(batch.base.shape[0]):
        if batch.lit[e] == 0 and not is_far(batch, e, q):
            batch.lit[e], batch.near[FIRST + batch.near[COUNT]] = 1, e
            batch.near[COUNT] += 1
            found = batch.base[e, 0]
    batch.near[WATCHED] = 1
    if found >= 0:
        return found
    for i in range(batch.near[COUNT]):
        e = batch.near[FIRST + i]
        if is_far(batch, e, q):
            continue
        narrow, r, far = batch.data[batch.contact[e], NARROW], first_node(batch, e, q), batch.far[e]
        way = math.sqrt((r[0] - far[0]) ** 2 + (r[1] - far[1]) ** 2 + (r[2] - far[2]) ** 2)
        if way > narrow and far[ROOM] > -math.inf:
            return batch.base[e, 0]
        body, nodes = carrier(batch, e, q), nodes_of(batch, e, q)
        at, axis = lie(batch, e, body)
        least = math.inf
        for p in range(batch.weight.shape[1]):
            d, _, _, _, _ = outside(batch, e, p, body, at, axis, place_on(batch, e, p, nodes))
            least = min(least, d)
        if min(least, deepest_between(batch, e, nodes, body, at, axis, narrow, least)) < -PASSED * narrow:
            return batch.base[e, 0]
    return -1


@kernel
def press_lost(batch, q, holds):
    """Forget in the initial shape of an equilibrium where elements were: its steps are long.

    Points that just touch have no stiffness against the surface until something presses them.  If it holds,
    the surface pulls them as well, until :func:`press_free`.
    """
    for e in range(batch.base.shape[0]):
        batch.far[e, ROOM] = -math.inf
        batch.near[FIRST + e], batch.lit[e] = e, 1
        body, nodes = carrier(batch, e, q), nodes_of(batch, e, q)
        at, axis = lie(batch, e, body)
        room = BONDED * batch.data[batch.contact[e], RADIUS]
        for p in range(batch.weight.shape[1]):
            d, _, _, _, _ = outside(batch, e, p, body, at, axis, place_on(batch, e, p, nodes))
            batch.bond[e, p] = 1 if holds and d - batch.data[batch.contact[e], RADIUS] < room else 0
    batch.near[COUNT], batch.near[WATCHED] = batch.base.shape[0], 0


def look_everywhere(batch, q, holds):
    """See :func:`press_lost`; there is no friction."""
    press_lost(Located(batch), q, holds)
    return False


@kernel
def press_free(batch, q, every):
    """Let go the points that a surface pulls in the state q, or every point; how many it pulled."""
    count = 0
    for e in range(batch.base.shape[0]):
        body, nodes = carrier(batch, e, q), nodes_of(batch, e, q)
        at, axis = lie(batch, e, body)
        for p in range(batch.weight.shape[1]):
            if batch.bond[e, p] == 0:
                continue
            d, _, _, _, _ = outside(batch, e, p, body, at, axis, place_on(batch, e, p, nodes))
            pulled = d > batch.data[batch.contact[e], RADIUS]
            count += 1 if pulled else 0
            batch.bond[e, p] = 0 if pulled or every else 1
    return count


def let_go(batch, q, every):
    """See :func:`press_free`."""
    return press_free(Located(batch), q, every)


implements(
    PressBatch,
    force=press_force,
    tangent=press_tangent,
    energy=press_energy,
    work_slopes=press_work_slopes,
    force_slopes=press_slopes_along,
    slopes_beside=press_slopes_beside,
    sloped=lambda batch: not np.any(batch.winch >= 0),
    number_work=press_number_work,
    changes=press_changes,
    kinds=kinds_of,
    numbers=numbers_of,
    numbered=("data", "weight", "shape", "reach", "mesh", "unwound", "far"),
    measure=press_measure,
    remember=press_remember,
    inverted=press_passed,
    early=look_everywhere,
    free=let_go,
    resting=((press_lost, (VECTOR, types.boolean)), (press_free, (VECTOR, types.boolean))),
    role=Role.DISSIPATES | Role.MEASURES,
    slots=("base", "winch"),
    memory=("far",),
    damped=lambda batch: bool(np.any(batch.data[:, DAMPING])),
)
