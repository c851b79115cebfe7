"""Forces of grounds, per reference length, on points along bodies: spring, damper, friction that sticks.

With the depth g of the axis below the ground, d the diameter of the section, n the normal,

    N = d max(0, k g + c on(g) dg/dt),   on = 0 for g < -SOFT d, 1 for g > 0, linear between,

which never pulls.  The damping comes on in the last hundredth of a diameter above the ground, so that the
force is continuous and what lies there is damped.  Friction is an elastic-plastic spring with a damper along
the ground,

    T = -d w,   w = P (k_t (r - anchor) + c_t v),   cut to |T| <= limit,   limit = mu N of the last step,

where P projects on the ground and c_t = c sqrt(k_t/k) is the same share of the critical damping.  The anchor
is where the spring has no force: a point that does not touch takes it along, one that slips drags it at the
distance limit/(d k_t), as soon as the spring alone is that long: what the damper takes beyond the limit
stretches nothing.  Anchors and limits are memory: they change once for each accepted step, see
``ground_remember``.  A limit that is that of the step before keeps the matrix symmetric and the iteration
stable.  In an equilibrium the anchors are the places of the initial shape, so that friction opposes the way
from there, whatever the load steps are; it comes on last, with limits that are renewed until they fit.

Along a cable with a winch the material takes its anchors along: what is at X was at X' = X lam'/lam at the
last accepted step.  With xi = r - anchor and the length L' of that step the anchor of a point is

    anchor(X', L') = anchor + (L/L' - 1) drift,     drift = X d(r - xi)/dX,

where r has its slope, and xi the difference to the point from which the material comes.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import Role, formula, implements, inline_kernel, kernel, traits
from ..errors import ModelError
from ..model.bodies.beam import Beam
from ..model.points import initial_position
from ..model.surroundings.fluids import require_section
from ..model.surroundings.grounds import Relief
from ..records import Located
from .along import (
    add_block_along,
    add_material,
    along,
    let_stick,
    ordered,
    passed,
    place_at,
    scaled,
    stretch_at,
    upstream,
    wound,
)
from .ground_along import (
    ground_choice,
    ground_memory_slopes,
    ground_remember_along,
    ground_slopes_along,
    ground_slopes_beside,
)
from .ground_numbers import NUMBERED, ground_changes, ground_memory_changes, kinds_of, numbers
from .ground_points import anchor_at, drawn_at, left_at, touch_at
from .ground_slopes import (
    ground_memory_back,
    ground_memory_work,
    ground_number_work,
    ground_work_slopes,
)
from .relief import DRAG, FRICTION, STICK

#: Gauss points of an element.
POINTS = 10
#: Fields that depend on the lengths of elements.
SHAPES = ("weight", "shift", "shape", "slope")
#: Depth in diameters, below which nothing may be held.
BURIED = 1.0


class GroundBatch(NamedTuple):
    """All elements on all grounds."""

    base: NDArray[np.int64]  # (n, k)
    dest: NDArray[np.int64]  # (n, k*k)
    shape: FloatArray  # (n, points, k)
    slope: FloatArray  # (n, points, k)
    weight: FloatArray  # (n, points) m
    shift: FloatArray  # (n, points) m
    winch: NDArray[np.int64]  # (n,) see loads/along.py
    unwound: FloatArray  # (n,) 1/m
    passing: FloatArray  # (n, points, k)
    twice: FloatArray  # (n, points, k)
    label: FloatArray  # (n, points) X of cables with a winch, m
    beside: NDArray[np.int64]  # (n, 2) rows that go on towards the far end and the winch, -1: none
    ground: NDArray[np.int64]  # (n,) which ground
    diameter: FloatArray  # (n,)
    grounds: FloatArray  # (m, 11) columns PLACE ... DRAG
    size: NDArray[np.int64]  # (m, 3) numbers of x and y of a table of heights, 0: a plane; its first number
    table: FloatArray  # (j,) x, y and z of the tables, one after the other
    anchor: FloatArray  # (n, points, 3) memory: where friction has no force
    limit: FloatArray  # (n, points) memory: largest friction, N/m; negative: it has that size, see drawn_at
    drift: FloatArray  # (n, points, 3) memory: by how much anchors move with the length; no rows: no winch
    since: FloatArray  # (n,) memory: length at the last accepted step, m, 0: none; no rows as well


def build(items, locate, value, model):
    """Batch of these grounds; ModelError if a section has no diameter, or a support is below."""
    pairs = []
    for k, item in enumerate(items):
        for body in _bodies(item, model):
            require_section(item, body, ("diameter",))
            _refuse_buried(item, body, model)
            pairs.append((k, body))
    bodies = [body for _, body in pairs]
    fields, owners = along(bodies, locate, POINTS)
    which = [k for k, body in pairs for _ in range(body.elements)]
    tables = [_table(item) for item in items]
    starts = np.cumsum([0, *(len(table) for _, _, table in tables)])
    winches = wound(bodies, locate, POINTS)
    moved = len(winches["passing"])
    return GroundBatch(
        **fields,
        **winches,
        **ordered(bodies, locate, POINTS),
        ground=np.array(which, dtype=np.int64),
        diameter=np.array([body.section.diameter for body in owners], dtype=np.float64),
        grounds=np.array([_numbers(item) for item in items]),
        size=np.array([[t[0], t[1], s] for t, s in zip(tables, starts[:-1], strict=True)], dtype=np.int64),
        table=np.concatenate([t[2] for t in tables]),
        anchor=np.zeros((len(owners), POINTS, 3)),
        limit=np.zeros((len(owners), POINTS)),
        drift=np.zeros((moved, POINTS, 3)),
        since=np.zeros(moved),
    )


def renumbered(batch: Any, model: Any, locate: Any = None) -> Any:
    """The batch of a model that differs in numbers of grounds and in diameters alone.

    ``locate``: finds the probe of a point where lengths of beams differ as well.  What friction remembers is
    its own.
    """
    items, own = model.grounds, {key: getattr(batch, key).copy() for key in traits(batch).memory}
    bodies = [body for item in items for body in _bodies(item, model)]
    if locate is not None:
        found = along(bodies, locate, POINTS)[0] | ordered(bodies, locate, POINTS)
        own |= {key: found[key] for key in (*SHAPES, "label")}
    each = [body.section.diameter for body in bodies for _ in range(body.elements)]
    return batch._replace(
        grounds=np.array([_numbers(item) for item in items]),
        diameter=np.array(each, dtype=np.float64),
        **own,
    )


def _bodies(item, model):
    """Those that a ground acts on."""
    each = model.bodies.items()
    return [body for name, body in each if isinstance(body, Beam) and item.acts_on(name)]


def _numbers(item):
    height = 0.0 if isinstance(item.height, Relief) else item.height
    stick = item.stiffness if item.stick is None else item.stick
    drag = item.damping * math.sqrt(stick / item.stiffness)
    return [0.0, 0.0, height, *item.up, item.stiffness, item.damping, item.friction, stick, drag]


def _table(item):
    if not isinstance(item.height, Relief):
        return 0, 0, np.zeros(0)
    x, y, z = item.height.x, item.height.y, item.height.z
    return len(x), len(y), np.concatenate([x, y, z.ravel()])


def _refuse_buried(item, body, model):
    for support in model.supports:
        if support.held and support.point.body is body:
            depth = item.depth(initial_position(support.point))
            if depth > BURIED * body.section.diameter:
                what = f'"{support.name}" is {depth:.4g} m below the ground "{item.name}"'
                raise ModelError(item.name, what, "lower the ground, or raise the point that is held")


@inline_kernel
def ground_force(batch, q, v, a, r, ws):
    """Subtract the forces of the grounds from r."""
    for e in range(batch.base.shape[0]):
        for p in range(batch.weight.shape[1]):
            at, u, n, N, _, _ = touch_at(batch, e, p, q, v)
            if batch.limit[e, p] != 0.0:
                w, _, f, _ = drawn_at(batch, e, p, q, at, u, n)
                f0, f1, f2 = N * n[0] - f * w[0], N * n[1] - f * w[1], N * n[2] - f * w[2]
                add_material(batch, e, p, f0, f1, f2, q, r)
            elif N > 0.0:
                add_material(batch, e, p, N * n[0], N * n[1], N * n[2], q, r)


@inline_kernel
def ground_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add minus the derivatives by position and velocity."""
    for e in range(batch.base.shape[0]):
        ground = batch.grounds[batch.ground[e]]
        for p in range(batch.weight.shape[1]):
            at, u, n, N, by_g, by_rate = touch_at(batch, e, p, q, v)
            if N == 0.0 and batch.limit[e, p] == 0.0:
                continue
            nn, one, ww = c_stiffness * by_g + c_damping * by_rate, 0.0, 0.0
            w = 0.0, 0.0, 0.0
            if batch.limit[e, p] != 0.0:
                w, size, f, slips = drawn_at(batch, e, p, q, at, u, n)
                one = f * (c_stiffness * ground[STICK] + c_damping * ground[DRAG])
                if slips:
                    ww = -one / (size * size)
            nn -= one
            xy = nn * n[0] * n[1] + ww * w[0] * w[1]
            xz = nn * n[0] * n[2] + ww * w[0] * w[2]
            yz = nn * n[1] * n[2] + ww * w[1] * w[2]
            rows = (
                (one + nn * n[0] * n[0] + ww * w[0] * w[0], xy, xz),
                (xy, one + nn * n[1] * n[1] + ww * w[1] * w[1], yz),
                (xz, yz, one + nn * n[2] * n[2] + ww * w[2] * w[2]),
            )
            add_block_along(batch, e, p, scaled(stretch_at(batch, e, q), rows), A)


