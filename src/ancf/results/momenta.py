"""Momentum, angular momentum and spins of states and histories."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..elements.winched_build import momenta
from ..errors import ModelError, named
from ..model import checks
from ..model.bodies.rigid import RigidBody
from ..model.names import unknown
from ..system.core import inertia

if TYPE_CHECKING:
    from ..system.system import System


class Momenta:
    """Questions about the motion as a whole; shapes are (3,) for a state, (n_t, 3) for a history."""

    @property
    def momentum(self: Any) -> FloatArray:
        """Momentum of all bodies, kg m/s; the mass of fluid that they carry along is not in it."""
        positions, _ = _slots(self.system)
        found = [_triples(Mv, positions).sum(0) for _, Mv in self._each()]
        return _shaped([p + more for p, more in zip(found, self._winched(linear), strict=True)], self.q)

    def angular_momentum(self: Any, about: Any = (0.0, 0.0, 0.0)) -> FloatArray:
        """Angular momentum of all bodies about a fixed place (3,) in m, kg m^2/s.

        All unknowns of nodes are vectors that turn with the body, so that it is the sum of r x (M v) over
        them, with r - about for positions.

        Raises
        ------
        ModelError
            `about` is no place.
        """
        place = checks.vector(about, "angular_momentum.about")
        positions, others = _slots(self.system)
        found = []
        for q, Mv in self._each():
            spin = np.cross(_triples(q, positions) - place, _triples(Mv, positions)).sum(0)
            found.append(spin + np.cross(_triples(q, others), _triples(Mv, others)).sum(0))
        more = self._winched(lambda r, p: angular(r, p, place))
        return _shaped([spin + own for spin, own in zip(found, more, strict=True)], self.q)

    def angular_velocity(self: Any, body: RigidBody | str) -> FloatArray:
        """Angular velocity of a rigid body in global components, rad/s.

        Raises
        ------
        ModelError
            There is no such rigid body.
        """
        system = self.system
        name = getattr(body, "name", body)
        if not isinstance(name, str) or not isinstance(system.model.bodies.get(name), RigidBody):
            if isinstance(name, str) and name in system.model.bodies:
                raise ModelError(named(name), "is no rigid body, and has no angular velocity")
            raise unknown("angular_velocity", "rigid body", name, system.model.rigid_bodies)
        slots = system.slots[name][0, 1:]
        axes, rates = (np.stack([x[..., i : i + 3] for i in slots], axis=-2) for x in (self.q, self.v))
        spin: FloatArray = 0.5 * np.cross(axes, rates).sum(axis=-2)
        return spin

    def _winched(self: Any, of: Callable[[FloatArray, FloatArray], FloatArray]) -> Iterator[FloatArray]:
        """Sums over the cables with a winch, whose material moves past their nodes."""
        batch = self.system.parts.get("winched")
        for q, v in zip(np.atleast_2d(self.q[:]), np.atleast_2d(self.v[:]), strict=True):
            if batch is None:
                yield np.zeros(3)
            else:
                r, _, p = momenta(batch, q, v)
                yield of(r, p)

    def _each(self: Any) -> Any:
        """State vectors one after the other, with their mass matrix times the velocities."""
        system = self.system
        Mv = np.empty(system.size)
        for q, v in zip(np.atleast_2d(self.q[:]), np.atleast_2d(self.v[:]), strict=True):
            inertia(system.core.batches, system.core.ws, np.ascontiguousarray(v), Mv)
            yield q, Mv


def linear(r: FloatArray, p: FloatArray) -> FloatArray:
    """Momentum of elements with these shapes and momenta, (n, 4, 3)."""
    total: FloatArray = p[:, ::2].sum((0, 1))
    return total


def angular(r: FloatArray, p: FloatArray, place: FloatArray) -> FloatArray:
    """Angular momentum of elements about a place."""
    arm = r - np.array([1.0, 0.0, 1.0, 0.0])[:, None] * place
    total: FloatArray = np.cross(arm, p).sum((0, 1))
    return total


def _slots(system: System) -> tuple[IntArray, IntArray]:
    """First unknowns of all positions, and of all other vectors."""
    positions = np.unique(np.concatenate([slots[:, 0] for slots in system.slots.values()]))
    every = np.unique(np.concatenate([slots.ravel() for slots in system.slots.values()]))
    return positions, np.setdiff1d(every[every >= 0], positions)


def _triples(x: FloatArray, slots: IntArray) -> FloatArray:
    found: FloatArray = x[slots[:, None] + np.arange(3)]
    return found


def _shaped(found: list[FloatArray], q: Any) -> FloatArray:
    return found[0] if np.ndim(q) == 1 else np.array(found).reshape(-1, 3)
