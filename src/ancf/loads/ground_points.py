"""What grounds do at points: where these are, how they are pressed and how friction draws them.

See :mod:`ancf.loads.ground`.
"""

from __future__ import annotations

import math

from ..compiled import formula
from ..vectors import dot
from .along import place_at, velocity_at
from .relief import DRAG, SOFT, STICK, depth_at, pressure


@formula
def touch_at(batch, e, p, q, v):
    """Place, velocity and normal at point p of row e; normal force with its derivatives."""
    k, d = batch.ground[e], batch.diameter[e]
    at = place_at(batch, e, p, q)
    g, n = depth_at(batch, k, at[0], at[1], at[2])
    if g <= -SOFT * d:
        return at, (0.0, 0.0, 0.0), n, 0.0, 0.0, 0.0
    u = velocity_at(batch, e, p, q, v)
    rate = -(u[0] * n[0] + u[1] * n[1] + u[2] * n[2])
    N, by_g, by_rate = pressure(batch.grounds[k], d, g, rate)
    return at, u, n, N, by_g, by_rate


@formula
def anchor_at(batch, e, p, q):
    """The anchor of the material that is at point p of row e."""
    x, y, z = batch.anchor[e, p, 0], batch.anchor[e, p, 1], batch.anchor[e, p, 2]
    i = batch.winch[e]
    if i >= 0 and batch.since[e] > 0.0:
        c = q[i] / batch.since[e] - 1.0
        drift = batch.drift[e, p]
        x, y, z = x + c * drift[0], y + c * drift[1], z + c * drift[2]
    return x, y, z


@formula
def pulled_at(batch, e, p, q, r, u):
    """What spring and damper of the friction pull with, normal to the ground as well."""
    ground, anchor = batch.grounds[batch.ground[e]], anchor_at(batch, e, p, q)
    stick, c = ground[STICK], ground[DRAG]
    return (
        stick * (r[0] - anchor[0]) + c * u[0],
        stick * (r[1] - anchor[1]) + c * u[1],
        stick * (r[2] - anchor[2]) + c * u[2],
    )


@formula
def drawn_at(batch, e, p, q, r, u, n):
    """The vector w of the friction, its size, and the factor f of the force -f w; whether it slips.

    Where derivatives of a step that slips are taken, the limit is negative: it slips in all their states.
    """
    x, d = pulled_at(batch, e, p, q, r, u), batch.diameter[e]
    normal = x[0] * n[0] + x[1] * n[1] + x[2] * n[2]
    w = x[0] - normal * n[0], x[1] - normal * n[1], x[2] - normal * n[2]
    size = math.sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2])
    if d * size > batch.limit[e, p]:
        return w, size, abs(batch.limit[e, p]) / size, True
    return w, size, d, False


@formula
def left_at(batch, e, p, q, r, u, n):
    """The same of the spring alone, f the factor of what a step leaves in it; whether its anchor moves.

    It moves where the point slips and the spring by itself pulls beyond the limit.
    """
    _, _, _, slips = drawn_at(batch, e, p, q, r, u, n)
    w, size, _, _ = drawn_at(batch, e, p, q, r, (0.0, 0.0, 0.0), n)
    d, limit = batch.diameter[e], abs(batch.limit[e, p])
    if slips and d * size > limit:
        return w, size, limit / size, True
    return w, size, d, False


@formula
def pressed_at(batch, e, p, q, v):
    """Place, velocity, depth and normal at point p of row e; N and its derivatives by depth and its rate."""
    k, d = batch.ground[e], batch.diameter[e]
    at, u = place_at(batch, e, p, q), velocity_at(batch, e, p, q, v)
    g, n = depth_at(batch, k, at[0], at[1], at[2])
    N, by_g, by_rate = pressure(batch.grounds[k], d, g, -dot(u, n))
    return at, u, g, n, N, by_g, by_rate