@inline_kernel
def ground_remember(batch, q, v):
    """Move the anchors to where the friction of the state q, v leaves them, and renew the limits."""
    for e in range(batch.base.shape[0]):
        ground = batch.grounds[batch.ground[e]]
        for p in range(batch.weight.shape[1]):
            at, u, n, N, _, _ = touch_at(batch, e, p, q, v)
            stick = ground[STICK]
            w, _, f, yields = left_at(batch, e, p, q, at, u, n)
            x, y, z = anchor_at(batch, e, p, q)
            if yields or N == 0.0:
                keep = f / (batch.diameter[e] * stick) if N > 0.0 else 0.0
                x, y, z = at[0] - keep * w[0], at[1] - keep * w[1], at[2] - keep * w[2]
            batch.anchor[e, p, 0], batch.anchor[e, p, 1], batch.anchor[e, p, 2] = x, y, z
            batch.limit[e, p] = ground[FRICTION] * N
    for e in range(batch.since.shape[0]):
        if batch.winch[e] >= 0:
            follow_material(batch, e, q, v)


@formula
def follow_material(batch, e, q, v):
    """How the anchors of row e move with the length from here on."""
    i = batch.winch[e]
    batch.since[e] = q[i]
    comes = 1 if v[i] > 0.0 else 0  # from the far end or from the winch
    for p in range(batch.weight.shape[1]):
        other, m = upstream(batch, e, p, comes)
        X, at, own = batch.label[e, p], place_at(batch, e, p, q), batch.anchor[e, p]
        slope = passed(batch.base, batch.passing, e, p, q)
        for c in range(3):
            xi, change = at[c] - own[c], 0.0
            if other >= 0:
                there = place_at(batch, other, m, q)
                change = (xi - there[c] + batch.anchor[other, m, c]) / (X - batch.label[other, m])
            elif comes == 1:  # what enters has not touched the ground
                change = -xi / (math.copysign(1.0 / batch.unwound[e], X) - X)
            batch.drift[e, p, c] = slope[c] - X * change


