"""Derivatives of what sensors record at every step."""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..model.bodies.rigid import Body
from ..model.lookup import parse_point
from ..model.points import Point
from ..results.sensors import Sensors
from ..solvers.derivatives.sensitivity import LEAST
from ..solvers.sampling import measured_of, measured_slopes, sample_rows, sample_slopes, sampling_of
from ..system.sensors import Listing
from ..system.system import System
from .answers import MOVED, PLACES, Face, derivative, is_linear, on_another, text_of, unkept
from .family import Family
from .remembering import refuse_friction

#: Change of the state of the differences of contact forces, m, and of velocities, m/s.
NEAR = 2e-6


class Samples:
    """Derivatives of the rows of samples of a run, by parameter.

    Parameters
    ----------
    families : list of Family
    system : System
        On whose arrays the sensitivities are computed.
    listing : Listing
        What the run records.
    steps : int
    """

    def __init__(self, families: list[Family], system: System, listing: Listing, steps: int) -> None:
        self.families, self.listing, self.done = families, listing, 0
        system.sensors = listing
        self.sampling = sampling_of(system)
        self.known = measured_of(self.sampling)
        self.near: list[list[Any]] = []
        measuring = list(self.sampling.batches)
        asked = [name for name, part in system.parts.items() if any(part is own for own in measuring)]
        for family in families if self.sampling.width else ():
            for own in family.systems:
                own.sensors = listing
            other = not family.changed.isdisjoint(asked)  # all else measures what the model does
            self.near.append([sampling_of(own) if other else None for own in family.systems])
        rows = steps + 1 if self.sampling.width else 0
        self.rows = np.zeros((len(families), rows, self.sampling.width))
        self.weight = system.core.weight

    def take(self, q: FloatArray, v: FloatArray, made: FloatArray) -> None:
        """Of states (n, size) whose derivatives q, v, a are ``made``, (p, n, 3, size)."""
        if not self.sampling.width:
            return
        s, count = self.sampling, len(q)
        k, j, moved = len(s.unknowns), len(s.entries), len(s.moved)
        q, v, made = (np.ascontiguousarray(x) for x in (q, v, made))
        here = self._rows(s, q, v) if j else np.zeros((count, s.width))
        rows = self.rows[:, self.done : self.done + count]
        rows[..., :k], rows[..., k : 2 * k] = made[:, :, 0, s.unknowns], made[:, :, 1, s.unknowns]
        rows[..., 2 * k + j : 2 * k + j + moved] = made[:, :, 2, s.moved]
        for p in range(len(self.families) if j else 0):
            rows[p, :, 2 * k : 2 * k + j] = self._measured(p, (q, v), made[p], here)[:, 2 * k : 2 * k + j]
        self.done += count

    def _measured(
        self, p: int, states: tuple[FloatArray, FloatArray], made: FloatArray, here: FloatArray
    ) -> FloatArray:
        """Derivatives of the samples ``here`` of states by parameter p."""
        total, family = np.zeros_like(here), self.families[p]
        for sampling, weight, own in zip(self.near[p], family.weights, family.systems, strict=True):
            if sampling is not None and own is not family.base:
                total += weight * (self._rows(sampling, *states) - here)
        if self.known is not None:
            entries = self.sampling.entries
            measured_slopes(self.known, entries, *states, made, 2 * len(self.sampling.unknowns), total)
            return total
        room = np.zeros((2, states[0].shape[1])), np.zeros(self.sampling.width)
        sample_slopes(self.sampling, *states, made, len(self.weight), NEAR, np.array(PLACES), *room, total)
        return total

    def _rows(self, sampling: Any, q: FloatArray, v: FloatArray) -> FloatArray:
        rows = np.zeros((len(q), sampling.width))
        sample_rows(sampling, q, v, rows)
        return rows


