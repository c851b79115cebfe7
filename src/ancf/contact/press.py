"""Normal forces of surfaces on beams, per reference length, at points along elements.

With the depth g = radius of the beam - distance of its axis, and the normal n of the surface,

    N = max(0, k g + c on(g) dg/dt),   on = g over the first hundredths of the radius, then 1,

pushes, never pulls, and is continuous: it begins with g.  Its elastic part is stored energy, k g^2/2 per
length; what damping adds or takes is dissipated.  The surface receives the opposite force in the same
place, so that forces and moments are balanced.  The matrix has the stiffness along n, the turning of n by the
curvatures of the surface, and the damping; it leaves out how the surface turns under what it carries.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import Role, implements, inline_kernel, kernel
from ..vectors import dot
from .touch import (
    DAMPING,
    NARROW,
    RADIUS,
    ROOM,
    STIFFNESS,
    add_pair,
    add_pair_block,
    carrier,
    first_node,
    in_body,
    is_far,
    lie,
    look_around,
    outside,
    place_on,
    pressure,
    relative,
    turning,
)

#: Columns of ``found``: force of all points, N, and the largest depth, m.
FORCE, DEPTH = range(2)
#: Share of the depth at which a surface has no sides that a beam may reach.
PASSED = 0.5


class PressBatch(NamedTuple):
    """All elements that may touch surfaces."""

    base: NDArray[np.int64]  # (n, k + 4) slots of the element and of the body of the surface
    dest: NDArray[np.int64]  # (n, (k + 4)^2)
    shape: FloatArray  # (n, points, k)
    reach: FloatArray  # (n, k) largest factors, negative of positions
    weight: FloatArray  # (n, points) m
    contact: NDArray[np.int64]  # (n,) which contact
    surface: NDArray[np.int64]  # (n,) which surface
    data: FloatArray  # (contacts, 6) columns RADIUS ... DRAG
    surfaces: FloatArray  # (surfaces, 10) columns PLACE ... NUMBERS
    shape_of: NDArray[np.int64]  # (surfaces,) number of the profile
    found: FloatArray  # (contacts, 4) columns FORCE, DEPTH when it was measured last
    far: (
        FloatArray  # (n, 4) memory: where the first node was, and how far it may go until something may touch
    )


@inline_kernel
def pressed(batch, e, p, q, v, body, moving, at, axis):
    """Place of point p in body axes, normal force and its derivatives, normal and what it turns with."""
    r = place_on(batch, e, p, q)
    d, n, away, bend, about = outside(batch, e, r, at, axis)
    data = batch.data[batch.contact[e]]
    g = data[RADIUS] - d
    if g <= 0.0:
        return g, (0.0, 0.0, 0.0), 0.0, 0.0, 0.0, n, away, bend, about
    x = in_body(body, r)
    u = relative(place_on(batch, e, p, v), moving, x)
    N, by_g, by_rate = pressure(data, g, -dot(u, n))
    return g, x, N, by_g, by_rate, n, away, bend, about


@inline_kernel
def press_force(batch, q, v, a, r, ws):
    """Subtract the normal forces from r."""
    for e in range(batch.base.shape[0]):
        if is_far(batch, e, q):
            continue
        body, moving = carrier(batch, e, q), still_or(batch, e, v)
        at, axis = lie(batch, e, body)
        for p in range(batch.weight.shape[1]):
            _, x, N, _, _, n, _, _, _ = pressed(batch, e, p, q, v, body, moving, at, axis)
            if N > 0.0:
                add_pair(batch, e, p, x, N * n[0], N * n[1], N * n[2], r)


@inline_kernel
def still_or(batch, e, v):
    """Rates of the place and the directions of what carries a surface; zero on the ground."""
    if batch.base[e, batch.base.shape[1] - 4] < 0:
        zero = (0.0, 0.0, 0.0)
        return zero, zero, zero, zero
    return carrier(batch, e, v)


@inline_kernel
def press_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add minus the derivatives by position and velocity."""
    for e in range(batch.base.shape[0]):
        if is_far(batch, e, q):
            continue
        body, moving = carrier(batch, e, q), still_or(batch, e, v)
        at, axis = lie(batch, e, body)
        for p in range(batch.weight.shape[1]):
            _, x, N, by_g, by_rate, n, away, bend, about = pressed(batch, e, p, q, v, body, moving, at, axis)
            if N == 0.0:
                continue
            k = c_stiffness * by_g + c_damping * by_rate
            t = turning(-c_stiffness * N, n, away, axis, bend, about)
            rows = (
                (t[0][0] + k * n[0] * n[0], t[0][1] + k * n[0] * n[1], t[0][2] + k * n[0] * n[2]),
                (t[1][0] + k * n[1] * n[0], t[1][1] + k * n[1] * n[1], t[1][2] + k * n[1] * n[2]),
                (t[2][0] + k * n[2] * n[0], t[2][1] + k * n[2] * n[1], t[2][2] + k * n[2] * n[2]),
            )
            add_pair_block(batch, e, p, x, rows, A)


