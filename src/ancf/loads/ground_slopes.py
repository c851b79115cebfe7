"""Derivatives of x . force of grounds without friction by the state, see :mod:`ancf.loads.ground`.

The work of a piece is -N n.X, with N = d (k g + c on(g) g') and g' = -n.v.  On a table of heights the
normal n = (-z_x, -z_y, 1) b, b = (1 + z_x^2 + z_y^2)^-1/2, changes with the place: z_x with y and z_y with x.
"""

from __future__ import annotations

import math

from ..compiled import inline_kernel
from ..vectors import both, dot
from .along import place_at
from .relief import DAMPING, SOFT, STIFFNESS, depth_at, twist_at


@inline_kernel
def ground_work_slopes(batch, q, v, a, x, by_q, by_v, by_a, ws):
    """See :func:`ancf.compiled.add_work_slopes`."""
    for e in range(batch.base.shape[0]):
        k, d = batch.ground[e], batch.diameter[e]
        stiff, damping, soft = d * batch.grounds[k, STIFFNESS], d * batch.grounds[k, DAMPING], SOFT * d
        for p in range(batch.weight.shape[1]):
            at = place_at(batch, e, p, q)
            g, n = depth_at(batch, k, at[0], at[1], at[2])
            if g <= -soft:
                continue
            u, X = place_at(batch, e, p, v), place_at(batch, e, p, x)
            on, rate = min(1.0, 1.0 + g / soft), -dot(u, n)
            N = stiff * g + damping * on * rate
            if N <= 0.0:
                continue
            w, power = -batch.weight[e, p], dot(n, X)
            by_g = w * power * (stiff + (damping * rate / soft if on < 1.0 else 0.0))
            by_rate = w * power * damping * on
            by_n = both(w * N, X, -by_rate, u)
            fx, fy, fz = -by_g * n[0], -by_g * n[1], -by_g * n[2]
            zx, zy, twist = twist_at(batch, k, at[0], at[1])
            if twist != 0.0:
                b = 1.0 / math.sqrt(1.0 + zx * zx + zy * zy)
                by_b = by_n[2] - zx * by_n[0] - zy * by_n[1] + by_g * g / b
                by_zx, by_zy = -b * by_n[0] - b * b * b * zx * by_b, -b * by_n[1] - b * b * b * zy * by_b
                fx, fy = fx + twist * by_zy, fy + twist * by_zx
            for m in range(batch.base.shape[1]):
                i, s = batch.base[e, m], batch.shape[e, p, m]
                if i >= 0:
                    by_q[i] += s * fx
                    by_q[i + 1] += s * fy
                    by_q[i + 2] += s * fz
                    for c in range(3):
                        by_v[i + c] -= s * by_rate * n[c]
