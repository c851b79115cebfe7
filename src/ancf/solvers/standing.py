"""Forces of what may stand still while a model turns: springs, torsion springs, laws of the motion.

In axes that turn with the rate W the velocity is x' + W x.  A force R(q, v) that does not turn with the model
therefore has the stiffness dR/dq + dR/dv W there: a damper on the ground, c v of a mass, pulls the mass with
c W x across its displacement, on which the stability of a rotor depends (Genta, Dynamics of Rotating Systems,
2005, 3.2).  A damper inside the model has c x' alone, and the same formula says so.  Neither matrix is
symmetric, those of a time step are: so both are differences of the forces.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..batches import Batches
from ..compiled import traits
from ..system.core import residual
from ..system.system import System

DIFFERENCE, ROUND_OFF = 1e-6, 1e-8  # of positions in sizes of the model; of derivatives, what is none

#: Batches whose forces may come from the ground and brake.
HELD = ("springs", "torsion springs")


class Standing:
    """Derivatives of these forces about states of a system that turns about an axis, or not."""

    def __init__(self, system: System, spin: FloatArray, centre: FloatArray) -> None:
        self.system, self.spin, self.centre = system, spin, centre
        held = [system.parts[name] for name in HELD if name in system.parts] if np.any(spin) else []
        self.batches = Batches([*held, *system.core.external])
        self.place = np.arange(system.n)
        supports = system.core.supports
        for c in range(3):
            self.place[supports.rot_slot + c] = supports.rot_shadow + c
        touched = np.isin(self.place, _touched(self.batches)) & (system.core.weight > 0.0)
        self.moved = np.flatnonzero(touched)

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
        n = self.system.n
        by_place, by_rate = np.zeros((n, n)), np.zeros((n, n))
        rate = max(1.0, float(np.linalg.norm(self.spin)))
        v = velocity(q)
        for i in self.moved.tolist():
            weight = self.system.core.weight[i]
            near, far = (self._nudged(q, i, s * DIFFERENCE / weight) for s in (1.0, -1.0))
            difference = self._forces(near, velocity(near)) - self._forces(far, velocity(far))
            by_place[:, i] = difference * weight / (2.0 * DIFFERENCE)
            step = rate * DIFFERENCE
            near, far = (self._nudged(v, i, s * step / weight) for s in (1.0, -1.0))
            by_rate[:, i] = (self._forces(q, near) - self._forces(q, far)) * weight / (2.0 * step)
        return by_place, by_rate

    def _nudged(self, x: FloatArray, i: int, by: float) -> FloatArray:
        near = x.copy()
        near[self.place[i]] += by
        return near

    def _forces(self, q: FloatArray, v: FloatArray) -> FloatArray:
        """In global components, (n,)."""
        none, r = np.zeros_like(q), np.zeros_like(q)
        residual(self.batches, self.system.core.ws, q, v, none, none, r)
        found: FloatArray = r[self.place]
        return found


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


def _touched(batches: Iterable[Any]) -> IntArray:
    """Entries of the state vector of all slots of batches."""
    slots = [np.ravel(getattr(b, name)) for b in batches for name in traits(b).slots]
    found = np.concatenate([np.zeros(0, dtype=np.int64), *slots])
    found = np.unique(found[found >= 0])
    return np.ravel(found[:, None] + np.arange(3))
