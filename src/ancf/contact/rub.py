"""Friction of beams on surfaces, per reference length: an elastic-plastic spring with memory.

At the place x of the axis, which a surface that moves carries along, with the normal n and P = 1 - n n^T,

    T = -w,   w = P (k_t (r - anchor) + c_t v),   cut to |T| <= limit,   limit = mu N,

where v is the velocity past the surface and c_t = c sqrt(k_t/k).  The anchor is where the spring has no
force; it stays in the axes of what carries the surface, so that a drum which turns takes it along.  A
point that does not touch takes its anchor along, one that slips drags it at the distance limit/k_t, as soon
as the spring alone is that long: what the damper takes beyond the limit stretches nothing.  Anchors and
limits are memory: they change once for each accepted step, see ``rub_remember``.  A limit that is known
before the step keeps the matrix symmetric and the iteration stable; N is continued from the ends of the last
two steps, so that what passes by does not feel the pressure where it was.

In an equilibrium the anchors are the places of the initial shape, so that friction opposes the way from
there.  It holds what touches there while the loads come on, so that nothing falls off that friction alone
bears; then its limits are renewed until they fit.  All work of friction counts as dissipated: what the spring
holds while it sticks, T^2/(2 k_t) per length, it gives back.

Along a cable with a winch the material takes its anchors along, as on a ground (:mod:`ancf.loads.ground`),
in the axes of what carries the surface: they move by ``drift`` with the growth of the length.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import types
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import VECTOR, Role, formula, implements, inline_kernel, kernel
from ..loads.along import let_stick, upstream
from ..records import Located, beginning
from ..vectors import dot
from .press import pressed
from .reel import grown, stretched, swept
from .rub_along import (
    kinds_of,
    numbers_of,
    rub_changes,
    rub_choice,
    rub_memory_changes,
    rub_memory_slopes,
    rub_remember_along,
    rub_slopes_along,
    rub_slopes_beside,
)
from .rub_back import rub_memory_back, rub_memory_work, rub_number_work, rub_work_slopes
from .rubbed import ahead, find, nothing_found, share_found
from .touch import (
    DRAG,
    FRICTION,
    RADIUS,
    STICK,
    ZERO,
    add_pair_block,
    add_sums,
    carried,
    carrier,
    in_body,
    lie,
    look_around,
    nodes_of,
    nothing,
    outside,
    place_on,
    plus,
    relative,
    row_of,
    with_force,
)
from .touching import Touching

#: Share of a change of the limits that a round of an equilibrium takes: all of it would swing past a cable
#: that friction holds on several turns.
TAKEN = 0.4
#: A limit that nothing reaches, N/m, and the gap in radii up to which a point counts as one that touches.
GRIP, CLOSE = 1e100, 0.05


class RubBatch(NamedTuple):
    """All elements that may rub on surfaces."""

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
    found: FloatArray  # (contacts, 4) memory: columns RUBBED, SLIPPED of the last accepted step
    tree: FloatArray
    faces: FloatArray
    hint: NDArray[np.int64]
    far: FloatArray
    bond: NDArray[np.int64]  # zero: friction knows of no point that is held against its pressure
    anchor: FloatArray  # (n, points, 3) memory: where friction has no force, in axes of what carries
    limit: FloatArray  # (n, points) memory: largest friction, N/m; negative: it has that size, see drawn
    before: FloatArray  # (n, points) memory: normal force at the end of the step before, N/m
    most: FloatArray  # (n,) memory: the largest limit of a row
    lit: NDArray[np.int64]  # (n + 1,) memory: how many rows have a limit, and which
    label: FloatArray  # (n, points) see loads/along.py
    beside: NDArray[np.int64]  # (n, 2)
    drift: FloatArray  # (n, points, 3) memory: by how much anchors move with the length; no rows: no winch
    since: FloatArray  # (n,) memory: length at the last accepted step, m, 0: none; no rows as well
    acted: FloatArray  # (n, points) memory: the limit that acted in the last accepted step, N/m


@formula
def rubs(batch, e):
    """Whether a row may have friction in this step."""
    return batch.most[e] > 0.0


@formula
def light(batch):
    """List the rows that may have friction."""
    count = 0
    for e in range(batch.base.shape[0]):
        if rubs(batch, e):
            count += 1
            batch.lit[count] = e
    batch.lit[0] = count


@formula
def anchor_at(batch, e, p, q):
    """The anchor of the material that is at point p of row e."""
    a = batch.anchor[e, p]
    if batch.winch[e] < 0:
        return a[0], a[1], a[2]
    return plus((a[0], a[1], a[2]), grown(batch, e, q), batch.drift[e, p])


@formula
def drawn(batch, e, p, r, u, n, body, q):
    """The vector w of the friction, its size, and the factor f of the force -f w; whether it slips.

    Where derivatives of a step that slips are taken, the limit is negative: it slips in all their states.
    """
    data, anchor = batch.data[batch.contact[e]], anchor_at(batch, e, p, q)
    k, c = data[STICK], data[DRAG]
    a = carried(body, anchor[0], anchor[1], anchor[2])
    x = k * (r[0] - a[0]) + c * u[0]
    y = k * (r[1] - a[1]) + c * u[1]
    z = k * (r[2] - a[2]) + c * u[2]
    normal = x * n[0] + y * n[1] + z * n[2]
    w = x - normal * n[0], y - normal * n[1], z - normal * n[2]
    size = math.sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2])
    if size > batch.limit[e, p]:
        return w, size, abs(batch.limit[e, p]) / size, True
    return w, size, 1.0, False


@formula
def left(batch, e, p, r, u, n, body, q):
    """The same of the spring alone, f the factor of what a step leaves in it; whether its anchor moves.

    It moves where the point slips and the spring by itself pulls beyond the limit.
    """
    _, _, _, slips = drawn(batch, e, p, r, u, n, body, q)
    w, size, _, _ = drawn(batch, e, p, r, ZERO, n, body, q)
    limit = abs(batch.limit[e, p])
    if slips and size > limit:
        return w, size, limit / size, True
    return w, size, 1.0, False


@beginning(Touching)
def rubbed(batch, e, p, row):
    """Place of point p, in body axes too, its velocity past the surface and the normal."""
    nodes, rates, body, moving, at, axis = row
    r = place_on(batch, e, p, nodes)
    _, n, _, _, _ = outside(batch, e, p, body, at, axis, r)
    x = in_body(body, r)
    return r, x, relative(place_on(batch, e, p, rates), moving, x), n


@inline_kernel
def rub_force(batch, q, v, a, r, ws):
    """Subtract the friction from r."""
    for i in range(batch.lit[0]):
        e = batch.lit[1 + i]
        if not rubs(batch, e):
            continue
        row, sums = row_of(batch, e, q, v), nothing()
        for p in range(batch.weight.shape[1]):
            if batch.limit[e, p] != 0.0:
                place, x, u, n = rubbed(batch, e, p, row)
                w, _, f, _ = drawn(batch, e, p, place, u, n, row[2], q)
                sums = with_force(batch, e, p, x, (-f * w[0], -f * w[1], -f * w[2]), sums)
        add_sums(batch, e, sums, row[0], 0.0, q, r)


@inline_kernel
def rub_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add minus the derivatives by position and velocity, the normal as it is."""
    for i in range(batch.lit[0]):
        e = batch.lit[1 + i]
        if not rubs(batch, e):
            continue
        data, row, lam = batch.data[batch.contact[e]], row_of(batch, e, q, v), stretched(batch, e, q)
        for p in range(batch.weight.shape[1]):
            if batch.limit[e, p] == 0.0:
                continue
            place, x, u, n = rubbed(batch, e, p, row)
            w, size, f, slips = drawn(batch, e, p, place, u, n, row[2], q)
            one = f * (c_stiffness * data[STICK] + c_damping * data[DRAG])
            ww = -one / (size * size) if slips else 0.0
            xy = ww * w[0] * w[1] - one * n[0] * n[1]
            xz = ww * w[0] * w[2] - one * n[0] * n[2]
            yz = ww * w[1] * w[2] - one * n[1] * n[2]
            rows = (
                (one + ww * w[0] * w[0] - one * n[0] * n[0], xy, xz),
                (xy, one + ww * w[1] * w[1] - one * n[1] * n[1], yz),
                (xz, yz, one + ww * w[2] * w[2] - one * n[2] * n[2]),
            )
            add_pair_block(batch, e, p, x, lam, rows, A)


