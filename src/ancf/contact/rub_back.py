"""Derivatives of the work of friction on surfaces, and of what it remembers, backwards.

These are the transposed ones of :mod:`ancf.contact.rub_along`.  With derivatives of a number by the friction
T, by the normal force N and by the normal n of a point, those by w, x and the limit are as on grounds
(:mod:`ancf.loads.ground_slopes`); by the place of the point, by its velocity past the surface and by what
carries it they follow as those of pressures do (:mod:`ancf.contact.press_slopes`).
"""

from __future__ import annotations

from ..compiled import formula, inline_kernel
from ..loads.ground_slopes import pulled_back
from ..records import beginning
from ..vectors import both, dot
from .press_slopes import add_at, distance_back
from .rub_along import OWN, drawn_here, grown_by, left_here, places_of
from .rubbed import ahead
from .touch import (
    DAMPING,
    DRAG,
    FRICTION,
    NODES,
    RADIUS,
    SOFT,
    STICK,
    STIFFNESS,
    ZERO,
    look_around,
    nodes_of,
    place_on,
    plus,
    relative,
    row_of,
    still_or,
    turned,
)
from .touching import Touching
from .ways import met

STILL = ZERO, ZERO, ZERO


@formula
def back_at(batch, e, p, row, here, pull, rubs, damps, by_T, by_N):
    """Derivatives at a point by r, u, x, the limit and what carries the surface, from those by T and by N.

    ``damps``: 1, or 0 of the spring alone.
    """
    _, r, _, u, n, _, by_g, by_speed = here
    by_x, by_n, by_L = ZERO, ZERO, 0.0
    if rubs:
        by_x, by_n, by_L, _ = pulled_back(pull[:6], n, by_T)
    by_rate = by_N * by_speed
    by_n, by_u = both(1.0, by_n, -by_rate, u), both(-by_rate, n, 0.0, n)
    by_r, a, b, c = distance_back(batch, e, p, row, r, -by_N * by_g, by_n)
    if rubs:
        data, z = batch.data[batch.contact[e]], pull[6]
        by_r, by_u = plus(by_r, data[STICK], by_x), plus(by_u, damps * data[DRAG], by_x)
        k = -data[STICK]
        a, b, c = plus(a, k * z[0], by_x), plus(b, k * z[1], by_x), plus(c, k * z[2], by_x)
    return by_r, by_u, by_x, by_L, (a, b, c)


@beginning(Touching)
def add_back(batch, e, p, factor, row, here, by_r, by_u, by_inside, ways, by_q, by_v):
    """Add derivatives by the place r, by u, by the place in body axes and by directions of what carries it.

    Times a factor, to those by the unknowns; the derivatives by the place with what the last have of it.
    """
    base, body, x = batch.base[e], row[2], here[2]
    by_r = by_place(batch, e, row, by_r, by_u, by_inside)
    for k in range(NODES):
        s = factor * batch.shape[e, p, k]
        add_at(by_q, base[k], s, by_r)
        add_at(by_v, base[k], s, by_u)
    if base[NODES] < 0:
        return by_r
    f = within(row, by_u, by_inside)
    y = both(1.0, here[1], -1.0, body[0])
    add_at(by_q, base[NODES], -factor, by_r)
    add_at(by_v, base[NODES], -factor, by_u)
    for m in range(3):
        add_at(by_q, base[NODES + 1 + m], factor, plus(ways[m], f[m], y))
        add_at(by_v, base[NODES + 1 + m], -factor * x[m], by_u)
    return by_r


@formula
def within(row, by_u, by_inside):
    """Derivatives by the place in body axes, with what the velocity past the surface has of it."""
    moving = row[3]
    return (
        by_inside[0] - dot(by_u, moving[1]),
        by_inside[1] - dot(by_u, moving[2]),
        by_inside[2] - dot(by_u, moving[3]),
    )


@beginning(Touching)
def by_place(batch, e, row, by_r, by_u, by_inside):
    """Derivatives by the place of a point with what its place in body axes has of it."""
    return plus(by_r, 1.0, turned(row[2], within(row, by_u, by_inside)))


