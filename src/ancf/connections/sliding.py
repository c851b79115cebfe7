"""Sliding joint (paper, section 6, eqs. 28-32): a point slides along a line of a body.

The line is that of a carrier, r_j(s) with its reference arc length s, and the point is r_i:

    C = r_i - r_j(s) = 0,        three multipliers lambda,                          (eq. 29)
    m s'' - r_x . lambda + friction = drive,

where the second line is the equation of motion of the coordinate s: without mass, friction and drive it
is the fourth line of eq. 29.  Time derivatives of C for the index 2 (eq. 31) and index 1 forms, the latter
with the convective term that eq. 32 lacks:

    dC/dt   = v_i - v_j - r_x s',
    d2C/dt2 = a_i - a_j - 2 v_x s' - r_xx s'^2 - r_x s''.

lambda is the force that the carrier receives.  Friction is c |r_x|^2 s' + mu N |r_x| tanh(|r_x| s'/v0) with
the normal force N; it does not act where ``mu`` and ``c`` are zero.  In a *released* direction u the joint
carries nothing: the row u . C = 0 is replaced by u . lambda = 0.  The hand-over from element to element is a
change of the element in which s is evaluated, in every iteration; beyond the ends the last one goes on.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ..arrays import FloatArray, IntArray
from ..compiled import formula, inline_kernel
from ..vectors import dot
from .carrier import COLUMNS, element_at, line, shape, slider

# columns of SlidingBatch.data
MASS, VISCOUS, MU, V0 = range(4)
# values of SlidingBatch.mode
SLIDES, FROZEN, FREE = range(3)
# events
LEFT, PULLS, TOUCHES = range(3)
#: What stands for zero in the rows of released directions.
FREED = 1e-3
#: In the matrix alone, m/N: a pivot for lambda where only s can move; the iteration makes up for it.  Where
#: rates of C are held it is at most what a step gives to so many kg: heavy bodies give little in short steps.
PIVOT, HEAVY = 1e-15, 1e9


class SlidingBatch(NamedTuple):
    """All sliding joints of a System; n joints, m elements of their carriers."""

    unknown: IntArray  # (n,) first unknown of the joint's block: lambda (3), then s
    level: FloatArray  # (3,) weights of C, dC/dt, d2C/dt2 in the residual, shared with the System
    own: IntArray  # (n,) place of the joint's diagonal block
    slot: IntArray  # (n, COLUMNS) slots of the sliding point, behind them -1: none
    factor: FloatArray  # (n, COLUMNS)
    place: IntArray  # (n, COLUMNS) places of the 3x3 pieces (lambda, slot)
    offset: FloatArray  # (n, 3) constant part of the sliding point's position
    first: IntArray  # (n + 1,) elements of the carrier of each joint
    x: FloatArray  # (m, 2) start and length of the element, m
    line_slot: IntArray  # (m, COLUMNS) the same of the carrier
    line_poly: FloatArray  # (m, COLUMNS, 4) factors as powers of xi = (s - start)/length
    line_place: IntArray  # (m, COLUMNS) places of the pieces (lambda, slot)
    data: FloatArray  # (n, 4) MASS, VISCOUS, MU, V0
    released: FloatArray  # (n, 3) direction that is never held, or zero
    unilateral: FloatArray  # (n, 3) direction of the force that the carrier may receive, or zero
    open: IntArray  # (n,) 1: the unilateral direction is released now
    mode: IntArray  # (n,) SLIDES, FROZEN (s does not change) or FREE (no force at all)


@formula
def keep(batch, j, x):
    """Part of a vector in the directions that the joint holds now."""
    if batch.mode[j] == FREE:
        return 0.0 * x[0], 0.0 * x[1], 0.0 * x[2]  # zeros of the kind of x, which may be eight lanes
    u = (batch.released[j, 0], batch.released[j, 1], batch.released[j, 2])
    d = dot(u, x)
    x = (x[0] - d * u[0], x[1] - d * u[1], x[2] - d * u[2])
    if batch.open[j] != 0:
        u = (batch.unilateral[j, 0], batch.unilateral[j, 1], batch.unilateral[j, 2])
        d = dot(u, x)
        x = (x[0] - d * u[0], x[1] - d * u[1], x[2] - d * u[2])
    return x


@formula
def gap_rates(batch, j, e, xi, q, v, a):
    """C weighted by level[0] plus its time derivatives weighted by level[1] and level[2]."""
    i = batch.unknown[j] + 3
    w0, w1, w2 = batch.level[0], batch.level[1], batch.level[2]
    gx, gy, gz = 0.0, 0.0, 0.0
    if w0 != 0.0:
        p, o = slider(batch, j, q, 1.0), line(batch, e, xi, q, 0)
        gx, gy, gz = w0 * (p[0] - o[0]), w0 * (p[1] - o[1]), w0 * (p[2] - o[2])
    if w1 != 0.0:
        p, o, t = slider(batch, j, v, 0.0), line(batch, e, xi, v, 0), line(batch, e, xi, q, 1)
        gx += w1 * (p[0] - o[0] - t[0] * v[i])
        gy += w1 * (p[1] - o[1] - t[1] * v[i])
        gz += w1 * (p[2] - o[2] - t[2] * v[i])
    if w2 != 0.0:
        p, o, t = slider(batch, j, a, 0.0), line(batch, e, xi, a, 0), line(batch, e, xi, q, 1)
        n, d = line(batch, e, xi, q, 2), line(batch, e, xi, v, 1)
        gx += w2 * (p[0] - o[0] - 2.0 * d[0] * v[i] - n[0] * v[i] ** 2 - t[0] * a[i])
        gy += w2 * (p[1] - o[1] - 2.0 * d[1] * v[i] - n[1] * v[i] ** 2 - t[1] * a[i])
        gz += w2 * (p[2] - o[2] - 2.0 * d[2] * v[i] - n[2] * v[i] ** 2 - t[2] * a[i])
    return gx, gy, gz


@formula
def friction(batch, j, t, lam, rate):
    """Force against the motion of s and its derivative with respect to the rate of s."""
    c, mu = batch.data[j, VISCOUS], batch.data[j, MU]
    a = dot(t, t)
    force, slope = c * a * rate, c * a
    if mu != 0.0:
        size, along = math.sqrt(a), dot(t, lam)
        normal = math.sqrt(max(dot(lam, lam) - along * along / a, 0.0))
        h = math.tanh(size * rate / batch.data[j, V0])
        force += mu * normal * size * h
        slope += mu * normal * a * (1.0 - h * h) / batch.data[j, V0]
    return force, slope


@inline_kernel
def sliding_force(batch, q, v, a, r, ws):
    """Add the joints' forces on the bodies and the rows of lambda and s."""
    for j in range(batch.unknown.shape[0]):
        i = batch.unknown[j]
        e = element_at(batch, j, q[i + 3])
        xi = (q[i + 3] - batch.x[e, 0]) / batch.x[e, 1]
        whole = (q[i], q[i + 1], q[i + 2])
        lam = keep(batch, j, whole)
        for k in range(COLUMNS):
            m, n = batch.slot[j, k], batch.line_slot[e, k]
            if m < 0 and n < 0:
                break
            if m >= 0:
                for c in range(3):
                    r[m + c] += batch.factor[j, k] * lam[c]
            if n >= 0:
                w = shape(batch, e, k, xi, 0)
                for c in range(3):
                    r[n + c] -= w * lam[c]
        g = keep(batch, j, gap_rates(batch, j, e, xi, q, v, a))
        for c in range(3):
            r[i + c] += g[c] - FREED * (whole[c] - lam[c])
        if batch.mode[j] == SLIDES:
            t = line(batch, e, xi, q, 1)
            force, _ = friction(batch, j, t, lam, v[i + 3])
            r[i + 3] += batch.data[j, MASS] * a[i + 3] - dot(t, lam) + force


