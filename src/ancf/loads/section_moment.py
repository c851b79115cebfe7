"""Moment M on the cross-section of a beam: the virtual work M . delta theta.

The rotation of the section is that of the rigid turn nearest to what r_y and r_z do, weighted by what each
of them carries of a torque, the section's second moments w_y = I_z/I_p and w_z = I_y/I_p, I_p = I_y + I_z:

    delta theta = J^-1 sum_i w_i r_i x delta r_i,     J = sum_i w_i (r_i.r_i I - r_i r_i^T),     i = y, z.

It gives delta theta itself for a rigid rotation of any section, sheared and stretched ones included, so that
the forces f_i = w_i (J^-1 M) x r_i on r_y and r_z have the moment sum r_i x f_i = M in every state.  With
c = r_y x r_z they are

    f_y = -(M.r_z) c/c.c + w_y s c x r_y,   f_z = (M.r_y) c/c.c + w_z s c x r_z,
    s = (M.c)/(c.c (w_y r_y.r_y + w_z r_z.r_z)):

a moment about r_z acts on r_y alone, and a torque in the shares in which the stress of pure torsion acts on
r_y and r_z, so that it does not shear the section where it acts.  The matrix takes the symmetric part of
the derivative.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import Role, formula, implements, inline_kernel
from ..simd import every, load, store
from ..vectors import both, cross, dot


class SectionMomentBatch(NamedTuple):
    """All moments; r_y is the sum over columns 0, 1, 2 of factor_k q[base_k], r_z that over 3, 4, 5."""

    base: NDArray[np.int64]  # (n, 6), -1 unused
    dest: NDArray[np.int64]  # (n, 36) places of the 3x3 blocks in the matrix
    factor: FloatArray  # (n, 6) shape functions
    share: FloatArray  # (n, 2) w_y, w_z, whose sum is 1
    value: FloatArray  # (n, 3) moment now, N m


@formula
def section_vector(batch, e, q, first):
    """r_y (first = 0) or r_z (first = 3)."""
    x, y, z = 0.0, 0.0, 0.0
    for k in range(first, first + 3):
        i, w = batch.base[e, k], batch.factor[e, k]
        if i >= 0:
            x += w * q[i]
            y += w * q[i + 1]
            z += w * q[i + 2]
    return x, y, z


@inline_kernel
def sum3(x, a, y, b, z, c):
    """Sum of three vectors with factors."""
    return (
        x * a[0] + y * b[0] + z * c[0],
        x * a[1] + y * b[1] + z * c[1],
        x * a[2] + y * b[2] + z * c[2],
    )


@formula
def turning(batch, e, ry, rz, M):
    """J^-1 M."""
    wy, wz = batch.share[e, 0], batch.share[e, 1]
    c = cross(ry, rz)
    cc = dot(c, c)
    s = dot(c, M) / (cc * (wy * dot(ry, ry) + wz * dot(rz, rz)))
    return sum3(s, c, dot(ry, M) / (wz * cc), ry, dot(rz, M) / (wy * cc), rz)


@formula
def section_forces(batch, e, ry, rz):
    """f_y and f_z."""
    wy, wz = batch.share[e, 0], batch.share[e, 1]
    M = (batch.value[e, 0], batch.value[e, 1], batch.value[e, 2])
    c = cross(ry, rz)
    cc = dot(c, c)
    s = dot(c, M) / (cc * (wy * dot(ry, ry) + wz * dot(rz, rz)))
    ty, tz = cross(c, ry), cross(c, rz)
    fy = sum3(-dot(M, rz) / cc, c, wy * s, ty, 0.0, c)
    fz = sum3(dot(M, ry) / cc, c, wz * s, tz, 0.0, c)
    return fy, fz


@inline_kernel
def section_moment_force(batch, q, v, a, r, ws):
    """Subtract the moments' forces from r."""
    for e in range(batch.base.shape[0]):
        ry, rz = section_vector(batch, e, q, 0), section_vector(batch, e, q, 3)
        fy, fz = section_forces(batch, e, ry, rz)
        for k in range(6):
            i = batch.base[e, k]
            if i >= 0:
                f, w = fy if k < 3 else fz, batch.factor[e, k]
                for c in range(3):
                    r[i + c] -= w * f[c]


@formula
def derivative_of_force(batch, e, ry, rz, ws):
    """ws[6 i + j] = derivative of component i of (f_y, f_z) by component j of (r_y, r_z).

    What is skew, the change of f_i = w_i m x r_i at a constant m = J^-1 M, is left out.
    """
    wy, wz = batch.share[e, 0], batch.share[e, 1]
    m = turning(batch, e, ry, rz, (batch.value[e, 0], batch.value[e, 1], batch.value[e, 2]))
    for j in range(6):
        p, w, k = ry if j < 3 else rz, wy if j < 3 else wz, j % 3
        unit = (1.0 if k == 0 else 0.0, 1.0 if k == 1 else 0.0, 1.0 if k == 2 else 0.0)
        # dm = -J^-1 dJ m
        dm = turning(batch, e, ry, rz, sum3(-2.0 * w * p[k], m, w * dot(p, m), unit, w * m[k], p))
        dy, dz = cross(dm, ry), cross(dm, rz)
        for i in range(3):
            ws[6 * i + j] = wy * dy[i]
            ws[6 * (i + 3) + j] = wz * dz[i]


