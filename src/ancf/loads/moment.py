"""Moment M on the slope r_x of a point: the virtual work M . (r_x x delta r_x)/|r_x|^2.

It acts on r_x as the force f = (M x r_x)/|r_x|^2.  The component along r_x does no work: a cable has no
rotation about its axis.  The matrix takes the symmetric part of the derivative, which is all of it as
long as M is perpendicular to r_x.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import Role, formula, implements, inline_kernel
from ..simd import every, load, store
from ..vectors import both, cross, dot


class MomentBatch(NamedTuple):
    """All moments; the slope is r_x = sum(factor_k q[base_k])."""

    base: NDArray[np.int64]  # (n, 4)
    dest: NDArray[np.int64]  # (n, 16) places of the 3x3 blocks in the matrix
    factor: FloatArray  # (n, 4) derivatives of the shape functions
    value: FloatArray  # (n, 3) moment now, N m


@formula
def moment_slope(batch, e, q):
    """The slope r_x or its rate."""
    x, y, z = 0.0, 0.0, 0.0
    for k in range(4):
        i, w = batch.base[e, k], batch.factor[e, k]
        x += w * q[i]
        y += w * q[i + 1]
        z += w * q[i + 2]
    return x, y, z


@formula
def slope_force(batch, e, q):
    """Slope p, |p|^2 and the force f on it."""
    p = moment_slope(batch, e, q)
    a = p[0] * p[0] + p[1] * p[1] + p[2] * p[2]
    mx, my, mz = batch.value[e, 0] / a, batch.value[e, 1] / a, batch.value[e, 2] / a
    f = (my * p[2] - mz * p[1], mz * p[0] - mx * p[2], mx * p[1] - my * p[0])
    return p, a, f


@inline_kernel
def moment_force(batch, q, v, a, r, ws):
    """Subtract the moments' forces from r."""
    for e in range(batch.base.shape[0]):
        _, _, f = slope_force(batch, e, q)
        for k in range(4):
            for c in range(3):
                r[batch.base[e, k] + c] -= batch.factor[e, k] * f[c]


@inline_kernel
def moment_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add the symmetric part of the moments' stiffness to A."""
    for e in range(batch.base.shape[0]):
        p, a, f = slope_force(batch, e, q)
        for k in range(4):
            for m in range(4):
                place = batch.dest[e, 4 * k + m]
                if place < 0:
                    continue
                w = c_stiffness * batch.factor[e, k] * batch.factor[e, m] / a
                for i in range(3):
                    for j in range(3):
                        A[place + 6 * i + j] += w * (f[i] * p[j] + p[i] * f[j])


@inline_kernel
def moment_work_slopes(batch, q, v, a, x, by_q, by_v, by_a, ws):
    """See :func:`ancf.compiled.add_work_slopes`: the work is -(X x M).p/|p|^2."""
    for e in range(batch.base.shape[0]):
        p, X = moment_slope(batch, e, q), moment_slope(batch, e, x)
        n = cross(X, (batch.value[e, 0], batch.value[e, 1], batch.value[e, 2]))
        inverse = 1.0 / dot(p, p)
        by = both(-inverse, n, 2.0 * dot(n, p) * inverse * inverse, p)
        for k in range(4):
            for c in range(3):
                by_q[batch.base[e, k] + c] += batch.factor[e, k] * by[c]


@inline_kernel
def subtract_along(batch, e, T, d, r):
    """Subtract the rows T of a matrix on the slope times the directions d, (size, 8), from r."""
    x = y = z = every(0.0)
    for k in range(4):
        i, w = batch.base[e, k], batch.factor[e, k]
        x, y, z = x + w * load(d, i), y + w * load(d, i + 1), z + w * load(d, i + 2)
    for c in range(3):
        f = T[c][0] * x + T[c][1] * y + T[c][2] * z
        for k in range(4):
            i = batch.base[e, k] + c
            store(load(r, i) - batch.factor[e, k] * f, r, i)


@formula
def skew_part(batch, e, p, a, f):
    """Half of the derivative of f by the slope less half of its transpose, as the vector s of s x p."""
    n = cross(f, p)
    return (batch.value[e, 0] + n[0]) / a, (batch.value[e, 1] + n[1]) / a, (batch.value[e, 2] + n[2]) / a


@inline_kernel
def moment_along(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_force_slopes`."""
    for e in range(batch.base.shape[0]):
        p, size, f = slope_force(batch, e, q)
        m0, m1, m2 = batch.value[e, 0] / size, batch.value[e, 1] / size, batch.value[e, 2] / size
        g = (-2.0 / size * f[0], -2.0 / size * f[1], -2.0 / size * f[2])
        T = (
            (g[0] * p[0], g[0] * p[1] - m2, g[0] * p[2] + m1),
            (g[1] * p[0] + m2, g[1] * p[1], g[1] * p[2] - m0),
            (g[2] * p[0] - m1, g[2] * p[1] + m0, g[2] * p[2]),
        )
        subtract_along(batch, e, T, d[0], r)


@inline_kernel
def moment_beside(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_slopes_beside`: the antisymmetric part."""
    for e in range(batch.base.shape[0]):
        p, size, f = slope_force(batch, e, q)
        s0, s1, s2 = skew_part(batch, e, p, size, f)
        subtract_along(batch, e, ((0.0, -s2, s1), (s2, 0.0, -s0), (-s1, s0, 0.0)), d[0], r)


implements(
    MomentBatch,
    force=moment_force,
    tangent=moment_tangent,
    work_slopes=moment_work_slopes,
    force_slopes=moment_along,
    slopes_beside=moment_beside,
    role=Role.EXTERNAL,
)
