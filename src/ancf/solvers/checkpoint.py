"""All that a run has in memory between two steps, from which it goes on to the last bit.

What a step may change is found, not listed: a compiled system and the memory of a run are named tuples of
arrays, and those of the system that differ from what they were when it was compiled are kept.  So a batch
that keeps a history of its own needs nothing to be kept with the rest.  Arrays that hold addresses of this
process do not change, and are never kept.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..batches import Batches
from ..errors import ModelError
from ..system.system import System
from ..words import begin_of

Arrays = dict[str, NDArray[Any]]


@dataclass(frozen=True)
class Snapshot:
    """State of a run between two steps.

    Parameters
    ----------
    t : float
        Time, s.
    values : dict
        Numbers and flags by name, ready for JSON.
    arrays : dict of str to ndarray
        By their place, such as ``memory.q`` or ``parts.springs.inside``; copies.
    """

    t: float
    values: dict[str, Any]
    arrays: Arrays


def distinct(roots: Mapping[str, Any]) -> Arrays:
    """Arrays that are not empty below some roots, by place; one that is reached twice has its first place.

    They are looked for in tuples, named tuples, batches, lists and dicts.
    """
    found: Arrays = {}
    seen: set[tuple[int, int]] = set()
    for name, root in roots.items():
        _find(root, name, found, seen)
    return found


def _find(item: Any, place: str, found: Arrays, seen: set[tuple[int, int]]) -> None:
    """Add the arrays in an item; whoever makes a thousand short runs waits for this a thousand times."""
    kind = type(item)
    if kind is np.ndarray:
        if item.size:
            key = begin_of(item), item.nbytes
            if key not in seen:
                seen.add(key)
                found[place] = item
    elif kind is Batches:
        for k, part in enumerate(item):
            _find(part, f"{place}.{k}", found, seen)
    elif isinstance(item, tuple | list):
        for name, part in zip(getattr(kind, "_fields", None) or range(len(item)), item, strict=True):
            if type(part) not in _NUMBERS:
                _find(part, f"{place}.{name}", found, seen)
    elif isinstance(item, Mapping):
        for name, part in item.items():
            _find(part, f"{place}.{name}", found, seen)


#: What the tuples hold besides arrays.
_NUMBERS = frozenset((int, float, bool))


def copies(roots: Mapping[str, Any]) -> Arrays:
    """Copies of all arrays below some roots."""
    return {place: array.copy() for place, array in distinct(roots).items()}


Pairs = list[tuple[NDArray[Any], NDArray[Any]]]


def matched(there: Arrays, saved: Mapping[str, NDArray[Any]]) -> Pairs:
    """Arrays that are there with what was saved of them; what is below other roots is left out.

    Raises
    ------
    ModelError
        An array is missing, or has another shape.
    """
    roots, pairs = {place.split(".", 1)[0] for place in there}, []
    for place, values in saved.items():
        if place.split(".", 1)[0] not in roots:
            continue
        mine = there.get(place)
        if mine is None or mine.shape != values.shape or mine.dtype != values.dtype:
            what = f'its array "{place}" does not fit the model that was compiled'
            raise ModelError("checkpoint", what, "go on with the model and the version that made it")
        pairs.append((mine, values))
    return pairs


class Watched:
    """The arrays of a system as they were compiled, so that what a run has changed can be told.

    Parameters
    ----------
    system : System
        Before anything was computed with it.
    """

    def __init__(self, system: System) -> None:
        roots = {
            "parts": system.parts,
            "level": system.level,
            "core": system.core._replace(batches=Batches(), external=Batches()),
        }
        self._arrays = distinct(roots)
        self._before = {place: array.tobytes() for place, array in self._arrays.items()}

    def changed(self) -> Arrays:
        """Copies of the arrays that are not as they were."""
        return {
            place: array.copy()
            for place, array in self._arrays.items()
            if array.tobytes() != self._before[place]
        }

    def fitting(self, own: Mapping[str, Any], snapshot: Snapshot, names: tuple[str, ...]) -> Pairs:
        """Arrays of the system, and of a run's own roots, with what a snapshot has of them.

        Raises
        ------
        ModelError
            It is of another system or method: the values with these names are not there.
        """
        if not set(names) <= snapshot.values.keys():
            raise ModelError(
                "checkpoint", "is of another kind of integrator", "go on with the one that made it"
            )
        return matched({**self._arrays, **distinct(own)}, snapshot.arrays)

    def restore(self, saved: Mapping[str, NDArray[Any]], pairs: Pairs | None = None) -> None:
        """Let the system be as it was when `saved` was taken; what is not in there is as it was compiled.

        ``pairs``: those of :meth:`fitting`, default those of the system alone.
        """
        pairs = matched(self._arrays, saved) if pairs is None else pairs
        for place, array in self._arrays.items():
            before = self._before[place]
            if place not in saved and array.tobytes() != before:
                array[...] = np.frombuffer(before, dtype=array.dtype).reshape(array.shape)
        for mine, values in pairs:
            mine[...] = values
