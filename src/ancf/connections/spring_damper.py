"""Spring and damper between two points, or a point and the ground; optionally slack in compression.

Tension F = k (l - l0) + c dl/dt along the line between the points.  A slack spring (a dropper, a rope)
carries nothing while l <= l0 and never pushes: F = max(F, 0).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import Role, implements, inline_kernel


class SpringBatch(NamedTuple):
    """All springs; the vector between the ends is d = sum(factor_k q[base_k]) + offset."""

    base: NDArray[np.int64]  # (n, k) slots of the two elements, -1 unused; k = 8 for cables
    dest: NDArray[np.int64]  # (n, k*k) places of the 3x3 blocks in the matrix
    factor: FloatArray  # (n, k) shape functions, negative at the first end
    offset: FloatArray  # (n, 3) position of a fixed second end
    data: FloatArray  # (n, 4) stiffness, damping, length, 1 if slack
    inside: NDArray[np.int64]  # (n,) 1: its stiffness is in the matrix that was assembled last


@inline_kernel
def spring_vector(batch, e, q, fixed):
    """Vector from the first to the second end (fixed = 1) or its rate (fixed = 0)."""
    x, y, z = fixed * batch.offset[e, 0], fixed * batch.offset[e, 1], fixed * batch.offset[e, 2]
    for k in range(batch.base.shape[1]):
        i = batch.base[e, k]
        if i >= 0:
            w = batch.factor[e, k]
            x += w * q[i]
            y += w * q[i + 1]
            z += w * q[i + 2]
    return x, y, z


@inline_kernel
def spring_state(batch, e, q, v):
    """Direction, length, rate, tension and whether the spring carries."""
    x, y, z = spring_vector(batch, e, q, 1.0)
    length = max(math.sqrt(x * x + y * y + z * z), 1e-100)
    n = (x / length, y / length, z / length)
    dx, dy, dz = spring_vector(batch, e, v, 0.0)
    rate = n[0] * dx + n[1] * dy + n[2] * dz
    extension = length - batch.data[e, 2]
    tension = batch.data[e, 0] * extension + batch.data[e, 1] * rate
    slack = batch.data[e, 3] != 0.0 and (extension <= 0.0 or tension <= 0.0)
    return n, length, rate, 0.0 if slack else tension, not slack


@inline_kernel
def spring_gradient(batch, e, q, b):
    """Add the gradient of the length of spring e to b."""
    x, y, z = spring_vector(batch, e, q, 1.0)
    il = 1.0 / max(math.sqrt(x * x + y * y + z * z), 1e-100)
    n = (x * il, y * il, z * il)
    for k in range(batch.base.shape[1]):
        i = batch.base[e, k]
        if i >= 0:
            for c in range(3):
                b[i + c] += batch.factor[e, k] * n[c]


@inline_kernel
def spring_force(batch, q, v, a, r, ws):
    """Add the spring forces to r."""
    for e in range(batch.base.shape[0]):
        n, _, _, tension, carries = spring_state(batch, e, q, v)
        if carries:
            for k in range(batch.base.shape[1]):
                i = batch.base[e, k]
                if i >= 0:
                    f = batch.factor[e, k] * tension
                    for c in range(3):
                        r[i + c] += f * n[c]


@inline_kernel
def spring_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add stiffness and damping of the springs that carry to A."""
    for e in range(batch.base.shape[0]):
        n, length, _, tension, carries = spring_state(batch, e, q, v)
        batch.inside[e] = carries
        if not carries:
            continue
        across = c_stiffness * tension / length
        along = c_stiffness * batch.data[e, 0] + c_damping * batch.data[e, 1] - across
        size = batch.base.shape[1]
        for k in range(size):
            for m in range(size):
                place = batch.dest[e, size * k + m]
                if place < 0:
                    continue
                w = batch.factor[e, k] * batch.factor[e, m]
                for i in range(3):
                    A[place + 7 * i] += w * across
                    for j in range(3):
                        A[place + 6 * i + j] += w * along * n[i] * n[j]


@inline_kernel
def spring_energy(batch, q, ws):
    """Elastic energy of the springs, J."""
    energy = 0.0
    for e in range(batch.base.shape[0]):
        x, y, z = spring_vector(batch, e, q, 1.0)
        extension = math.sqrt(x * x + y * y + z * z) - batch.data[e, 2]
        if extension > 0.0 or batch.data[e, 3] == 0.0:
            energy += 0.5 * batch.data[e, 0] * extension**2
    return energy


implements(
    SpringBatch,
    force=spring_force,
    tangent=spring_tangent,
    energy=spring_energy,
    role=Role.DISSIPATES,
    damped=lambda batch: bool(np.any(batch.data[:, 1])),
    exact=lambda batch, moving: not (moving and np.any(batch.data[:, 1])),
)
