"""Moment M on the cross-section of a beam: the virtual work M . delta theta.

The rotation of the section is the mean of what r_y and r_z turn, each counted once:

    delta theta = (I - t t^T/2) sum_i  r_i x delta r_i/|r_i|^2,   i = y, z,   t = r_y x r_z/|r_y x r_z|,

which gives delta theta itself for a rigid rotation of a section whose r_y and r_z are at right angles, as
they are up to the shear of the section.  M acts as the forces f_i = (m x r_i)/|r_i|^2 with
m = M - t (t . M)/2 on r_i: a moment about r_z on r_y alone, a torque by halves on both.  The matrix
takes the symmetric part of the derivative.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..compiled import implements, inline_kernel

FloatArray = NDArray[np.float64]


class SectionMomentBatch(NamedTuple):
    """All moments; r_y is the sum over columns 0, 1, 2 of factor_k q[base_k], r_z that over 3, 4, 5."""

    base: NDArray[np.int64]  # (n, 6), -1 unused
    dest: NDArray[np.int64]  # (n, 36) places of the 3x3 blocks in the matrix
    factor: FloatArray  # (n, 6) shape functions
    value: FloatArray  # (n, 3) moment now, N m


@inline_kernel
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
def cross(a, b):
    """Vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@inline_kernel
def scalar(a, b):
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inline_kernel
def section_axis(batch, e, ry, rz):
    """t, |r_y x r_z|, t . M and m."""
    c = cross(ry, rz)
    size = math.sqrt(scalar(c, c))
    t = (c[0] / size, c[1] / size, c[2] / size)
    M = (batch.value[e, 0], batch.value[e, 1], batch.value[e, 2])
    s = scalar(t, M)
    return t, size, s, (M[0] - 0.5 * s * t[0], M[1] - 0.5 * s * t[1], M[2] - 0.5 * s * t[2])


@inline_kernel
def section_moment_force(batch, q, v, a, r, ws):
    """Subtract the moments' forces from r."""
    for e in range(batch.base.shape[0]):
        ry, rz = section_vector(batch, e, q, 0), section_vector(batch, e, q, 3)
        _, _, _, m = section_axis(batch, e, ry, rz)
        for k in range(6):
            i = batch.base[e, k]
            if i >= 0:
                p = ry if k < 3 else rz
                f, w = cross(m, p), batch.factor[e, k] / scalar(p, p)
                for c in range(3):
                    r[i + c] -= w * f[c]


@inline_kernel
def section_moment_inertia(batch, a, r, ws):
    """Loads have no mass."""


@inline_kernel
def derivative_of_force(batch, e, ry, rz, ws):
    """ws[6 i + j] = derivative of component i of (f_y, f_z) by component j of (r_y, r_z).

    What is skew, the change of f_i = (m x r_i)/|r_i|^2 at a constant m/|r_i|^2, is left out.
    """
    t, size, s, m = section_axis(batch, e, ry, rz)
    M = (batch.value[e, 0], batch.value[e, 1], batch.value[e, 2])
    a, b = scalar(ry, ry), scalar(rz, rz)
    fy, fz = cross(m, ry), cross(m, rz)
    for j in range(6):
        unit = (1.0 if j % 3 == 0 else 0.0, 1.0 if j % 3 == 1 else 0.0, 1.0 if j % 3 == 2 else 0.0)
        dc = cross(unit, rz) if j < 3 else cross(ry, unit)
        along = scalar(t, dc)
        dt = ((dc[0] - along * t[0]) / size, (dc[1] - along * t[1]) / size, (dc[2] - along * t[2]) / size)
        ds = scalar(dt, M)
        dm = (
            -0.5 * (s * dt[0] + ds * t[0]),
            -0.5 * (s * dt[1] + ds * t[1]),
            -0.5 * (s * dt[2] + ds * t[2]),
        )
        dy, dz = cross(dm, ry), cross(dm, rz)
        ly = 2.0 * ry[j % 3] / a if j < 3 else 0.0
        lz = 0.0 if j < 3 else 2.0 * rz[j % 3] / b
        for i in range(3):
            ws[6 * i + j] = (dy[i] - ly * fy[i]) / a
            ws[6 * (i + 3) + j] = (dz[i] - lz * fz[i]) / b


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
def section_moment_energy(batch, q, ws):
    """Loads store nothing: what they do counts as supplied energy."""
    return 0.0


implements(
    SectionMomentBatch,
    force=section_moment_force,
    inertia=section_moment_inertia,
    tangent=section_moment_tangent,
    energy=section_moment_energy,
)
