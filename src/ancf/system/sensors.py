"""Sensors: what is recorded at every step of a run, as entries of the state vectors."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from ..arrays import IntArray
from ..connections.torsion_build import torsion_springs
from ..model.bodies.beam import Beam
from ..model.joints.basic import Slide
from ..model.joints.connections import Connection, Spring
from ..model.joints.torsion import TorsionSpring
from ..model.kind import body_of
from ..model.kinds import kind_of
from ..model.points import Point
from ..model.supports.support import Support
from ..model.surfaces.contact import Contact
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
        Places in ``entries`` of what was measured at a contact, shape (4,), by name.
    moved : ndarray, shape (m,)
        Entries of the accelerations, ascending.
    pushed : ndarray, shape (p,)
        Unknowns of supported nodes whose reactions are recorded.
    held : dict of str to ndarray
        Place in ``pushed`` and component of what a support holds, shape (c, 2), by its name.
    springs : dict of str to ndarray
        Places in ``entries`` of force and length of a spring, shape (2,), by its name; those of others
        follow from the unknowns of their ends.
    turned : dict of str to ndarray
        Of the vectors that turn with the node of a support, shape (d, 2): entry of the state vectors and
        place in ``pushed`` of the first of their three components, by its name.
    """

    points: tuple[Point, ...] = ()
    connections: tuple[str, ...] = ()
    index: IntArray = field(default_factory=_none)
    entries: IntArray = field(default_factory=_none)
    columns: dict[str, IntArray] = field(default_factory=dict)
    moved: IntArray = field(default_factory=_none)
    pushed: IntArray = field(default_factory=_none)
    held: dict[str, IntArray] = field(default_factory=dict)
    springs: dict[str, IntArray] = field(default_factory=dict)
    turned: dict[str, IntArray] = field(default_factory=dict)

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

    model: Any
    joints: dict[str, IntArray]
    slots: dict[str, IntArray]
    measures: dict[str, IntArray]
    constraints: Any
    numbering: Any

    @property
    def lengths(self) -> dict[str, tuple[int, float]]:
        """Of cables with a winch, see :func:`ancf.system.probe.lengths_of`."""
        ...

    def probe(self, point: Point) -> Probe:
        """Where the state of a point is found."""
        ...


def listing(
    system: Probed,
    items: Sequence[Point | Connection | Support],
    accelerations: bool,
    ends: bool = False,
) -> Listing:
    """Entries that a system needs to record these points, connections and supports.

    ``accelerations`` says whether the run has them, and reactions. ``ends``: of springs the unknowns of their
    ends are recorded, which have derivatives, in place of force and length.
    """
    points = tuple(dict.fromkeys(item for item in items if isinstance(item, Point)))
    joined = {item.name: item for item in items if not isinstance(item, Point)}
    wanted, entries, moved, pushed = [_none()], [_none()], [_none()], [_none()]
    columns: dict[str, IntArray] = {}
    springs: dict[str, IntArray] = {}
    held: dict[str, IntArray] = {}
    turned: dict[str, IntArray] = {}
    for point in points:
        probe = system.probe(point)
        wanted.append(_triples(probe.slots))
        moved.append(_triples(_position_slots(probe)))
        if point.body.name in system.lengths:
            wanted.append(np.array(system.lengths[point.body.name][:1]))
    for name, item in joined.items():
        wanted += _moving(system, item, ends)
        if name in system.measures and not (ends and isinstance(item, Spring)):
            first = sum(map(len, entries))
            own = springs if isinstance(item, Spring) else columns
            own[name] = np.arange(first, first + len(system.measures[name]))
            entries.append(system.measures[name])
        if isinstance(item, Support):
            unknowns = np.array(system.constraints.positions[name], dtype=np.int64)
            first = sum(map(len, pushed))
            held[name] = np.stack([first + np.arange(len(unknowns)), unknowns % 3], axis=1)
            slots = turning(system, item)
            turned[name] = np.stack([slots, first + len(unknowns) + 3 * np.arange(len(slots))], axis=1)
            pushed += [unknowns, _triples(slots)]
            wanted.append(_triples(slots))
    index = np.unique(np.concatenate(wanted)).astype(np.int64)
    rates = np.unique(np.concatenate(moved)).astype(np.int64) if accelerations else _none()
    measured, reactions = np.concatenate(entries), np.concatenate(pushed)
    return Listing(points, tuple(joined), index, measured, columns, rates, reactions, held, springs, turned)


def turning(system: Probed, item: Support) -> IntArray:
    """First unknowns (d,) of the vectors that turn with the node or body of a support: slopes, directors.

    Of several supports that hold directions there the first one has them, others none.
    """
    body = item.point.body
    node = _node_of(item)
    holding = (s for s in system.model.supports if s.point.body is body and _node_of(s) == node)
    turning_ones = (s.name for s in holding if any(not part.startswith("position") for part in s.held))
    if item.name != next(turning_ones, None):
        return _none()
    slots: IntArray = system.slots[body.name][node, 1 : system.numbering.shared[body.name]]
    return slots


def _node_of(item: Support) -> int:
    body = item.point.body
    return (body.node_at(item.point.x) or 0) if isinstance(body, Beam) else 0


def _moving(system: Probed, item: Connection | Support, ends: bool) -> list[IntArray]:
    """Entries of the state vectors that a connection needs."""
    found = []
    if isinstance(item, Spring) and ends:
        points = [end for end in (item.a, item.b) if isinstance(end, Point)]
        found += [_triples(_position_slots(system.probe(end))) for end in points]
    if isinstance(item, TorsionSpring):
        slots = torsion_springs([item], system.slots).base
        found.append(_triples(slots[slots >= 0]))
    if item.name in system.joints:
        found.append(unknowns_of(system, item))
    return found


def unknowns_of(system: Probed, joint: Any) -> IntArray:
    """Entries of the state vectors that say what a joint carries: its own, and what it turns at its ends."""
    own = system.joints[joint.name]
    if isinstance(joint, Slide | Contact):
        return own
    ends = [_triples(_slots_of(system, end)) for end in kind_of(joint).ends_of(joint)]
    return np.concatenate([own, *ends]).astype(np.int64)


def _slots_of(system: Probed, end: Any) -> IntArray:
    """Slots of all that a joint turns at one of its ends; none of a fixed position."""
    if isinstance(end, Point):
        return system.probe(end).slots
    body = body_of(end)
    return _none() if body is None else system.slots[body.name].ravel()


def by_ends(listed: Listing, connections: Iterable[Connection]) -> bool:
    """Whether springs were recorded by the unknowns of their ends, as in files of earlier versions."""
    springs = {item.name for item in connections if isinstance(item, Spring)}
    return not springs.isdisjoint(listed.connections) and not listed.springs


def _triples(slots: IntArray) -> IntArray:
    """Entries of vectors that start at these slots."""
    return (slots[:, None] + np.arange(3)).ravel()


def _position_slots(probe: Probe) -> IntArray:
    """Slots on which the position of a point depends: at a node of a beam few of the element's."""
    return probe.slots[probe.S[R] != 0.0] if isinstance(probe.body, Beam) else probe.slots
