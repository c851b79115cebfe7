"""Friction of cables on cables: elastic-plastic springs with memory, for each cell and cable that it touches.

Of a cell that touches, the middle of the pressure and the place that it meets are one pair of material places
until the end of the next step, rho = r_a - r_b.  With the tangents t_a, t_b, the normal n, the directions

    d_1 ~ t_a +- t_b,   d_2 = n x d_1,

the stretch e that is left of earlier steps, and the rates of slip g_i,

    w_i = k_t (phi_i d_i.rho + e_i) + c_t phi_i g_i,   T = -f (w_1 d_1 + phi_2 w_2 d_2),   |f w| <= limit.

phi_1 = 1.  phi_2 = 1 where the cables cross by 45 degrees or more, and fades to 0 where they are parallel: a
cable has no torsion: nothing but an outside moment could keep parallel ones from rolling on each other.

T and -T have an arm, rho.  Their moment is balanced by moments on the tangents of both cables, m_a normal to
t_a and m_b normal to t_b, the smallest that do: m_a + m_b = -rho x T.  The rates g_i are those with which
these forces and moments do work; they are zero where all moves as one rigid body.  So momentum and angular
momentum are kept whatever the friction is.

Limits are those of the last step, stretches and pairs are memory: they change once for each accepted step.
A pair that slips keeps a stretch of limit/k_t at most: what the damper takes beyond stretches nothing.
All work counts as dissipated; what springs hold while they stick they give back.
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import VECTOR, Role, formula, implements, inline_kernel, kernel
from ..connections.in_matrix import no_pairs, no_places
from ..records import Located, beginning
from ..vectors import dot
from .cross import add_force_on, factors, from_slots, met, not_in_matrix, pressed_at
from .near import look_if_live
from .rubbed import find, nothing_found, share_found
from .strand import (
    CELL,
    CONTACT,
    DRAG,
    ELEMENT,
    FRICTION,
    POINTS,
    REACH,
    START,
    STICK,
    StrandBatch,
    along_cubic,
    cubic,
    find_zones,
    less,
    nearest,
    on_cubic,
)

#: Columns of ``grip`` behind those of element (-1: no more) and cell: element that is met, xi of both, length
#: of cable that presses, m, stretch along and across t_a, m, and limit, N.
OTHER, X, Y, LENGTH, ALONG, ACROSS, LIMIT = range(2, 9)
COLUMNS = 9
#: phi_2 below which it is none, and 1 - cos of an angle between tangents that is none.
NONE, PARALLEL = 1e-6, 1e-10
#: Share of a change of the limits that a round of an equilibrium takes.
TAKEN = 0.4


class GripBatch(StrandBatch):
    """Friction of the elements of a StrandBatch, whose arrays it shares."""

    __slots__ = ()


@inline_kernel
def cross(a, b):
    """Vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@inline_kernel
def plus(a, s, b):
    """a + s b."""
    return a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]


@inline_kernel
def unit(a):
    """Direction of a vector and its size; a zero vector has no direction."""
    size = math.sqrt(dot(a, a))
    s = 1.0 / size if size > 0.0 else 0.0
    return (s * a[0], s * a[1], s * a[2]), size


@inline_kernel
def slopes(x, h):
    """Factors of r, r_x, r, r_x of an element in the derivative of r by xi."""
    y = 1.0 - x
    return -6.0 * x * y, h * y * (1.0 - 3.0 * x), 6.0 * x * y, h * x * (3.0 * x - 2.0)


@beginning(StrandBatch)
def frame(batch, e, x, b, y, q):
    """Of a pair: rho, both tangents, sizes of both derivatives by xi, n, d_1, d_2 and phi_2."""
    ca, cb = cubic(batch, e, q), cubic(batch, b, q)
    rho = less(on_cubic(ca, x), on_cubic(cb, y))
    (ta, size_a), (tb, size_b) = unit(along_cubic(ca, x)), unit(along_cubic(cb, y))
    g = dot(ta, tb)
    side = 1.0 if g >= 0.0 else -1.0
    (d1, _), (aside, wide) = unit(plus(ta, side, tb)), unit(plus(ta, -side, tb))
    crossed = min(1.0, 2.0 * (1.0 - g * g))
    phi = crossed * crossed * (3.0 - 2.0 * crossed)
    if phi < NONE or wide == 0.0:
        phi = 0.0
    n = plus(plus(rho, -dot(rho, d1), d1), -phi * dot(rho, aside), aside)
    n, _ = unit(n)
    return rho, ta, tb, size_a, size_b, n, d1, cross(n, d1), phi


