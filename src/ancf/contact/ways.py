"""How points along elements move against surfaces, and what forces on them change by.

A change moves the four vectors of a row by ``ways[0]`` and those of what carries the surface by ``ways[1]``;
these are numbers, or eight directions at a time.  With c, a_j of the latter, x_j = (r - c).a_j and the
velocity u past the surface,

    dx_j = (dr - dc).a_j + (r - c).da_j,      du = dv - dc' - x_j da_j' - dx_j a_j',

and with a surface at the height h on its axis e, a distance rho from there along the unit vector s, and
the normal n = n_rho s + n_z e,

    dd = n_rho drho + n_z dh,    dn = b (n_rho dh - n_z drho) (n_rho e - n_z s) + n_rho ds + n_z de,

where b is the curvature of its profile.
"""

from __future__ import annotations

from typing import Any

from numba.extending import overload

from ..compiled import FORMULA, formula
from ..records import beginning
from ..simd import every, load, store
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
    carried,
    cylindrical,
    in_body,
    outside,
    place_on,
    pressure,
    relative,
)
from .touching import Touching


@formula
def at_place(d, n, i):
    """Eight directions n at a slot."""
    return load(d, n, i), load(d, n, i + 1), load(d, n, i + 2)


@formula
def no_way():
    """A vector that no direction moves."""
    return every(0.0), every(0.0), every(0.0)


@beginning(Touching)
def nodes_along(batch, e, d, n):
    """The four vectors of a row of eight directions n."""
    b = batch.base[e]
    return at_place(d, n, b[0]), at_place(d, n, b[1]), at_place(d, n, b[2]), at_place(d, n, b[3])


@beginning(Touching)
def carrier_along(batch, e, d, n):
    """The same of what carries the surface; zero on the ground."""
    b = batch.base[e]
    if b[NODES] < 0:
        return no_way(), no_way(), no_way(), no_way()
    return (
        at_place(d, n, b[NODES]),
        at_place(d, n, b[NODES + 1]),
        at_place(d, n, b[NODES + 2]),
        at_place(d, n, b[NODES + 3]),
    )


@beginning(Touching)
def ways_along(batch, e, d):
    """What eight directions move a row by, and its rates."""
    ways = nodes_along(batch, e, d, 0), carrier_along(batch, e, d, 0)
    return ways, (nodes_along(batch, e, d, 1), carrier_along(batch, e, d, 1))


@beginning(Touching)
def met(batch, e, p, row):
    """Of a point: depth, place, the same in body axes, u, normal, N, and N by depth and by its rate."""
    nodes, rates, body, moving, at, axis = row
    r, data = place_on(batch, e, p, nodes), batch.data[batch.contact[e]]
    d, n, _, _, _ = outside(batch, e, p, body, at, axis, r)
    g, x = data[RADIUS] - d, in_body(body, r)
    u = relative(place_on(batch, e, p, rates), moving, x)
    rate, soft = -dot(u, n), SOFT * data[RADIUS]
    N, by_g, by_rate = pressure(data, g, rate)
    if N > 0.0 and g < soft:  # also of damping that pulls
        by_g = data[STIFFNESS] + data[DAMPING] * rate / soft
    return g, r, x, u, n, N, by_g, by_rate


@beginning(Touching)
def inside(batch, e, row, r, dr, carrying):
    """What a place in body axes changes by as it moves and what carries the surface does."""
    body = row[2]
    if batch.base[e, NODES] < 0:
        return dr
    y, dy = both(1.0, r, -1.0, body[0]), both(1.0, dr, -1.0, carrying[0])
    return (
        dot(body[1], dy) + dot(y, carrying[1]),
        dot(body[2], dy) + dot(y, carrying[2]),
        dot(body[3], dy) + dot(y, carrying[3]),
    )


@beginning(Touching)
def past(batch, e, row, x, dv, dx, carrying):
    """What the velocity past the surface changes by, with the rates of what carries it."""
    if batch.base[e, NODES] < 0:
        return dv
    s, t = carried(carrying, x[0], x[1], x[2]), carried((ZERO, *row[3][1:]), dx[0], dx[1], dx[2])
    return dv[0] - s[0] - t[0], dv[1] - s[1] - t[1], dv[2] - s[2] - t[2]


@beginning(Touching)
def lying(batch, e, carrying):
    """What place and axis of the surface of a row change by."""
    s = batch.surfaces[batch.surface[e]]
    at = carried(carrying, s[PLACE], s[PLACE + 1], s[PLACE + 2])
    x, y, z = s[AXIS], s[AXIS + 1], s[AXIS + 2]
    a, b, c = carrying[1], carrying[2], carrying[3]
    return at, both(1.0, both(x, a, y, b), z, c)


