"""Derivatives of the forces of contacts of a wire with a strip along eight directions at a time.

Along a direction that moves the strip's point past the wire by y, and its velocity by w, the terms of
:mod:`ancf.connections.contact_slopes` are

    ds = e.y/(e.r_s),     dg = m.y,     dm = -d(sigma) e,     dF = k dg + c (m.(w - v_s ds) + dm.v),

and the force F m changes by dF m + F dm on both; on the wire, where it is met elsewhere, by F m ds as well.
"""

from __future__ import annotations

from ..compiled import formula, inline_kernel
from ..simd import every, load, store
from ..vectors import dot
from .carrier import COLUMNS, line, shape
from .contact_slopes import between
from .contact_touch import DAMPING, STIFFNESS, touch


@formula
def past(batch, j, e, xi, d, n):
    """What directions n of d move the point by less what they move the wire by there."""
    x, y, z = every(0.0), every(0.0), every(0.0)
    for k in range(COLUMNS):
        i, o = batch.slot[j, k], batch.line_slot[e, k]
        if i >= 0:
            f = batch.factor[j, k]
            x, y, z = x + f * load(d, n, i), y + f * load(d, n, i + 1), z + f * load(d, n, i + 2)
        if o >= 0:
            f = shape(batch, e, k, xi, 0)
            x, y, z = x - f * load(d, n, o), y - f * load(d, n, o + 1), z - f * load(d, n, o + 2)
    return x, y, z


@formula
def turned(batch, e, xi, d):
    """What directions turn the tangent of the wire by there."""
    x, y, z = every(0.0), every(0.0), every(0.0)
    for k in range(COLUMNS):
        o = batch.line_slot[e, k]
        if o >= 0:
            f = shape(batch, e, k, xi, 1)
            x, y, z = x + f * load(d, 0, o), y + f * load(d, 0, o + 1), z + f * load(d, 0, o + 2)
    return x, y, z


@formula
def add_lanes(batch, j, e, xi, change, aside, r):
    """Add changes of the force to r; ``aside``: what is met elsewhere on the wire."""
    for k in range(COLUMNS):
        i, o = batch.slot[j, k], batch.line_slot[e, k]
        for c in range(3):
            if i >= 0:
                store(load(r, i + c) + batch.factor[j, k] * change[c], r, i + c)
            if o >= 0:
                moved = shape(batch, e, k, xi, 0) * change[c] + shape(batch, e, k, xi, 1) * aside[c]
                store(load(r, o + c) - moved, r, o + c)


@inline_kernel
def contact_slopes_along(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_force_slopes`; the tangent has none of it."""
    for j in range(batch.slot.shape[0]):
        pushes, e, xi, m, force = touch(batch, j, q, v)
        if not pushes:
            continue
        stiff, damping = batch.data[j, STIFFNESS], batch.data[j, DAMPING]
        tau = (batch.travel[j, 0], batch.travel[j, 1], batch.travel[j, 2])
        rise = 1.0 / dot(tau, line(batch, e, xi, q, 1))
        y, w = past(batch, j, e, xi, d, 0), past(batch, j, e, xi, d, 1)
        ds = rise * dot(tau, y)
        turn = rise * (dot(m, turned(batch, e, xi, d)) + dot(m, line(batch, e, xi, q, 2)) * ds)
        fast = dot(m, w) - dot(m, line(batch, e, xi, v, 1)) * ds
        fast = fast - dot(tau, between(batch, j, e, xi, v)) * turn
        df, dm, ds = stiff * dot(m, y) + damping * fast, force * turn, force * ds
        change = df * m[0] - dm * tau[0], df * m[1] - dm * tau[1], df * m[2] - dm * tau[2]
        add_lanes(batch, j, e, xi, change, (ds * m[0], ds * m[1], ds * m[2]), r)