@inline_kernel
def own_axes(ta, n):
    """Directions along and across t_a, normal to n, in which the stretch is kept."""
    along, _ = unit(plus(ta, -dot(ta, n), n))
    return along, cross(n, along)


@inline_kernel
def balanced(d, rho, ta, tb, size_a, size_b):
    """Forces on the derivatives by xi of both cables that balance the moment of d on one, -d on the other."""
    c = cross(d, rho)  # - rho x d
    g, x, y = dot(ta, tb), -0.5 * dot(c, ta), 0.5 * dot(c, tb)
    s = 0.5 * (x + y) / (1.0 + g) if 1.0 + g > PARALLEL else 0.0
    t = 0.5 * (x - y) / (1.0 - g) if 1.0 - g > PARALLEL else 0.0
    z = plus((0.0, 0.0, 0.0), s + t, ta)
    z = plus(z, s - t, tb)
    half = (0.5 * c[0], 0.5 * c[1], 0.5 * c[2])
    zero = (0.0, 0.0, 0.0)
    pa, pb = cross(plus(half, 1.0, z), ta), cross(plus(half, -1.0, z), tb)
    return plus(zero, 1.0 / size_a, pa), plus(zero, 1.0 / size_b, pb)


@beginning(StrandBatch)
def rate(batch, e, x, b, y, d, pa, pb, v):
    """Rate with which a unit of friction along d does work."""
    h, k = batch.length[e], batch.length[b]
    u = less(from_slots(batch, e, factors(x, h), v), from_slots(batch, b, factors(y, k), v))
    return (
        dot(d, u)
        + dot(pa, from_slots(batch, e, slopes(x, h), v))
        + dot(pb, from_slots(batch, b, slopes(y, k), v))
    )


@beginning(StrandBatch)
def add_friction(batch, e, x, b, y, f, d, pa, pb, r):
    """Subtract a friction f along d from the residual r."""
    h, k = batch.length[e], batch.length[b]
    add_force_on(batch, e, factors(x, h), (f * d[0], f * d[1], f * d[2]), r)
    add_force_on(batch, b, factors(y, k), (-f * d[0], -f * d[1], -f * d[2]), r)
    add_force_on(batch, e, slopes(x, h), (f * pa[0], f * pa[1], f * pa[2]), r)
    add_force_on(batch, b, slopes(y, k), (f * pb[0], f * pb[1], f * pb[2]), r)


@beginning(StrandBatch)
def springs(batch, g):
    """Stiffness and damping of a row of ``grip``, N/m and N s/m."""
    data = batch.data[batch.law[batch.cable[int(g[ELEMENT])], batch.cable[int(g[OTHER])]]]
    return g[LENGTH] * data[STICK], g[LENGTH] * data[DRAG]


@beginning(StrandBatch)
def drawn(batch, g, q, v):
    """Of a row of ``grip``: both w, the factor f, whether it slips, directions with their moments, phi_2."""
    e, b, x, y = int(g[ELEMENT]), int(g[OTHER]), g[X], g[Y]
    rho, ta, tb, size_a, size_b, n, d1, d2, phi = frame(batch, e, x, b, y, q)
    along, across = own_axes(ta, n)
    held = plus((g[ALONG] * along[0], g[ALONG] * along[1], g[ALONG] * along[2]), g[ACROSS], across)
    k, c = springs(batch, g)
    pa1, pb1 = balanced(d1, rho, ta, tb, size_a, size_b)
    w1 = k * (dot(d1, rho) + dot(d1, held)) + c * rate(batch, e, x, b, y, d1, pa1, pb1, v)
    pa2, pb2, w2 = pa1, pb1, k * dot(d2, held)
    if phi > 0.0:
        pa2, pb2 = balanced(d2, rho, ta, tb, size_a, size_b)
        w2 += phi * (k * dot(d2, rho) + c * rate(batch, e, x, b, y, d2, pa2, pb2, v))
    else:
        w2 = 0.0
    size = math.sqrt(w1 * w1 + w2 * w2)
    slips = size > g[LIMIT]
    f = g[LIMIT] / size if slips else 1.0
    return w1, w2, f, slips, d1, pa1, pb1, d2, pa2, pb2, phi


