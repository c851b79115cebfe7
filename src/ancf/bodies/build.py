"""From point masses and rigid bodies of the model to the flat arrays of an InertiaBatch."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..arrays import FloatArray, IntArray
from ..model.bodies import PointMass, RigidBody
from .inertia import InertiaBatch


def second_moments(body: RigidBody) -> FloatArray:
    """J_ij, the integral of x_i x_j dm over the body, shape (3, 3), kg m^2."""
    J: FloatArray = 0.5 * np.trace(body.inertia) * np.eye(3) - body.inertia
    return J


def inertia(bodies: Iterable[PointMass | RigidBody], slots: dict[str, IntArray]) -> InertiaBatch:
    """Batch of all their masses."""
    base, mass = [], []
    for body in bodies:
        own = slots[body.name][0]
        base.append((own[0], own[0]))
        mass.append(body.mass)
        if isinstance(body, RigidBody):
            J = second_moments(body)
            base += [(own[1 + i], own[1 + j]) for i in range(3) for j in range(3)]
            mass += [float(J[i, j]) for i in range(3) for j in range(3)]
    n = len(base)
    return InertiaBatch(
        base=np.array(base, dtype=np.int64).reshape(n, 2),
        dest=np.full((n, 4), -1, dtype=np.int64),
        mass=np.array(mass, dtype=np.float64),
    )
