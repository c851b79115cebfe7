"""Derivatives of the forces of sliding joints, backwards and along eight directions.

See :mod:`ancf.connections.sliding` for the equations.
"""

from __future__ import annotations

import math

from ..compiled import formula, inline_kernel
from ..simd import every, lanes_plus, load, store
from ..vectors import both, dot, plus, without
from .carrier import COLUMNS, element_at, line, shape, slider
from .sliding import (
    FREE,
    FREED,
    MASS,
    MU,
    SLIDES,
    V0,
    VISCOUS,
    friction,
    keep,
)


@formula
def keep_back(batch, j, x):
    """The transposed of :func:`keep`."""
    if batch.mode[j] == FREE:
        return 0.0, 0.0, 0.0
    if batch.open[j] != 0:
        x = without(x, (batch.unilateral[j, 0], batch.unilateral[j, 1], batch.unilateral[j, 2]))
    return without(x, (batch.released[j, 0], batch.released[j, 1], batch.released[j, 2]))


@formula
def friction_slopes(batch, j, t, lam, rate):
    """Derivatives of :func:`friction` by t and lam are sums of both: two factors for each."""
    c, mu = batch.data[j, VISCOUS], batch.data[j, MU]
    by_t, lam_by_t, by_lam, t_by_lam = 2.0 * c * rate, 0.0, 0.0, 0.0
    if mu != 0.0:
        a = dot(t, t)
        size, share = math.sqrt(a), dot(t, lam) / a
        normal = math.sqrt(max(dot(lam, lam) - share * share * a, 0.0))
        h = math.tanh(size * rate / batch.data[j, V0])
        by_t += mu * normal * (h / size + (1.0 - h * h) * rate / batch.data[j, V0])
        if normal > 0.0:
            by_lam = mu * size * h / normal
            t_by_lam = -share * by_lam
            by_t, lam_by_t = by_t + share * share * by_lam, -share * by_lam
    return by_t, lam_by_t, by_lam, t_by_lam


@inline_kernel
def sliding_slopes(batch, q, v, a, x, by_q, by_v, by_a, ws):
    """See :func:`ancf.compiled.add_work_slopes`; of joints that slide."""
    w0, w1, w2 = batch.level[0], batch.level[1], batch.level[2]
    for j in range(batch.unknown.shape[0]):
        i = batch.unknown[j]
        e, y, rate, rate2 = element_at(batch, j, q[i + 3]), x[i + 3], v[i + 3], a[i + 3]
        xi = (q[i + 3] - batch.x[e, 0]) / batch.x[e, 1]
        lam = keep(batch, j, (q[i], q[i + 1], q[i + 2]))
        z = keep_back(batch, j, (x[i], x[i + 1], x[i + 2]))
        t = bend = third = moved = turned = d = dn = da = (0.0, 0.0, 0.0)
        for k in range(COLUMNS):
            n = batch.line_slot[e, k]
            if n >= 0:
                s1, s2 = shape(batch, e, k, xi, 1), shape(batch, e, k, xi, 2)
                t, bend, d = plus(t, s1, q, n), plus(bend, s2, q, n), plus(d, s1, v, n)
                moved, turned = plus(moved, shape(batch, e, k, xi, 0), x, n), plus(turned, s1, x, n)
                if w2 != 0.0:
                    third = plus(third, shape(batch, e, k, xi, 3), q, n)
                    dn, da = plus(dn, s2, v, n), plus(da, s1, a, n)
        by_t, lam_by_t, by_lam, t_by_lam = friction_slopes(batch, j, t, lam, rate)
        _, by_rate = friction(batch, j, t, lam, rate)
        by_t, lam_by_t, by_lam, t_by_lam = y * by_t, y * (lam_by_t - 1.0), y * by_lam, y * (t_by_lam - 1.0)
        along = both(by_lam, lam, t_by_lam, t)
        gap = keep_back(batch, j, both(1.0, both(1.0, slider(batch, j, x, 0.0), -1.0, moved), 1.0, along))
        for c in range(3):
            by_q[i + c] += gap[c] - FREED * (x[i + c] - z[c])
        pull = both(by_t, t, lam_by_t, lam)
        ahead, bent = dot(z, t), dot(z, bend)
        by_q[i + 3] += dot(pull, bend) - dot(lam, turned) - w0 * ahead - w1 * (dot(z, d) + bent * rate)
        by_q[i + 3] -= w2 * (
            dot(z, da) + 2.0 * rate * dot(z, dn) + rate * rate * dot(z, third) + rate2 * bent
        )
        by_v[i + 3] += y * by_rate - w1 * ahead - 2.0 * w2 * (dot(z, d) + rate * bent)
        by_a[i + 3] += y * batch.data[j, MASS] - w2 * ahead
        for k in range(COLUMNS):
            m, n = batch.slot[j, k], batch.line_slot[e, k]
            if m >= 0:
                for c in range(3):
                    by_q[m + c] += w0 * batch.factor[j, k] * z[c]
                    by_v[m + c] += w1 * batch.factor[j, k] * z[c]
                    by_a[m + c] += w2 * batch.factor[j, k] * z[c]
            if n >= 0:
                s0, s1 = shape(batch, e, k, xi, 0), shape(batch, e, k, xi, 1)
                f = w0 * s0 + w1 * s1 * rate + w2 * (shape(batch, e, k, xi, 2) * rate * rate + s1 * rate2)
                for c in range(3):
                    by_q[n + c] += s1 * pull[c] - f * z[c]
                    by_v[n + c] -= (w1 * s0 + 2.0 * w2 * s1 * rate) * z[c]
                    by_a[n + c] -= w2 * s0 * z[c]


