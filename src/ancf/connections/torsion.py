"""Torsion spring and damper: a moment M = k (theta - theta0) + c d(theta)/dt about an axis.

The angle theta is that of one or two vectors p_k of what turns against axes a_k and b_k of a frame, which are
normal to the axis of the spring and to each other, with the initial direction of p_k along a_k:

    theta = atan2(S, C),     S = sum p_k . b_k,     C = sum p_k . a_k.

All vectors are sums of unknown vectors times factors, the axes of a frame on the ground are constant.  The
force on the bodies is -M grad theta.  A memory of the last step tells how often it has gone round.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..arrays import FloatArray, IntArray
from ..compiled import Role, formula, implements, inline_kernel

SLOTS = 6  # three of what turns, three of the frame
TURN = 2.0 * math.pi


class TorsionBatch(NamedTuple):
    """All torsion springs."""

    base: IntArray  # (n, 6) slots, -1 unused
    dest: IntArray  # (n, 36) places of the 3x3 blocks in the matrix
    turned: FloatArray  # (n, 2, 3) factors of p_0 and p_1
    frame: FloatArray  # (n, 2, 2, 3) factors of a_0, b_0 and of a_1, b_1
    constant: FloatArray  # (n, 2, 2, 3) constant parts of them
    data: FloatArray  # (n, 4) stiffness, damping, angle without moment, 1 or -1: the sense of the angle
    last: FloatArray  # (n,) angle at the last step


@formula
def components(batch, e, k, c, q):
    """Component c of p_k, a_k and b_k of spring e."""
    p, a, b = 0.0, batch.constant[e, k, 0, c], batch.constant[e, k, 1, c]
    for i in range(3):
        if batch.base[e, i] >= 0:
            p += batch.turned[e, k, i] * q[batch.base[e, i] + c]
        if batch.base[e, 3 + i] >= 0:
            x = q[batch.base[e, 3 + i] + c]
            a += batch.frame[e, k, 0, i] * x
            b += batch.frame[e, k, 1, i] * x
    return p, a, b


@formula
def angle_gradients(batch, e, q, ws):
    """S and C of spring e; their gradients by the slots in ws[3 i + c] and ws[18 + 3 i + c]."""
    for i in range(36):
        ws[i] = 0.0
    S, C = 0.0, 0.0
    for k in range(2):
        for c in range(3):
            p, a, b = components(batch, e, k, c, q)
            S += p * b
            C += p * a
            for i in range(3):
                ws[3 * i + c] += batch.turned[e, k, i] * b
                ws[18 + 3 * i + c] += batch.turned[e, k, i] * a
                ws[9 + 3 * i + c] += batch.frame[e, k, 1, i] * p
                ws[27 + 3 * i + c] += batch.frame[e, k, 0, i] * p
    return S, C


@formula
def full_angle(batch, e, S, C):
    """The angle next to that of the last step."""
    angle = batch.data[e, 3] * math.atan2(S, C)
    return angle + TURN * math.floor((batch.last[e] - angle) / TURN + 0.5)


@formula
def torsion_moment(batch, e, S, C, v, ws):
    """Moment against a growing angle."""
    rate = 0.0
    for i in range(SLOTS):
        if batch.base[e, i] >= 0:
            for c in range(3):
                rate += (C * ws[3 * i + c] - S * ws[18 + 3 * i + c]) * v[batch.base[e, i] + c]
    rate *= batch.data[e, 3] / (S * S + C * C)
    return batch.data[e, 0] * (full_angle(batch, e, S, C) - batch.data[e, 2]) + batch.data[e, 1] * rate


@inline_kernel
def torsion_force(batch, q, v, a, r, ws):
    """Add the moments' forces to r."""
    for e in range(batch.base.shape[0]):
        S, C = angle_gradients(batch, e, q, ws)
        f = batch.data[e, 3] * torsion_moment(batch, e, S, C, v, ws) / (S * S + C * C)
        for i in range(SLOTS):
            if batch.base[e, i] >= 0:
                for c in range(3):
                    r[batch.base[e, i] + c] += f * (C * ws[3 * i + c] - S * ws[18 + 3 * i + c])


