"""Forces that turn with what they act on: F = F_1 e_1 + F_2 e_2 + F_3 e_3 in its axes.

On a cable e_1 is the unit tangent, and there are no other axes.  On a section e_1 is its normal, and e_2 and
e_3 are as near to r_y as to r_z, as results have them; on a rigid body they are its own.  Such forces have no
potential: the matrix takes the symmetric part of their derivatives, see :mod:`ancf.loads.follower_slopes`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import Role, formula, implements, inline_kernel
from ..model.bodies.beam import Beam
from .follower_slopes import (
    differentiate,
    follower_slopes_along,
    follower_slopes_beside,
    follower_work_slopes,
    put_axes,
    section_axes,
    section_of,
    unit,
)

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
def following(batch, e):
    """The force with the axes that have been put."""
    a, F = batch.axes[e], batch.value[e, 0]
    if not batch.framed[e]:
        t, _ = unit(a[0], a[1], a[2])
        return F[0] * t[0], F[0] * t[1], F[0] * t[2]
    t, y, z = section_axes(section_of(a))
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


implements(
    FollowerForceBatch,
    force=follower_force,
    tangent=follower_tangent,
    work_slopes=follower_work_slopes,
    force_slopes=follower_slopes_along,
    slopes_beside=follower_slopes_beside,
    role=Role.EXTERNAL,
)
