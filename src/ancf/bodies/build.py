"""From point masses and rigid bodies of the model to the flat arrays of an InertiaBatch."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..arrays import FloatArray, IntArray
from ..model.bodies.beam import Beam
from ..model.bodies.rigid import PointMass, RigidBody
from ..model.sections.inertia import of_cable
from .inertia import InertiaBatch


def second_moments(body: RigidBody) -> FloatArray:
    """J_ij, the integral of x_i x_j dm over the body, shape (3, 3), kg m^2."""
    J: FloatArray = 0.5 * np.trace(body.inertia) * np.eye(3) - body.inertia
    return J


def rotary_inertia(beams: Iterable[Beam], slots: dict[str, IntArray]) -> list[tuple[int, int, float]]:
    """Pairs of slots of cables and their masses: the integral of rho I r_x'. r_x' of the slopes' rates."""
    found = []
    for beam in beams:
        turned = 0.0 if beam.has_section else of_cable(beam.section)
        if not turned:
            continue
        for e, h in enumerate(np.diff(beam.node_x).tolist()):
            own = np.concatenate([slots[beam.name][e, :2], slots[beam.name][e + 1, :2]]).tolist()
            entries = turned / (30 * h) * _slopes_product(h)
            found += [(own[i], own[j], float(entries[i, j])) for i in range(4) for j in range(4)]
    return found


def _slopes_product(h: float) -> FloatArray:
    """30 h times the integral of S' S'^T over an element of length h; S of r, r_x, r, r_x."""
    return np.array(
        [
            [36.0, 3 * h, -36.0, 3 * h],
            [3 * h, 4 * h * h, -3 * h, -h * h],
            [-36.0, -3 * h, 36.0, -3 * h],
            [3 * h, -h * h, -3 * h, 4 * h * h],
        ]
    )


def inertia(
    bodies: Iterable[PointMass | RigidBody],
    slots: dict[str, IntArray],
    more: Iterable[tuple[int, int, float]],
) -> InertiaBatch:
    """Batch of all their masses, and of more pairs of slots with theirs."""
    base = [(i, j) for i, j, _ in more]
    mass = [m for _, _, m in more]
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
