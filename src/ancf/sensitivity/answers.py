"""Sensitivity: the derivatives of everything that a state or a result answers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..model import checks
from ..model.bodies.beam import Beam
from ..model.bodies.rigid import Body
from ..model.describe import point as point_text
from ..model.lookup import parse_point
from ..model.points import Point
from ..results import moments
from ..results.momenta import Momenta
from ..results.state import Energy
from ..solvers.derivatives.sensitivity import LEAST
from ..solvers.in_motion import in_motion
from ..system.contact_fields import ContactFields
from ..system.energy import energies
from ..system.probe import Probe
from ..system.reactions import at_rest, held_part, support_name
from ..system.spring_fields import SpringFields, springs_of
from ..system.system import System
from .branches import Change, changed, kinks_of
from .family import Family
from .remembering import Resting, Row, refuse_friction

#: Change of a state, in sizes of the model, of the differences of an answer, and of velocities per second.
MOVED = 1e-4
#: Part of a derivative by which differences of order two that reach over no kink agree, part of the largest
#: one below which that does not matter; how much closer others are taken, and how often.
BENT, SMALL, CLOSE, CLOSER = 1e-3, 1e-6, 32.0, 2
#: Questions that are linear in the state; slopes on a cable whose length a winch changes are not.
LINEAR = ("position", "velocity", "slope", "multiplier", "arc_rate")
#: Where points are, by system and by name.
_PROBES: WeakKeyDictionary[System, dict[str, Probe]] = WeakKeyDictionary()
PLACES = ((-2.0, 1 / 12), (-1.0, -8 / 12), (1.0, 8 / 12), (2.0, -1 / 12))


class Face(SpringFields, ContactFields, Momenta):
    """What can be asked of state vectors of a system, one (size,) or a history (n, size).

    ``beside``: they are changed, or the system is another one, for a difference. ``base``: then points are
    those of this system. ``times``: of the states, if they are stored ones, which have accelerations.
    ``rests``: they are of an equilibrium, in which supports that move count as at rest.
    """

    def __init__(
        self,
        system: System,
        q: FloatArray,
        v: FloatArray,
        t: float,
        beside: bool = False,
        base: System | None = None,
        times: Any = None,
        rests: bool = False,
    ) -> None:
        self.beside, self.rests, self.base = beside, rests, None if base is system else base
        self.system, self.model, self.t, self.times = system, system.model, t, times
        self._q, self._v = q, v
        self._bodies, self._slots = self.model.bodies, system.slots
        self._joints, self._arcs, self._lengths = system.joints, system.numbering.arcs, system.lengths
        self._springs = springs_of(self.model.connections)
        self._found = _PROBES.setdefault(system, {})
        self.inertial = False  # something was asked that has forces of inertia in it

    @property
    def rates(self) -> FloatArray:
        """See :attr:`ancf.State.rates`."""
        return np.zeros_like(self.v) if self.rests else self.v

    def _probe(self, point: Any) -> Probe:
        """Where a point is, which is asked many times of one system by its name."""
        if not isinstance(point, str):
            return super()._probe(point)
        if point not in self._found:
            self._found[point] = super()._probe(point)
        return self._found[point]

    def _parsed(self, label: str) -> Point:
        return super()._parsed(label) if self.base is None else parse_point(self.base.model.bodies, label)

    def _there(self, place: Point, body: Body) -> tuple[Point, int | None]:
        return super()._there(place, body) if self.base is None else on_another(place, self.base, body)

    def _contact_system(self) -> System:
        return self.system

    def reaction(self, support: Any) -> FloatArray:
        """See :meth:`ancf.State.reaction`."""
        name = support_name(self.system, support)
        forces = self._held_forces(name, "reaction")
        rows = np.array([held_part(self.system, name, r) for r in np.atleast_2d(forces)])
        return rows.reshape(*forces.shape[:-1], 3)

    def reaction_moment(self, support: Any) -> FloatArray:
        """See :meth:`ancf.State.reaction_moment`."""
        name = support_name(self.system, support)
        item = next(item for item in self.model.supports if item.name == name)
        return moments.of_support(self.system, item, self.q, self._held_forces(name, "reaction_moment"))

    def _held_forces(self, name: str, question: str) -> FloatArray:
        """What is out of balance, (..., size), for a support; at rest without accelerations."""
        checked = None if self.beside else self.times is None
        forces = at_rest(self.system, self.q, self.rates, self.t, name, checked) if self.q.ndim == 1 else None
        return self._in_motion(question)[1] if forces is None else forces

    def _in_motion(self, question: str) -> tuple[FloatArray, FloatArray]:
        """Accelerations, and forces out of balance, (..., size), by the equations of motion of each state."""
        if self.times is None:
            raise unkept(question)
        self.inertial = True
        system, times = self.system.double, np.atleast_1d(self.times).tolist()
        states = zip(np.atleast_2d(self.q), np.atleast_2d(self.v), times, strict=True)
        found = np.array([in_motion(system, *state) for state in states]).swapaxes(0, 1)
        a, r = found[:, 0] if self.q.ndim == 1 else found
        return a, r

    def joint_moment(self, joint: Any) -> FloatArray:
        """See :meth:`ancf.State.joint_moment`."""
        return moments.of_joint(self.system, moments.checked_joint(self.system, joint), self.q)

    def joint_force(self, joint: Any) -> FloatArray:
        """See :meth:`ancf.State.joint_force`; of joints with multipliers alone."""
        return moments.force_of_joint(self.system, moments.checked_joint(self.system, joint, True), self.q)

    def acceleration(self, point: Any) -> FloatArray:
        """See :meth:`ancf.State.acceleration`."""
        a: FloatArray = self._probe(point).field(self._in_motion("acceleration")[0])
        return a

    def energies(self) -> FloatArray:
        """Kinetic, strain and potential energy, (..., 3), J."""
        found = energies(self.system, np.atleast_2d(self.q), np.atleast_2d(self.v))
        return found if self.q.ndim > 1 else found[0]


class Sensitivity:
    """Derivatives by one parameter, per unit of it; it answers what a state or a result answers.

    ``sensitivity.position(point)`` is the derivative of ``result.position(point)``, with the same shape, and
    so are velocity, tension, strain, curvature, spring_force, energy, ...: of the numbers that were computed,
    not of what they approximate.

    Parameters
    ----------
    family : Family
    t : ndarray (n,) or float
        Times, s.
    q, v : ndarray (n, size) or (size,)
        States.
    dq, dv : ndarray
        Their derivatives; of q perhaps a function that computes them when they are asked for.
    """

    def __init__(
        self,
        family: Family,
        t: Any,
        q: FloatArray,
        v: FloatArray,
        dq: FloatArray | Callable[[], FloatArray],
        dv: FloatArray,
    ) -> None:
        self._family, self.t = family, t
        self._q, self._v, self._dq, self.dv = q, v, dq, dv
        self.memory: Row | None = None  # of what friction remembers in the last state, None: not known
        self.resting: Resting | None = None  # the same of an equilibrium with friction
        self.rests = False  # it is of an equilibrium of bodies without motion, see State.rests

    @property
    def dq(self) -> FloatArray:
        """Derivatives of q, as the states."""
        if callable(self._dq):
            self._dq = self._dq()
        return self._dq

    def __repr__(self) -> str:
        count = f", {len(self.dv)} times" if self.dv.ndim > 1 else ""
        return f"Sensitivity({self.name!r}{count})"

    def __getattr__(self, name: str) -> Callable[..., FloatArray]:
        if name.startswith("_") or not callable(getattr(Face, name, None)):
            raise AttributeError(f"a sensitivity has no {name!r}", name=name, obj=self)

        def answer(*items: Any) -> FloatArray:
            refuse_friction(self._family.base, name)
            linear = is_linear(name, self._family.base)
            return self.answer(lambda face: getattr(face, name)(*map(text_of, items)), linear)

        return answer

    @property
    def name(self) -> str:
        """Of the parameter."""
        return self._family.name

    @property
    def value(self) -> float:
        """Of the parameter."""
        return self._family.parameter.value

    @property
    def momentum(self) -> FloatArray:
        """Derivative of the momentum of all bodies, kg m/s per unit."""
        return self.answer(lambda face: face.momentum)

    @property
    def energy(self) -> Energy:
        """Derivatives of kinetic, strain and potential energy, J per unit; work is not known and zero."""
        kinetic, strain, potential = np.moveaxis(self.answer(lambda face: face.energies()), -1, 0)
        none = np.zeros_like(kinetic)
        return Energy(kinetic, strain, potential, none, none)

    def state(self, index: int = -1) -> Sensitivity:
        """Of the state at a stored time of a history."""
        rows = (x[index] for x in (self._q, self._v, self.dq, self.dv))
        made = Sensitivity(self._family, float(self.t[index]), *rows)
        made.memory = self.memory if index in (-1, len(self.t) - 1) else None
        return made

    def branches(self, by: float) -> list[Change]:
        """Slack springs and contacts that slacken or open at other stored times if the parameter changes.

        The derivative is that of the branches on which the steps ended: beyond such a change it tells of
        another motion. To the first order in the change, which may have either sign; in the order in which
        they happen.

        Parameters
        ----------
        by : float
            Change of the parameter, in its unit.

        Returns
        -------
        list of Change
            Name, first time in s and the least change that does it; empty if the events keep their order.
        """
        size = checks.positive(abs(checks.number(by, "branches.by")), "branches.by")
        t, found = np.atleast_1d(np.asarray(self.t, dtype=np.float64)), []
        for name, kink in kinks_of(self._family.base.model).items():
            here = kink(Face(self._family.base, self._q, self._v, float(t[-1])))
            own = changed(name, t, np.atleast_1d(here), np.atleast_1d(self.answer(kink)), size)
            found += [own] if own is not None else []
        return sorted(found, key=lambda one: (one.t, one.name))

    def of(self, question: Callable[[Face], Any]) -> FloatArray:
        """Derivative of a question, a function of what answers as a state or a result does.

        Raises
        ------
        ModelError
            What the question itself raises.
        """
        return self._at(question, False, self._family.around())

    def answer(self, question: Callable[[Face], Any], linear: bool = False) -> FloatArray:
        """The same for a question that a state or a result answers by itself.

        Parameters
        ----------
        question : function
        linear : bool
            It is linear in the state.
        """
        each = zip(self._family.systems, self._family.weights, strict=True)
        return self._at(question, linear, list(each))

    def _at(
        self, question: Callable[[Face], Any], linear: bool, around: list[tuple[System, float]]
    ) -> FloatArray:
        if self.resting is None:
            return self._of(question, linear, around)
        with self.resting.brought([self._family.base, *(system for system, _ in around)]):
            return self._of(question, linear, around)

    def _of(
        self, question: Callable[[Face], Any], linear: bool, around: list[tuple[System, float]]
    ) -> FloatArray:
        family, t = self._family, np.ravel(self.t)[-1]
        face = self._face(family.base, self._q, self._v)
        here = np.asarray(question(face), dtype=np.float64)
        around = family.around() if face.inertial else around  # accelerations are not linear in a mass
        total: Any = np.zeros_like(here)
        for system, weight in around:
            if system is not family.base:
                total = total + weight * (
                    np.asarray(question(self._face(system, self._q, self._v, True, family.base))) - here
                )
        if linear:
            return np.asarray(total + question(Face(family.base, self.dq, self.dv, t)))
        for e, dq, dv, places in self._moves():

            def moved(
                x: float, dq: FloatArray = dq, dv: FloatArray = dv, places: bool = places
            ) -> FloatArray:
                if self.resting is not None:
                    self.resting.bring(family.base, x if places else 0.0)
                near = self._face(family.base, self._q + x * dq, self._v + x * dv, True)
                return np.asarray(question(near), dtype=np.float64)

            total = total + derivative(moved, e)
        found: FloatArray = np.asarray(total)
        return found

    def _face(
        self, system: System, q: FloatArray, v: FloatArray, beside: bool = False, base: System | None = None
    ) -> Face:
        """What answers questions about these states of the model, or of one with another number."""
        return Face(system, q, v, np.ravel(self.t)[-1], beside, base, self.t, self.rests)

    def _moves(self) -> list[tuple[float, FloatArray, FloatArray, bool]]:
        """Sizes and directions of the changes of the state; whether places change, not velocities."""
        n, weight = self._family.base.n, self._family.base.core.weight
        found = []
        for dq, dv, x in ((self.dq, 0 * self.dv, self.dq), (0 * self.dq, self.dv, self.dv)):
            most = float(np.max(np.abs(x[..., :n]) * weight, initial=0.0))
            most = most if most > LEAST else float(np.max(np.abs(x), initial=0.0))
            if most <= LEAST and x is self.dq and self.resting is not None:
                most = self.resting.size  # only what is remembered changes
            if most > LEAST:
                found.append((MOVED / most, dq, dv, x is self.dq))
        return found


def derivative(value: Callable[[float], FloatArray], e: float) -> FloatArray:
    """Derivative of value(x) at 0, an array, by differences of order four from -2e to 2e.

    Where there is a kink between, as where a contact nearly opens, they are taken more closely: the two of
    order two of which they consist do not agree then.
    """
    found, bent = np.zeros(()), np.array(True)
    for _ in range(CLOSER + 1):
        far, near = ((value(x) - value(-x)) / (2.0 * x) for x in (2.0 * e, e))
        found = np.where(bent, (4.0 * near - far) / 3.0, found)
        size = np.maximum(np.abs(near), np.abs(far))
        least = SMALL * np.max(size, initial=0.0, where=np.isfinite(size))
        bent = bent & (np.abs(near - far) > np.maximum(BENT * size, least))
        if not np.any(bent):
            break
        e /= CLOSE
    return found


def is_linear(question: str, system: System) -> bool:
    """Whether a question is linear in the state."""
    return question in LINEAR and not (question == "slope" and system.lengths)


def unkept(question: str) -> ModelError:
    """What is said of forces of inertia where they are not those of a stored state."""
    what = "its derivatives are known of equilibria and of the stored states of runs"
    hint = "result.sensitivity(...), or the force of a spring or joint there; sensors record accelerations"
    return ModelError(f"sensitivity.{question}", what, hint)


def on_another(place: Point, base: System, body: Body) -> tuple[Point, int | None]:
    """A point of a model on the same body of another one, as long or not: in the element that holds it here.

    Beyond the end of that element its shape goes on, so that an answer has no jump from one to the next. Ends
    stay ends.
    """
    own = base.model.bodies[body.name]
    if place.body is body or not isinstance(own, Beam) or not isinstance(body, Beam):
        return replace(place, body=body), None
    if own.elements != body.elements:
        return replace(place, body=body), None
    x = body.length if place.x == own.length else place.x
    return replace(place, body=body, x=x), own.element_at(place.x)


def text_of(item: Any) -> Any:
    """A point or an item by its name: it is asked of several models."""
    if isinstance(item, Point):
        return point_text(item)
    return getattr(item, "name", item)