@formula
def turned_by(batch, e, i, m):
    """What S and C have of the product of slots i and m: their second derivatives."""
    s, c = 0.0, 0.0
    if (i < 3) != (m < 3):
        t, f = (i, m - 3) if i < 3 else (m, i - 3)
        for k in range(2):
            s += batch.turned[e, k, t] * batch.frame[e, k, 1, f]
            c += batch.turned[e, k, t] * batch.frame[e, k, 0, f]
    return s, c


@inline_kernel
def torsion_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add stiffness and damping along the gradient, and the moment times the second derivatives."""
    for e in range(batch.base.shape[0]):
        S, C = angle_gradients(batch, e, q, ws)
        D = S * S + C * C
        M = c_stiffness * batch.data[e, 3] * torsion_moment(batch, e, S, C, v, ws)
        along = (c_stiffness * batch.data[e, 0] + c_damping * batch.data[e, 1]) / (D * D)
        for i in range(SLOTS):
            for m in range(SLOTS):
                place = batch.dest[e, SLOTS * i + m]
                if place < 0:
                    continue
                s, t = turned_by(batch, e, i, m)
                for c in range(3):
                    A[place + 7 * c] += M * (C * s - S * t) / D
                    gi = C * ws[3 * i + c] - S * ws[18 + 3 * i + c]
                    wi = C * ws[18 + 3 * i + c] + S * ws[3 * i + c]
                    for d in range(3):
                        gm = C * ws[3 * m + d] - S * ws[18 + 3 * m + d]
                        wm = C * ws[18 + 3 * m + d] + S * ws[3 * m + d]
                        A[place + 6 * c + d] += along * gi * gm - M * (gi * wm + wi * gm) / (D * D)


@inline_kernel
def torsion_rate_work(batch, q, v, x, out, ws):
    """See :func:`ancf.compiled.add_rate_work`: dampers turn with the gradient of the angle."""
    for e in range(batch.base.shape[0]):
        if batch.data[e, 1] == 0.0:
            continue
        S, C = angle_gradients(batch, e, q, ws)
        D, gx, gv, wv = S * S + C * C, 0.0, 0.0, 0.0
        for i in range(SLOTS):
            if batch.base[e, i] >= 0:
                for c in range(3):
                    g = C * ws[3 * i + c] - S * ws[18 + 3 * i + c]
                    gx += g * x[batch.base[e, i] + c]
                    gv += g * v[batch.base[e, i] + c]
                    wv += (C * ws[18 + 3 * i + c] + S * ws[3 * i + c]) * v[batch.base[e, i] + c]
        f = batch.data[e, 1] * gx / (D * D)
        for i in range(SLOTS):
            if batch.base[e, i] < 0:
                continue
            for c in range(3):
                g, w = C * ws[3 * i + c] - S * ws[18 + 3 * i + c], C * ws[18 + 3 * i + c] + S * ws[3 * i + c]
                turned = -(g * wv + w * gv) / D
                for m in range(SLOTS):
                    if batch.base[e, m] >= 0:
                        s, t = turned_by(batch, e, i, m)
                        turned += (C * s - S * t) * v[batch.base[e, m] + c]
                out[batch.base[e, i] + c] += f * turned


@inline_kernel
def torsion_energy(batch, q, ws):
    """Elastic energy, J."""
    energy = 0.0
    for e in range(batch.base.shape[0]):
        S, C = angle_gradients(batch, e, q, ws)
        energy += 0.5 * batch.data[e, 0] * (full_angle(batch, e, S, C) - batch.data[e, 2]) ** 2
    return energy


@inline_kernel
def torsion_turns(batch, q, v):
    """Keep the angle of an accepted step."""
    for e in range(batch.base.shape[0]):
        S, C = 0.0, 0.0
        for k in range(2):
            for c in range(3):
                p, a, b = components(batch, e, k, c, q)
                S += p * b
                C += p * a
        batch.last[e] = full_angle(batch, e, S, C)


implements(
    TorsionBatch,
    force=torsion_force,
    tangent=torsion_tangent,
    energy=torsion_energy,
    rate_work=torsion_rate_work,
    remember=torsion_turns,
    role=Role.DISSIPATES,
    memory=("last",),
    goes_round=True,
    damped=lambda batch: bool(np.any(batch.data[:, 1])),
    exact=lambda batch, moving: not (moving and np.any(batch.data[:, 1])),
)