class _Recorded(Sensors):
    """Samples with other numbers."""

    def __init__(self, sensors: Sensors, whole: Any, arrays: dict[str, FloatArray], base: System) -> None:
        super().__init__(sensors.listing, lambda: arrays, whole)
        self._base = base

    def _parsed(self, label: str) -> Point:
        return parse_point(self._base.model.bodies, label)

    def _there(self, place: Point, body: Body) -> tuple[Point, int | None]:
        return on_another(place, self._base, body)

    def _check(self, probe: Any, point: Any, known: Any) -> None:
        """The sensors themselves were asked before, with bodies of their own."""


class SensorSensitivity:
    """Derivatives by one parameter, per unit of it, of what sensors have recorded, at all steps.

    It answers what :class:`ancf.results.Sensors` answers; reactions of supports it does not know.

    Parameters
    ----------
    family : Family
    sensors : Sensors
    rows : (n, width)
        Derivatives of the samples.
    """

    def __init__(self, family: Family, sensors: Sensors, rows: FloatArray) -> None:
        self._family, self._sensors = family, sensors
        self.rows, k = rows, len(sensors.listing.index)
        self._d = {"q": rows[:, :k], "v": rows[:, k : 2 * k], "measured": rows[:, 2 * k :]}
        self.t = sensors.t
        self._faces: dict[int, _Recorded] = {}  # that answer for the systems

    def __repr__(self) -> str:
        return f"SensorSensitivity({self.name!r}, {len(self.t)} times)"

    @property
    def name(self) -> str:
        """Of the parameter."""
        return self._family.name

    def __getattr__(self, name: str) -> Callable[..., FloatArray]:
        if name.startswith("_") or not callable(getattr(Sensors, name, None)):
            raise AttributeError(f"a sensitivity has no {name!r}", name=name, obj=self)

        def answer(*items: Any) -> FloatArray:
            linear = is_linear(name, self._family.base)
            return self.of(lambda one: getattr(one, name)(*map(text_of, items)), linear, name)

        return answer

    def of(self, question: Callable[[Any], Any], linear: bool = False, name: str = "") -> FloatArray:
        """Derivative of a question, a function of what answers as sensors do.

        Raises
        ------
        ModelError
            What the question itself raises; a reaction; friction.
        """
        refuse_friction(self._family.base, name)
        if name in ("reaction", "reaction_moment"):
            raise unkept(name)
        here, d = self._sensors._arrays(), self._d
        now = {key: np.asarray(here[key][:]) for key in ("time", "q", "v", "measured")}
        question(self._sensors)
        base = np.asarray(question(self._with(self._family.base, now)))
        total: Any = np.zeros_like(base)
        family = self._family
        for system, weight in zip(family.systems, family.weights, strict=True) if name else family.around():
            if system is not family.base:
                total = total + weight * (np.asarray(question(self._with(system, now))) - base)
        if linear or name.startswith(("contact", "acceleration")):
            return np.asarray(total + question(self._with(self._family.base, now | d)))
        for key in d:
            size = float(np.max(np.abs(d[key]), initial=0.0))
            if size > LEAST:

                def moved(x: float, key: str = key) -> FloatArray:
                    near = now | {key: now[key] + x * d[key]}
                    return np.asarray(question(self._with(self._family.base, near)), dtype=np.float64)

                total = total + derivative(moved, MOVED / size)
        found: FloatArray = np.asarray(total)
        return found

    def _with(self, system: System, arrays: dict[str, FloatArray]) -> _Recorded:
        if id(system) not in self._faces:
            whole = Face(system, np.zeros(system.size), np.zeros(system.size), 0.0)
            self._faces[id(system)] = _Recorded(self._sensors, _Whole(whole), {}, self._family.base)
        made = copy(self._faces[id(system)])
        made._arrays = lambda: arrays
        return made


class _Whole:
    """What sensors want of a result."""

    def __init__(self, face: Face) -> None:
        self.model, self.bodies, self.slots = face.model, face.model.bodies, face.system.slots
        self.lengths, self.springs = face.system.lengths, face._springs
        self.joints, self.arcs = face.system.joints, face.system.numbering.arcs
