"""The histories on which one number of a run depends: their derivatives by the states and by parameters.

Answers that are linear in the state are weighed by what they are of each unknown on its own; what contacts of
strips measure knows its slopes (``add_measured_work``); all others are differentiated by differences.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..compiled import add_measured_work, does_something
from ..connections.contact_touch import ARC, FORCE, OVERLAP
from ..model.surfaces.contact import Contact
from ..solvers.sampling import Meters, measured_works, meters_of
from ..system.system import System
from .answers import LINEAR, Face
from .family import Family

#: Change of an unknown, in its own size, of the differences of what is asked; and of what has no smooth zero,
#: as the size of a bend has none.
MOVED, FINELY = 1e-4, 1e-6
FINE = {"curvature", "bending_moment"}
#: Answers that nothing but the state and the shape functions has a part in.
SHAPES = ("position", "velocity", "slope")
PLACES = ((-2.0, 1 / 12), (-1.0, -8 / 12), (1.0, 8 / 12), (2.0, -1 / 12))
#: What a contact of a strip measures: which number, and its sign.
METERED = {"contact_force": (FORCE, 1.0), "contact_gap": (OVERLAP, -1.0), "arc_length": (ARC, 1.0)}
STRIPS = "contacts"

#: A question: a quantity and of what.
Key = tuple[str, str]
#: ``asked(face, keys)``: the histories of these questions, by key, of states (n, size).
Asked = Callable[[Face, Iterable[Key]], dict[Key, FloatArray]]


def is_metered(system: System, key: Key) -> bool:
    """Whether a question is one that a contact of a strip measures."""
    return key[0] in METERED and key[1] in _strips(system)


def touched_by(system: System, name: str) -> IntArray:
    """Entries of the state vectors on which a contact of a strip depends: of its point and all its wire."""
    batch, j = system.parts[STRIPS], _strips(system).index(name)
    slots = np.concatenate([batch.slot[j], batch.line_slot[batch.first[j] : batch.first[j + 1]].ravel()])
    found: IntArray = (np.unique(slots[slots >= 0])[:, None] + np.arange(3)).ravel()
    return found


def _strips(system: System) -> list[str]:
    """Names of the contacts of strips, in the order of their batch."""
    return [item.name for item in system.model.connections if isinstance(item, Contact)]


class Objective:
    """What a number is asked from.

    Parameters
    ----------
    system : System
    families : list of Family
    asked : function
        How histories are found, see ``Asked``.
    unknowns : mapping
        By question the entries of the state vectors on which it depends.

    Attributes
    ----------
    keys : list of (str, str)
    unknowns : (k,) array
        All of them, ascending.
    """

    def __init__(
        self, system: System, families: list[Family], asked: Asked, unknowns: Mapping[Key, IntArray]
    ) -> None:
        self.system, self.families, self._asked = system, families, asked
        self.keys = list(unknowns)
        self.unknowns = np.unique(np.concatenate([*unknowns.values()])).astype(np.int64)
        self._places = {key: np.searchsorted(self.unknowns, np.unique(own)) for key, own in unknowns.items()}
        self._linear = {key: self._of_units(key) for key in self.keys if key[0] in LINEAR}
        known = STRIPS in system.parts and does_something(type(system.parts[STRIPS]), add_measured_work)
        self._metered = [key for key in self.keys if known and is_metered(system, key)]
        self._meters: Meters | None = meters_of(system, STRIPS) if self._metered else None
        self._sums: dict[Key, Any] = {}  # of states with the derivatives by linear answers, (2, c, size)

    def histories(self, q: FloatArray, v: FloatArray) -> dict[Key, FloatArray]:
        """Those of states (n, size)."""
        return self._of(self.system, q, v, self.keys)

    def _of(self, system: System, q: FloatArray, v: FloatArray, keys: list[Key]) -> dict[Key, FloatArray]:
        return self._asked(Face(system, q, v, 0.0, base=self.system), keys)

    def _of_units(self, key: Key) -> FloatArray:
        """An answer that is linear in the state, of each of its unknowns as q and as v alone, (2, k, ...)."""
        own, size = self.unknowns[self._places[key]], self.system.size
        units = np.zeros((2, 2, len(own), size))
        for i in range(2):
            units[i, i, np.arange(len(own)), own] = 1.0
        q, v = units.reshape(2, 2 * len(own), size)
        return self._of(self.system, q, v, [key])[key].reshape(2, len(own), -1)

    def wanted(self, q: FloatArray, v: FloatArray, slopes: Mapping[Key, FloatArray]) -> FloatArray:
        """Those of the number by the unknowns of states (n, size), (n, 2, k), from those by the answers."""
        made = np.zeros((len(q), 2, len(self.unknowns)))
        for key, units in self._linear.items():
            slope, places = slopes[key].reshape(len(q), -1), self._places[key]
            made[:, :, places] += (slope @ units.reshape(-1, slope.shape[1]).T).reshape(len(q), 2, -1)
        self._add_metered(q, v, slopes, made)
        others = [key for key in slopes if key not in self._linear and key not in self._metered]
        fine = [key for key in others if key[0] in FINE]
        for keys, moved in (([key for key in others if key not in fine], MOVED), (fine, FINELY)):
            if keys:
                self._add_differences(q, v, {key: slopes[key] for key in keys}, moved, made)
        return made

    def _add_metered(
        self, q: FloatArray, v: FloatArray, slopes: Mapping[Key, FloatArray], made: FloatArray
    ) -> None:
        """Add those by what contacts of strips measure."""
        if self._meters is None:
            return
        weights = np.zeros((len(q), 4 * len(self.system.parts[STRIPS].slot)))
        names = _strips(self.system)
        for key in self._metered:
            column, sign = METERED[key[0]]
            weights[:, 4 * names.index(key[1]) + column] += sign * slopes[key]
        states = np.ascontiguousarray(q), np.ascontiguousarray(v)
        measured_works(self._meters, *states, weights, self.unknowns, np.zeros((2, q.shape[1])), made)

    def _add_differences(
        self, q: FloatArray, v: FloatArray, slopes: dict[Key, FloatArray], moved: float, made: FloatArray
    ) -> None:
        """Add those by answers that are differentiated by differences."""
        keys, system = list(slopes), self.system
        weight = np.ones(q.shape[1])
        weight[: system.n] = system.core.weight
        here = self._of(system, q, v, keys)  # what does not change leaves no round-off
        places = np.unique(np.concatenate([self._places[key] for key in keys])).tolist()
        for k, x in enumerate((q, v)):
            for n in places:
                i = int(self.unknowns[n])
                e, before = moved / (weight[i] if weight[i] > 0.0 else 1.0), x[:, i].copy()
                for place, w in PLACES:
                    x[:, i] = before + place * e
                    found = self._of(system, q, v, keys)
                    for key in keys:
                        change = (w / e * slopes[key] * (found[key] - here[key])).reshape(len(q), -1)
                        made[:, k, n] += change.sum(axis=1)
                x[:, i] = before

    def explicit(self, q: FloatArray, v: FloatArray, slopes: Mapping[Key, FloatArray]) -> FloatArray:
        """What parameters do to the answers of fixed states, (p,); of linear ones these are summed up."""
        total, here = np.zeros(len(self.families)), None
        others = [key for key in slopes if key not in self._linear]
        for key in self._linear:
            weights = slopes[key].reshape(len(q), -1).T
            self._sums[key] = self._sums.get(key, 0.0) + np.stack([weights @ q, weights @ v])
        for k, system, weight, keys in self._around(others):
            here = self._of(self.system, q, v, others) if here is None else here
            found = self._of(system, q, v, keys)
            total[k] += weight * float(sum(np.sum(slopes[key] * (found[key] - here[key])) for key in keys))
        return total

    def of_sums(self) -> FloatArray:
        """What parameters do to linear answers of all states: each component of that of its own sum."""
        total = np.zeros(len(self.families))

        def answers(system: System, keys: list[Key]) -> float:
            found = (self._of(system, self._sums[key][0], self._sums[key][1], [key])[key] for key in keys)
            return float(sum(np.trace(made.reshape(len(made), -1)) for made in found))

        for k, system, weight, keys in self._around(list(self._sums)):
            total[k] += weight * (answers(system, keys) - answers(self.system, keys))
        return total

    def _around(self, keys: list[Key]) -> Iterator[tuple[int, System, float, list[Key]]]:
        """Numbers of parameters, systems around these, their weights and what they may answer otherwise."""
        for k, family in enumerate(self.families):
            own = [key for key in keys if self._differs(family, key)]
            if own:
                each = zip(family.systems, family.weights, strict=True)
                yield from ((k, system, weight, own) for system, weight in each if system is not self.system)

    def _differs(self, family: Family, key: Key) -> bool:
        """Whether systems around a parameter may answer a question otherwise, of the same state."""
        acts = family.parameter.acts
        if key[0] in SHAPES:
            return acts is None or acts.shapes
        return key not in self._metered or STRIPS in family.changed