@inline_kernel
def rub_remember(batch, q, v):
    """Move the anchors to where the friction of the state q, v leaves them, and renew the limits.

    What acted in the state is left in ``found`` and ``acted``: it does not follow from what is renewed.
    """
    nothing_found(batch)
    for e in range(batch.base.shape[0]):
        if look_around(batch, e, q) and not rubs(batch, e):
            continue
        batch.most[e] = 0.0
        j, row, lam = batch.contact[e], row_of(batch, e, q, v), stretched(batch, e, q)
        body, data = row[2], batch.data[j]
        for p in range(batch.weight.shape[1]):
            _, _, N, _, _, n, _, _, _ = pressed(batch, e, p, row)
            r, x, u, _ = rubbed(batch, e, p, row)
            _, size, f, slips = drawn(batch, e, p, r, u, n, body, q)
            find(batch, j, lam * batch.weight[e, p] * f * size, slips)
            to = x
            if N > 0.0:
                w, _, f, yields = left(batch, e, p, r, u, n, body, q)
                to = in_body(body, plus(r, -f / data[STICK], w)) if yields else anchor_at(batch, e, p, q)
            batch.anchor[e, p, 0], batch.anchor[e, p, 1], batch.anchor[e, p, 2] = to
            batch.acted[e, p] = batch.limit[e, p]
            batch.limit[e, p] = data[FRICTION] * ahead(N, batch.before[e, p])
            batch.before[e, p] = N
            batch.most[e] = max(batch.most[e], batch.limit[e, p])
    share_found(batch)
    light(batch)
    for e in range(batch.since.shape[0]):
        if batch.winch[e] >= 0:
            follow_material(batch, e, q, v)


