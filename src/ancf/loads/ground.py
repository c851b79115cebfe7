"""Forces of grounds, per reference length, on points along bodies: spring, damper, friction that sticks.

With the depth g of the axis below the ground and its rate, d the diameter of the section, n the normal,

    N = d max(0, k g + c min(1, g/(SOFT d)) dg/dt)   for g > 0, else 0,

which never pulls; the damping comes on over a hundredth of the diameter, so that the force is continuous.
Friction is an elastic-plastic spring along the ground,

    T = -d k_t u,  u = P (r - anchor),   cut to |T| <= mu N,

where P projects on the ground.  The anchor is where the spring has no force: a point that does not touch
takes it along, one that slips drags it at the distance mu N/(d k_t).  It is memory: it changes once for each
accepted step, see ``ground_remember``.  In an equilibrium the anchors are the places of the initial shape, so
that friction opposes the way from there, whatever the load steps are; it comes on last.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import Role, implements, inline_kernel
from ..errors import ModelError
from ..model.beam import Beam
from ..model.fluids import require_section
from ..model.grounds import Relief
from ..model.points import initial_position
from .along import add_along, add_block_along, along, place_at

#: Gauss points of an element.
POINTS = 10
# columns of ``grounds``: a point of the plane, its normal, k, c, mu, k_t
PLACE, NORMAL, STIFFNESS, DAMPING, FRICTION, STICK = 0, 3, 6, 7, 8, 9
#: Depth in diameters over which damping comes on.
SOFT = 0.01
#: Depth in diameters, below which nothing may be held.
BURIED = 1.0


class GroundBatch(NamedTuple):
    """All elements on all grounds."""

    base: NDArray[np.int64]  # (n, k)
    dest: NDArray[np.int64]  # (n, k*k)
    shape: FloatArray  # (n, points, k)
    slope: FloatArray  # (n, points, k)
    weight: FloatArray  # (n, points) m
    ground: NDArray[np.int64]  # (n,) which ground
    diameter: FloatArray  # (n,)
    grounds: FloatArray  # (m, 10) columns PLACE ... STICK
    size: NDArray[np.int64]  # (m, 3) numbers of x and y of a table of heights, 0: a plane; its first number
    table: FloatArray  # (j,) x, y and z of the tables, one after the other
    anchor: FloatArray  # (n, points, 3) memory: where friction has no force
    rubs: FloatArray  # (1,) share of the friction, 1 but in the load steps of an equilibrium


def build(items, locate, value, model):
    """Batch of these grounds; ModelError if a section has no diameter, or a support is below."""
    pairs = []
    for k, item in enumerate(items):
        for name, body in model.bodies.items():
            if isinstance(body, Beam) and item.acts_on(name):
                require_section(item, body, ("diameter",))
                _refuse_buried(item, body, model)
                pairs.append((k, body))
    fields, owners = along([body for _, body in pairs], locate, POINTS)
    which = [k for k, body in pairs for _ in range(body.elements)]
    tables = [_table(item) for item in items]
    starts = np.cumsum([0, *(len(table) for _, _, table in tables)])
    return GroundBatch(
        **fields,
        ground=np.array(which, dtype=np.int64),
        diameter=np.array([body.section.diameter for body in owners], dtype=np.float64),
        grounds=np.array([_numbers(item) for item in items]),
        size=np.array([[t[0], t[1], s] for t, s in zip(tables, starts[:-1], strict=True)], dtype=np.int64),
        table=np.concatenate([t[2] for t in tables]),
        anchor=np.zeros((len(owners), POINTS, 3)),
        rubs=np.ones(1),
    )


def _numbers(item):
    height = 0.0 if isinstance(item.height, Relief) else item.height
    stick = item.stiffness if item.stick is None else item.stick
    return [0.0, 0.0, height, *item.up, item.stiffness, item.damping, item.friction, stick]


def _table(item):
    if not isinstance(item.height, Relief):
        return 0, 0, np.zeros(0)
    x, y, z = item.height.x, item.height.y, item.height.z
    return len(x), len(y), np.concatenate([x, y, z.ravel()])


def _refuse_buried(item, body, model):
    for support in model.supports:
        if support.point.body is body:
            depth = item.depth(initial_position(support.point))
            if depth > BURIED * body.section.diameter:
                what = f'"{support.name}" is {depth:.4g} m below the ground "{item.name}"'
                raise ModelError(item.name, what, "lower the ground, or raise the point that is held")


@inline_kernel
def interval(table, first, count, x):
    """The place k of x between the numbers ``table[first:first + count]``, and its share of the way on."""
    if x <= table[first]:
        return 0, 0.0, 0.0
    if x >= table[first + count - 1]:
        return count - 2, 1.0, 0.0
    a, b = first, first + count - 1
    while b - a > 1:
        middle = (a + b) // 2
        if table[middle] <= x:
            a = middle
        else:
            b = middle
    length = table[a + 1] - table[a]
    return a - first, (x - table[a]) / length, 1.0 / length


@inline_kernel
def depth_at(batch, k, x, y, z):
    """Depth of a place below ground k and its normal there."""
    ground = batch.grounds[k]
    nx, ny, first = batch.size[k, 0], batch.size[k, 1], batch.size[k, 2]
    if nx == 0:
        n = ground[NORMAL], ground[NORMAL + 1], ground[NORMAL + 2]
        return (ground[PLACE] - x) * n[0] + (ground[PLACE + 1] - y) * n[1] + (ground[PLACE + 2] - z) * n[2], n
    i, s, ds = interval(batch.table, first, nx, x)
    j, t, dt = interval(batch.table, first + nx, ny, y)
    at = first + nx + ny + i * ny + j
    z00, z01, z10, z11 = batch.table[at], batch.table[at + 1], batch.table[at + ny], batch.table[at + ny + 1]
    low, high = z00 + t * (z01 - z00), z10 + t * (z11 - z10)
    zx, zy = (high - low) * ds, ((1.0 - s) * (z01 - z00) + s * (z11 - z10)) * dt
    c = 1.0 / math.sqrt(1.0 + zx * zx + zy * zy)
    return (low + s * (high - low) - z) * c, (-zx * c, -zy * c, c)


@inline_kernel
def pressure(ground, d, g, rate):
    """Normal force N per length and its derivatives by g and by the rate of g."""
    if g <= 0.0:
        return 0.0, 0.0, 0.0
    full = SOFT * d
    on = min(1.0, g / full)
    N = ground[STIFFNESS] * g + ground[DAMPING] * on * rate
    if N <= 0.0:
        return 0.0, 0.0, 0.0
    slope = ground[STIFFNESS] + (max(ground[DAMPING] * rate, 0.0) / full if on < 1.0 else 0.0)
    return d * N, d * slope, d * ground[DAMPING] * on


@inline_kernel
def stretch_at(batch, e, p, n, x, y, z):
    """Way from the anchor along the ground, and its length."""
    ux, uy, uz = x - batch.anchor[e, p, 0], y - batch.anchor[e, p, 1], z - batch.anchor[e, p, 2]
    un = ux * n[0] + uy * n[1] + uz * n[2]
    u = ux - un * n[0], uy - un * n[1], uz - un * n[2]
    return u, math.sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2])


@inline_kernel
def touch_at(batch, e, p, q, v):
    """Place, normal and normal force with its derivatives at point p of row e."""
    k = batch.ground[e]
    x, y, z = place_at(batch, e, p, q)
    g, n = depth_at(batch, k, x, y, z)
    rate = 0.0
    if g > 0.0:
        vx, vy, vz = place_at(batch, e, p, v)
        rate = -(vx * n[0] + vy * n[1] + vz * n[2])
    N, by_g, by_rate = pressure(batch.grounds[k], batch.diameter[e], g, rate)
    return (x, y, z), n, N, by_g, by_rate


@inline_kernel
def friction_at(batch, e, p, r, n, N):
    """Way from the anchor, its length, and the stiffness s of the force -s u, cut to mu N."""
    ground = batch.grounds[batch.ground[e]]
    u, length = stretch_at(batch, e, p, n, r[0], r[1], r[2])
    stiffness, most = batch.diameter[e] * ground[STICK], batch.rubs[0] * ground[FRICTION] * N
    if stiffness * length > most:
        return u, length, most / length, True
    return u, length, stiffness, False


@inline_kernel
def ground_force(batch, q, v, a, r, ws):
    """Subtract the forces of the grounds from r."""
    for e in range(batch.base.shape[0]):
        rubs = batch.rubs[0] * batch.grounds[batch.ground[e], FRICTION] > 0.0
        for p in range(batch.weight.shape[1]):
            at, n, N, _, _ = touch_at(batch, e, p, q, v)
            if N == 0.0:
                continue
            fx, fy, fz = N * n[0], N * n[1], N * n[2]
            if rubs:
                u, _, s, _ = friction_at(batch, e, p, at, n, N)
                fx, fy, fz = fx - s * u[0], fy - s * u[1], fz - s * u[2]
            add_along(batch, e, p, fx, fy, fz, r)


@inline_kernel
def ground_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add the symmetric part that does not come from the normal force in the friction."""
    for e in range(batch.base.shape[0]):
        rubs = batch.rubs[0] * batch.grounds[batch.ground[e], FRICTION] > 0.0
        for p in range(batch.weight.shape[1]):
            at, n, N, by_g, by_rate = touch_at(batch, e, p, q, v)
            if N == 0.0:
                continue
            nn = c_stiffness * by_g + c_damping * by_rate
            one, uu = 0.0, 0.0
            u = 0.0, 0.0, 0.0
            if rubs:
                u, length, s, slips = friction_at(batch, e, p, at, n, N)
                one = c_stiffness * s
                if slips:
                    uu = -one / (length * length)
            nn -= one
            xy = nn * n[0] * n[1] + uu * u[0] * u[1]
            xz = nn * n[0] * n[2] + uu * u[0] * u[2]
            yz = nn * n[1] * n[2] + uu * u[1] * u[2]
            rows = (
                (one + nn * n[0] * n[0] + uu * u[0] * u[0], xy, xz),
                (xy, one + nn * n[1] * n[1] + uu * u[1] * u[1], yz),
                (xz, yz, one + nn * n[2] * n[2] + uu * u[2] * u[2]),
            )
            add_block_along(batch, e, p, rows, A)


@inline_kernel
def ground_remember(batch, q, v):
    """Move the anchors to where the friction of the state q, v leaves them."""
    for e in range(batch.base.shape[0]):
        for p in range(batch.weight.shape[1]):
            at, n, N, _, _ = touch_at(batch, e, p, q, v)
            anchor = batch.anchor[e, p]
            if N == 0.0:
                anchor[0], anchor[1], anchor[2] = at
                continue
            u, _, s, slips = friction_at(batch, e, p, at, n, N)
            if slips:
                keep = s / (batch.diameter[e] * batch.grounds[batch.ground[e], STICK])
                anchor[0], anchor[1], anchor[2] = (
                    at[0] - keep * u[0],
                    at[1] - keep * u[1],
                    at[2] - keep * u[2],
                )


def bring_on(batch, share):
    """Let a share of the friction act."""
    batch.rubs[0] = share


implements(
    GroundBatch,
    force=ground_force,
    tangent=ground_tangent,
    remember=ground_remember,
    role=Role.EXTERNAL,
    memory=("anchor",),
    follows=lambda batch: False,
    late=lambda batch: bring_on if np.any(batch.grounds[:, FRICTION]) else None,
)
