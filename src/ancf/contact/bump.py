"""Normal forces of rigid bodies on rigid bodies: spheres and capsules, and what they meet.

With the depth g and the normal n towards the first body of each row of :mod:`ancf.contact.meeting`,
N = pressure(g, dg/dt) acts along n on both bodies in one place in the middle of the depth, so that momentum
and angular momentum are kept.
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import Role, formula, implements, inline_kernel, kernel
from ..records import Located
from ..vectors import dot
from .bump_along import bump_slopes_along, bump_slopes_beside
from .bump_still import still_part
from .meeting import (
    FIRST,
    RADII,
    SEGMENTS,
    BumpBatch,
    apart_at,
    between,
    both,
    both_rates,
    end_of,
    factor_in,
    meet,
    share,
)
from .strand import less
from .touch import DAMPING, STIFFNESS, in_body, pressure

#: Columns of ``found``: force, N, and largest depth, m.
FORCE, DEPTH = range(2)
#: Part of the radii down to which the middle of a body may come to another one.
PASSED = 0.5
#: Columns of ``last``: the way between the two, both ends of the first one in the axes of the second.
WAY, WERE = 0, 3
#: Part of the way through another body that a body has to go to have passed it.
THROUGH = 0.9


@formula
def bumped(batch, e, q, v):
    """Place of contact in the axes of both bodies, normal, force, derivatives by depth and rate, depth.

    And the part of the force that friction goes with.
    """
    one, two = both(batch, e, q)
    g, n, c, _, w, lost, _ = meet(batch, e, one, two)
    zero = 0.0, 0.0, 0.0
    if g <= 0.0:
        return zero, zero, n, 0.0, 0.0, 0.0, g, 0.0
    moving, other = both_rates(batch, e, v)
    u, x, y = apart_at(one, two, moving, other, c)
    data = batch.data[batch.contact[e]]
    N, by_g, by_rate = pressure(data, g, -dot(u, n))
    held, k = lost * N, (w - lost) * data[STIFFNESS]
    return x, y, n, held + k * g, lost * by_g + k, lost * by_rate, g, held


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
        x, y, n, N, _, _, _, _ = bumped(batch, e, q, v)
        if N != 0.0:
            add_bump(batch, e, x, y, (N * n[0], N * n[1], N * n[2]), r)


@inline_kernel
def bump_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add minus the derivatives along the normal, which is taken as it is."""
    for e in range(batch.base.shape[0]):
        x, y, n, N, by_g, by_rate, _, _ = bumped(batch, e, q, v)
        if N != 0.0:
            add_bump_block(batch, e, x, y, n, c_stiffness * by_g + c_damping * by_rate, 0.0, A)


@inline_kernel
def bump_energy(batch, q, ws):
    """Energy of the depths, J."""
    energy = 0.0
    for e in range(batch.base.shape[0]):
        one, two = both(batch, e, q)
        g, _, _, _, _, _, share_of_it = meet(batch, e, one, two)
        energy += 0.5 * batch.data[batch.contact[e], STIFFNESS] * share_of_it * max(g, 0.0) ** 2
    return energy


@inline_kernel
def bump_measure(batch, q, v):
    """Fill ``found`` for the state (q, v)."""
    for j in range(batch.found.shape[0]):
        batch.found[j, FORCE], batch.found[j, DEPTH] = 0.0, -np.inf
    for e in range(batch.base.shape[0]):
        _, _, _, N, _, _, g, _ = bumped(batch, e, q, v)
        j = batch.contact[e]
        batch.found[j, FORCE] += N
        batch.found[j, DEPTH] = max(batch.found[j, DEPTH], g)


@formula
def ends_seen(batch, e, one, two):
    """Both ends of the first body of a row in the axes of the second one."""
    return in_body(two, end_of(batch, e, one, FIRST)), in_body(two, end_of(batch, e, one, FIRST + 3))


@inline_kernel
def bump_remember(batch, q, v):
    """Keep where things that may touch are: from there the next step is judged."""
    for e in range(batch.base.shape[0]):
        one, two = both(batch, e, q)
        _, _, _, way, _, _, _ = meet(batch, e, one, two)
        x, y = ends_seen(batch, e, one, two)
        for i in range(3):
            batch.last[e, WAY + i], batch.last[e, WERE + i], batch.last[e, WERE + 3 + i] = way[i], x[i], y[i]


@inline_kernel
def distance_of(p, x):
    """Distance of two places."""
    return math.sqrt((p[0] - x[0]) ** 2 + (p[1] - x[1]) ** 2 + (p[2] - x[2]) ** 2)


@inline_kernel
def bump_passed(batch, q, ws):
    """Slot of a body that has gone through another one since the last step, else -1.

    Of two segments the axes are nearer than half of the radii; the middle of a ball is below a surface; or
    the two have changed sides, on a way that leads through and that they went: in a ring only the nearest
    place goes to the other side.
    """
    for e in range(batch.base.shape[0]):
        one, two = both(batch, e, q)
        g, _, _, way, _, _, _ = meet(batch, e, one, two)
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
        a, b = ends_seen(batch, e, one, two)
        gone = max(distance_of(a, x[WERE : WERE + 3]), distance_of(b, x[WERE + 3 : WERE + 6]))
        apart = math.sqrt(dot(old, old)) + math.sqrt(dot(way, way))
        across_it = dot(way, old) < 0.0 and gone > THROUGH * apart
        if g > deepest or (across_it and dot(nearest, nearest) < left * left):
            return batch.base[e, 0] if batch.base[e, 0] >= 0 else batch.base[e, 4]
    return -1


@kernel
def bump_lost(batch):
    """Forget where things were: the steps of an equilibrium are long."""
    batch.last[:, :] = np.inf


def forget_way(batch, q, holds):
    """See :func:`bump_lost`; there is nothing that it could hold."""
    bump_lost(Located(batch))
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
            g, n, c, _, _, _, _ = meet(batch, e, one, two)
            if g > deepest:
                deepest = g
                for i in range(3):
                    out[m, 0, i], out[m, 1, i] = c[i] - 0.5 * g * n[i], c[i] + 0.5 * g * n[i]


implements(
    BumpBatch,
    force=bump_force,
    tangent=bump_tangent,
    energy=bump_energy,
    force_slopes=bump_slopes_along,
    slopes_beside=bump_slopes_beside,
    measure=bump_measure,
    remember=bump_remember,
    inverted=bump_passed,
    early=forget_way,
    still=still_part,
    role=Role.DISSIPATES | Role.MEASURES,
    memory=("last",),
    damped=lambda batch: bool(np.any(batch.data[:, DAMPING])),
)