@formula
def follow_material(batch, e, q, v):
    """How the anchors of row e move with the length from here on."""
    i = batch.winch[e]
    batch.since[e] = q[i]
    if not rubs(batch, e):
        return
    nodes, body = nodes_of(batch, e, q), carrier(batch, e, q)
    slopes, comes = swept(batch, e, nodes), 1 if v[i] > 0.0 else 0  # from the far end or from the winch
    for p in range(batch.weight.shape[1]):
        other, m = upstream(batch, e, p, comes)
        X, own, there, way = batch.label[e, p], behind(batch, e, p, nodes, body), ZERO, math.inf
        if other >= 0:
            there = behind(batch, other, m, nodes_of(batch, other, q), body)
            way = X - batch.label[other, m]
        elif comes == 1:  # what enters has not touched the surface
            way = X - math.copysign(1.0 / batch.unwound[e], X)
        slope = of_body(body, place_on(batch, e, p, slopes))
        for c in range(3):
            batch.drift[e, p, c] = slope[c] - X * (own[c] - there[c]) / way


@formula
def behind(batch, e, p, nodes, body):
    """The way from the anchor to the place of a point, in the axes of what carries the surface."""
    if not rubs(batch, e):
        return ZERO
    x, a = in_body(body, place_on(batch, e, p, nodes)), batch.anchor[e, p]
    return x[0] - a[0], x[1] - a[1], x[2] - a[2]


@inline_kernel
def of_body(body, f):
    """A direction in the axes of a body."""
    return dot(f, body[1]), dot(f, body[2]), dot(f, body[3])