@formula
def worked_at(batch, e, p, row, here, given):
    """Of the work that friction does on given vectors: these there, what draws, and :func:`back_at`."""
    X = relative(place_on(batch, e, p, given[0]), given[1], here[2])
    pull = drawn_here(batch, e, p, row, here)
    by_T = plus(ZERO, -batch.weight[e, p], X)
    return X, pull, back_at(batch, e, p, row, here, pull, True, 1.0, by_T, 0.0)


@formula
def on_inside(batch, e, p, pull, given):
    """Derivatives of that work by the place in body axes, where it acts on what carries the surface."""
    f, ways = plus(ZERO, -batch.weight[e, p] * pull[3], pull[1]), given[1]
    return dot(f, ways[1]), dot(f, ways[2]), dot(f, ways[3])


@inline_kernel
def rub_work_slopes(batch, q, v, a, x, by_q, by_v, by_a, ws):
    """See :func:`ancf.compiled.add_work_slopes`."""
    for e in range(batch.base.shape[0]):
        if batch.most[e] == 0.0:
            continue
        row, given = row_of(batch, e, q, v), (nodes_of(batch, e, x), still_or(batch, e, x))
        for p in range(batch.weight.shape[1]):
            if batch.limit[e, p] == 0.0:
                continue
            here = met(batch, e, p, row)
            _, pull, (by_r, by_u, _, _, ways) = worked_at(batch, e, p, row, here, given)
            inner = on_inside(batch, e, p, pull, given)
            add_back(batch, e, p, 1.0, row, here, by_r, by_u, inner, ways, by_q, by_v)


@beginning(Touching)
def add_factors(batch, e, p, factor, row, by_r, by_u, out):
    """Add derivatives by the factors of a point, times a factor, from those by its place and velocity."""
    for k in range(NODES):
        out[k] += factor * (dot(by_r, row[0][k]) + dot(by_u, row[1][k]))


@formula
def add_pulled(batch, e, factor, here, pull, by_x, own):
    """Add derivatives by the numbers of friction of a contact, times a factor."""
    own[STICK] += factor * dot(pull[5], by_x)
    own[DRAG] += factor * dot(here[3], by_x)


@formula
def add_pressed(batch, e, factor, here, by_N, own):
    """Add derivatives by radius, stiffness and damping, times a factor."""
    g, _, _, u, n, _, by_g, _ = here
    data, rate, power = batch.data[batch.contact[e]], -dot(u, n), factor * by_N
    soft = SOFT * data[RADIUS]
    on = min(1.0, g / soft)
    own[STIFFNESS] += power * g
    own[DAMPING] += power * on * rate
    own[RADIUS] += power * by_g
    if on < 1.0:
        own[RADIUS] -= power * data[DAMPING] * rate * on / data[RADIUS]


@formula
def places_in(batch, e, p):
    """Where in the numbers those of a contact begin, the weight of a point is, and its factors begin."""
    point, weights = e * batch.weight.shape[1] + p, OWN * batch.data.shape[0]
    return OWN * batch.contact[e], weights + point, weights + batch.weight.size + point * batch.shape.shape[2]


@inline_kernel
def rub_number_work(batch, q, v, a, x, out, ws):
    """See :func:`ancf.compiled.add_number_work`."""
    for e in range(batch.base.shape[0]):
        if batch.most[e] == 0.0:
            continue
        row, given = row_of(batch, e, q, v), (nodes_of(batch, e, x), still_or(batch, e, x))
        for p in range(batch.weight.shape[1]):
            if batch.limit[e, p] == 0.0:
                continue
            here, (first, weight, factors) = met(batch, e, p, row), places_in(batch, e, p)
            X, pull, (by_r, by_u, by_x, _, _) = worked_at(batch, e, p, row, here, given)
            add_pulled(batch, e, 1.0, here, pull, by_x, out[first:])
            out[weight] += pull[3] * dot(pull[1], X)
            by_r = by_place(batch, e, row, by_r, by_u, on_inside(batch, e, p, pull, given))
            add_factors(batch, e, p, 1.0, row, by_r, by_u, out[factors:])
            f = plus(ZERO, batch.weight[e, p] * pull[3], pull[1])
            for k in range(NODES):
                out[factors + k] += dot(f, given[0][k])