@beginning(Touching)
def leaned(batch, e, p, row, r, dr, carrying):
    """What distance and normal change by."""
    k = batch.surface[e]
    if batch.shape_of[k] == MESH:
        return leaned_mesh(batch.tree, batch, e, p, row[2], r, dr, carrying)
    at, axis, (dat, daxis) = row[4], row[5], lying(batch, e, carrying)
    h, rho, away = cylindrical(r, at, axis)
    _, n_rho, n_z, bend = profile_of(batch.shape_of[k], batch.surfaces[k, NUMBERS:], rho, h)
    about = n_rho / rho if rho > 0.0 else bend
    y, dy = both(1.0, r, -1.0, at), both(1.0, dr, -1.0, dat)
    dh = dot(axis, dy) + dot(y, daxis)
    across = both(1.0, both(1.0, dy, -h, daxis), -1.0, scaled(dh, axis))
    drho = dot(away, across)
    turn = bend * (n_rho * dh - n_z * drho)
    dn = both(1.0, scaled(turn * n_rho, axis), -1.0, scaled(turn * n_z + about * drho, away))
    return n_rho * drho + n_z * dh, both(1.0, dn, 1.0, both(about, across, n_z, daxis))


@formula
def scaled(f, x):
    """f x, of f that may be eight numbers."""
    return f * x[0], f * x[1], f * x[2]


def leaned_mesh(tree: Any, *others: Any) -> Any:
    """The same of a mesh, which lies in body axes."""
    raise TypeError("only in compiled code")


def _leaned_mesh(tree, batch, e, p, body, r, dr, carrying):
    s, x = batch.surfaces[batch.surface[e]], in_body(body, r)
    x = x[0] - s[PLACE], x[1] - s[PLACE + 1], x[2] - s[PLACE + 2]
    _, n, a, bend, about, _ = nearest_face(tree, batch.faces, s[NUMBERS], batch.hint[e, p], x)
    y, dy = both(1.0, r, -1.0, body[0]), both(1.0, dr, -1.0, carrying[0])
    dx = (
        dot(body[1], dy) + dot(y, carrying[1]),
        dot(body[2], dy) + dot(y, carrying[2]),
        dot(body[3], dy) + dot(y, carrying[3]),
    )
    b = cross(n, a)
    dn = both(1.0, scaled(about * dot(a, dx), a), 1.0, scaled(bend * dot(b, dx), b))
    turn = carried((scaled(dn[0], body[1]), *carrying[1:]), n[0], n[1], n[2])
    turn = both(1.0, turn, 1.0, both(1.0, scaled(dn[1], body[2]), 1.0, scaled(dn[2], body[3])))
    return dot(n, dx), turn


def _no_mesh(tree, batch, e, p, body, r, dr, carrying):
    return 0.0 * dr[0], dr


@overload(leaned_mesh, jit_options=FORMULA, strict=False)
def _choose(tree, *others):
    return _leaned_mesh if tree.ndim == 2 else _no_mesh


@beginning(Touching)
def apart(batch, e, x, dr, carrying):
    """What the matrix of a step takes for the way of a point against the surface, which it meets at x."""
    if batch.base[e, NODES] < 0:
        return dr
    s = carried(carrying, x[0], x[1], x[2])
    return dr[0] - s[0], dr[1] - s[1], dr[2] - s[2]


@beginning(Touching)
def add_lanes(batch, e, p, x, f, df, dx, r):
    """Subtract eight changes of a force f on point p, at x in body axes, which moves there by dx, from r."""
    w, b = batch.weight[e, p], batch.base[e]
    for k in range(NODES):
        s = w * batch.shape[e, p, k]
        for c in range(3):
            store(load(r, b[k] + c) - s * df[c], r, b[k] + c)
    if b[NODES] < 0:
        return
    for c in range(3):
        i = b[NODES] + c
        store(load(r, i) + w * df[c], r, i)
    for m in range(3):
        y, dy = (x[0], dx[0]) if m == 0 else ((x[1], dx[1]) if m == 1 else (x[2], dx[2]))
        for c in range(3):
            i = b[NODES + 1 + m] + c
            store(load(r, i) + w * (y * df[c] + f[c] * dy), r, i)


@beginning(Touching)
def moved_by(batch, e, p, nodes, rates):
    """What a point changes by with its factors, of which these are the changes ``rates``."""
    a, b, c, d = nodes
    w = rates
    return both(1.0, both(w[0], a, w[1], b), 1.0, both(w[2], c, w[3], d))


@beginning(Touching)
def add_change(batch, e, p, x, f, df, dx, more, rates, out):
    """The same of one change, which acts on weights by ``more`` and on factors by ``rates`` as well."""
    w, b = batch.weight[e, p], batch.base[e]
    for k in range(NODES):
        s, t = w * batch.shape[e, p, k], more * batch.shape[e, p, k] + w * rates[k]
        for c in range(3):
            out[b[k] + c] -= s * df[c] + t * f[c]
    if b[NODES] < 0:
        return
    for c in range(3):
        out[b[NODES] + c] += w * df[c] + more * f[c]
        for m in range(3):
            out[b[NODES + 1 + m] + c] += w * (x[m] * df[c] + dx[m] * f[c]) + more * x[m] * f[c]