@inline_kernel
def rub_measure(batch, q, v):
    """Fill ``found`` for the state (q, v), with the limits that acted in it."""
    nothing_found(batch)
    for e in range(batch.base.shape[0]):
        if not rubs(batch, e):
            continue
        row, j, lam = row_of(batch, e, q, v), batch.contact[e], stretched(batch, e, q)
        for p in range(batch.weight.shape[1]):
            place, _, u, n = rubbed(batch, e, p, row)
            _, size, f, slips = drawn(batch, e, p, place, u, n, row[2], q)
            find(batch, j, lam * batch.weight[e, p] * f * size, slips)
    share_found(batch)


@kernel
def renew_limits(batch, q, v):
    """Limits of the friction from the state q, v; returns their largest change and the largest of them.

    What has been held by whatever it took is let go by and by: the pressure comes to where the load goes.
    """
    change, most = 0.0, 0.0
    for e in range(batch.base.shape[0]):
        batch.most[e] = 0.0
        row, data = row_of(batch, e, q, v), batch.data[batch.contact[e]]
        for p in range(batch.weight.shape[1]):
            _, _, N, _, _, _, _, _, _ = pressed(batch, e, p, row)
            wanted, limit, batch.before[e, p] = data[FRICTION] * N, batch.limit[e, p], N  # at rest N stays
            if limit == GRIP:
                r, _, u, n = rubbed(batch, e, p, row)
                limit = max(wanted, drawn(batch, e, p, r, u, n, row[2], q)[1])
            change = max(change, abs(wanted - limit))
            most = max(most, wanted)
            batch.limit[e, p] = limit + TAKEN * (wanted - limit)
            batch.most[e] = max(batch.most[e], batch.limit[e, p])
    light(batch)
    return change, most


@kernel
def grip(batch, q, holds):
    """Let friction hold all that touches in the state q, whatever it takes, or nothing."""
    for e in range(batch.base.shape[0]):
        body, nodes = carrier(batch, e, q), nodes_of(batch, e, q)
        at, axis = lie(batch, e, body)
        radius, batch.most[e] = batch.data[batch.contact[e], RADIUS], 0.0
        for p in range(batch.weight.shape[1]):
            d, _, _, _, _ = outside(batch, e, p, body, at, axis, place_on(batch, e, p, nodes))
            batch.limit[e, p] = GRIP if holds and d < (1.0 + CLOSE) * radius else 0.0
            batch.most[e] = max(batch.most[e], batch.limit[e, p])
    light(batch)


def hold(batch, q, holds):
    """See :func:`grip`."""
    grip(Located(batch), q, holds)
    return True


def let_rub(batch, q):
    """Renew the limits in an equilibrium; returns their relative change."""
    change, most = renew_limits(Located(batch), q, np.zeros_like(q))
    if most > 0.0:
        return float(change / most)
    return 1.0 if change > 0.0 else 0.0  # what has been held does not touch: it is let go all the same


implements(
    RubBatch,
    force=rub_force,
    tangent=rub_tangent,
    force_slopes=rub_slopes_along,
    slopes_beside=rub_slopes_beside,
    sloped=lambda batch: not np.any(batch.winch >= 0),
    changes=rub_changes,
    work_slopes=rub_work_slopes,
    number_work=rub_number_work,
    memory_work=rub_memory_work,
    memory_back=rub_memory_back,
    numbers=numbers_of,
    numbered=("data", "weight", "shape", "reach", "mesh", "unwound", "far", "label"),
    kinds=kinds_of,
    memory_choice=rub_choice,
    memory_slopes=rub_memory_slopes,
    memory_along=rub_remember_along,
    memory_changes=rub_memory_changes,
    remember=rub_remember,
    measure=rub_measure,
    role=Role.RUBS | Role.MEASURES,
    slots=("base", "winch"),
    memory=("far", "anchor", "limit", "before", "most", "lit", "drift", "since", "acted", "found"),
    late=lambda batch: let_rub,
    early=hold,
    stick=let_stick,
    resting=((grip, (VECTOR, types.boolean)), (renew_limits, (VECTOR, VECTOR))),
)
