"""Normal forces of rigid bodies on rigid bodies: spheres and capsules, and what they meet.

A row is one place where two bodies may touch: the segments of two capsules with radii (a sphere is one
without length), or an end of a segment and a surface of revolution.  With the depth g and the normal n
towards the first body, N = pressure(g, dg/dt) acts along n on both bodies in one place in the middle of the
depth, so that momentum and angular momentum are kept.  Two capsules touch where they are nearest, and where
they lie side by side with both ends of what they share; weights that go with the angle lead from one to the
other.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import Role, formula, implements, inline_kernel, kernel
from ..vectors import dot
from .profiles import profile_of
from .strand import less
from .touch import (
    DAMPING,
    EX,
    EY,
    EZ,
    STIFFNESS,
    at_slot,
    carried,
    cylindrical,
    in_body,
    pressure,
)

#: Kinds of rows: nearest places of two segments, an end of the first and a surface of revolution.
SEGMENTS, PROFILE = range(2)
#: Columns of ``ends``: both ends of the first segment and of the second, body axes, and both radii.
FIRST, SECOND, RADII = 0, 6, 12
#: Parts of a row in its pair: all of it, what crosses, what lies side by side.
WHOLE, CROSSING, BESIDE = range(3)
#: Columns of ``found``: force, N, and largest depth, m.
FORCE, DEPTH = range(2)
#: Part of the radii down to which the middle of a body may come to another one.
PASSED = 0.5


class BumpBatch(NamedTuple):
    """All places where rigid bodies may touch."""

    base: NDArray[np.int64]  # (n, 8) slots of both bodies, -1 for the ground
    dest: NDArray[np.int64]  # (n, 64)
    kind: NDArray[np.int64]  # (n,)
    part: NDArray[np.int64]  # (n,)
    ends: FloatArray  # (n, 14) columns FIRST ... RADII
    lines: FloatArray  # (n, 6) directions of both capsules of the pair in body axes
    contact: NDArray[np.int64]  # (n,) which contact
    surface: FloatArray  # (n, 10) of a surface: its place, its axis in body axes, its numbers
    shape_of: NDArray[np.int64]  # (n,) number of its profile
    data: FloatArray  # (contacts, 6) as of surfaces: RADIUS ... DRAG
    found: FloatArray  # (contacts, 4) what was measured last
    last: FloatArray  # (n, 3) memory: the way between the two after the last step
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
def weight_of(batch, e, one, two):
    """Weight of a row."""
    if batch.part[e] == WHOLE:
        return 1.0
    x, y = batch.lines[e, 0:3], batch.lines[e, 3:6]
    a, b = less(carried(one, x[0], x[1], x[2]), one[0]), less(carried(two, y[0], y[1], y[2]), two[0])
    crossed = min(1.0, max(0.0, 2.0 * (1.0 - dot(a, b) ** 2)))
    phi = crossed * crossed * (3.0 - 2.0 * crossed)
    return phi if batch.part[e] == CROSSING else 0.5 * (1.0 - phi)


@formula
def meet(batch, e, one, two):
    """Depth, normal, place of contact and the way between the middles of what touches."""
    a, b = batch.ends[e, RADII], batch.ends[e, RADII + 1]
    p = end_of(batch, e, one, FIRST)
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
        h, rho, away = cylindrical(p, at, axis)
        d, n_rho, n_z, _ = profile_of(batch.shape_of[e], x[6:], rho, h)
        n = n_rho * away[0] + n_z * axis[0], n_rho * away[1] + n_z * axis[1], n_rho * away[2] + n_z * axis[2]
        way, g = (d * n[0], d * n[1], d * n[2]), a - d
    k = a - 0.5 * g
    return g, n, (p[0] - k * n[0], p[1] - k * n[1], p[2] - k * n[2]), way


@inline_kernel
def apart_at(one, two, moving, other, c):
    """Velocity of the first body past the second one in a place, and the place in the axes of both."""
    x, y = in_body(one, c), in_body(two, c)
    u = less(carried(moving, x[0], x[1], x[2]), carried(other, y[0], y[1], y[2]))
    return u, x, y


@formula
def bumped(batch, e, q, v):
    """Place of contact in the axes of both bodies, normal, force, derivatives by depth and rate, depth."""
    one, two = both(batch, e, q)
    g, n, c, _ = meet(batch, e, one, two)
    zero = 0.0, 0.0, 0.0
    if g <= 0.0:
        return zero, zero, n, 0.0, 0.0, 0.0, g
    moving, other = both_rates(batch, e, v)
    u, x, y = apart_at(one, two, moving, other, c)
    w = weight_of(batch, e, one, two)
    N, by_g, by_rate = pressure(batch.data[batch.contact[e]], g, -dot(u, n))
    return x, y, n, w * N, w * by_g, w * by_rate, g


@inline_kernel
def factor_in(k, x, y):
    """Factor of slot k of a row in the way of the first body past the second, at x and y in their axes."""
    if k < 4:
        return 1.0 if k == 0 else x[k - 1]
    return -1.0 if k == 4 else -y[k - 5]


@formula
def add_bump(batch, e, x, y, f, r):
    """Subtract a force on the first body, and the opposite one on the second, from the residual r."""
    for k in range(8):
        i = batch.base[e, k]
        if i >= 0:
            s = factor_in(k, x, y)
            r[i] -= s * f[0]
            r[i + 1] -= s * f[1]
            r[i + 2] -= s * f[2]


@formula
def add_bump_block(batch, e, x, y, n, along, across, A):
    """Add a stiffness along n and another one across it to A."""
    for k in range(8):
        for m in range(8):
            place = batch.dest[e, 8 * k + m]
            if place < 0:
                continue
            w = factor_in(k, x, y) * factor_in(m, x, y)
            for i in range(3):
                for j in range(3):
                    A[place + 6 * i + j] += w * ((along - across) * n[i] * n[j] + (across if i == j else 0.0))


@inline_kernel
def bump_force(batch, q, v, a, r, ws):
    """Subtract the normal forces from r."""
    for e in range(batch.base.shape[0]):
        x, y, n, N, _, _, _ = bumped(batch, e, q, v)
        if N > 0.0:
            add_bump(batch, e, x, y, (N * n[0], N * n[1], N * n[2]), r)


@inline_kernel
def bump_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add minus the derivatives along the normal, which is taken as it is."""
    for e in range(batch.base.shape[0]):
        x, y, n, N, by_g, by_rate, _ = bumped(batch, e, q, v)
        if N > 0.0:
            add_bump_block(batch, e, x, y, n, c_stiffness * by_g + c_damping * by_rate, 0.0, A)


