"""Joints between points and axes of bodies: rows C = d1 . d2 - c = 0 with one multiplier each.

d1 and d2 are sums of unknown vectors times factors, plus a constant: with d2 a constant unit vector and
d1 the difference of two points the row holds one component of a distance; with two axes it holds an
angle; with d1 = d2 a length.  Spherical joint, revolute joint, clamp to a body and the six conditions
that keep a rigid body rigid are all made of such rows (natural coordinates: Garcia de Jalon & Bayo 1994).

The forces on the bodies are C_q^T (lambda + alpha C): alpha vanishes from the solution and makes the
part of the iteration matrix that belongs to the bodies positive definite where only the joints hold
them (augmented Lagrangian), so that the factorisation needs no pivoting.
"""

from __future__ import annotations

from typing import NamedTuple

from ..arrays import FloatArray, IntArray
from ..compiled import Role, formula, implements, inline_kernel
from ..simd import every, lanes_plus, load, store
from ..vectors import dot
from .in_matrix import bind_joints, joint_pairs


class JointBatch(NamedTuple):
    """All rows of a System: n rows, m entries (a slot in d1 or d2 of a row)."""

    unknown: IntArray  # (n,) multiplier of the row
    level: FloatArray  # (3,) weights of C, dC/dt, d2C/dt2 in the residual, shared with the System
    constant: FloatArray  # (n, 7) constant parts of d1 and of d2, and c
    scale: FloatArray  # (n, 3) mass, stiffness, and stiffness where no mass helps, of which alpha is made
    alpha: FloatArray  # (n,) now
    start: IntArray  # (n + 1,) entries of each row
    slot: IntArray  # (m,)
    factor: FloatArray  # (m,)
    second: IntArray  # (m,) 0: of d1, 1: of d2
    place: IntArray  # (m,) places of the pieces (multiplier, slot)
    pair_start: IntArray  # (n + 1,) pairs of each row
    pair: IntArray  # (k,) places of the pieces (slot of one entry, slot of another), -1: above the diagonal


@formula
def sums(batch, n, q, fixed):
    """d1 and d2 of row n (fixed = 1) or their rates (fixed = 0)."""
    x, y, z = fixed * batch.constant[n, 0], fixed * batch.constant[n, 1], fixed * batch.constant[n, 2]
    u, v, w = fixed * batch.constant[n, 3], fixed * batch.constant[n, 4], fixed * batch.constant[n, 5]
    for k in range(batch.start[n], batch.start[n + 1]):
        i, f = batch.slot[k], batch.factor[k]
        if batch.second[k] == 0:
            x += f * q[i]
            y += f * q[i + 1]
            z += f * q[i + 2]
        else:
            u += f * q[i]
            v += f * q[i + 1]
            w += f * q[i + 2]
    return (x, y, z), (u, v, w)


@inline_kernel
def joint_force(batch, q, v, a, r, ws):
    """Add the joints' forces and the weighted constraints."""
    for n in range(batch.unknown.shape[0]):
        d1, d2 = sums(batch, n, q, 1.0)
        g = batch.level[0] * (dot(d1, d2) - batch.constant[n, 6])
        if batch.level[1] != 0.0 or batch.level[2] != 0.0:
            v1, v2 = sums(batch, n, v, 0.0)
            g += batch.level[1] * (dot(v1, d2) + dot(d1, v2))
            if batch.level[2] != 0.0:
                a1, a2 = sums(batch, n, a, 0.0)
                g += batch.level[2] * (dot(a1, d2) + 2.0 * dot(v1, v2) + dot(d1, a2))
        r[batch.unknown[n]] += g
        lam = q[batch.unknown[n]] + batch.alpha[n] * g
        for k in range(batch.start[n], batch.start[n + 1]):
            d = d2 if batch.second[k] == 0 else d1
            for c in range(3):
                r[batch.slot[k] + c] += lam * batch.factor[k] * d[c]


@inline_kernel
def joint_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add C_q, the change of the joints' forces with the motion, and alpha C_q^T C_q."""
    weight = batch.level[0] * c_stiffness + batch.level[1] * c_damping + batch.level[2] * c_mass
    for n in range(batch.unknown.shape[0]):
        d1, d2 = sums(batch, n, q, 1.0)
        alpha = c_mass * batch.scale[n, 0] + c_stiffness * batch.scale[n, 1 if c_mass > 0.0 else 2]
        batch.alpha[n] = alpha
        lam = c_stiffness * q[batch.unknown[n]]
        first, p = batch.start[n], batch.pair_start[n]
        entries = batch.start[n + 1] - first
        for k in range(entries):
            d = d2 if batch.second[first + k] == 0 else d1
            f = weight * batch.factor[first + k]
            for c in range(3):
                A[batch.place[first + k] + c] += f * d[c]
            for m in range(entries):
                place = batch.pair[p + k * entries + m]
                if place < 0:
                    continue
                e = d2 if batch.second[first + m] == 0 else d1
                w = batch.factor[first + k] * batch.factor[first + m]
                for i in range(3):
                    if batch.second[first + k] != batch.second[first + m]:
                        A[place + 7 * i] += lam * w
                    for j in range(3):
                        A[place + 6 * i + j] += alpha * w * d[i] * e[j]