@formula
def rows_of(batch):
    """Number of rows of ``grip``."""
    m = 0
    while batch.grip[m, ELEMENT] >= 0.0:
        m += 1
    return m


@inline_kernel
def grip_force(batch, q, v, a, r, ws):
    """Subtract the friction from r."""
    for m in range(rows_of(batch)):
        g = batch.grip[m]
        if g[LIMIT] == 0.0:
            continue
        e, b = int(g[ELEMENT]), int(g[OTHER])
        w1, w2, f, _, d1, pa1, pb1, d2, pa2, pb2, phi = drawn(batch, g, q, v)
        add_friction(batch, e, g[X], b, g[Y], -f * w1, d1, pa1, pb1, r)
        if phi > 0.0:
            add_friction(batch, e, g[X], b, g[Y], -f * w2 * phi, d2, pa2, pb2, r)


@beginning(StrandBatch)
def left_over(batch, g, q, v):
    """Stretch of a row after a step, along and across t_a."""
    e, b = int(g[ELEMENT]), int(g[OTHER])
    _, _, _, slips, d1, _, _, d2, _, _, phi = drawn(batch, g, q, v)
    rho, ta, _, _, _, n, _, _, _ = frame(batch, e, g[X], b, g[Y], q)
    along, across = own_axes(ta, n)
    k, _ = springs(batch, g)
    held = plus((g[ALONG] * along[0], g[ALONG] * along[1], g[ALONG] * along[2]), g[ACROSS], across)
    x, y = dot(d1, rho) + dot(d1, held), phi * dot(d2, rho) + dot(d2, held)
    if phi == 0.0:
        y = 0.0
    pull = k * math.sqrt(x * x + y * y)
    if slips and pull > g[LIMIT]:
        x, y = x * g[LIMIT] / pull, y * g[LIMIT] / pull
    return x * dot(d1, along) + y * dot(d2, along), x * dot(d1, across) + y * dot(d2, across)


@beginning(StrandBatch)
def take_over(batch, count, q, v, moves):
    """Copy the rows to ``older``, with stretches after the step where it moves the pairs; their number."""
    rows = rows_of(batch)
    for m in range(rows):
        g, o = batch.grip[m], batch.older[m]
        for c in range(COLUMNS):
            o[c] = g[c]
        if moves and g[LIMIT] > 0.0:
            o[ALONG], o[ACROSS] = left_over(batch, g, q, v)
    return rows


@beginning(StrandBatch)
def same_place(batch, z, b, y, rows):
    """Row of ``older`` of the same cell and the same place of the other cable, or -1."""
    zone = batch.zone[z]
    for m in range(rows):
        o = batch.older[m]
        if o[ELEMENT] != zone[ELEMENT] or o[CELL] != zone[CELL]:
            continue
        other = int(o[OTHER])
        way = batch.place[other] + o[Y] * batch.length[other] - batch.place[b] - y * batch.length[b]
        if batch.cable[other] == batch.cable[b] and abs(way) < zone[REACH]:
            return m
    return -1


@beginning(StrandBatch)
def pressed_middle(batch, z, q, v):
    """Force of a zone, xi of its middle, and the length that presses."""
    force, middle, length = 0.0, 0.0, 0.0
    for p in range(POINTS):
        x, weight, _, _, _, _ = met(batch, z, p, q)
        _, _, _, _, _, _, N, _, _ = pressed_at(batch, z, p, q, v)
        force, middle, length = force + N, middle + N * x, length + weight
    return force, (middle / force if force > 0.0 else 0.0), length