@inline_kernel
def bump_energy(batch, q, ws):
    """Energy of the depths, J."""
    energy = 0.0
    for e in range(batch.base.shape[0]):
        one, two = both(batch, e, q)
        g, _, _, _ = meet(batch, e, one, two)
        k = batch.data[batch.contact[e], STIFFNESS] * weight_of(batch, e, one, two)
        energy += 0.5 * k * max(g, 0.0) ** 2
    return energy


@inline_kernel
def bump_measure(batch, q, v):
    """Fill ``found`` for the state (q, v)."""
    for j in range(batch.found.shape[0]):
        batch.found[j, FORCE], batch.found[j, DEPTH] = 0.0, -np.inf
    for e in range(batch.base.shape[0]):
        _, _, _, N, _, _, g = bumped(batch, e, q, v)
        j = batch.contact[e]
        batch.found[j, FORCE] += N
        batch.found[j, DEPTH] = max(batch.found[j, DEPTH], g)


@inline_kernel
def bump_remember(batch, q, v):
    """Keep the way between what may touch: from there the next step is judged."""
    for e in range(batch.base.shape[0]):
        one, two = both(batch, e, q)
        _, _, _, way = meet(batch, e, one, two)
        batch.last[e, 0], batch.last[e, 1], batch.last[e, 2] = way


@inline_kernel
def bump_passed(batch, q, ws):
    """Slot of a body that has gone through another one since the last step, else -1.

    Of two segments the axes are nearer than half of the radii; the middle of a ball is below a surface; or
    the two have changed sides, on a way that leads through.
    """
    for e in range(batch.base.shape[0]):
        one, two = both(batch, e, q)
        g, _, _, way = meet(batch, e, one, two)
        size = batch.ends[e, RADII] + (batch.ends[e, RADII + 1] if batch.kind[e] == SEGMENTS else 0.0)
        x = batch.last[e]
        if not x[0] < np.inf:
            continue
        old = x[0], x[1], x[2]
        step = less(way, old)
        s = share(-dot(old, step), dot(step, step))
        nearest = between(old, s, way)
        deepest = PASSED * size if batch.kind[e] == SEGMENTS else size
        left = size - deepest if batch.kind[e] == SEGMENTS else PASSED * size
        if g > deepest or (dot(way, old) < 0.0 and dot(nearest, nearest) < left * left):
            return batch.base[e, 0] if batch.base[e, 0] >= 0 else batch.base[e, 4]
    return -1


@kernel
def bump_lost(batch):
    """Forget where things were: the steps of an equilibrium are long."""
    batch.last[:, :] = np.inf


def forget_way(batch, q, holds):
    """See :func:`bump_lost`; there is nothing that it could hold."""
    bump_lost(batch)
    return False


@kernel
def bump_values(batch, q, v, out):
    """What ``found`` says of each contact in each state, ``out`` of shape (states, contacts, 4)."""
    for n in range(q.shape[0]):
        bump_measure(batch, q[n], v[n])
        for j in range(batch.found.shape[0]):
            out[n, j, 0], out[n, j, 1] = batch.found[j, 0], batch.found[j, 1]


@kernel
def bump_places(batch, j, q, out):
    """Of contact j in states: the places on both bodies that are nearest, ``out`` of shape (states, 2, 3)."""
    for m in range(q.shape[0]):
        deepest = -np.inf
        for e in range(batch.base.shape[0]):
            if batch.contact[e] != j:
                continue
            one, two = both(batch, e, q[m])
            g, n, c, _ = meet(batch, e, one, two)
            if g > deepest:
                deepest = g
                for i in range(3):
                    out[m, 0, i], out[m, 1, i] = c[i] - 0.5 * g * n[i], c[i] + 0.5 * g * n[i]


implements(
    BumpBatch,
    force=bump_force,
    tangent=bump_tangent,
    energy=bump_energy,
    measure=bump_measure,
    remember=bump_remember,
    inverted=bump_passed,
    early=forget_way,
    role=Role.DISSIPATES | Role.MEASURES,
    memory=("last",),
    damped=lambda batch: bool(np.any(batch.data[:, DAMPING])),
)
