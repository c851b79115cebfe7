"""Where points along elements are against a surface: distance, normal, curvatures, relative velocity.

A row of a batch is one element of a beam and one surface.  Its ``base`` has the slots of the element, then
four of the rigid body that carries the surface: its place and its three directions, -1 on the ground.  A
point p of the row stands for the piece of reference length ``weight[e, p]`` around it.  All vectors are
global ones; places on a surface that turns are in body axes where they have to stay.
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import inline_kernel
from ..vectors import dot
from .profiles import profile_of

#: Slots of a rigid body.
BODY = 4
#: Columns of ``surfaces``: its place and its axis in body axes, then the numbers of its shape.
PLACE, AXIS, NUMBERS = 0, 3, 6
#: Columns of ``data``: radius of the beam, k, c, mu, k_t, c_t, depth at which a surface has no sides.
RADIUS, STIFFNESS, DAMPING, FRICTION, STICK, DRAG, NARROW = range(7)
#: Depth in radii over which damping comes on.
SOFT = 0.02
#: Column of ``far`` behind a place in body axes: how far the first node may go from there, m.
ROOM = 3
#: Factor of the size of an element by which it may grow before its ball is renewed.
STRETCHED = 1.25
#: Indices without a sign: it need not be looked at.
ONE, TWO = np.uint64(1), np.uint64(2)
EX, EY, EZ = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


@inline_kernel
def at_slot(q, i):
    """The vector of a slot."""
    return q[i], q[i + 1], q[i + 2]


@inline_kernel
def carrier(batch, e, q):
    """Place and directions of what carries the surface of a row."""
    k = batch.base.shape[1] - BODY
    if batch.base[e, k] < 0:
        return (0.0, 0.0, 0.0), EX, EY, EZ
    return (
        at_slot(q, batch.base[e, k]),
        at_slot(q, batch.base[e, k + 1]),
        at_slot(q, batch.base[e, k + 2]),
        at_slot(q, batch.base[e, k + 3]),
    )


@inline_kernel
def carried(body, x, y, z):
    """Global place of a place in body axes, or its velocity from the rates of the body."""
    c, a, b, d = body
    return (
        c[0] + x * a[0] + y * b[0] + z * d[0],
        c[1] + x * a[1] + y * b[1] + z * d[1],
        c[2] + x * a[2] + y * b[2] + z * d[2],
    )


@inline_kernel
def lie(batch, e, body):
    """Global place and axis of the surface of a row."""
    s = batch.surfaces[batch.surface[e]]
    at = carried(body, s[PLACE], s[PLACE + 1], s[PLACE + 2])
    tip = carried(body, s[PLACE] + s[AXIS], s[PLACE + 1] + s[AXIS + 1], s[PLACE + 2] + s[AXIS + 2])
    return at, (tip[0] - at[0], tip[1] - at[1], tip[2] - at[2])


@inline_kernel
def cylindrical(r, at, axis):
    """Height along the axis, distance from it, and the unit vector away from it, zero on it."""
    x, y, z = r[0] - at[0], r[1] - at[1], r[2] - at[2]
    h = x * axis[0] + y * axis[1] + z * axis[2]
    x, y, z = x - h * axis[0], y - h * axis[1], z - h * axis[2]
    rho = math.sqrt(x * x + y * y + z * z)
    s = 1.0 / rho if rho > 0.0 else 0.0
    return h, rho, (x * s, y * s, z * s)


@inline_kernel
def outside(batch, e, r, at, axis):
    """Signed distance of a place from the surface of a row, the normal, and what its derivative needs."""
    k = batch.surface[e]
    h, rho, away = cylindrical(r, at, axis)
    d, n_rho, n_z, bend = profile_of(batch.shape_of[k], batch.surfaces[k, NUMBERS:], rho, h)
    n = (
        n_rho * away[0] + n_z * axis[0],
        n_rho * away[1] + n_z * axis[1],
        n_rho * away[2] + n_z * axis[2],
    )
    about = n_rho / rho if rho > 0.0 else bend
    return d, n, away, bend, about


@inline_kernel
def place_on(batch, e, p, q):
    """Position of point p of row e, or its velocity from v."""
    x, y, z = 0.0, 0.0, 0.0
    for k in range(batch.base.shape[1] - BODY):
        i, w = batch.base[e, k], batch.shape[e, p, k]
        if i >= 0:
            x += w * q[i]
            y += w * q[i + 1]
            z += w * q[i + 2]
    return x, y, z


@inline_kernel
def in_body(body, r):
    """Place in body axes."""
    c, a, b, d = body
    x = r[0] - c[0], r[1] - c[1], r[2] - c[2]
    return dot(x, a), dot(x, b), dot(x, d)


@inline_kernel
def first_node(batch, e, q):
    """Place of the first node of a row, in the axes of what carries the surface."""
    k = batch.base.shape[1] - BODY
    r = at_slot(q, batch.base[e, 0])
    if batch.base[e, k] < 0:
        return r
    return in_body(carrier(batch, e, q), r)


@inline_kernel
def reach_of(batch, e, q):
    """Radius of a ball about the first node of a row, with the radius of the beam, that holds all its points.

    With the factors S_k of the points in q_k, r_0 the first node, sum |S_k| |q_k - r_0|, or |q_k| of a
    slope, bounds it; the sum of the sizes of the components bounds the size of a vector.
    """
    r = at_slot(q, batch.base[e, 0])
    reach = batch.data[batch.contact[e], RADIUS]
    for k in range(1, batch.base.shape[1] - BODY):
        i, w = batch.base[e, k], batch.reach[e, k]
        if i >= 0:
            if w > 0.0:
                reach += w * (abs(q[i]) + abs(q[i + 1]) + abs(q[i + 2]))
            else:
                reach -= w * (abs(q[i] - r[0]) + abs(q[i + 1] - r[1]) + abs(q[i + 2] - r[2]))
    return reach


@inline_kernel
def is_far(batch, e, q):
    """Whether no point of a row can touch: its first node has not left the ball in which none does."""
    i, far = np.uint64(batch.base[e, 0]), batch.far[e]
    if batch.base[e, batch.base.shape[1] - BODY] < 0:
        return abs(q[i] - far[0]) + abs(q[i + ONE] - far[1]) + abs(q[i + TWO] - far[2]) < far[ROOM]
    r = first_node(batch, e, q)
    return abs(r[0] - far[0]) + abs(r[1] - far[1]) + abs(r[2] - far[2]) < far[ROOM]


@inline_kernel
def look_around(batch, e, q):
    """Whether a row is far; its ball is renewed when half of it is used up."""
    r, far = first_node(batch, e, q), batch.far[e]
    if 2.0 * (abs(r[0] - far[0]) + abs(r[1] - far[1]) + abs(r[2] - far[2])) < far[ROOM]:
        return True
    at, axis = lie(batch, e, carrier(batch, e, q))
    d, _, _, _, _ = outside(batch, e, at_slot(q, batch.base[e, 0]), at, axis)
    far[0], far[1], far[2] = r
    far[ROOM] = d - STRETCHED * reach_of(batch, e, q)
    return far[ROOM] > 0.0


@inline_kernel
def relative(u, moving, x):
    """Velocity u of a point less that of the surface at the place x in body axes."""
    s = carried(moving, x[0], x[1], x[2])
    return u[0] - s[0], u[1] - s[1], u[2] - s[2]


@inline_kernel
def pressure(data, g, rate):
    """Normal force N per length for a depth g, and its derivatives by g and by the rate of g."""
    if g <= 0.0:
        return 0.0, 0.0, 0.0
    soft = SOFT * data[RADIUS]
    on = min(1.0, g / soft)
    N = data[STIFFNESS] * g + data[DAMPING] * on * rate
    if N <= 0.0:
        return 0.0, 0.0, 0.0
    slope = data[STIFFNESS] + (max(data[DAMPING] * rate, 0.0) / soft if on < 1.0 else 0.0)
    return N, slope, data[DAMPING] * on


@inline_kernel
def factor_of(batch, e, p, k, x):
    """Factor of slot k in the place of point p against the surface, which it meets at x in body axes."""
    size = batch.base.shape[1] - BODY
    if k < size:
        return batch.shape[e, p, k]
    return -1.0 if k == size else -x[k - size - 1]


@inline_kernel
def add_pair(batch, e, p, x, fx, fy, fz, r):
    """Subtract a force per reference length on point p, and the opposite one on what it touches, from r."""
    size = batch.base.shape[1]
    w = batch.weight[e, p]
    for k in range(size):
        i = batch.base[e, k]
        if i >= 0:
            s = w * factor_of(batch, e, p, k, x)
            r[i] -= s * fx
            r[i + 1] -= s * fy
            r[i + 2] -= s * fz


@inline_kernel
def add_pair_block(batch, e, p, x, rows, A):
    """Add a symmetric 3x3 matrix per length, minus the derivative of that force by the way apart, to A."""
    size = batch.base.shape[1]
    for k in range(size):
        wk = batch.weight[e, p] * factor_of(batch, e, p, k, x)
        for m in range(size):
            place = batch.dest[e, size * k + m]
            if place < 0:
                continue
            w = wk * factor_of(batch, e, p, m, x)
            for i in range(3):
                for j in range(3):
                    A[place + 6 * i + j] += w * rows[i][j]


@inline_kernel
def turning(N, n, away, axis, bend, about):
    """Rows of N times the derivative of the normal by the place."""
    a = (
        axis[1] * away[2] - axis[2] * away[1],
        axis[2] * away[0] - axis[0] * away[2],
        axis[0] * away[1] - axis[1] * away[0],
    )
    b = n[1] * a[2] - n[2] * a[1], n[2] * a[0] - n[0] * a[2], n[0] * a[1] - n[1] * a[0]
    s, t = N * about, N * bend
    xy, xz = s * a[0] * a[1] + t * b[0] * b[1], s * a[0] * a[2] + t * b[0] * b[2]
    yz = s * a[1] * a[2] + t * b[1] * b[2]
    return (
        (s * a[0] * a[0] + t * b[0] * b[0], xy, xz),
        (xy, s * a[1] * a[1] + t * b[1] * b[1], yz),
        (xz, yz, s * a[2] * a[2] + t * b[2] * b[2]),
    )
