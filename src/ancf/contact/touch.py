"""Where points along elements are against a surface: distance, normal, curvatures, relative velocity.

A row of a batch is one element of a beam and one surface.  Its ``base`` has the slots of the element, then
four of the rigid body that carries the surface: its place and its three directions, -1 on the ground.  A
point p of the row stands for the piece of reference length ``weight[e, p]`` around it.  All vectors are
global ones; places on a surface that turns are in body axes where they have to stay.
"""

from __future__ import annotations

import math

import numpy as np

from ..choices import where_dimensions
from ..compiled import inline_kernel
from ..records import beginning
from ..vectors import cross, dot
from .mesh import MESH, nearest_face
from .profiles import profile_of
from .reel import add_on_length, rates_of_material, stretched, times
from .touching import Touching

#: Slots of an element that its axis depends on: r and r_x of both nodes; and of a rigid body.
NODES, BODY = 4, 4
#: Columns of ``surfaces``: its place and its axis in body axes, then the numbers of its shape.
PLACE, AXIS, NUMBERS = 0, 3, 6
#: Columns of ``data``: radius of the beam, k, c, mu, k_t, c_t, depth at which a surface has no sides.
RADIUS, STIFFNESS, DAMPING, FRICTION, STICK, DRAG, NARROW = range(7)
#: Depth in radii over which damping comes on.
SOFT = 0.02
#: Columns of ``far`` behind a place in body axes: how far the first node may go from there, and how far it
#: has gone when that was looked at last, m.
ROOM, GONE = 3, 4
#: Steps such as the last in which it must stay there to count as far.
STEPS = 4.0
#: Factor of the size of an element by which it may grow before its ball is renewed.
STRETCHED = 1.25
#: Indices without a sign: it need not be looked at.
ONE, TWO = np.uint64(1), np.uint64(2)
ZERO = (0.0, 0.0, 0.0)
EX, EY, EZ = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


@inline_kernel
def at_slot(q, i):
    """The vector of a slot; one without a sign need not be looked at."""
    return q[i], q[i + ONE], q[i + TWO]


