"""Forces that turn with what they act on: F = F_1 e_1 + F_2 e_2 + F_3 e_3 in its axes.

On a cable e_1 is the unit tangent, and there are no other axes.  On a section e_1 is its normal, and e_2 and
e_3 are as near to r_y as to r_z, as results have them; on a rigid body they are its own.  Such forces have no
potential: the matrix takes the symmetric part of their derivatives, which are central differences.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import Role, formula, implements, inline_kernel
from ..model.beam import Beam
from ..vectors import dot
from .at_points import at_point

#: Step of the differences; slopes and directors are about 1.
STEP = 1e-6
#: The same of order four, and its weights.
WIDE, NEAR, FAR = 1e-3, 8.0 / 12.0, -1.0 / 12.0
# rows of a probe's factors, see ancf.system.probe: the point, and r_x, r_y, r_z, for which directors stand
PLACE, AXES = 0, (1, 3, 4)


class FollowerForceBatch(NamedTuple):
    """All forces that follow."""

    base: NDArray[np.int64]  # (n, k)
    dest: NDArray[np.int64]  # (n, k*k)
    factor: FloatArray  # (n, k) of the point
    slope: FloatArray  # (n, 3, k) of r_x, r_y, r_z
    framed: NDArray[np.bool_]  # (n,) whether there is more than a tangent
    axes: FloatArray  # (n, 9) scratch memory: r_x, r_y, r_z now
    change: FloatArray  # (n, 3, 9) scratch memory: derivatives of the force by them
    value: FloatArray  # (n, 1, 3) components now, N


def build(items, locate, value):
    """Batch of these loads."""
    probes = [locate(item.point) for item in items]
    cable = np.zeros((2, 4))  # which has no r_y and r_z
    rows = [p.S if len(p.S) > max(AXES) else np.vstack([p.S, cable]) for p in probes]
    used = [np.flatnonzero(np.any(S[[PLACE, *AXES]] != 0.0, axis=0)) for S in rows]
    n, k = len(items), max(map(len, used))
    base, factor, slope = np.full((n, k), -1, dtype=np.int64), np.zeros((n, k)), np.zeros((n, 3, k))
    for e, (probe, S, columns) in enumerate(zip(probes, rows, used, strict=True)):
        here = slice(0, len(columns))
        base[e, here], factor[e, here] = probe.slots[columns], S[PLACE, columns]
        slope[e, :, here] = S[np.ix_(AXES, columns)]
    bodies = [item.point.body for item in items]
    return FollowerForceBatch(
        base=base,
        dest=np.full((n, k * k), -1, dtype=np.int64),
        factor=factor,
        slope=slope,
        framed=np.array([not isinstance(body, Beam) or body.has_section for body in bodies]),
        axes=np.zeros((n, 9)),
        change=np.zeros((n, 3, 9)),
        value=value,
    )


@formula
def put_axes(batch, e, q):
    """r_x, r_y and r_z of point e into the scratch memory."""
    for d in range(3):
        for c in range(3):
            x = 0.0
            for k in range(batch.base.shape[1]):
                if batch.base[e, k] >= 0:
                    x += batch.slope[e, d, k] * q[batch.base[e, k] + c]
            batch.axes[e, 3 * d + c] = x


@inline_kernel
def unit(x, y, z):
    """Unit vector."""
    inverse = 1.0 / math.sqrt(x * x + y * y + z * z)
    return x * inverse, y * inverse, z * inverse


@formula
def following(batch, e):
    """The force with the axes that have been put."""
    a, F = batch.axes[e], batch.value[e, 0]
    if not batch.framed[e]:
        t = unit(a[0], a[1], a[2])
        return F[0] * t[0], F[0] * t[1], F[0] * t[2]
    y, z = unit(a[3], a[4], a[5]), unit(a[6], a[7], a[8])
    s = unit(y[0] + z[0], y[1] + z[1], y[2] + z[2])
    d = unit(y[0] - z[0], y[1] - z[1], y[2] - z[2])
    w = math.sqrt(0.5)
    y = (w * (s[0] + d[0]), w * (s[1] + d[1]), w * (s[2] + d[2]))
    z = (w * (s[0] - d[0]), w * (s[1] - d[1]), w * (s[2] - d[2]))
    t = (y[1] * z[2] - y[2] * z[1], y[2] * z[0] - y[0] * z[2], y[0] * z[1] - y[1] * z[0])
    return (
        F[0] * t[0] + F[1] * y[0] + F[2] * z[0],
        F[0] * t[1] + F[1] * y[1] + F[2] * z[1],
        F[0] * t[2] + F[1] * y[2] + F[2] * z[2],
    )


@inline_kernel
def follower_force(batch, q, v, a, r, ws):
    """Subtract the forces from r."""
    for e in range(batch.base.shape[0]):
        put_axes(batch, e, q)
        force = following(batch, e)
        for k in range(batch.base.shape[1]):
            i = batch.base[e, k]
            if i >= 0:
                for c in range(3):
                    r[i + c] -= batch.factor[e, k] * force[c]


@formula
def differentiate(batch, e):
    """Derivatives of the force by r_x, r_y and r_z."""
    for j in range(9):
        here = batch.axes[e, j]
        batch.axes[e, j] = here + STEP
        ahead = following(batch, e)
        batch.axes[e, j] = here - STEP
        behind = following(batch, e)
        batch.axes[e, j] = here
        for i in range(3):
            batch.change[e, i, j] = (ahead[i] - behind[i]) / (2.0 * STEP)


@inline_kernel
def follower_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add the symmetric part of minus the derivatives."""
    size = batch.base.shape[1]
    for e in range(batch.base.shape[0]):
        put_axes(batch, e, q)
        differentiate(batch, e)
        for k in range(size):
            for m in range(size):
                place = batch.dest[e, size * k + m]
                if place < 0:
                    continue
                for i in range(3):
                    for j in range(3):
                        x, y = 0.0, 0.0
                        for d in range(3):
                            x += batch.slope[e, d, m] * batch.change[e, i, 3 * d + j]
                            y += batch.slope[e, d, k] * batch.change[e, j, 3 * d + i]
                        x = batch.factor[e, k] * x + batch.factor[e, m] * y
                        A[place + 6 * i + j] -= 0.5 * c_stiffness * x


@inline_kernel
def follower_work_slopes(batch, q, v, a, x, by_q, by_v, by_a, ws):
    """See :func:`ancf.compiled.add_work_slopes`: by the axes by differences of order four."""
    for e in range(batch.base.shape[0]):
        put_axes(batch, e, q)
        X = at_point(batch, e, x)
        for d in range(3 if batch.framed[e] else 1):
            for c in range(3):
                j = 3 * d + c
                here, by = batch.axes[e, j], 0.0
                for m in range(4):
                    batch.axes[e, j] = here + WIDE * (m - 2.0 if m < 2 else m - 1.0)
                    f = following(batch, e)
                    by += (FAR if m == 0 or m == 3 else NEAR) * (1.0 if m > 1 else -1.0) * dot(f, X)
                batch.axes[e, j] = here
                for k in range(batch.base.shape[1]):
                    if batch.base[e, k] >= 0:
                        by_q[batch.base[e, k] + c] -= batch.slope[e, d, k] * by / WIDE


implements(
    FollowerForceBatch,
    force=follower_force,
    tangent=follower_tangent,
    work_slopes=follower_work_slopes,
    role=Role.EXTERNAL,
)