@formula
def add_lanes(x, i, r):
    """Add three times eight lanes to the rows of r from i on."""
    for c in range(3):
        store(load(r, i + c) + x[c], r, i + c)


@formula
def lane_line(batch, e, xi, d, k, derivative):
    """Sums of ``line`` over the vectors d[k] in eight lanes."""
    none = every(0.0)
    x = (none, none, none)
    for m in range(COLUMNS):
        i = batch.line_slot[e, m]
        if i < 0:
            break
        x = lanes_plus(x, shape(batch, e, m, xi, derivative), d, k, i)
    return x


@formula
def lane_slider(batch, j, d, k):
    """The same of ``slider``."""
    none = every(0.0)
    x = (none, none, none)
    for m in range(COLUMNS):
        i = batch.slot[j, m]
        if i < 0:
            break
        x = lanes_plus(x, batch.factor[j, m], d, k, i)
    return x


@formula
def rate_slopes(batch, j, e, xi, q, v, a, d):
    """Derivatives of ``gap_rates`` along eight directions, without those that rates have in the tangent."""
    i, w1, w2 = batch.unknown[j] + 3, batch.level[1], batch.level[2]
    rate, rate2, ds, dv = v[i], a[i], load(d, 0, i), load(d, 1, i)
    n, o = line(batch, e, xi, q, 2), line(batch, e, xi, v, 1)
    turned = both(1.0, lane_line(batch, e, xi, d, 0, 1), ds, n)  # of the line's direction
    g = both(-w1 * ds, o, -w1 * rate, turned)
    if w2 != 0.0:
        third, bend = line(batch, e, xi, q, 3), line(batch, e, xi, v, 2)
        x = both(1.0, lane_line(batch, e, xi, d, 1, 1), ds, bend)
        x = both(2.0 * rate, x, 2.0 * dv, both(1.0, o, rate, n))
        x = both(1.0, x, ds, line(batch, e, xi, a, 1))
        x = both(1.0, x, rate * rate, both(1.0, lane_line(batch, e, xi, d, 0, 2), ds, third))
        g = both(1.0, g, -w2, both(1.0, x, rate2, turned))
    return g


