"""Constant mass matrix of point masses and rigid bodies, given by pairs of slots.

A point mass has its position r.  A rigid body has natural coordinates: the position r of its centre of
mass and three directors d_1, d_2, d_3, orthonormal vectors that turn with it, so that the point with the
body coordinates x is r + sum x_i d_i.  There are no singular rotations, and the kinetic energy

    T = m/2 |r'|^2 + 1/2 sum J_ij d_i'. d_j',      J_ij = integral of x_i x_j dm,

has a constant matrix: gyroscopic terms do not occur (Betsch & Steinmann 2001).  J follows from the
inertia tensor I as J = tr(I)/2 1 - I.  Six rows of :mod:`ancf.connections.joint` keep it rigid.
"""

from __future__ import annotations

from typing import NamedTuple

from ..arrays import FloatArray, IntArray
from ..compiled import implements, inline_kernel


class InertiaBatch(NamedTuple):
    """Masses m_ij 1 between slots i and j; each pair stands once in each order."""

    base: IntArray  # (n, 2) slots
    dest: IntArray  # (n, 4) places of the 3x3 pieces (i, i), (i, j), (j, i), (j, j)
    mass: FloatArray  # (n,)


@inline_kernel
def body_inertia(batch, a, r, ws):
    """Add M a."""
    for n in range(batch.base.shape[0]):
        i, j, m = batch.base[n, 0], batch.base[n, 1], batch.mass[n]
        for c in range(3):
            r[i + c] += m * a[j + c]


@inline_kernel
def body_force(batch, q, v, a, r, ws):
    """Add M a: there are no other forces."""
    body_inertia(batch, a, r, ws)


@inline_kernel
def body_number_work(batch, q, v, a, x, out, ws):
    """See :func:`ancf.compiled.add_number_work`."""
    for n in range(batch.base.shape[0]):
        i, j = batch.base[n, 0], batch.base[n, 1]
        for c in range(3):
            out[n] += x[i + c] * a[j + c]


@inline_kernel
def body_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add c_mass M."""
    for n in range(batch.base.shape[0]):
        place = batch.dest[n, 1]
        if place >= 0:
            for c in range(3):
                A[place + 7 * c] += c_mass * batch.mass[n]


@inline_kernel
def body_tangent_work(batch, q, v, x, by_q, by_v, by_a, ws):
    """See :func:`ancf.compiled.add_tangent_work`."""
    body_inertia(batch, x, by_a, ws)


implements(
    InertiaBatch,
    force=body_force,
    inertia=body_inertia,
    tangent=body_tangent,
    tangent_work=body_tangent_work,
    number_work=body_number_work,
    numbers=lambda batch: batch.mass,
    numbered=("mass",),
    exact=lambda batch, moving: True,
)