@inline_kernel
def sliding_inertia(batch, a, r, ws):
    """Add the mass that goes with s."""
    for j in range(batch.unknown.shape[0]):
        i = batch.unknown[j] + 3
        r[i] += batch.data[j, MASS] * a[i]


@inline_kernel
def axis(c):
    """Unit vector."""
    return 1.0 if c == 0 else 0.0, 1.0 if c == 1 else 0.0, 1.0 if c == 2 else 0.0


@inline_kernel
def add_piece(A, place, w, batch, j):
    """Add w times the held directions to the 3x3 piece at ``place``."""
    for c in range(3):
        column = keep(batch, j, axis(c))
        for m in range(3):
            A[place + 6 * m + c] += w * column[m]


@inline_kernel
def sliding_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add the rows of lambda and s; what is above the diagonal blocks follows from symmetry."""
    scale = batch.level[0] * c_stiffness + batch.level[1] * c_damping + batch.level[2] * c_mass
    rates = batch.level[1] != 0.0 or batch.level[2] != 0.0
    pivot = min(PIVOT, 1.0 / (HEAVY * max(c_mass, 1.0))) if rates else PIVOT
    for j in range(batch.unknown.shape[0]):
        i, own = batch.unknown[j], batch.own[j]
        e = element_at(batch, j, q[i + 3])
        xi = (q[i + 3] - batch.x[e, 0]) / batch.x[e, 1]
        lam = keep(batch, j, (q[i], q[i + 1], q[i + 2]))
        slides = batch.mode[j] == SLIDES
        for k in range(COLUMNS):
            if batch.slot[j, k] < 0 and batch.line_slot[e, k] < 0:
                break
            if batch.slot[j, k] >= 0:
                add_piece(A, batch.place[j, k], scale * batch.factor[j, k], batch, j)
            if batch.line_slot[e, k] >= 0:
                place = batch.line_place[e, k]
                add_piece(A, place, -scale * shape(batch, e, k, xi, 0), batch, j)
                if slides:
                    w = -c_stiffness * shape(batch, e, k, xi, 1)
                    for c in range(3):
                        A[place + 18 + c] += w * lam[c]
        for c in range(3):
            unit = axis(c)
            held = keep(batch, j, unit)
            for m in range(3):
                A[own + 6 * m + c] -= FREED * (unit[m] - held[m])
            A[own + 7 * c] -= scale * pivot
        if not slides:
            A[own + 21] += 1.0
            continue
        t, n = line(batch, e, xi, q, 1), line(batch, e, xi, q, 2)
        held = keep(batch, j, t)
        for c in range(3):
            A[own + 18 + c] -= scale * held[c]
            A[own + 6 * c + 3] -= scale * held[c]
        _, slope = friction(batch, j, t, lam, v[i + 3])
        A[own + 21] += c_mass * batch.data[j, MASS] + c_damping * slope - c_stiffness * dot(n, lam)


@inline_kernel
def sliding_event(batch, q):
    """4 j + LEFT, PULLS or TOUCHES of the first joint j to which that happens, else -1."""
    for j in range(batch.unknown.shape[0]):
        if batch.mode[j] == FREE:
            continue
        i = batch.unknown[j]
        s, low, high = q[i + 3], batch.first[j], batch.first[j + 1] - 1
        start, end = batch.x[low, 0], batch.x[high, 0] + batch.x[high, 1]
        slack = 1e-9 * (end - start)
        if batch.mode[j] == SLIDES and (s < start - slack or s > end + slack):
            return 4 * j + LEFT
        u = (batch.unilateral[j, 0], batch.unilateral[j, 1], batch.unilateral[j, 2])
        if dot(u, u) == 0.0:
            continue
        if batch.open[j] == 0:
            if dot(u, (q[i], q[i + 1], q[i + 2])) < 0.0:
                return 4 * j + PULLS
            continue
        e = element_at(batch, j, s)
        o = line(batch, e, (s - batch.x[e, 0]) / batch.x[e, 1], q, 0)
        p = slider(batch, j, q, 1.0)
        if dot(u, (o[0] - p[0], o[1] - p[1], o[2] - p[2])) < 0.0:
            return 4 * j + TOUCHES
    return -1
