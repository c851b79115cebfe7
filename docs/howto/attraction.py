"""Attraction by a centre, and drag: F = -s d/|d|^3 - c |v| v, d = r - centre.

The example of "Write a load".  With y = 1/|d| and u = d y the derivatives are

    -dF/dr = s y^3 (1 - 3 u u^T),      -dF/dv = c (|v| 1 + v v^T/|v|).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ancf.compiled import Role, implements, inline_kernel
from ancf.loads.at_points import add_force_at, add_tangent_at, at_point, at_points

FloatArray = NDArray[np.float64]


class AttractionBatch(NamedTuple):
    """All attractions of a System."""

    base: NDArray[np.int64]  # (n, k) slots of the points
    dest: NDArray[np.int64]  # (n, k*k) places in the matrix
    factor: FloatArray  # (n, k)
    centre: FloatArray  # (n, 3) m
    drag: FloatArray  # (n,) c, N s^2/m^2
    value: FloatArray  # (n, 1, 3) inputs now: s at [e, 0, 0], N m^2


def build(items, locate, value):
    """Batch of these loads; ``locate`` finds points, ``value`` are their inputs."""
    return AttractionBatch(
        **at_points([item.point for item in items], locate),
        centre=np.array([item.centre for item in items]),
        drag=np.array([item.drag for item in items]),
        value=value,
    )


@inline_kernel
def distance(batch, e, q):
    """Vector from the centre to the point, and one over its length."""
    x, y, z = at_point(batch, e, q)
    d = (x - batch.centre[e, 0], y - batch.centre[e, 1], z - batch.centre[e, 2])
    return d, 1.0 / math.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])


@inline_kernel
def attraction_force(batch, q, v, a, r, ws):
    """Subtract the forces from the residual."""
    for e in range(batch.base.shape[0]):
        d, y = distance(batch, e, q)
        w = at_point(batch, e, v)
        pull = batch.value[e, 0, 0] * y * y * y
        c = batch.drag[e] * math.sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2])
        force = (
            -pull * d[0] - c * w[0],
            -pull * d[1] - c * w[1],
            -pull * d[2] - c * w[2],
        )
        add_force_at(batch, e, force, r)


@inline_kernel
def along(x, a, u):
    """Rows of x 1 + a u u^T."""
    return (
        (x + a * u[0] * u[0], a * u[0] * u[1], a * u[0] * u[2]),
        (a * u[1] * u[0], x + a * u[1] * u[1], a * u[1] * u[2]),
        (a * u[2] * u[0], a * u[2] * u[1], x + a * u[2] * u[2]),
    )


@inline_kernel
def attraction_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add minus the derivatives by position and velocity; they are symmetric."""
    for e in range(batch.base.shape[0]):
        d, y = distance(batch, e, q)
        s = c_stiffness * batch.value[e, 0, 0] * y * y * y
        add_tangent_at(batch, e, along(s, -3.0 * s * y * y, d), A)
        w = at_point(batch, e, v)
        speed = math.sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2])
        c = c_damping * batch.drag[e]
        if speed > 0.0:
            add_tangent_at(batch, e, along(c * speed, c / speed, w), A)


implements(
    AttractionBatch,
    force=attraction_force,
    tangent=attraction_tangent,
    role=Role.EXTERNAL,
)
