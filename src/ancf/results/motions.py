"""Accelerations and reactions of states and histories, by the equations of motion of each state."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..model.supports.support import Support
from ..model.supports.winch import Winch
from ..solvers.in_motion import in_motion
from ..system import reactions
from ..system.reactions import held_part, support_name
from ..system.system import System
from . import moments, remembered
from .parted import Parted, shared_joint
from .remembered import Remembered

_FRICTION = (
    "sensors record it at every step: simulate(..., sensors=[...]), or sensors = [...] in [simulation] of a "
    "file; the last state of a simulation knows it"
)


class Motions:
    """Questions about forces of inertia; shapes are (3,) for a state, (n_t, 3) for a history."""

    def acceleration(self: Any, point: Any) -> FloatArray:
        """Acceleration of a point, m/s^2, that the equations of motion give in each state.

        What runs record at every step is in ``sensors``.

        Raises
        ------
        ModelError
            Friction acts, which depends on the way until the state, or inputs whose history is not kept.
        """
        a: FloatArray = self._probe(point).field(self._in_motion()[0])
        return a

    def reaction(self: Any, support: Support | str) -> FloatArray:
        """Force of the ground on the node of a support, N, global components, at rest or in motion.

        Components that the support does not hold are zero; of a clamp it is the force, without the
        moment. Of two supports that hold the same component of a node that bodies share, the one that
        was added first has it. It is what the equations of motion of a state leave; of a state that is no
        equilibrium with all forces of inertia. In an equilibrium supports that move count as at rest.

        Parameters
        ----------
        support : Pin, Clamp, Hold or its name, or the point that one of them holds

        Raises
        ------
        ModelError
            There is no such support, or as for :meth:`acceleration`.
        """
        system = self.system
        name = support_name(system, support)
        forces = self._held_forces(name)
        found = [held_part(system, name, r) for r in np.atleast_2d(forces)]
        return found[0] if forces.ndim == 1 else np.array(found).reshape(-1, 3)

    def reaction_moment(self: Any, support: Support | str) -> FloatArray:
        """Moment of the ground on the node or body of a support, N m, about it, along global axes.

        Of a rigid body it is about the centre of mass, of the end of a beam about the node. With a prescribed
        rotation it is the moment of the motor. Of several supports that hold directions of one node the one
        that was added first has all of it.

        Parameters
        ----------
        support : Pin, Clamp, Hold or its name

        Raises
        ------
        ModelError
            As for :meth:`reaction`.
        """
        system = self.system
        name = support_name(system, support)
        item = next(item for item in system.model.supports if item.name == name)
        return moments.of_support(system, item, self.q[...], self._held_forces(name))

    def joint_moment(self: Any, joint: Any) -> FloatArray:
        """Moment that the second end of a joint receives, N m, about the joint's point, along global axes.

        The second end is ``b`` of a weld or hinge, the body of ``clamp(point, to=body)``, or the ground.

        Parameters
        ----------
        joint : joint with multipliers, or its name

        Raises
        ------
        ModelError
            There is no such joint, or it is a sliding one.
        """
        item = moments.checked_joint(self.system, joint)
        return moments.of_joint(self.system, item, np.array(self.q[...]))

    def joint_force(self: Any, joint: Any) -> FloatArray:
        """Force that the second end of a joint receives, N, along global axes.

        The second end is ``b`` of a joint of two points, the carrier of a sliding joint, the body of
        ``clamp(point, to=body)``, or the ground. The first end receives the opposite.

        Nodes that a spherical joint ties share their position, without multipliers: there it is what
        the equations of motion of one of the bodies miss, as a :meth:`reaction` is.

        Parameters
        ----------
        joint : joint, or its name

        Raises
        ------
        ModelError
            There is no such joint; of nodes that share their position, supports hold both, or as for
            :meth:`acceleration`.
        """
        ball = shared_joint(self.system, joint)
        if ball is None:
            item = moments.checked_joint(self.system, joint, slides=True)
            return moments.force_of_joint(self.system, item, np.array(self.q[...]))
        parted, states = Parted(self.system, ball), list(self._each_state())
        rests = all(known.balanced for *_, known in states)
        accelerations = [None] * len(states) if rests else np.atleast_2d(self._in_motion()[0])
        each = zip(states, accelerations, strict=True)
        found = [parted.force(q, v, a, t, known) for (q, v, t, known), a in each]
        return found[0] if self.q.ndim == 1 else np.array(found).reshape(-1, 3)

    def held_supports(self: Any) -> list[str]:
        """Names of the supports that have a reaction."""
        return [item.name for item in self.model.supports if not isinstance(item, Winch)]

    def _held_forces(self: Any, name: str) -> FloatArray:
        """What is out of balance, (..., size), for the support of a name; at rest without accelerations."""
        still: FloatArray | None = self._at_rest(name)
        return self._in_motion()[1] if still is None else still

    def _at_rest(self, name: str) -> FloatArray | None:
        """Of an equilibrium, None for what is in motion."""
        return None


def of_state(
    system: System, q: FloatArray, v: FloatArray, t: float, known: Remembered
) -> tuple[FloatArray, FloatArray]:
    """Accelerations and forces out of balance of a state, each of shape (size,).

    Raises
    ------
    ModelError
        They depend on what is not known.
    """
    return in_motion(_double(system, known), q, v, t)


def of_history(
    system: System, q: Any, v: Any, t: FloatArray, known: list[Remembered]
) -> tuple[FloatArray, FloatArray]:
    """The same of many states, shapes (n_t, size)."""
    q, v = np.array(q[...]), np.array(v[...])  # a file is read once
    pairs = [of_state(system, q[k], v[k], float(t[k]), known[k]) for k in range(len(t))]
    none = np.zeros((0, system.size))
    a, r = (np.array(column) for column in zip(*pairs, strict=True)) if pairs else (none, none)
    return a, r


def at_rest(
    system: System, q: FloatArray, v: FloatArray, t: float, known: Remembered, name: str
) -> FloatArray | None:
    """What an equilibrium leaves out of balance for a support, (size,), None in motion."""
    double = system.double
    double.measured[:] = system.measured  # where contacts are looked for first
    remembered.restore(double, known)
    for key, value in known.inputs.items():
        double.inputs.give(key, value)
    return reactions.at_rest(double, q, v, t, name, known.balanced)


def _double(system: System, known: Remembered) -> System:
    """A system that nobody uses, which knows all that the state does."""
    double = system.double
    double.measured[:] = system.measured
    if rubs(system) and any(name not in known.memory for name in system.memory):
        what = "friction depends on the way until a state, and of this one it is not known"
        raise ModelError("acceleration, reaction", what, _FRICTION)
    if double.inputs.led and known.led and not known.inputs:
        what = "inputs were given while the run went on, and what they were in this state is not kept"
        raise ModelError("acceleration, reaction", what, "give simulate(..., sensors=[...]), which record it")
    for name, value in known.inputs.items():
        double.inputs.give(name, value)
    remembered.restore(double, known)
    return double


def rubs(system: System) -> bool:
    """Whether there is friction that sticks."""
    grounds = any(item.friction > 0.0 for item in system.model.grounds)
    return grounds or "rubbing" in system.parts