@inline_kernel
def press_energy(batch, q, ws):
    """Energy of the depths, J."""
    energy = 0.0
    for e in range(batch.base.shape[0]):
        if is_far(batch, e, q):
            continue
        at, axis = lie(batch, e, carrier(batch, e, q))
        data = batch.data[batch.contact[e]]
        for p in range(batch.weight.shape[1]):
            d, _, _, _, _ = outside(batch, e, place_on(batch, e, p, q), at, axis)
            g = max(data[RADIUS] - d, 0.0)
            energy += 0.5 * batch.weight[e, p] * data[STIFFNESS] * g * g
    return energy


@inline_kernel
def press_measure(batch, q, v):
    """Fill ``found`` for the state (q, v)."""
    for j in range(batch.found.shape[0]):
        batch.found[j, FORCE], batch.found[j, DEPTH] = 0.0, -np.inf
    for e in range(batch.base.shape[0]):
        body, moving, j = carrier(batch, e, q), still_or(batch, e, v), batch.contact[e]
        at, axis = lie(batch, e, body)
        for p in range(batch.weight.shape[1]):
            g, _, N, _, _, _, _, _, _ = pressed(batch, e, p, q, v, body, moving, at, axis)
            batch.found[j, FORCE] += batch.weight[e, p] * N
            batch.found[j, DEPTH] = max(batch.found[j, DEPTH], g)


@inline_kernel
def press_remember(batch, q, v):
    """See which elements are far."""
    for e in range(batch.base.shape[0]):
        look_around(batch, e, q)


@inline_kernel
def press_passed(batch, q, ws):
    """Slot of the first node of an element that may have gone through a surface since the last step, else -1.

    It is deeper than half of where a surface has no sides, or has come as far near it in one step.
    """
    for e in range(batch.base.shape[0]):
        if is_far(batch, e, q):
            continue
        narrow, r, far = batch.data[batch.contact[e], NARROW], first_node(batch, e, q), batch.far[e]
        way = math.sqrt((r[0] - far[0]) ** 2 + (r[1] - far[1]) ** 2 + (r[2] - far[2]) ** 2)
        if way > narrow and far[ROOM] > -math.inf:
            return batch.base[e, 0]
        at, axis = lie(batch, e, carrier(batch, e, q))
        for p in range(batch.weight.shape[1]):
            d, _, _, _, _ = outside(batch, e, place_on(batch, e, p, q), at, axis)
            if d < -PASSED * narrow:
                return batch.base[e, 0]
    return -1


@kernel
def press_lost(batch, q, holds):
    """Forget in the initial shape of an equilibrium where elements were: its steps are long."""
    for e in range(batch.base.shape[0]):
        batch.far[e, ROOM] = -math.inf


def look_everywhere(batch, q, holds):
    """See :func:`press_lost`; there is nothing that it could hold."""
    press_lost(batch, q, holds)
    return False


implements(
    PressBatch,
    force=press_force,
    tangent=press_tangent,
    energy=press_energy,
    measure=press_measure,
    remember=press_remember,
    inverted=press_passed,
    early=look_everywhere,
    role=Role.DISSIPATES | Role.MEASURES,
    memory=("far",),
    damped=lambda batch: bool(np.any(batch.data[:, DAMPING])),
)
