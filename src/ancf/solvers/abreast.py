"""Sensitivities by eight parameters abreast: one in each lane of every unknown.

See :mod:`ancf.solvers.sensitivity` for the equations.  All parameters of a step share its matrices, whose
numbers are read once for eight of them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..arrays import FloatArray
from ..compiled import formula, inline_kernel, kernel
from ..linalg.eight import factor_of
from ..linalg.lanes import multiply_abreast, multiply_twisted_abreast, solve_abreast
from ..simd import LANES, absolute, every, load, store
from ..system.core import constraint_rows, drive, solve_sparse, to_local
from .ahead import look_ahead
from .local import add_local, add_locals, look_near
from .scheme import coefficients
from .sensitivity import (
    ABAR,
    DIFFERENCED,
    ENOUGH,
    LEAST,
    MOST,
    A,
    Q,
    V,
    add_lossy,
    add_rough,
    extent,
    is_done,
)
from .status import OK, SINGULAR, SLOW


class Abreast(NamedTuple):
    """Room for eight sensitivities."""

    d: FloatArray  # (3, size, 8) s_q, s_v, s_a
    r: FloatArray  # (size, 8)
    seen: FloatArray  # (size, 8)
    before: FloatArray  # (8,) sizes of the last corrections
    open: FloatArray  # (8,) 1 while corrections go on, else 0
    norm: FloatArray  # (8,) sizes of corrections, and of what they correct
    size: FloatArray  # (8,)
    shift: FloatArray  # (8,) sizes of shifts onto the constraints


def room_for(size: int) -> Abreast:
    """Room for the unknowns of a model."""
    return Abreast(
        *(np.zeros((*shape, LANES)) for shape in ((3, size), (size,), (size,))), *np.zeros((5, LANES))
    )


@formula
def follow_abreast(supports, d):
    """Shadows from the unknowns, as :func:`ancf.system.core.follow`."""
    for k in range(supports.rot_slot.shape[0]):
        i, j = supports.rot_slot[k], supports.rot_shadow[k]
        for c in range(3):
            x, dx, ddx = every(0.0), every(0.0), every(0.0)
            for m in range(3):
                R, dR, ddR = (
                    supports.rot_R[k, 0, c, m],
                    supports.rot_R[k, 1, c, m],
                    supports.rot_R[k, 2, c, m],
                )
                q, v, a = load(d, 0, i + m), load(d, 1, i + m), load(d, 2, i + m)
                x = x + R * q
                dx = dx + R * v + dR * q
                ddx = ddx + R * a + (2.0 * dR) * v + ddR * q
            store(x, d, 0, j + c)
            store(dx, d, 1, j + c)
            store(ddx, d, 2, j + c)


@formula
def see(core, x, room):
    """Keep x as the matrices take it, the values of shadows at the unknowns where they have their rows."""
    supports = core.supports
    for i in range(x.shape[0]):
        store(load(x, i), room.seen, i)
    for k in range(supports.rot_slot.shape[0]):
        for c in range(3):
            store(load(x, supports.rot_shadow[k] + c), room.seen, supports.rot_slot[k] + c)


@formula
def add_product(core, values, x, room):
    """Add a matrix times x to r, the rows of shadows where the matrix has them."""
    see(core, x, room)
    multiply_abreast(core.factor, values, room.seen, room.r)


@formula
def products(core, m, K, C, W, room):
    """r = M s_a + C s_v + K s_q of the exact batches."""
    d, r, supports = room.d, room.r, core.supports
    for i in range(r.shape[0]):
        store(every(0.0), r, i)
    add_product(core, K, d[0], room)
    if W.shape[0] > 0:
        multiply_twisted_abreast(core.factor, W, room.seen, room.r)
    add_product(core, m.M, d[2], room)
    if m.damped:
        add_product(core, C, d[1], room)
    for k in range(supports.rot_slot.shape[0]):
        for c in range(3):
            i, j = supports.rot_slot[k] + c, supports.rot_shadow[k] + c
            store(load(r, j) + load(r, i), r, j)
            store(every(0.0), r, i)


@inline_kernel
def taken(room, lane, d):
    """The sensitivity in a lane as vectors (3, size)."""
    for k in range(3):
        for i in range(d.shape[1]):
            d[k, i] = room.d[k, i, lane]


@inline_kernel
def add_others(core, m, x, room, lane):
    """Add what the batches that are not exact do to r, of one lane."""
    r, d = m.work[0], m.work[1:4]
    taken(room, lane, d)
    for i in range(r.shape[0]):
        r[i] = 0.0
    if m.lossy.table.shape[0] > 0:
        add_lossy(core, m, x, d, r)
    if m.rough.table.shape[0] > 0 and not m.local:
        add_rough(core, m, x, d, r)
        for k in range(core.joints.multipliers.shape[0]):
            room.r[core.joints.multipliers[k], lane] = 0.0
    for i in range(r.shape[0]):
        room.r[i, lane] += r[i]


@formula
def to_local_abreast(supports, r):
    """Components along local axes, as :func:`ancf.system.core.to_local`."""
    for k in range(supports.rot_slot.shape[0]):
        i, j = supports.rot_slot[k], supports.rot_shadow[k]
        for c in range(3):
            R = supports.rot_R[k, 0]
            store(R[0, c] * load(r, j) + R[1, c] * load(r, j + 1) + R[2, c] * load(r, j + 2), r, i + c)


@inline_kernel
def out_of_balance(core, m, matrices, x, push, n, first, room):
    """r = M s_a + C s_v + K s_q + R_p as the solve wants it, of step n and parameters from ``first`` on."""
    r, count = room.r, min(LANES, push.shape[0] - first)
    follow_abreast(core.supports, room.d)
    products(core, m, matrices[0], matrices[1], matrices[2], room)
    if m.lossy.table.shape[0] > 0 or (m.rough.table.shape[0] > 0 and not m.local):
        for k in range(count):
            if room.open[k] > 0.0:
                add_others(core, m, x, room, k)
    add_locals(core, m, x, room, count)
    to_local_abreast(core.supports, r)
    for k in range(count):
        own = push[first + k, n]
        for i in range(r.shape[0]):
            r[i, k] = room.open[k] * (r[i, k] + own[i])
    for k in range(core.supports.held.shape[0]):
        store(every(0.0), r, core.supports.held[k])


@inline_kernel
def shifted(core, m, factor, x, gap, joined, room, lane):
    """Shift s_q of a lane onto the derivative of C = 0; the size of the shift."""
    joints, w, r, d = core.joints, m.work, m.work[0], m.work[1:4]
    taken(room, lane, d)
    joints.level[0], joints.level[1], joints.level[2] = 1.0, 0.0, 0.0
    size = extent(d[0], core.weight)
    e = m.moved / size if size > LEAST else 1.0
    for i in range(r.shape[0]):
        r[i] = gap[i]
    for side in (1.0, -1.0):
        for i in range(r.shape[0]):
            w[4][i] = x[0][i] + side * e * d[0][i]
        constraint_rows(joints, w[4], x[1], x[2], w[5], core.ws)
        for i in range(r.shape[0]):
            r[i] += side * w[5][i] / (2.0 * e)
    joints.level[0], joints.level[1], joints.level[2] = joined.w0, joined.w1, joined.w2
    to_local(core.supports, r)
    solve_sparse(factor, r, joints.lowest)
    norm = 0.0
    for i in range(core.weight.shape[0]):
        c = r[i] * (1.0 - joints.mask[i])
        room.d[0, i, lane] -= c
        norm = max(norm, abs(c) * core.weight[i])
    return norm


@formula
def correct(core, room, B, G):
    """Subtract the corrections in r; multipliers have no rates."""
    d, multipliers = room.d, core.joints.multipliers
    for i in range(core.weight.shape[0]):
        c = load(room.r, i)
        store(load(d, 0, i) - c, d, 0, i)
        store(load(d, 1, i) - (G / B) * c, d, 1, i)
        store(load(d, 2, i) - (1.0 / B) * c, d, 2, i)
    for k in range(multipliers.shape[0]):
        store(every(0.0), d, 1, multipliers[k])
        store(every(0.0), d, 2, multipliers[k])


@formula
def sizes_of(X, weight, out):
    """Largest entry of each lane by size, weighted."""
    found = every(0.0)
    for i in range(weight.shape[0]):
        size = weight[i] * absolute(load(X, i))
        found = 0.5 * (found + size + absolute(found - size))
    store(found, out, 0)


@inline_kernel
def out_again(core, m, W, x, room, lanes, B, G):
    """r = what is out of balance after the corrections in r: what these do that is not in the factors."""
    r, seen, supports = room.r, room.seen, core.supports
    for i in range(r.shape[0]):
        store(load(r, i), seen, i)
        store(every(0.0), r, i)
    for k in range(supports.rot_slot.shape[0]):
        i, j, R = supports.rot_slot[k], supports.rot_shadow[k], supports.rot_R[k, 0]
        x0, x1, x2 = load(seen, i), load(seen, i + 1), load(seen, i + 2)
        for c in range(3):
            y = R[c, 0] * x0 + R[c, 1] * x1 + R[c, 2] * x2
            store(y, seen, i + c)
            store(y, seen, j + c)
    if W.shape[0] > 0:
        multiply_twisted_abreast(core.factor, W, seen, r)
    for k in range(supports.rot_slot.shape[0]):
        i, j = supports.rot_slot[k], supports.rot_shadow[k]
        for c in range(3):
            store(load(r, i + c), r, j + c)
    if m.rough.table.shape[0] > 0:
        count = look_near(m, x)
        for lane in range(lanes):
            if room.open[lane] > 0.0:
                for t in range(count):
                    change = seen[int(m.near[0, t]), lane]
                    m.near[1, t], m.near[2, t], m.near[3, t] = change, (G / B) * change, change / B
                add_local(core, m, x, count, r, lane)
    to_local_abreast(supports, r)
    turned_back(core, r)


@formula
def turned_back(core, r):
    """Change the sign of r; zero at held unknowns."""
    supports = core.supports
    for i in range(core.weight.shape[0]):
        store(-1.0 * load(r, i), r, i)
    for k in range(supports.held.shape[0]):
        store(every(0.0), r, supports.held[k])


@inline_kernel
def not_done(room, weight, count, enough):
    """Number of lanes whose corrections, in r, go on; these stay open."""
    left = 0
    sizes_of(room.r, weight, room.norm)
    sizes_of(room.d[0], weight, room.size)
    for k in range(count):
        if room.open[k] > 0.0:
            norm = max(room.norm[k], room.shift[k])
            if is_done(norm, room.size[k], room.before[k], enough):
                room.open[k] = 0.0
            else:
                room.before[k] = norm
                left += 1
    return left


@inline_kernel
def solved(core, m, factor, matrices, x, push, gap, n, first, joined, room, B, G):
    """Corrections of predicted sensitivities; a status."""
    joints, count = core.joints, min(LANES, push.shape[0] - first)
    rough = m.rough.table.shape[0] > 0
    known = m.lossy.table.shape[0] == 0 and not m.turning and (m.local or not rough)
    projects = joined.projects and joints.multipliers.shape[0] > 0
    again, enough = matrices[2].shape[0] > 0 or rough, DIFFERENCED if rough else ENOUGH
    for k in range(count):
        room.before[k], room.open[k], room.shift[k] = np.inf, 1.0, 0.0
    for round in range(MOST):
        if round > 0 and known and not projects:
            out_again(core, m, matrices[2], x, room, count, B, G)
        else:
            out_of_balance(core, m, matrices, x, push, n, first, room)
        solve_abreast(factor, room.r)
        correct(core, room, B, G)
        if known and not projects and not again:
            return OK
        if projects:
            for k in range(count):
                if room.open[k] > 0.0:
                    room.shift[k] = shifted(core, m, factor, x, gap[first + k, n], joined, room, k)
        if not_done(room, core.weight, count, enough) == 0 or (known and not again):
            return OK
    return SLOW


@formula
def predicted(s, d, h, scheme):
    """d = (s_q, s_v, s_a) at the end of a step from the sensitivities s at its start, with the same s_a."""
    am, af = scheme.alpha_m, scheme.alpha_f
    c1, c2, c3 = (1.0 - af) / (1.0 - am), af / (1.0 - am), -am / (1.0 - am)
    for i in range(s.shape[1]):
        q, v, a, bar = load(s, Q, i), load(s, V, i), load(s, A, i), load(s, ABAR, i)
        new = (c1 + c2) * a + c3 * bar
        store(q + h * v + (h * h) * ((0.5 - scheme.beta) * bar + scheme.beta * new), d, 0, i)
        store(v + h * ((1.0 - scheme.gamma) * bar + scheme.gamma * new), d, 1, i)
        store(a, d, 2, i)


@inline_kernel
def kept(room, s, scheme, out, row, first):
    """Write s_q, s_v and, if there is room, s_a to a row of what is kept; the next step starts with them."""
    am, af = scheme.alpha_m, scheme.alpha_f
    c1, c2, c3 = (1.0 - af) / (1.0 - am), af / (1.0 - am), -am / (1.0 - am)
    for i in range(s.shape[1]):
        q, v, a = load(room.d, 0, i), load(room.d, 1, i), load(room.d, 2, i)
        store(c1 * a + c2 * load(s, A, i) + c3 * load(s, ABAR, i), s, ABAR, i)
        store(q, s, Q, i)
        store(v, s, V, i)
        store(a, s, A, i)
    for p in range(first, min(first + LANES, out.shape[0])):
        for k in range(out.shape[2]):
            for i in range(s.shape[1]):
                out[p, row, k, i] = room.d[k, i, p - first]


@kernel
def follow_steps(core, m, ahead, room, tables, way, push, gap, h, scheme, joined, s, out, place):
    """Carry sensitivities through the steps of a block.

    Parameters
    ----------
    core, m, ahead, room : Core, Matrices, Ahead, Abreast
    tables : Tables
        At the ends of the steps.
    way : Way
    push, gap : (p, steps, size)
        Derivatives of the residual and of the constraints' positions, at fixed free unknowns.
    h, scheme, joined : float, Scheme, Constraining
    s : (p/8 rounded up, 4, size, 8)
        At the start; changed to the end.
    out : (p, rows, 2 or 3, size)
        s_q, s_v and s_a at the ends of the steps, in the rows from ``place`` on.
    place : int

    Returns
    -------
    Steps done and the status of the last one.
    """
    B, G = coefficients(h, scheme)
    level = core.joints.level
    level[0], level[1], level[2] = joined.w0, joined.w1, joined.w2
    for n in range(way.q.shape[0]):
        lane = n % LANES
        if lane == 0:
            bad = look_ahead(core, m, ahead, tables, way, n, B, G, core.joints.multipliers.shape[0] > 0)
            if bad >= 0:
                return n + bad, SINGULAR
        factor = factor_of(core.factor, ahead.eight, lane)
        matrices = (ahead.K[lane], ahead.C[lane], ahead.W[lane])
        x = (way.q[n], way.v[n], way.a[n])
        drive(core.supports, core.loads.value, tables, n, x[0], x[1], x[2])
        for g in range(s.shape[0]):
            predicted(s[g], room.d, h, scheme)
            status = solved(core, m, factor, matrices, x, push, gap, n, LANES * g, joined, room, B, G)
            if status != OK:
                return n, status
            follow_abreast(core.supports, room.d)
            kept(room, s[g], scheme, out, place + n, LANES * g)
    return way.q.shape[0], OK
