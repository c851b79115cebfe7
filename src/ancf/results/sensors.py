"""Sensors: the history at every step of what a simulation was asked to record."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..connections.spring_damper import DISTANCE, FORCE
from ..errors import ModelError, named
from ..model.bodies.rigid import PointMass, RigidBody
from ..model.joints.connections import Spring
from ..model.points import Point
from ..model.supports.held import support_asked
from ..system.contact_fields import ContactFields
from ..system.probe import BeamProbe, Probe, R, locate
from ..system.redundancy import independent
from ..system.sensors import Listing, unknowns_of
from ..system.spring_fields import SpringFields
from ..system.system import System
from . import moments
from .given import Given, Led
from .parted import shared_joint
from .pictures import Plotted
from .sensitivities import sensitivity_of


class Sensors(SpringFields, ContactFields, Led, Plotted):
    """What was recorded, at all steps; it answers as a :class:`ancf.Result` does.

    Points, springs and joints that were not recorded give a ModelError that lists those that were.

    Parameters
    ----------
    listing : Listing
    arrays : callable
        Gives ``time`` (n,), ``q`` (n, k), ``v`` (n, k) and ``measured`` (n, j) by name.  They are asked for
        anew each time: data sets of a file that grows must not stay open when it is loaded again.
    whole : SpringFields and ContactFields
        The result, for its bodies, slots, joints and springs.
    """

    def __init__(self, listing: Listing, arrays: Callable[[], dict[str, Any]], whole: Any) -> None:
        self.listing, self._arrays = listing, arrays
        self.model, self._bodies = whole.model, whole.bodies
        self._whole_slots, self._source = whole.slots, whole
        self._slots = {name: listing.places(slots) for name, slots in whole.slots.items()}
        self._lengths = {
            name: (int(listing.places(np.array([unknown]))[0]), far)
            for name, (unknown, far) in whole.lengths.items()
        }
        mine = listing.connections
        self._springs = {name: item for name, item in whole.springs.items() if name in mine}
        self._joints = {name: listing.places(u) for name, u in whole.joints.items() if name in mine}
        self._arcs = {name: int(self._joints[name][-1]) for name in whole.arcs if name in mine}
        by_ends = [item for name, item in self._springs.items() if name not in listing.springs]
        self._listed = frozenset(listing.points)
        self._by_label = {str(point): point for point in reversed(listing.points)}
        self._placed = self._listed.union(end for item in by_ends for end in _ends(item))
        self.derivatives: Mapping[str, Any] = {}  # by the name of a parameter

    @property
    def t(self) -> FloatArray:
        """Times of all steps, s, shape (n,); with the start."""
        t: FloatArray = self._arrays()["time"]
        return t

    def _turned_to(self, spring: Any) -> float | None:
        found: float | None = self._source._turned_to(spring)
        return found

    def _led(self) -> bool:
        return bool(self._source._led())

    def _kept(self) -> Given | None:
        history: Given | None = self._source._kept()
        return history

    @property
    def q(self) -> Any:
        """Recorded entries of the state vectors, shape (n, k)."""
        return self._arrays()["q"]

    @property
    def v(self) -> Any:
        """Their rates, shape (n, k)."""
        return self._arrays()["v"]

    @property
    def names(self) -> list[str]:
        """Points, springs, joints, contacts and supports that were recorded."""
        return [*map(str, self.listing.points), *self.listing.connections]

    def sensitivity(self, name: str) -> Any:
        """Derivatives of what was recorded by a parameter of ``simulate(..., sensitivities=[...])``.

        Raises
        ------
        ModelError
            It was not asked for.
        """
        return sensitivity_of(self.derivatives, name)

    def acceleration(self, point: Point | PointMass | RigidBody | str) -> FloatArray:
        """Acceleration of a point, m/s^2, shape (n, 3), as the steps had it.

        Raises
        ------
        ModelError
            The point was not recorded; of methods of the Radau family no accelerations are.
        """
        probe = self._probe(point)
        measured = self._arrays()["measured"]
        used = probe.S[R] != 0.0
        unknowns = self._whole_probe(probe).slots[used]
        columns = self.listing.accelerated(unknowns[:, None] + np.arange(3))
        if np.any(columns < 0):
            hint = "Radau's methods have none; ask the result, or list the point in sensors"
            raise ModelError(named(str(point)), "the sensors have no accelerations of it", hint)
        first = len(self.listing.entries)
        a: FloatArray = np.zeros((len(self.t), 3))
        for weight, column in zip(probe.S[R][used], columns, strict=True):
            a = a + weight * np.stack([measured[..., first + int(c)] for c in column], axis=-1)
        return a

    def _sliding(self, joint: Any) -> tuple[FloatArray, FloatArray]:
        raise _not_recorded(joint, "the shape of its carrier")

    def reaction_moment(self, support: Any) -> FloatArray:
        """Moment of the ground on the node or body of a support, N m, shape (n, 3), see :meth:`ancf.Result`.

        Raises
        ------
        ModelError
            The support was not recorded, or by an earlier version.
        """
        name = self._support(support)
        if name not in self.listing.turned:
            raise _not_recorded(support, "its moment")
        vectors, places = self.listing.turned[name].T
        forces = self._pushed([int(place) + k for place in places for k in range(3)])
        acting = 3 * np.arange(len(places))
        return moments.turned(self.q[...], forces, self.listing.places(vectors), acting)

    def joint_moment(self, joint: Any) -> FloatArray:
        """Moment that the second end of a joint receives, N m, shape (n, 3), see :meth:`ancf.Result`.

        Raises
        ------
        ModelError
            The joint was not recorded, or by an earlier version; or it is a sliding one.
        """
        return self._carried(joint, "its moment", moments.of_joint)

    def has_force(self, name: str) -> bool:
        """Whether all that the force of a joint needs was recorded."""
        item = next((c for c in self.model.connections if c.name == name), None)
        own = item is not None and super().has_force(name)
        return own and bool(np.all(np.isin(unknowns_of(self._system, item), self.listing.index)))

    def _carried(
        self, joint: Any, what: str, of: Callable[..., FloatArray], slides: bool = False
    ) -> FloatArray:
        """A force or moment of a joint."""
        system = self._system
        item = moments.checked_joint(system, joint, slides)
        if item.name not in self._joints:
            raise ModelError(named(item.name), "was not recorded by the sensors", self._recorded())
        if not self.has_force(item.name):
            raise _not_recorded(joint, what)
        # what the joint does not touch is the same with and without its forces: it stays as it starts
        whole = np.tile(system.initial_state()[0], (len(self.t), 1))
        whole[:, self.listing.index] = self.q[...]
        return of(system, item, whole)

    def joint_force(self, joint: Any) -> FloatArray:
        """Force that the second end of a joint receives, N, shape (n, 3), see :meth:`ancf.Result`.

        Raises
        ------
        ModelError
            The joint was not recorded, or by an earlier version.
        """
        if shared_joint(self._system, joint) is not None:
            what = "its nodes share their position, sensors record nothing of it"
            raise ModelError(named(getattr(joint, "name", joint)), what, "ask the result or a state")
        return self._carried(joint, "its force", moments.force_of_joint, slides=True)

    @cached_property
    def _system(self) -> System:
        """One that no run uses, with the numbers of that which was recorded."""
        try:
            return independent(self.model)
        except ModelError:  # functions of time that a file does not keep
            return System(self.model)

    def held_supports(self) -> list[str]:
        """Names of the supports whose reactions were recorded."""
        return [*self.listing.held]

    def reaction(self, support: Any) -> FloatArray:
        """Force of the ground on the node of a support, N, shape (n, 3), global components.

        Raises
        ------
        ModelError
            The support was not recorded.
        """
        name = self._support(support)
        places, components = self.listing.held[name].T
        force = np.zeros((len(self.t), 3))
        force[:, components] = self._pushed(places.tolist())
        return force

    def _pushed(self, places: list[int]) -> FloatArray:
        """Forces (n, k) of the ground on unknowns, by their places in what was listed."""
        first = len(self.listing.entries) + len(self.listing.moved)
        measured = self._arrays()["measured"]
        forces = [measured[..., first + place] for place in places]
        return np.stack(forces, axis=-1) if forces else np.zeros((len(self.t), 0))

    def _support(self, support: Any) -> str:
        name = getattr(support, "name", support)
        if isinstance(name, str) and name in self.listing.held:
            return name
        try:
            return support_asked(self.model, support, self.listing.held, "reaction")
        except ModelError:
            what = "is no support that the sensors have recorded"
            raise ModelError(named(str(name)), what, self._recorded()) from None

    def _whole_probe(self, probe: Probe) -> Probe:
        """Where a point is in whole state vectors."""
        place = Point(probe.body, probe.x, "", probe.y, probe.z)
        element = probe.element if isinstance(probe, BeamProbe) else None
        return locate(place, self._whole_slots[probe.body.name], element=element)

    def spring_length(self, spring: Spring | str) -> FloatArray:
        """See :meth:`ancf.Result.spring_length`."""
        measured = self._gauged(spring, DISTANCE)
        return super().spring_length(spring) if measured is None else measured

    def spring_force(self, spring: Spring | str) -> FloatArray:
        """See :meth:`ancf.Result.spring_force`."""
        measured = self._gauged(spring, FORCE)
        return super().spring_force(spring) if measured is None else measured

    def _gauged(self, spring: Spring | str, column: int) -> FloatArray | None:
        """What a spring has measured; None where it follows from the unknowns of its ends."""
        places = self.listing.springs.get(self._spring(spring).name)
        if places is None:
            return None
        measured: FloatArray = self._arrays()["measured"][..., int(places[column])]
        return measured

    def missing(self) -> str:
        """The first point or spring of which not all was recorded, as in a damaged file; "" for none."""
        for point in self.listing.points:
            if np.any(self._probe(point).slots < 0):
                return str(point)
        for name, spring in self._springs.items():
            probes = [] if name in self.listing.springs else [self._probe(end) for end in _ends(spring)]
            if any(np.any(probe.slots[probe.S[R] != 0.0] < 0) for probe in probes):
                return name
        return ""

    def _contacts(self) -> list[str]:
        return [*self.listing.columns]

    def _contact(self, contact: Any) -> FloatArray:
        name = getattr(contact, "name", contact)
        if name not in self.listing.columns:
            raise ModelError(named(name), "is no contact that the sensors have recorded", self._recorded())
        measured = self._arrays()["measured"]
        return np.stack([measured[..., int(column)] for column in self.listing.columns[name]], axis=-1)

    def _probe(self, point: Point | PointMass | RigidBody | str) -> Probe:
        probe = super()._probe(self._labelled(point))
        self._check(probe, point, self._placed)
        return probe

    def _beam(self, point: Point | RigidBody | str) -> BeamProbe:
        probe = super()._beam(self._labelled(point))
        self._check(probe, point, self._listed)
        return probe

    def _labelled(self, point: Any) -> Any:
        """The point that was recorded under a text, which may have fewer digits than its place."""
        return self._by_label.get(point.strip(), point) if isinstance(point, str) else point

    def _check(self, probe: Probe, point: Any, known: frozenset[Point]) -> None:
        place = Point(probe.body, probe.x, "", probe.y, probe.z)
        if place not in known:
            name = (
                str(point) if isinstance(point, str) or str(point) else f"{probe.body.name}.at({probe.x:g})"
            )
            hint, gauged = self._recorded(), self.listing.springs
            if any(place in _ends(item) for key, item in self._springs.items() if key in gauged):
                hint = f"a spring records its force and length alone, list its end as well; {hint}"
            raise ModelError(named(name), "was not recorded by the sensors", hint)

    def _recorded(self) -> str:
        return "recorded are: " + ", ".join(self.names)


def _not_recorded(item: Any, what: str) -> ModelError:
    """An error of what results answer and samples do not."""
    hint = "ask the result itself, at its stored times; without output_step= those are all steps"
    return ModelError(named(getattr(item, "name", item)), f"the sensors have not recorded {what}", hint)


def _ends(spring: Spring) -> list[Point]:
    """Ends of a spring that are points of bodies."""
    return [end for end in (spring.a, spring.b) if isinstance(end, Point)]
