"""Forces of what may stand still while a model turns: springs, torsion springs, laws of the motion.

In axes that turn with the rate W the velocity is x' + W x.  A force R(q, v) that does not turn with the model
therefore has the stiffness dR/dq + dR/dv W there: a damper on the ground, c v of a mass, pulls the mass with
c W x across its displacement, on which the stability of a rotor depends (Genta, Dynamics of Rotating Systems,
2005, 3.2).  A damper inside the model has c x' alone, and the same formula says so.  Neither matrix is
symmetric, those of a time step are: so both are differences of the forces.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...arrays import FloatArray, IntArray
from ...system.system import System
from ..derivatives.differences_of_forces import ROUND_OFF, Differences

#: Batches whose forces may come from the ground and brake.
HELD = ("springs", "torsion springs")


class Standing:
    """Derivatives of these forces about states of a system that turns about an axis, or not."""

    def __init__(self, system: System, spin: FloatArray, centre: FloatArray) -> None:
        self.system, self.spin, self.centre = system, spin, centre
        held = [system.parts[name] for name in HELD if name in system.parts] if np.any(spin) else []
        self.own = Differences(system, [*held, *system.core.external])

    def velocity(self, q: FloatArray) -> FloatArray:
        """Velocities of the rotation, shape (size,): of places about the axis, of other vectors alone."""
        v = np.zeros_like(q)
        places, arms = vectors_and_arms(self.system, q, self.centre)
        v[places] = np.cross(self.spin, arms)
        return v

    def beyond(self, q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What the matrices of a time step at rest lack of stiffness and damping, each (n, n)."""
        stiffness, damping = self.derivatives(q, self.velocity)
        K0, D0 = self.derivatives(q, np.zeros_like) if np.any(self.spin) else (stiffness, damping)
        return _beyond(stiffness, K0), _beyond(damping, D0)

    def derivatives(
        self, q: FloatArray, velocity: Callable[[FloatArray], FloatArray]
    ) -> tuple[FloatArray, FloatArray]:
        """Of the forces by positions, velocities following them, and by velocities alone, each (n, n)."""
        return self.own.at(q, velocity, max(1.0, float(np.linalg.norm(self.spin))))


def vectors_and_arms(system: System, q: FloatArray, centre: FloatArray) -> tuple[IntArray, FloatArray]:
    """Places of all vectors of a state, (count, 3), and the vectors, positions counted from a centre."""
    slots = np.unique(np.concatenate([table.ravel() for table in system.slots.values()]))
    first = np.concatenate([table[:, 0] for table in system.slots.values()])
    places = slots[:, None] + np.arange(3)
    arms: FloatArray = q[places] - np.where(np.isin(slots, first)[:, None], centre, 0.0)
    return places, arms


def _beyond(J: FloatArray, at_rest: FloatArray) -> FloatArray:
    """A matrix less the symmetric one that a time step has of it at rest, without noise of differences."""
    found = J - 0.5 * (at_rest + at_rest.T)
    largest = max(float(np.max(np.abs(x), initial=0.0)) for x in (J, at_rest))
    return np.where(np.abs(found) < ROUND_OFF * largest, 0.0, found)
