"""Derivatives of x . force, and of what is measured, of contacts of a wire with a strip by the state.

With y = x_p - x_r(s), w = dp/dt - dr(s)/dt and, as in :mod:`ancf.connections.contact`, F = k g + c m.w, the
work is F m.y.  The crossing moves by ds = e.(dp - dr)/(e.r_s), so that

    dg = m.(dp - dr),     dm = -d(sigma) e,     d(sigma) = m.(dr_s + r_ss ds)/(e.r_s),
    dw = dv_p - dv_r - v_s ds,     dy = -x_s ds,

where an index s is a derivative along the wire, and the slope of a profile is the same around s.  Aside of
the strip's middle, -u.y, the crossing is with u = n x e.  All of these sums are of the form
f.(dp - dr) + g m.dr_s + h m.(dv_p - dv_r), which :func:`spread` gives to the nodes.
"""

from __future__ import annotations

import numpy as np

from ..compiled import formula, inline_kernel
from ..vectors import both, dot
from .carrier import COLUMNS, line, shape, slider
from .contact_touch import ARC, ASIDE, DAMPING, FORCE, OVERLAP, STIFFNESS, touch


@formula
def between(batch, j, e, xi, x):
    """What x is at the point less what it is on the wire there."""
    p, r = slider(batch, j, x, 0.0), line(batch, e, xi, x, 0)
    return p[0] - r[0], p[1] - r[1], p[2] - r[2]


@formula
def aside(batch, j):
    """Direction of the strip, u = n x e."""
    n, tau = batch.normal[j], batch.travel[j]
    return n[1] * tau[2] - n[2] * tau[1], n[2] * tau[0] - n[0] * tau[2], n[0] * tau[1] - n[1] * tau[0]


@inline_kernel
def spread(batch, j, e, xi, m, sums, by_q, by_v):
    """Add f, g and h of f.(dp - dr) + g m.dr_s + h m.(dv_p - dv_r) to the derivatives by the nodes."""
    f, g, h = sums
    for n in range(COLUMNS):
        i, o = batch.slot[j, n], batch.line_slot[e, n]
        if i < 0 and o < 0:
            break
        if i >= 0:
            w = batch.factor[j, n]
            for d in range(3):
                by_q[i + d] += w * f[d]
                by_v[i + d] += w * h * m[d]
        if o >= 0:
            w, turn = shape(batch, e, n, xi, 0), g * shape(batch, e, n, xi, 1)
            for d in range(3):
                by_q[o + d] += turn * m[d] - w * f[d]
                by_v[o + d] -= w * h * m[d]


@inline_kernel
def contact_work_slopes(batch, q, v, a, x, by_q, by_v, by_a, ws):
    """See :func:`ancf.compiled.add_work_slopes`."""
    for j in range(batch.slot.shape[0]):
        pushes, e, xi, m, force = touch(batch, j, q, v)
        if not pushes:
            continue
        k, c = batch.data[j, STIFFNESS], batch.data[j, DAMPING]
        tau = (batch.travel[j, 0], batch.travel[j, 1], batch.travel[j, 2])
        y, w = between(batch, j, e, xi, x), between(batch, j, e, xi, v)
        rise = 1.0 / dot(tau, line(batch, e, xi, q, 1))
        power = dot(m, y)
        turning = -rise * (c * power * dot(tau, w) + force * dot(tau, y))
        moving = c * power * dot(m, line(batch, e, xi, v, 1)) + force * dot(m, line(batch, e, xi, x, 1))
        along = rise * (turning * dot(m, line(batch, e, xi, q, 2)) - moving)
        spread(batch, j, e, xi, m, (both(k * power, m, along, tau), turning, c * power), by_q, by_v)


@inline_kernel
def contact_number_work(batch, q, v, a, x, out, ws):
    """See :func:`ancf.compiled.add_number_work`: stiffness and damping of each contact."""
    columns = batch.data.shape[1]
    for j in range(batch.slot.shape[0]):
        pushes, e, xi, m, _ = touch(batch, j, q, v)
        if pushes:
            power = dot(m, between(batch, j, e, xi, x))
            out[columns * j + STIFFNESS] += batch.found[j, OVERLAP] * power
            out[columns * j + DAMPING] += dot(m, between(batch, j, e, xi, v)) * power


@inline_kernel
def contact_measured_slopes(batch, q, v, dq, dv, out):
    """See :func:`ancf.compiled.take_measured_slopes`; zero where no wire crosses the strip's plane."""
    for j in range(batch.slot.shape[0]):
        pushes, e, xi, m, _ = touch(batch, j, q, v)
        own = out[4 * j : 4 * j + 4]
        own[FORCE] = own[OVERLAP] = own[ARC] = own[ASIDE] = 0.0
        if batch.found[j, OVERLAP] == -np.inf:
            continue
        tau, u = (batch.travel[j, 0], batch.travel[j, 1], batch.travel[j, 2]), aside(batch, j)
        t = line(batch, e, xi, q, 1)
        rise, y, w = 1.0 / dot(tau, t), between(batch, j, e, xi, dq), between(batch, j, e, xi, dv)
        ds = rise * dot(tau, y)
        own[OVERLAP], own[ARC], own[ASIDE] = dot(m, y), ds, dot(u, t) * ds - dot(u, y)
        if pushes:
            turn = rise * (dot(m, line(batch, e, xi, dq, 1)) + dot(m, line(batch, e, xi, q, 2)) * ds)
            fast = dot(m, w) - dot(m, line(batch, e, xi, v, 1)) * ds
            fast -= dot(tau, between(batch, j, e, xi, v)) * turn
            own[FORCE] = batch.data[j, STIFFNESS] * dot(m, y) + batch.data[j, DAMPING] * fast


@inline_kernel
def contact_measured_work(batch, q, v, y, by_q, by_v):
    """See :func:`ancf.compiled.add_measured_work`: what :func:`contact_measured_slopes` is, transposed."""
    for j in range(batch.slot.shape[0]):
        own = y[4 * j : 4 * j + 4]
        pushes, e, xi, m, _ = touch(batch, j, q, v)
        if batch.found[j, OVERLAP] == -np.inf:
            continue
        tau, u = (batch.travel[j, 0], batch.travel[j, 1], batch.travel[j, 2]), aside(batch, j)
        t = line(batch, e, xi, q, 1)
        force = own[FORCE] if pushes else 0.0
        k, c = force * batch.data[j, STIFFNESS], force * batch.data[j, DAMPING]
        rise = 1.0 / dot(tau, t)
        turning = -rise * c * dot(tau, between(batch, j, e, xi, v))
        moving = c * dot(m, line(batch, e, xi, v, 1)) - turning * dot(m, line(batch, e, xi, q, 2))
        along = rise * (own[ARC] + own[ASIDE] * dot(u, t) - moving)
        f = both(1.0, both(k + own[OVERLAP], m, along, tau), -own[ASIDE], u)
        spread(batch, j, e, xi, m, (f, turning, c), by_q, by_v)