@formula
def gap_slopes(batch, j, e, xi, q, v, a, d):
    """Derivatives of ``gap_rates`` along eight directions."""
    i, w0, w1, w2 = batch.unknown[j] + 3, batch.level[0], batch.level[1], batch.level[2]
    t, none = line(batch, e, xi, q, 1), every(0.0)
    g = (none, none, none)
    if w1 != 0.0 or w2 != 0.0:
        g = rate_slopes(batch, j, e, xi, q, v, a, d)
    for k in range(3):
        w = w0 if k == 0 else (w1 if k == 1 else w2)
        if w != 0.0:
            x = both(1.0, lane_slider(batch, j, d, k), -1.0, lane_line(batch, e, xi, d, k, 0))
            g = both(1.0, g, w, both(1.0, x, -1.0 * load(d, k, i), t))
    return g


@formula
def friction_along(batch, j, e, xi, t, lam, q, v, d, y, hung):
    """Derivative of the force on the coordinate s by its tangent and the multipliers, less ``hung`` of t.lam.

    ``y``: of the multipliers that are held.
    """
    i = batch.unknown[j] + 3
    by_t, lam_by_t, by_lam, t_by_lam = friction_slopes(batch, j, t, lam, v[i])
    turned = both(1.0, lane_line(batch, e, xi, d, 0, 1), load(d, 0, i), line(batch, e, xi, q, 2))
    along = dot(both(by_t, t, lam_by_t - hung, lam), turned)
    return along + dot(both(by_lam, lam, t_by_lam - hung, t), y)


@inline_kernel
def sliding_slopes_along(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_force_slopes`."""
    for j in range(batch.unknown.shape[0]):
        i = batch.unknown[j]
        e, ds = element_at(batch, j, q[i + 3]), load(d, 0, i + 3)
        xi = (q[i + 3] - batch.x[e, 0]) / batch.x[e, 1]
        lam, whole = (
            keep(batch, j, (q[i], q[i + 1], q[i + 2])),
            (load(d, 0, i), load(d, 0, i + 1), load(d, 0, i + 2)),
        )
        y = keep(batch, j, whole)
        for k in range(COLUMNS):
            m, n = batch.slot[j, k], batch.line_slot[e, k]
            if m < 0 and n < 0:
                break
            if m >= 0:
                add_lanes(both(batch.factor[j, k], y, 0.0, y), m, r)
            if n >= 0:
                w = (-1.0 * shape(batch, e, k, xi, 1)) * ds
                add_lanes(both(-1.0 * shape(batch, e, k, xi, 0), y, w, lam), n, r)
        g = keep(batch, j, gap_slopes(batch, j, e, xi, q, v, a, d))
        add_lanes(both(1.0, g, -FREED, both(1.0, whole, -1.0, y)), i, r)
        if batch.mode[j] != SLIDES:
            continue
        t = line(batch, e, xi, q, 1)
        _, by_rate = friction(batch, j, t, lam, v[i + 3])
        found = friction_along(batch, j, e, xi, t, lam, q, v, d, y, 1.0)
        found = found + by_rate * load(d, 1, i + 3) + batch.data[j, MASS] * load(d, 2, i + 3)
        store(load(r, i + 3) + found, r, i + 3)


@inline_kernel
def sliding_slopes_beside(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_slopes_beside`: what rates do to the rows, and friction."""
    rates = batch.level[1] != 0.0 or batch.level[2] != 0.0
    for j in range(batch.unknown.shape[0]):
        i, e = batch.unknown[j], element_at(batch, j, q[batch.unknown[j] + 3])
        xi = (q[i + 3] - batch.x[e, 0]) / batch.x[e, 1]
        if rates:
            add_lanes(keep(batch, j, rate_slopes(batch, j, e, xi, q, v, a, d)), i, r)
        if batch.mode[j] == SLIDES and (batch.data[j, VISCOUS] != 0.0 or batch.data[j, MU] != 0.0):
            lam = keep(batch, j, (q[i], q[i + 1], q[i + 2]))
            y = keep(batch, j, (load(d, 0, i), load(d, 0, i + 1), load(d, 0, i + 2)))
            t = line(batch, e, xi, q, 1)
            found = friction_along(batch, j, e, xi, t, lam, q, v, d, y, 0.0)
            store(load(r, i + 3) + found, r, i + 3)
