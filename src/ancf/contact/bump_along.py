"""Derivatives of the normal forces of bodies on bodies along eight directions at a time.

The force F n acts in the place c, which is at x in the axes of each body, with its share w of the stiffness
and l of the pressure N:

    F = l N(g, g') + (w - l) k g,      g' = -n.u,
    dF = l dN + dl N + (w - l) k dg + (dw - dl) k g,      dg' = -n.du - u.dn,

and as the place does, its arms in both bodies move: dx_j = (dc - dr).a_j + (c - r).da_j, where the
velocity u past each other has the rates of the bodies at x.  See :mod:`ancf.contact.meet_along`.
"""

from __future__ import annotations

from ..compiled import formula, inline_kernel
from ..simd import every, load, store
from ..vectors import both as sum_of
from ..vectors import dot
from .meet_along import body_along, meet_along
from .meeting import apart_at, both, both_rates, factor_in, meet
from .touch import DAMPING, RADIUS, SOFT, STIFFNESS, carried, pressure

ZERO = (0.0, 0.0, 0.0)


@formula
def arms_along(body, moving, c, dc):
    """What a place in the axes of a body changes by."""
    y = c[0] - body[0][0], c[1] - body[0][1], c[2] - body[0][2]
    dy = sum_of(1.0, dc, -1.0, moving[0])
    return (
        dot(body[1], dy) + dot(y, moving[1]),
        dot(body[2], dy) + dot(y, moving[2]),
        dot(body[3], dy) + dot(y, moving[3]),
    )


@formula
def velocity_along(rates, faster, x, dx):
    """What the velocity of a place of a body at x in its axes changes by."""
    s, t = carried(faster, x[0], x[1], x[2]), carried((ZERO, *rates[1:]), dx[0], dx[1], dx[2])
    return sum_of(1.0, s, 1.0, t)


@formula
def factor_along(k, dx, dy):
    """What the factor of a slot of a row changes by."""
    if k == 0 or k == 4:
        return every(0.0)
    if k < 4:
        return dx[0] if k == 1 else (dx[1] if k == 2 else dx[2])
    return -1.0 * (dy[0] if k == 5 else (dy[1] if k == 6 else dy[2]))


@formula
def add_lanes_between(batch, e, x, y, f, df, dx, dy, r):
    """Subtract changes df of a force f on the first body, and of the opposite one, from the residual r.

    It acts at x and y in the axes of both bodies, which change by dx and dy.
    """
    for k in range(8):
        i = batch.base[e, k]
        if i >= 0:
            s, ds = factor_in(k, x, y), factor_along(k, dx, dy)
            for c in range(3):
                store(load(r, i + c) - (s * df[c] + f[c] * ds), r, i + c)


@formula
def past_along(batch, e, x, y, d, n):
    """Way of the first body past the second at x and y in their axes, as the tangent has it, or its rate."""
    a, b = body_along(batch, e, 0, d, n), body_along(batch, e, 1, d, n)
    return sum_of(1.0, carried(a, x[0], x[1], x[2]), -1.0, carried(b, y[0], y[1], y[2]))


@formula
def add_row_along(batch, e, q, v, d, r, apart):
    """Add what a row does; ``apart``: 1 without what the tangent has of it, else 0."""
    one, two = both(batch, e, q)
    g, n, c, _, w, lost, _ = meet(batch, e, one, two)
    if g <= 0.0:
        return
    moving, other = both_rates(batch, e, v)
    u, x, y = apart_at(one, two, moving, other, c)
    data, rate = batch.data[batch.contact[e]], -dot(u, n)
    N, by_g, by_rate = pressure(data, g, rate)
    k, soft = (w - lost) * data[STIFFNESS], SOFT * data[RADIUS]
    F = lost * N + k * g
    if F == 0.0:
        return
    kept, kept_rate = apart * (lost * by_g + k), apart * lost * by_rate
    if N > 0.0 and g < soft:
        by_g = data[STIFFNESS] + data[DAMPING] * rate / soft
    ways = body_along(batch, e, 0, d, 0), body_along(batch, e, 1, d, 0)
    fast = body_along(batch, e, 0, d, 1), body_along(batch, e, 1, d, 1)
    dg, dn, dc, dw, dlost = meet_along(batch, e, one, two, ways)
    dx, dy = arms_along(one, ways[0], c, dc), arms_along(two, ways[1], c, dc)
    du = velocity_along(moving, fast[0], x, dx)
    du = sum_of(1.0, du, -1.0, velocity_along(other, fast[1], y, dy))
    dN = by_g * dg - by_rate * (dot(n, du) + dot(u, dn))
    dF = lost * dN + N * dlost + k * dg + (data[STIFFNESS] * g) * (dw - dlost)
    if apart != 0.0:
        dF = dF + kept * dot(n, past_along(batch, e, x, y, d, 0))
        dF = dF + kept_rate * dot(n, past_along(batch, e, x, y, d, 1))
    f = F * n[0], F * n[1], F * n[2]
    add_lanes_between(batch, e, x, y, f, sum_of(dF, n, F, dn), dx, dy, r)


@inline_kernel
def bump_slopes_along(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_force_slopes`."""
    for e in range(batch.base.shape[0]):
        add_row_along(batch, e, q, v, d, r, 0.0)


@inline_kernel
def bump_slopes_beside(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_slopes_beside`: how places, normals and shares change."""
    for e in range(batch.base.shape[0]):
        add_row_along(batch, e, q, v, d, r, 1.0)