@inline_kernel
def rub_memory_work(batch, q, v, x, z, ws):
    """See :func:`ancf.compiled.take_memory_work`."""
    for e in range(batch.base.shape[0]):
        if batch.most[e] == 0.0:
            continue
        stick, row = batch.data[batch.contact[e], STICK], row_of(batch, e, q, v)
        given, body = (nodes_of(batch, e, x), still_or(batch, e, x)), row[2]
        for p in range(batch.weight.shape[1]):
            if batch.limit[e, p] == 0.0:
                continue
            anchor, limit, _ = places_of(batch, e, p)
            _, _, (_, _, by_x, by_L, _) = worked_at(batch, e, p, row, met(batch, e, p, row), given)
            for c in range(3):
                z[anchor + c] += stick * dot(by_x, body[1 + c])
            z[limit] -= by_L


@inline_kernel
def rub_memory_back(batch, q, v, z, by_q, by_v, numbers, ws):
    """See :func:`ancf.compiled.take_memory_back`."""
    for e in range(batch.base.shape[0]):
        if look_around(batch, e, q) and batch.most[e] == 0.0:
            continue
        row = row_of(batch, e, q, v)
        for p in range(batch.weight.shape[1]):
            point_back(batch, e, p, row, z, by_q, by_v, numbers)


@formula
def point_back(batch, e, p, row, z, by_q, by_v, numbers):
    """The same of a point."""
    anchor, limit, before = places_of(batch, e, p)
    kept, by_limit, by_force = (z[anchor], z[anchor + 1], z[anchor + 2]), z[limit], z[before]
    if kept == ZERO and by_limit == 0.0 and by_force == 0.0:
        return
    here, (first, _, factors) = met(batch, e, p, row), places_in(batch, e, p)
    data, own, N, body = batch.data[batch.contact[e]], numbers[first:], here[5], row[2]
    if N == 0.0:
        by_r = add_back(batch, e, p, -1.0, row, here, ZERO, ZERO, kept, STILL, by_q, by_v)
        add_factors(batch, e, p, -1.0, row, by_r, ZERO, numbers[factors:])
        for c in range(3):
            z[anchor + c] = 0.0
        z[limit] = z[before] = 0.0
        return
    by_next, by_last = grown_by(N, batch.before[e, p])
    by_N = by_force + data[FRICTION] * by_next * by_limit
    own[FRICTION] -= ahead(N, batch.before[e, p]) * by_limit
    pull, left = left_here(batch, e, p, row, here), turned(body, kept)
    yields, stick = pull[4], data[STICK]
    by_T = plus(ZERO, 1.0 / stick, left) if yields else ZERO
    by_r, by_u, by_x, by_L, (a, b, c) = back_at(batch, e, p, row, here, pull, yields, 0.0, by_T, by_N)
    if yields:
        y = both(1.0, here[1], -1.0, body[0])
        y = plus(y, -pull[3] / stick, pull[1])
        by_r = plus(by_r, 1.0, left)
        a, b, c = plus(a, kept[0], y), plus(b, kept[1], y), plus(c, kept[2], y)
        own[STICK] -= pull[3] * dot(pull[1], left) / (stick * stick)
        own[STICK] -= dot(pull[5], by_x)
    by_r = add_back(batch, e, p, -1.0, row, here, by_r, by_u, ZERO, (a, b, c), by_q, by_v)
    add_pressed(batch, e, -1.0, here, by_N, own)
    add_factors(batch, e, p, -1.0, row, by_r, by_u, numbers[factors:])
    for m in range(3):
        z[anchor + m] = -stick * dot(by_x, body[1 + m]) if yields else kept[m]
    z[limit], z[before] = by_L, data[FRICTION] * by_last * by_limit