@beginning(StrandBatch)
def start_pair(batch, g, stretch, q):
    """Let a row begin at its pair with a stretch along and across t_a, from which nothing is to be added."""
    e, b = int(g[ELEMENT]), int(g[OTHER])
    rho, ta, _, _, _, n, d1, d2, phi = frame(batch, e, g[X], b, g[Y], q)
    along, across = own_axes(ta, n)
    x, y = dot(d1, rho), phi * dot(d2, rho)
    g[ALONG] = stretch[0] - x * dot(d1, along) - y * dot(d2, along)
    g[ACROSS] = stretch[1] - x * dot(d1, across) - y * dot(d2, across)


@beginning(StrandBatch)
def renew(batch, q, v, moves, taken):
    """Rows for what touches now; returns the largest change of a limit and the largest limit.

    Where it ``moves`` the pairs are those of the state, else they stay where they are.
    """
    look_if_live(batch, q)
    count, change, most = find_zones(batch, q), 0.0, 0.0
    rows, n = take_over(batch, count, q, v, moves), 0
    for z in range(count):
        zone = batch.zone[z]
        mu = batch.data[int(zone[CONTACT]), FRICTION]
        force, x, length = pressed_middle(batch, z, q, v)
        if force <= 0.0 or mu == 0.0 or n + 1 >= batch.grip.shape[0]:
            continue
        r = on_cubic(cubic(batch, int(zone[ELEMENT]), q), x)
        b, y = nearest(batch, q, r, int(zone[START]))
        o, g = same_place(batch, z, b, y, rows), batch.grip[n]
        before = batch.older[o, LIMIT] if o >= 0 else 0.0
        if o >= 0 and not moves:
            for c in range(COLUMNS):
                g[c] = batch.older[o, c]
        else:
            g[ELEMENT], g[CELL], g[OTHER], g[X], g[Y] = zone[ELEMENT], zone[CELL], b, x, y
            stretch = (0.0, 0.0)
            if o >= 0 and before > 0.0:
                stretch = batch.older[o, ALONG], batch.older[o, ACROSS]
            start_pair(batch, g, stretch, q)
        g[LENGTH], g[LIMIT] = length, before + taken * (mu * force - before)
        change, most = max(change, abs(mu * force - before)), max(most, mu * force)
        n += 1
    batch.grip[n, ELEMENT] = -1.0
    return change, most


@inline_kernel
def grip_remember(batch, q, v):
    """Bring pairs, stretches and limits up to the state of an accepted step; ``found`` keeps what acted."""
    grip_measure(batch, q, v)
    renew(batch, q, v, True, 1.0)


@inline_kernel
def grip_measure(batch, q, v):
    """Fill ``found`` for the state (q, v), with the limits that acted in it."""
    nothing_found(batch)
    for m in range(rows_of(batch)):
        g = batch.grip[m]
        if g[LIMIT] == 0.0:
            continue
        j = batch.law[batch.cable[int(g[ELEMENT])], batch.cable[int(g[OTHER])]]
        w1, w2, f, slips, _, _, _, _, _, _, phi = drawn(batch, g, q, v)
        force = f * math.sqrt(w1 * w1 + (phi * w2) ** 2)
        find(batch, j, force, slips)
    share_found(batch)


@kernel
def renew_limits(batch, q, v):
    """See :func:`renew`, for an equilibrium: the pairs are those of the initial shape."""
    return renew(batch, q, v, False, TAKEN)


def let_rub(batch, q):
    """Renew the limits in an equilibrium; returns their relative change."""
    change, most = renew_limits(Located(batch), q, np.zeros_like(q))
    return change / most if most > 0.0 else 0.0


def stick(batch):
    """Let friction hold what it acts on."""
    batch.grip[batch.grip[:, LIMIT] > 0.0, LIMIT] = np.inf


implements(
    GripBatch,
    force=grip_force,
    tangent=not_in_matrix,
    remember=grip_remember,
    measure=grip_measure,
    couples=no_pairs,
    bind=no_places,
    role=Role.RUBS | Role.MEASURES,
    memory=("grip", "found"),
    late=lambda batch: let_rub,
    stick=stick,
    resting=((renew_limits, (VECTOR, VECTOR)),),
)
