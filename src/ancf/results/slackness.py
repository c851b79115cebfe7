"""When and where cables and springs that only pull are slack, from the stored states of a run."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..errors import ModelError, named
from ..model import checks
from ..model.bodies.beam import Beam
from ..model.joints.connections import Spring
from ..model.names import unknown
from .tension import cables, middles, pieces

#: Share of its largest tension that a rope bears as a straight column at most: others are not told unasked.
ROPE = 1e-3


@dataclass(frozen=True)
class SlackInterval:
    """A time in which a cable is slack somewhere, or a spring.

    Parameters
    ----------
    name : str
        Of the cable or spring.
    start, end : float
        Times, s: where the smallest tension falls below the limit and rises above it, between stored states
        on straight lines; the first and the last stored time where it is below it there.
    tension : float
        Its smallest tension in this time, N; a compression is negative.
    t : float
        When that is, s.
    point : str
        Where: the middle of an element, "" of a spring.
    below : float
        The limit, N.
    """

    name: str
    start: float
    end: float
    tension: float
    t: float
    point: str
    below: float = 0.0

    @property
    def duration(self) -> float:
        """Its length, s."""
        return self.end - self.start

    def __str__(self) -> str:
        where = f" at {self.point}" if self.point else ""
        least = f"{self.tension:.4g} N{where}, t = {self.t:.6g} s"
        what = f"below {self.below:g} N" if self.below else "slack"
        return f'"{self.name}" is {what} from {self.start:.6g} to {self.end:.6g} s; smallest tension {least}'

    def as_dict(self) -> dict[str, Any]:
        """All by name."""
        return asdict(self)


def slack_intervals(known: Any, of: Any = None, below: float = 0.0) -> list[SlackInterval]:
    """See :meth:`ancf.Result.slack_intervals`."""
    limit = checks.non_negative(below, "slack_intervals.below")
    beams, springs = _chosen(known, of)
    return _found(np.asarray(known.t), dict(_lowest(known, beams, springs)), limit)


def of_ropes(known: Any) -> list[SlackInterval]:
    """Those of springs that only pull, and of cables that pull a thousand times what they could bear."""
    beams, springs = _chosen(known, None)
    lowest = {
        name: seen
        for name, seen in _lowest(known, beams, springs)
        if isinstance(seen.item, Spring) or _is_rope(seen.item, float(np.max(seen.high)))
    }
    # what begins without a stretch is slack at the start alone
    return [item for item in _found(np.asarray(known.t), lowest, 0.0) if item.duration > 0.0]


def _is_rope(beam: Beam, largest: float) -> bool:
    return bool(np.pi**2 * beam.section.EI / beam.length**2 <= ROPE * largest)


@dataclass(frozen=True)
class _Seen:
    """Smallest and largest tension (n_t,) over a cable or spring, and the elements (n_t,) of the smallest."""

    item: Beam | Spring
    low: FloatArray
    high: FloatArray
    element: IntArray

    @property
    def points(self) -> list[str]:
        """Places of the elements."""
        return [str(self.item.at(x)) for x in middles(self.item)] if isinstance(self.item, Beam) else [""]


def _chosen(known: Any, of: Any) -> tuple[list[Beam], list[Spring]]:
    """Cables and slack springs, all or those that are asked for."""
    every: dict[str, Any] = {beam.name: beam for beam in cables(known)}
    every |= {name: spring for name, spring in known.springs.items() if spring.slack}
    if of is None:
        items = [*every.values()]
    else:
        single = isinstance(of, str) or not isinstance(of, Iterable)
        items = [_of_name(getattr(item, "name", item), every) for item in ([of] if single else of)]
    beams = [item for item in items if isinstance(item, Beam)]
    return beams, [item for item in items if not isinstance(item, Beam)]


def _of_name(name: Any, every: dict[str, Any]) -> Any:
    if not isinstance(name, str):
        raise ModelError(named(name), "is no cable and no spring that can be slack")
    if name not in every:
        raise unknown("slack_intervals.of", "cable or slack spring", name, every)
    return every[name]


def _lowest(known: Any, beams: list[Beam], springs: list[Spring]) -> Iterator[tuple[str, _Seen]]:
    count = len(known.t)
    if not count:
        return
    room = {beam.name: (np.empty(count), np.empty(count), np.empty(count, np.int64)) for beam in beams}
    for rows, forces in pieces(known, beams):
        for name, force in forces.items():
            low, high, element = room[name]
            element[rows] = np.argmin(force, axis=1)
            low[rows], high[rows] = force.min(axis=1), force.max(axis=1)
    for beam in beams:
        yield beam.name, _Seen(beam, *room[beam.name])
    for spring in springs:
        force = np.asarray(known.spring_force(spring))
        yield spring.name, _Seen(spring, force, force, np.zeros(count, np.int64))


def _found(t: FloatArray, lowest: dict[str, _Seen], limit: float) -> list[SlackInterval]:
    """Intervals of all, by the time at which they begin."""
    found = [item for name, seen in lowest.items() for item in _of_one(t, name, seen, limit)]
    return sorted(found, key=lambda item: item.start)


def _of_one(t: FloatArray, name: str, seen: _Seen, limit: float) -> Iterator[SlackInterval]:
    slack = np.concatenate([[False], seen.low <= limit, [False]])
    changes = np.flatnonzero(np.diff(slack)).reshape(-1, 2)
    points = seen.points if len(changes) else []
    for first, after in changes.tolist():
        k = first + int(np.argmin(seen.low[first:after]))
        start = t[0] if first == 0 else _crossing(t, seen.low, first - 1, limit)
        end = t[-1] if after == len(t) else _crossing(t, seen.low, after - 1, limit)
        point = points[int(seen.element[k])]
        yield SlackInterval(name, float(start), float(end), float(seen.low[k]), float(t[k]), point, limit)


def _crossing(t: FloatArray, tension: FloatArray, k: int, limit: float) -> float:
    """Where a straight line between two stored times is at the limit."""
    one, other = tension[k] - limit, tension[k + 1] - limit
    return float(t[k] + (t[k + 1] - t[k]) * one / (one - other))
