"""A cable with the logarithmic axial strain ln |r_x| and the material curvature.

The example of "Write an element". Straight natural shape, external damping only.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ancf.compiled import Role, implements, inline_kernel
from ancf.elements.cable_build import initial_vectors, shape
from ancf.elements.shapes import gauss, hermite
from ancf.model.bodies.beam import Beam

__all__ = ["build", "initial_vectors", "shape"]

POINTS = 5


class HenckyBatch(NamedTuple):
    """All n elements of the kind."""

    base: NDArray[np.int64]  # (n, 4) first unknown of r, r_x, r, r_x
    dest: NDArray[np.int64]  # (n, 16) places of the 3x3 blocks in the matrix, -1: none
    data: NDArray[np.float64]  # (n, 5) length, EA, EI, rhoA, damping
    gp: NDArray[np.float64]  # (n, POINTS, 9) weight times length, S_x (4), S_xx (4)


def build(beams: Sequence[Beam], slots: Sequence[Any]) -> HenckyBatch:
    """Batch of all elements; slots (nodes, 2) of r and r_x of the nodes, by beam."""
    base, data, points = [], [], []
    xi, w = gauss(POINTS)
    for beam, slot in zip(beams, slots, strict=True):
        s = beam.section
        for e, h in enumerate(np.diff(beam.node_x)):
            base.append([*slot[e], *slot[e + 1]])
            data.append([h, s.EA, s.EI, s.rhoA, s.damping])
            points.append(
                np.column_stack([w * h, hermite(xi, h, 1), hermite(xi, h, 2)])
            )
    unplaced = np.full((len(base), 16), -1)
    return HenckyBatch(np.array(base), unplaced, np.array(data), np.array(points))


@inline_kernel
def products(batch, e, g, q):
    """r_x, r_xx and a, b, c at a Gauss point."""
    p, s = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    for k in range(4):
        i, d, dd = batch.base[e, k], batch.gp[e, g, 1 + k], batch.gp[e, g, 5 + k]
        p = (p[0] + d * q[i], p[1] + d * q[i + 1], p[2] + d * q[i + 2])
        s = (s[0] + dd * q[i], s[1] + dd * q[i + 1], s[2] + dd * q[i + 2])
    a = p[0] * p[0] + p[1] * p[1] + p[2] * p[2]
    b = p[0] * s[0] + p[1] * s[1] + p[2] * s[2]
    c = s[0] * s[0] + s[1] * s[1] + s[2] * s[2]
    return p, s, a, b, c


@inline_kernel
def hencky_energy(batch, q, ws):
    """W = EA/2 (ln a / 2)^2 + EI/2 (a c - b^2)/a^2, J."""
    total = 0.0
    for e in range(batch.base.shape[0]):
        EA, EI = batch.data[e, 1], batch.data[e, 2]
        for g in range(batch.gp.shape[1]):
            _, _, a, b, c = products(batch, e, g, q)
            strain, square = 0.5 * math.log(a), (a * c - b * b) / a**2
            total += 0.5 * batch.gp[e, g, 0] * (EA * strain**2 + EI * square)
    return total


@inline_kernel
def mass_entry(x, y, h):
    """420/h times the integral of S_x S_y (eq. 23)."""
    if x > y:
        x, y = y, x
    if x == y:
        return 156.0 if x % 2 == 0 else 4.0 * h * h
    if x == 0:
        return 22.0 * h if y == 1 else (54.0 if y == 2 else -13.0 * h)
    if x == 1:
        return 13.0 * h if y == 2 else -3.0 * h * h
    return -22.0 * h


@inline_kernel
def add_mass(batch, column, u, r):
    """Add the mass matrix of one density (a column of data) times u to r."""
    for e in range(batch.base.shape[0]):
        h = batch.data[e, 0]
        for x in range(4):
            for y in range(4):
                m = batch.data[e, column] * h / 420.0 * mass_entry(x, y, h)
                for k in range(3):
                    r[batch.base[e, x] + k] += m * u[batch.base[e, y] + k]


@inline_kernel
def hencky_inertia(batch, a, r, ws):
    """Add M a."""
    add_mass(batch, 3, a, r)


@inline_kernel
def hencky_force(batch, q, v, a, r, ws):
    """Add M a, the external damping and the elastic forces."""
    add_mass(batch, 3, a, r)
    add_mass(batch, 4, v, r)
    for e in range(batch.base.shape[0]):
        EA, EI = batch.data[e, 1], batch.data[e, 2]
        for g in range(batch.gp.shape[1]):
            p, s, aa, b, c = products(batch, e, g, q)
            W_a = 0.25 * EA * math.log(aa) / aa
            W_a += 0.5 * EI * (2.0 * b * b / aa - c) / aa**2
            W_b, W_c = -EI * b / aa**2, 0.5 * EI / aa
            w = batch.gp[e, g, 0]
            for x in range(4):
                d, dd = w * batch.gp[e, g, 1 + x], w * batch.gp[e, g, 5 + x]
                for k in range(3):
                    with_x = 2.0 * W_a * p[k] + W_b * s[k]
                    with_xx = W_b * p[k] + 2.0 * W_c * s[k]
                    r[batch.base[e, x] + k] += d * with_x + dd * with_xx


@inline_kernel
def hencky_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add c_mass M + c_damping C + c_stiffness K to the blocks that are stored."""
    for e in range(batch.base.shape[0]):
        h, EA, EI = batch.data[e, 0], batch.data[e, 1], batch.data[e, 2]
        density = c_mass * batch.data[e, 3] + c_damping * batch.data[e, 4]
        for x in range(4):
            for y in range(4):
                place = batch.dest[e, 4 * x + y]
                if place >= 0:
                    for k in range(3):
                        A[place + 7 * k] += density * h / 420.0 * mass_entry(x, y, h)
        for g in range(batch.gp.shape[1]):
            p, s, a, b, c = products(batch, e, g, q)
            W_a = 0.25 * EA * math.log(a) / a
            W_a += 0.5 * EI * (2.0 * b * b / a - c) / a**2
            W_aa = 0.25 * EA * (1.0 - math.log(a)) / a**2
            W_aa += EI * (c - 3.0 * b * b / a) / a**3
            W_b, W_c = -EI * b / a**2, 0.5 * EI / a
            W_ab, W_ac, W_bb = 2.0 * EI * b / a**3, -0.5 * EI / a**2, -EI / a**2
            w = c_stiffness * batch.gp[e, g, 0]
            for x in range(4):
                for y in range(4):
                    place = batch.dest[e, 4 * x + y]
                    if place < 0:
                        continue
                    dx, ddx = w * batch.gp[e, g, 1 + x], w * batch.gp[e, g, 5 + x]
                    dy, ddy = batch.gp[e, g, 1 + y], batch.gp[e, g, 5 + y]
                    for i in range(3):
                        for j in range(3):
                            one = 1.0 if i == j else 0.0
                            pp, ss = p[i] * p[j], s[i] * s[j]
                            ps, sp = p[i] * s[j], s[i] * p[j]
                            K_pp = 2.0 * W_a * one + 4.0 * W_aa * pp
                            K_pp += 2.0 * W_ab * (ps + sp) + W_bb * ss
                            K_ps = W_b * one + 2.0 * W_ab * pp
                            K_sp = K_ps + 4.0 * W_ac * sp + W_bb * ps
                            K_ps += 4.0 * W_ac * ps + W_bb * sp
                            K_ss = 2.0 * W_c * one + W_bb * pp
                            first = dx * (K_pp * dy + K_ps * ddy)
                            second = ddx * (K_sp * dy + K_ss * ddy)
                            A[place + 6 * i + j] += first + second


implements(
    HenckyBatch,
    force=hencky_force,
    inertia=hencky_inertia,
    tangent=hencky_tangent,
    energy=hencky_energy,
    role=Role.DISSIPATES,
    damped=lambda batch: bool(np.any(batch.data[:, 4])),
)