@kernel
def renew_limits(batch, q, v):
    """Limits of the friction from the state q, v; returns their largest change and the largest of them."""
    change, most = 0.0, 0.0
    for e in range(batch.base.shape[0]):
        for p in range(batch.weight.shape[1]):
            _, _, _, N, _, _ = touch_at(batch, e, p, q, v)
            limit = batch.grounds[batch.ground[e], FRICTION] * N
            change = max(change, abs(limit - batch.limit[e, p]))
            most = max(most, limit)
            batch.limit[e, p] = limit
    return change, most


def let_rub(batch, q):
    """Renew the limits in an equilibrium; returns their relative change."""
    change, most = renew_limits(Located(batch), q, np.zeros_like(q))
    return change / most if most > 0.0 else 0.0


@kernel
def lie_down(batch, q):
    """The anchors to where the points are, without friction so far."""
    for e in range(batch.base.shape[0]):
        for p in range(batch.weight.shape[1]):
            at = place_at(batch, e, p, q)
            batch.anchor[e, p, 0], batch.anchor[e, p, 1], batch.anchor[e, p, 2] = at[0], at[1], at[2]
            batch.limit[e, p] = 0.0


def lay(batch, q):
    """Let friction hold from the state q on."""
    lie_down(Located(batch), q)


implements(
    GroundBatch,
    force=ground_force,
    tangent=ground_tangent,
    work_slopes=ground_work_slopes,
    force_slopes=ground_slopes_along,
    slopes_beside=ground_slopes_beside,
    sloped=lambda batch: not np.any(batch.winch >= 0),
    changes=ground_changes,
    number_work=ground_number_work,
    memory_work=ground_memory_work,
    memory_back=ground_memory_back,
    numbers=numbers,
    numbered=NUMBERED,
    kinds=kinds_of,
    memory_choice=ground_choice,
    memory_slopes=ground_memory_slopes,
    memory_along=ground_remember_along,
    memory_changes=ground_memory_changes,
    remember=ground_remember,
    role=Role.EXTERNAL,
    slots=("base", "winch"),
    memory=("anchor", "limit", "drift", "since"),
    follows=lambda batch: False,
    late=lambda batch: let_rub if np.any(batch.grounds[:, FRICTION]) else None,
    laid=lay,
    stick=let_stick,
)
