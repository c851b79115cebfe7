"""Derivatives of x . force of pressures by the state and by numbers, see :mod:`ancf.contact.press`.

With X for x of a point less that of the surface there, the work of a piece is -w N n.X, where

    N = k g + c on(g) g',   g = radius - d,   g' = -n.u.

It depends on the place r of the point, its velocity u past the surface and X, and on what carries the
surface: its place c and its directions a_j.  Against that the point is at x_j = (r - c).a_j, with which rates
and x of the directions are in u and X.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..choices import where_dimensions
from ..compiled import formula, inline_kernel
from ..records import beginning
from ..vectors import both, cross, dot
from .mesh import MESH, nearest_face
from .profiles import profile_of
from .touch import (
    AXIS,
    DAMPING,
    NODES,
    NUMBERS,
    PLACE,
    RADIUS,
    SOFT,
    STIFFNESS,
    ZERO,
    cylindrical,
    factor_of,
    in_body,
    look_around,
    nodes_of,
    outside,
    place_on,
    plus,
    pressure,
    relative,
    row_of,
    still_or,
    turned,
)
from .touching import Touching

#: How many columns of ``data`` forces depend on: RADIUS, STIFFNESS, DAMPING.
OWN = 3
#: Places of what :func:`part_of` gives: the place of a point in body axes, X, the normal and N.
INSIDE, GIVEN, NORMAL, FORCE = 2, 4, 5, 6


def numbers_of(batch: Any) -> FloatArray:
    """Those of :func:`press_number_work`: radius, stiffness and damping, weights and factors of points."""
    return np.concatenate([batch.data[:, :OWN].ravel(), batch.weight.ravel(), batch.shape.ravel()])


@formula
def part_of(batch, e, p, row, given):
    """Of a point: depth, place, the same in body axes, u, X, normal, N, and N by depth and by its rate."""
    nodes, rates, body, moving, at, axis = row
    r, data = place_on(batch, e, p, nodes), batch.data[batch.contact[e]]
    d, n, _, _, _ = outside(batch, e, p, body, at, axis, r)
    g = data[RADIUS] - d
    if g <= 0.0:
        return g, r, ZERO, ZERO, ZERO, n, 0.0, 0.0, 0.0
    x = in_body(body, r)
    u = relative(place_on(batch, e, p, rates), moving, x)
    X = relative(place_on(batch, e, p, given[0]), given[1], x)
    rate, soft = -dot(u, n), SOFT * data[RADIUS]
    N, by_g, by_rate = pressure(data, g, rate)
    if N > 0.0 and g < soft:  # also of damping that pulls
        by_g = data[STIFFNESS] + data[DAMPING] * rate / soft
    return g, r, x, u, X, n, N, by_g, by_rate


@beginning(Touching)
def distance_back(batch, e, p, row, r, by_d, by_n):
    """Derivatives by a place and by what carries the surface from those by its distance and by the normal."""
    k = batch.surface[e]
    if batch.shape_of[k] == MESH:
        return mesh_back(batch.tree, batch, e, p, row[2], r, by_d, by_n)
    s, at, axis = batch.surfaces[k], row[4], row[5]
    h, rho, away = cylindrical(r, at, axis)
    _, n_rho, n_z, bend = profile_of(batch.shape_of[k], s[NUMBERS:], rho, h)
    about = n_rho / rho if rho > 0.0 else bend
    turn = bend * (n_rho * dot(by_n, axis) - n_z * dot(by_n, away))  # by how the normal turns in its plane
    by_rho, by_h = n_rho * by_d - n_z * turn, n_z * by_d + n_rho * turn
    across = both(about, by_n, by_rho - about * dot(away, by_n), away)  # by the way from the axis
    by_h -= dot(across, axis)
    y = r[0] - at[0], r[1] - at[1], r[2] - at[2]
    by_axis, by_r = plus(both(n_z, by_n, by_h, y), -h, across), plus(across, by_h, axis)
    return (
        by_r,
        both(-s[PLACE], by_r, s[AXIS], by_axis),
        both(-s[PLACE + 1], by_r, s[AXIS + 1], by_axis),
        both(-s[PLACE + 2], by_r, s[AXIS + 2], by_axis),
    )


def _mesh_back(tree, batch, e, p, body, r, by_d, by_n):
    """The same of a mesh, which lies in body axes."""
    s, x = batch.surfaces[batch.surface[e]], in_body(body, r)
    x = x[0] - s[PLACE], x[1] - s[PLACE + 1], x[2] - s[PLACE + 2]
    _, n, a, bend, about, _ = nearest_face(tree, batch.faces, s[NUMBERS], batch.hint[e, p], x)
    b, f = cross(n, a), (dot(by_n, body[1]), dot(by_n, body[2]), dot(by_n, body[3]))
    by_x = plus(both(about * dot(a, f), a, bend * dot(b, f), b), by_d, n)
    y = r[0] - body[0][0], r[1] - body[0][1], r[2] - body[0][2]
    by_a, by_b = both(n[0], by_n, by_x[0], y), both(n[1], by_n, by_x[1], y)
    return turned(body, by_x), by_a, by_b, both(n[2], by_n, by_x[2], y)


mesh_back = where_dimensions(2, _mesh_back, (ZERO, ZERO, ZERO, ZERO))


@formula
def part_back(batch, e, p, row, given, part):
    """Derivatives of the work of a piece by r, u and X, and by the three directions of what carries it."""
    _, r, _, u, X, n, N, by_g, by_rate = part
    w, body, moving, ways = batch.weight[e, p], row[2], row[3], given[1]
    power = -w * dot(n, X)
    by_u, by_X = plus(ZERO, -power * by_rate, n), plus(ZERO, -w * N, n)
    by_n = both(-w * N, X, -power * by_rate, u)
    by_r, a, b, d = distance_back(batch, e, p, row, r, -power * by_g, by_n)
    f = -dot(by_X, ways[1]) - dot(by_u, moving[1])
    g = -dot(by_X, ways[2]) - dot(by_u, moving[2])
    h = -dot(by_X, ways[3]) - dot(by_u, moving[3])
    y = r[0] - body[0][0], r[1] - body[0][1], r[2] - body[0][2]
    return plus(by_r, 1.0, turned(body, (f, g, h))), by_u, by_X, plus(a, f, y), plus(b, g, y), plus(d, h, y)


@inline_kernel
def add_at(out, i, w, f):
    """Add w f to a slot."""
    for c in range(3):
        out[i + c] += w * f[c]


@inline_kernel
def press_work_slopes(batch, q, v, a, x, by_q, by_v, by_a, ws):
    """See :func:`ancf.compiled.add_work_slopes`."""
    for e in range(batch.base.shape[0]):
        if look_around(batch, e, q):
            continue
        row, given = row_of(batch, e, q, v), (nodes_of(batch, e, x), still_or(batch, e, x))
        base = batch.base[e]
        for p in range(batch.weight.shape[1]):
            part = part_of(batch, e, p, row, given)
            if part[FORCE] == 0.0:
                continue
            by_r, by_u, _, by_a1, by_a2, by_a3 = part_back(batch, e, p, row, given, part)
            for k in range(NODES):
                add_at(by_q, base[k], batch.shape[e, p, k], by_r)
                add_at(by_v, base[k], batch.shape[e, p, k], by_u)
            if base[NODES] < 0:
                continue
            add_at(by_q, base[NODES], -1.0, by_r)
            add_at(by_q, base[NODES + 1], 1.0, by_a1)
            add_at(by_q, base[NODES + 2], 1.0, by_a2)
            add_at(by_q, base[NODES + 3], 1.0, by_a3)
            for k in range(4):
                add_at(by_v, base[NODES + k], factor_of(batch, e, p, NODES + k, part[INSIDE]), by_u)


@inline_kernel
def press_number_work(batch, q, v, a, x, out, ws):
    """See :func:`ancf.compiled.add_number_work`."""
    points, slots, by_weight = batch.weight.shape[1], batch.shape.shape[2], OWN * batch.data.shape[0]
    by_shape = by_weight + batch.weight.size
    for e in range(batch.base.shape[0]):
        if look_around(batch, e, q):
            continue
        row, given = row_of(batch, e, q, v), (nodes_of(batch, e, x), still_or(batch, e, x))
        first = OWN * batch.contact[e]
        for p in range(points):
            part = part_of(batch, e, p, row, given)
            if part[FORCE] == 0.0:
                continue
            add_by_data(batch, e, p, part, out[first : first + OWN])
            by_r, by_u, by_X, _, _, _ = part_back(batch, e, p, row, given, part)
            i = points * e + p
            out[by_weight + i] -= part[FORCE] * dot(part[NORMAL], part[GIVEN])
            for k in range(NODES):
                by_factor = dot(by_r, row[0][k]) + dot(by_u, row[1][k]) + dot(by_X, given[0][k])
                out[by_shape + slots * i + k] += by_factor


@formula
def add_by_data(batch, e, p, part, out):
    """Add the derivatives by radius, stiffness and damping."""
    g, _, _, u, X, n, _, by_g, _ = part
    data, power, rate = batch.data[batch.contact[e]], -batch.weight[e, p] * dot(n, X), -dot(u, n)
    soft = SOFT * data[RADIUS]
    on = min(1.0, g / soft)
    out[STIFFNESS] += power * g
    out[DAMPING] += power * on * rate
    out[RADIUS] += power * by_g
    if on < 1.0:
        out[RADIUS] -= power * data[DAMPING] * rate * on / data[RADIUS]
