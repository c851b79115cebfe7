"""Sensors: what is recorded at every step of a run, as entries of the state vectors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from ..arrays import IntArray
from ..connections.torsion_build import torsion_springs
from ..model.beam import Beam
from ..model.connections import Connection, Spring
from ..model.points import Point
from ..model.supports import Support
from ..model.torsion import TorsionSpring
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
        Names of springs, joints, contacts and supports.
    index : ndarray, shape (k,)
        Entries of the state vectors, ascending.
    entries : ndarray, shape (j,)
        Entries of ``System.measured``.
    columns : dict of str to ndarray
        Places in ``entries`` of what was measured at a connection, by name.
    moved : ndarray, shape (m,)
        Entries of the accelerations, ascending.
    pushed : ndarray, shape (p,)
        Held unknowns whose reactions are recorded.
    held : dict of str to ndarray
        Place in ``pushed`` and component of what a support holds, shape (c, 2), by its name.
    """

    points: tuple[Point, ...] = ()
    connections: tuple[str, ...] = ()
    index: IntArray = field(default_factory=_none)
    entries: IntArray = field(default_factory=_none)
    columns: dict[str, IntArray] = field(default_factory=dict)
    moved: IntArray = field(default_factory=_none)
    pushed: IntArray = field(default_factory=_none)
    held: dict[str, IntArray] = field(default_factory=dict)

    @property
    def width(self) -> int:
        """Numbers that a step leaves beside q and v."""
        return len(self.entries) + len(self.moved) + len(self.pushed)

    def __bool__(self) -> bool:
        return bool(self.points or self.connections)

    def places(self, unknowns: IntArray) -> IntArray:
        """Places in ``index`` of entries of the state vectors, -1 where they are not recorded."""
        return _places(self.index, unknowns)

    def accelerated(self, unknowns: IntArray) -> IntArray:
        """The same in ``moved``."""
        return _places(self.moved, unknowns)


def _places(index: IntArray, unknowns: IntArray) -> IntArray:
    """Places of unknowns in an index that ascends, -1 where they are not in it."""
    if not len(index):
        return np.full_like(unknowns, -1)
    found = np.minimum(np.searchsorted(index, unknowns), len(index) - 1)
    return np.where(index[found] == unknowns, found, -1).astype(np.int64)


class Probed(Protocol):
    """What a System has."""

    joints: dict[str, IntArray]
    slots: dict[str, IntArray]
    measures: dict[str, IntArray]
    constraints: Any

    @property
    def lengths(self) -> dict[str, tuple[int, float]]:
        """Of cables with a winch, see :func:`ancf.system.probe.lengths_of`."""
        ...

    def probe(self, point: Point) -> Probe:
        """Where the state of a point is found."""
        ...


def listing(system: Probed, items: Sequence[Point | Connection | Support], accelerations: bool) -> Listing:
    """Entries that a system needs to record these points, connections and supports.

    ``accelerations`` says whether the run has them, and reactions.
    """
    points = tuple(dict.fromkeys(item for item in items if isinstance(item, Point)))
    joined = {item.name: item for item in items if not isinstance(item, Point)}
    wanted, entries, columns = [_none()], [_none()], {}
    moved, pushed, held = [_none()], [_none()], {}
    for point in points:
        probe = system.probe(point)
        wanted.append(_triples(probe.slots))
        moved.append(_triples(_position_slots(probe)))
        if point.body.name in system.lengths:
            wanted.append(np.array(system.lengths[point.body.name][:1]))
    for name, item in joined.items():
        if isinstance(item, Spring):
            ends = [end for end in (item.a, item.b) if isinstance(end, Point)]
            wanted += [_triples(_position_slots(system.probe(end))) for end in ends]
        if isinstance(item, TorsionSpring):
            slots = torsion_springs([item], system.slots).base
            wanted.append(_triples(slots[slots >= 0]))
        if name in system.joints:
            wanted.append(system.joints[name])
        if name in system.measures:
            first = sum(map(len, entries))
            columns[name] = np.arange(first, first + len(system.measures[name]))
            entries.append(system.measures[name])
        if isinstance(item, Support):
            unknowns = np.array(system.constraints.positions[name], dtype=np.int64)
            first = sum(map(len, pushed))
            held[name] = np.stack([first + np.arange(len(unknowns)), unknowns % 3], axis=1)
            pushed.append(unknowns)
    index = np.unique(np.concatenate(wanted)).astype(np.int64)
    rates = np.unique(np.concatenate(moved)).astype(np.int64) if accelerations else _none()
    return Listing(
        points, tuple(joined), index, np.concatenate(entries), columns, rates, np.concatenate(pushed), held
    )


def _triples(slots: IntArray) -> IntArray:
    """Entries of vectors that start at these slots."""
    return (slots[:, None] + np.arange(3)).ravel()


def _position_slots(probe: Probe) -> IntArray:
    """Slots on which the position of a point depends: at a node of a beam few of the element's."""
    return probe.slots[probe.S[R] != 0.0] if isinstance(probe.body, Beam) else probe.slots