@inline_kernel
def section_moment_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add the symmetric part of the moments' stiffness to A."""
    for e in range(batch.base.shape[0]):
        ry, rz = section_vector(batch, e, q, 0), section_vector(batch, e, q, 3)
        derivative_of_force(batch, e, ry, rz, ws)
        for k in range(6):
            for n in range(6):
                place = batch.dest[e, 6 * k + n]
                if place < 0:
                    continue
                w = -0.5 * c_stiffness * batch.factor[e, k] * batch.factor[e, n]
                for i in range(3):
                    for j in range(3):
                        x, y = 3 * (k // 3) + i, 3 * (n // 3) + j
                        A[place + 6 * i + j] += w * (ws[6 * x + y] + ws[6 * y + x])


@inline_kernel
def section_moment_slopes(batch, q, v, a, x, by_q, by_v, by_a, ws):
    """See :func:`ancf.compiled.add_work_slopes`.

    With u and w of x for r_y and r_z the work is -(c.g/c.c + s c.h), g = -(M.r_z) u + (M.r_y) w,
    h = w_y r_y x u + w_z r_z x w.
    """
    for e in range(batch.base.shape[0]):
        y, z = section_vector(batch, e, q, 0), section_vector(batch, e, q, 3)
        u, w = section_vector(batch, e, x, 0), section_vector(batch, e, x, 3)
        wy, wz, M = (
            batch.share[e, 0],
            batch.share[e, 1],
            (batch.value[e, 0], batch.value[e, 1], batch.value[e, 2]),
        )
        c = cross(y, z)
        cc, D = dot(c, c), wy * dot(y, y) + wz * dot(z, z)
        s, g = dot(c, M) / (cc * D), both(-dot(M, z), u, dot(M, y), w)
        h = both(wy, cross(y, u), wz, cross(z, w))
        ch, cg = dot(c, h), dot(c, g)
        by_c = sum3(1.0 / cc, g, s, h, ch / (cc * D), M)
        by_c = both(1.0, by_c, -2.0 * (cg / cc + s * ch) / cc, c)
        fall = -2.0 * s * ch / D
        f = sum3(1.0, cross(z, by_c), dot(c, w) / cc, M, s * wy, cross(u, c))
        by_y = both(1.0, f, fall * wy, y)
        f = sum3(1.0, cross(by_c, y), -dot(c, u) / cc, M, s * wz, cross(w, c))
        by_z = both(1.0, f, fall * wz, z)
        for k in range(6):
            i = batch.base[e, k]
            if i >= 0:
                by, f = by_y if k < 3 else by_z, batch.factor[e, k]
                for d in range(3):
                    by_q[i + d] -= f * by[d]


@inline_kernel
def whole_derivative(batch, e, q, ws):
    """As :func:`derivative_of_force`, with what is skew: f_i = w_i m x r_i."""
    y, z = section_vector(batch, e, q, 0), section_vector(batch, e, q, 3)
    derivative_of_force(batch, e, y, z, ws)
    m = turning(batch, e, y, z, (batch.value[e, 0], batch.value[e, 1], batch.value[e, 2]))
    for own in range(2):
        o, w = 21 * own, batch.share[e, own]
        ws[o + 1] -= w * m[2]
        ws[o + 2] += w * m[1]
        ws[o + 6] += w * m[2]
        ws[o + 8] -= w * m[0]
        ws[o + 12] -= w * m[1]
        ws[o + 13] += w * m[0]


@formula
def along_section(batch, e, d, first, c):
    """Component c of what r_y (first = 0) or r_z (first = 3) changes by along directions (size, 8)."""
    moved = every(0.0)
    for k in range(first, first + 3):
        i = batch.base[e, k]
        if i >= 0:
            moved = moved + batch.factor[e, k] * load(d, i + c)
    return moved


@inline_kernel
def subtract_along(batch, e, ws, d, r):
    """Subtract the matrix of :func:`whole_derivative` times the directions d, (size, 8), from r."""
    u0, u1, u2 = (
        along_section(batch, e, d, 0, 0),
        along_section(batch, e, d, 0, 1),
        along_section(batch, e, d, 0, 2),
    )
    w0, w1, w2 = (
        along_section(batch, e, d, 3, 0),
        along_section(batch, e, d, 3, 1),
        along_section(batch, e, d, 3, 2),
    )
    for n in range(6):
        o = 6 * n
        f = ws[o] * u0 + ws[o + 1] * u1 + ws[o + 2] * u2
        f = f + ws[o + 3] * w0 + ws[o + 4] * w1 + ws[o + 5] * w2
        for k in range(3 * (n // 3), 3 * (n // 3) + 3):
            i = batch.base[e, k]
            if i >= 0:
                store(load(r, i + n % 3) - batch.factor[e, k] * f, r, i + n % 3)


@inline_kernel
def section_moment_along(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_force_slopes`."""
    for e in range(batch.base.shape[0]):
        whole_derivative(batch, e, q, ws)
        subtract_along(batch, e, ws, d[0], r)


@inline_kernel
def section_moment_beside(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_slopes_beside`: the antisymmetric part."""
    for e in range(batch.base.shape[0]):
        whole_derivative(batch, e, q, ws)
        for i in range(6):
            for j in range(i + 1):
                half = 0.5 * (ws[6 * i + j] - ws[6 * j + i])
                ws[6 * i + j], ws[6 * j + i] = half, -half
        subtract_along(batch, e, ws, d[0], r)


implements(
    SectionMomentBatch,
    force=section_moment_force,
    tangent=section_moment_tangent,
    work_slopes=section_moment_slopes,
    force_slopes=section_moment_along,
    slopes_beside=section_moment_beside,
    role=Role.EXTERNAL,
)