@beginning(Touching)
def carrier(batch, e, q):
    """Place and directions of what carries the surface of a row."""
    b = batch.base[e]
    if b[NODES] < 0:
        return ZERO, EX, EY, EZ
    return (
        at_slot(q, np.uint64(b[NODES])),
        at_slot(q, np.uint64(b[NODES + 1])),
        at_slot(q, np.uint64(b[NODES + 2])),
        at_slot(q, np.uint64(b[NODES + 3])),
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


@beginning(Touching)
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


@beginning(Touching)
def outside(batch, e, p, body, at, axis, r):
    """Signed distance of a place from the surface of a row, the normal, and how it turns.

    That is: a direction a along the surface, the curvature along n x a and the one along a, 1/m.  Point p
    is where a mesh begins to look.
    """
    k = batch.surface[e]
    if batch.shape_of[k] == MESH:
        return beside_mesh(batch.tree, batch, e, p, k, body, r)
    h, rho, away = cylindrical(r, at, axis)
    d, n_rho, n_z, bend = profile_of(batch.shape_of[k], batch.surfaces[k, NUMBERS:], rho, h)
    n = (
        n_rho * away[0] + n_z * axis[0],
        n_rho * away[1] + n_z * axis[1],
        n_rho * away[2] + n_z * axis[2],
    )
    about = n_rho / rho if rho > 0.0 else bend
    return d, n, cross(axis, away), bend, about


def _beside_mesh(tree, batch, e, p, k, body, r):
    """The same of a mesh, which lies in body axes."""
    s = batch.surfaces[k]
    x = in_body(body, r)
    x = x[0] - s[PLACE], x[1] - s[PLACE + 1], x[2] - s[PLACE + 2]
    d, n, a, bend, about, face = nearest_face(tree, batch.faces, s[NUMBERS], batch.hint[e, p], x)
    batch.hint[e, p] = face
    return d, turned(body, n), turned(body, a), bend, about


beside_mesh = where_dimensions(2, _beside_mesh, (math.inf, ZERO, ZERO, 0.0, 0.0))


@inline_kernel
def turned(body, n):
    """A direction in body axes as a global one."""
    _, a, b, d = body
    return (
        n[0] * a[0] + n[1] * b[0] + n[2] * d[0],
        n[0] * a[1] + n[1] * b[1] + n[2] * d[1],
        n[0] * a[2] + n[1] * b[2] + n[2] * d[2],
    )


@beginning(Touching)
def nodes_of(batch, e, q):
    """The four vectors of a row, or their rates from v."""
    b = batch.base[e]
    return (
        at_slot(q, np.uint64(b[0])),
        at_slot(q, np.uint64(b[1])),
        at_slot(q, np.uint64(b[2])),
        at_slot(q, np.uint64(b[3])),
    )


@beginning(Touching)
def row_of(batch, e, q, v):
    """What all points of a row share: its vectors and their rates, what carries the surface, how it lies.

    The rates are those of the material.
    """
    body, nodes = carrier(batch, e, q), nodes_of(batch, e, q)
    at, axis = lie(batch, e, body)
    rates = rates_of_material(batch, e, nodes, nodes_of(batch, e, v), q, v)
    return nodes, rates, body, still_or(batch, e, v), at, axis


@beginning(Touching)
def still_or(batch, e, v):
    """Rates of the place and the directions of what carries a surface; zero on the ground."""
    if batch.base[e, NODES] < 0:
        return ZERO, ZERO, ZERO, ZERO
    return carrier(batch, e, v)


@beginning(Touching)
def place_on(batch, e, p, nodes):
    """Position of point p of row e from its four vectors, or its velocity from their rates."""
    s, (a, b, c, d) = batch.shape[e, p], nodes
    return (
        s[0] * a[0] + s[1] * b[0] + s[2] * c[0] + s[3] * d[0],
        s[0] * a[1] + s[1] * b[1] + s[2] * c[1] + s[3] * d[1],
        s[0] * a[2] + s[1] * b[2] + s[2] * c[2] + s[3] * d[2],
    )


@inline_kernel
def in_body(body, r):
    """Place in body axes."""
    c, a, b, d = body
    x = r[0] - c[0], r[1] - c[1], r[2] - c[2]
    return dot(x, a), dot(x, b), dot(x, d)


@beginning(Touching)
def first_node(batch, e, q):
    """Place of the first node of a row, in the axes of what carries the surface."""
    r = at_slot(q, np.uint64(batch.base[e, 0]))
    if batch.base[e, NODES] < 0:
        return r
    return in_body(carrier(batch, e, q), r)


@beginning(Touching)
def reach_of(batch, e, q):
    """Radius of a ball about the first node of a row, with the radius of the beam, that holds all its points.

    With the factors S_k of the points in q_k, r_0 the first node, sum |S_k| |q_k - r_0|, or |q_k| of a
    slope, bounds it; the sum of the sizes of the components bounds the size of a vector.
    """
    nodes = nodes_of(batch, e, q)
    r, reach = nodes[0], batch.data[batch.contact[e], RADIUS]
    for k in range(1, NODES):
        w, x = batch.reach[e, k], nodes[k]
        if w > 0.0:
            reach += w * (abs(x[0]) + abs(x[1]) + abs(x[2]))
        else:
            reach -= w * (abs(x[0] - r[0]) + abs(x[1] - r[1]) + abs(x[2] - r[2]))
    return reach


@beginning(Touching)
def is_far(batch, e, q):
    """Whether no point of a row can touch: its first node has not left the ball in which none does."""
    i, far = np.uint64(batch.base[e, 0]), batch.far[e]
    if batch.base[e, NODES] < 0:
        return abs(q[i] - far[0]) + abs(q[i + ONE] - far[1]) + abs(q[i + TWO] - far[2]) < far[ROOM]
    r = first_node(batch, e, q)
    return abs(r[0] - far[0]) + abs(r[1] - far[1]) + abs(r[2] - far[2]) < far[ROOM]


@beginning(Touching)
def look_around(batch, e, q):
    """Whether a row is far; its ball is renewed when half of it is used up.

    One that would leave its ball in a few steps such as the last counts as near.
    """
    r, far = first_node(batch, e, q), batch.far[e]
    gone = abs(r[0] - far[0]) + abs(r[1] - far[1]) + abs(r[2] - far[2])
    way = abs(gone - far[GONE])
    far[GONE] = gone
    if 2.0 * gone < far[ROOM]:
        return gone + STEPS * way < far[ROOM]
    return renew_ball(batch, e, q, r, way)


@beginning(Touching)
def renew_ball(batch, e, q, r, way):
    """Lay the ball of a row about its first node r, which went so far in the last step; whether it is far."""
    far, body = batch.far[e], carrier(batch, e, q)
    at, axis = lie(batch, e, body)
    d, _, _, _, _ = outside(batch, e, 0, body, at, axis, at_slot(q, np.uint64(batch.base[e, 0])))
    far[0], far[1], far[2] = r
    far[ROOM], far[GONE] = d - STRETCHED * reach_of(batch, e, q), 0.0
    return far[ROOM] > STEPS * way


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


@beginning(Touching)
def factor_of(batch, e, p, k, x):
    """Factor of slot k in the place of point p against the surface, which it meets at x in body axes."""
    if k < NODES:
        return batch.shape[e, p, k]
    return -1.0 if k == NODES else -x[k - NODES - 1]


@inline_kernel
def plus(a, s, f):
    """a + s f."""
    return a[0] + s * f[0], a[1] + s * f[1], a[2] + s * f[2]


@inline_kernel
def nothing():
    """The sums of a row without forces: of its four vectors, of the place and the directions of its body."""
    return ZERO, ZERO, ZERO, ZERO, ZERO, ZERO, ZERO, ZERO


@beginning(Touching)
def with_force(batch, e, p, x, f, sums):
    """The sums with a force f per length of the material on point p, at x in body axes of the surface."""
    s, w = batch.shape[e, p], batch.weight[e, p]
    a, b, c, d, o, i, j, k = sums
    return (
        plus(a, w * s[0], f),
        plus(b, w * s[1], f),
        plus(c, w * s[2], f),
        plus(d, w * s[3], f),
        plus(o, -w, f),
        plus(i, -w * x[0], f),
        plus(j, -w * x[1], f),
        plus(k, -w * x[2], f),
    )


@inline_kernel
def take(r, i, f):
    """Subtract a vector from a slot."""
    r[i] -= f[0]
    r[i + ONE] -= f[1]
    r[i + TWO] -= f[2]


@beginning(Touching)
def add_sums(batch, e, sums, nodes, more, q, r):
    """Subtract the forces of a row, and the opposite ones on what it touches, from r.

    Of a cable with a winch see :func:`ancf.contact.reel.add_on_length`, also for ``more``.
    """
    b = batch.base[e]
    if batch.winch[e] >= 0:
        add_on_length(batch, e, nodes, sums, more, r)
        lam = stretched(batch, e, q)
        n0, n1, n2, n3, o, i, j, k = sums
        sums = (
            times(lam, n0),
            times(lam, n1),
            times(lam, n2),
            times(lam, n3),
            times(lam, o),
            times(lam, i),
            times(lam, j),
            times(lam, k),
        )
    take(r, np.uint64(b[0]), sums[0])
    take(r, np.uint64(b[1]), sums[1])
    take(r, np.uint64(b[2]), sums[2])
    take(r, np.uint64(b[3]), sums[3])
    if b[NODES] >= 0:
        take(r, np.uint64(b[NODES]), sums[4])
        take(r, np.uint64(b[NODES + 1]), sums[5])
        take(r, np.uint64(b[NODES + 2]), sums[6])
        take(r, np.uint64(b[NODES + 3]), sums[7])


@beginning(Touching)
def add_pair_block(batch, e, p, x, lam, rows, A):
    """Add a symmetric 3x3 matrix per length, minus the derivative of that force by the way apart, to A.

    ``lam``: length of the material as a multiple of that of the mesh.
    """
    size = NODES if batch.base[e, NODES] < 0 else NODES + BODY
    for k in range(size):
        wk = lam * batch.weight[e, p] * factor_of(batch, e, p, k, x)
        for m in range(size):
            place = batch.dest[e, (NODES + BODY) * k + m]
            if place < 0:  # one half of a symmetric matrix is kept
                continue
            w = wk * factor_of(batch, e, p, m, x)
            for i in range(3):
                for j in range(3):
                    A[np.uint64(place + 6 * i + j)] += w * rows[i][j]


@inline_kernel
def turning(N, n, a, bend, about):
    """Rows of N times the derivative of the normal by the place."""
    b = cross(n, a)
    s, t = N * about, N * bend
    xy, xz = s * a[0] * a[1] + t * b[0] * b[1], s * a[0] * a[2] + t * b[0] * b[2]
    yz = s * a[1] * a[2] + t * b[1] * b[2]
    return (
        (s * a[0] * a[0] + t * b[0] * b[0], xy, xz),
        (xy, s * a[1] * a[1] + t * b[1] * b[1], yz),
        (xz, yz, s * a[2] * a[2] + t * b[2] * b[2]),
    )
