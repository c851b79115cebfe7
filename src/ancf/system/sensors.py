"""Sensors: what is recorded at every step of a run, as entries of the state vectors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from ..arrays import IntArray
from ..model.beam import Beam
from ..model.connections import Connection, Spring
from ..model.points import Point
from .probe import Probe, R


def _none() -> IntArray:
    return np.zeros(0, dtype=np.int64)


@dataclass(frozen=True)
class Listing:
    """What sensors record.

    Parameters
    ----------
    points : tuple of Point
        All unknowns of the element at such a point are recorded: it can be asked for strains too.
    connections : tuple of str
        Names of springs and joints.
    index : ndarray, shape (k,)
        Entries of the state vectors, ascending.
    entries : ndarray, shape (j,)
        Entries of ``System.measured``.
    columns : dict of str to ndarray
        Places in ``entries`` of what was measured at a connection, by name.
    """

    points: tuple[Point, ...] = ()
    connections: tuple[str, ...] = ()
    index: IntArray = field(default_factory=_none)
    entries: IntArray = field(default_factory=_none)
    columns: dict[str, IntArray] = field(default_factory=dict)

    def __bool__(self) -> bool:
        return bool(self.points or self.connections)

    def places(self, unknowns: IntArray) -> IntArray:
        """Places in ``index`` of entries of the state vectors, -1 where they are not recorded."""
        if not len(self.index):
            return np.full_like(unknowns, -1)
        found = np.minimum(np.searchsorted(self.index, unknowns), len(self.index) - 1)
        return np.where(self.index[found] == unknowns, found, -1).astype(np.int64)


class Probed(Protocol):
    """What a System has."""

    joints: dict[str, IntArray]
    measures: dict[str, IntArray]

    @property
    def lengths(self) -> dict[str, tuple[int, float]]:
        """Of cables with a winch, see :func:`ancf.system.probe.lengths_of`."""
        ...

    def probe(self, point: Point) -> Probe:
        """Where the state of a point is found."""
        ...


def listing(system: Probed, items: Sequence[Point | Connection]) -> Listing:
    """Entries that a system needs to record these points and connections."""
    points = tuple(dict.fromkeys(item for item in items if isinstance(item, Point)))
    joined = {item.name: item for item in items if not isinstance(item, Point)}
    wanted, entries, columns = [_none()], [_none()], {}
    for point in points:
        wanted.append(_triples(system.probe(point).slots))
        if point.body.name in system.lengths:
            wanted.append(np.array(system.lengths[point.body.name][:1]))
    for name, item in joined.items():
        if isinstance(item, Spring):
            ends = [end for end in (item.a, item.b) if isinstance(end, Point)]
            wanted += [_triples(_position_slots(system.probe(end))) for end in ends]
        if name in system.joints:
            wanted.append(system.joints[name])
        if name in system.measures:
            first = sum(map(len, entries))
            columns[name] = np.arange(first, first + len(system.measures[name]))
            entries.append(system.measures[name])
    index = np.unique(np.concatenate(wanted)).astype(np.int64)
    return Listing(points, tuple(joined), index, np.concatenate(entries), columns)


def _triples(slots: IntArray) -> IntArray:
    """Entries of vectors that start at these slots."""
    return (slots[:, None] + np.arange(3)).ravel()


def _position_slots(probe: Probe) -> IntArray:
    """Slots on which the position of a point depends: at a node of a beam few of the element's."""
    return probe.slots[probe.S[R] != 0.0] if isinstance(probe.body, Beam) else probe.slots