@inline_kernel
def joint_slopes(batch, q, v, a, x, by_q, by_v, by_a, ws):
    """See :func:`ancf.compiled.add_work_slopes`; alpha has no part in it."""
    w0, w1, w2 = batch.level[0], batch.level[1], batch.level[2]
    for n in range(batch.unknown.shape[0]):
        i = batch.unknown[n]
        d1, d2 = sums(batch, n, q, 1.0)
        v1, v2 = sums(batch, n, v, 0.0)
        a1, a2 = sums(batch, n, a, 0.0)
        x1, x2 = sums(batch, n, x, 0.0)
        lam, y = q[i], x[i]
        by_q[i] += dot(x1, d2) + dot(d1, x2)
        for k in range(batch.start[n], batch.start[n + 1]):
            m, f = batch.slot[k], batch.factor[k]
            d, rate, second, along = (d2, v2, a2, x2) if batch.second[k] == 0 else (d1, v1, a1, x1)
            for c in range(3):
                by_q[m + c] += f * (lam * along[c] + y * (w0 * d[c] + w1 * rate[c] + w2 * second[c]))
                by_v[m + c] += f * y * (w1 * d[c] + 2.0 * w2 * rate[c])
                by_a[m + c] += f * y * w2 * d[c]


@formula
def lane_sums(batch, n, d, k):
    """Rates of d1 and d2 of row n along eight directions, d[k] of q, v or a."""
    none = every(0.0)
    first, second = (none, none, none), (none, none, none)
    for m in range(batch.start[n], batch.start[n + 1]):
        if batch.second[m] == 0:
            first = lanes_plus(first, batch.factor[m], d, k, batch.slot[m])
        else:
            second = lanes_plus(second, batch.factor[m], d, k, batch.slot[m])
    return first, second


@inline_kernel
def joint_slopes_along(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_force_slopes`; alpha has no part in it."""
    w0, w1, w2 = batch.level[0], batch.level[1], batch.level[2]
    for n in range(batch.unknown.shape[0]):
        i = batch.unknown[n]
        d1, d2 = sums(batch, n, q, 1.0)
        s1, s2 = lane_sums(batch, n, d, 0)
        g = w0 * (dot(d2, s1) + dot(d1, s2))
        if w1 != 0.0 or w2 != 0.0:
            v1, v2 = sums(batch, n, v, 0.0)
            r1, r2 = lane_sums(batch, n, d, 1)
            g = g + w1 * (dot(d2, r1) + dot(d1, r2) + dot(v2, s1) + dot(v1, s2))
            if w2 != 0.0:
                a1, a2 = sums(batch, n, a, 0.0)
                b1, b2 = lane_sums(batch, n, d, 2)
                g = g + w2 * (dot(d2, b1) + dot(d1, b2) + dot(a2, s1) + dot(a1, s2))
                g = g + (2.0 * w2) * (dot(v2, r1) + dot(v1, r2))
        store(load(r, i) + g, r, i)
        lam, y = q[i], load(d, 0, i)
        for k in range(batch.start[n], batch.start[n + 1]):
            m, f = batch.slot[k], batch.factor[k]
            x, s = (d2, s2) if batch.second[k] == 0 else (d1, s1)
            for c in range(3):
                store(load(r, m + c) + (f * x[c]) * y + (f * lam) * s[c], r, m + c)


@inline_kernel
def joint_slopes_beside(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_slopes_beside`: what velocities and accelerations do to the rows."""
    w1, w2 = batch.level[1], batch.level[2]
    if w1 == 0.0 and w2 == 0.0:
        return
    for n in range(batch.unknown.shape[0]):
        i = batch.unknown[n]
        v1, v2 = sums(batch, n, v, 0.0)
        s1, s2 = lane_sums(batch, n, d, 0)
        g = w1 * (dot(v2, s1) + dot(v1, s2))
        if w2 != 0.0:
            a1, a2 = sums(batch, n, a, 0.0)
            r1, r2 = lane_sums(batch, n, d, 1)
            g = g + w2 * (dot(a2, s1) + dot(a1, s2)) + (2.0 * w2) * (dot(v2, r1) + dot(v1, r2))
        store(load(r, i) + g, r, i)


implements(
    JointBatch,
    force=joint_force,
    tangent=joint_tangent,
    work_slopes=joint_slopes,
    force_slopes=joint_slopes_along,
    slopes_beside=joint_slopes_beside,
    role=Role.CONSTRAINS,
    slots=("unknown", "slot"),
    couples=joint_pairs,
    bind=bind_joints,
)
