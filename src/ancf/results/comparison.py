"""Two results of one model side by side: where and when they differ most."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import ModelError
from ..model import checks
from ..model.tables import Readable, Sheet, Table, number
from .overview import points_of

#: Times that are the same, of the longer run.
SAME = 1e-9


@dataclass(frozen=True)
class Difference:
    """The largest distance of a point in two results.

    Parameters
    ----------
    point : str
    distance : float
        m.
    t : float
        When it is reached, s.
    moved : float
        Largest distance of the point from where it starts, m, of the first result.
    """

    point: str
    distance: float
    t: float
    moved: float


@dataclass(frozen=True)
class Comparison(Readable):
    """What two results differ by at the times that both have stored; ``print`` shows it as a table.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Common times, s.
    differences : list of Difference
        By point, the largest first.
    """

    t: Any
    differences: list[Difference]

    @property
    def largest(self) -> Difference:
        """The largest one."""
        return self.differences[0]

    def __repr__(self) -> str:
        worst = self.largest
        return f"Comparison({worst.distance:.3g} m at {worst.point}, t = {worst.t:g} s)"

    def _sheet(self) -> Sheet:
        times = f"{len(self.t)} in common, t = {self.t[0]:g} to {self.t[-1]:g} s"
        rows = [(d.point, number(d.distance, 3), number(d.t), number(d.moved, 4)) for d in self.differences]
        columns = ("point", "largest difference [m]", "at t [s]", "moved by [m]")
        return Sheet("Comparison", [("times", times)], [Table(columns, rows)])


def compare(one: Any, other: Any, points: Sequence[Any] | None = None) -> Comparison:
    """Compare positions of two results; see :meth:`ancf.Result.compare`."""
    if not all(hasattr(other, name) for name in ("t", "position", "bodies")):
        raise ModelError("compare", f"must be given a Result, is given {checks.shown(other)}")
    missing = one.bodies.keys() - other.bodies.keys()
    if points is None and missing:
        raise ModelError(
            "compare", f"the other result has no body {checks.listed(sorted(missing))}", "give points="
        )
    if points is None:
        points = [str(point) for body in one.bodies.values() for point in points_of(body)]
    mine, theirs = np.asarray(one.t), np.asarray(other.t)
    near = np.clip(np.searchsorted(theirs, mine - SAME * mine[-1:].sum()), 0, len(theirs) - 1)
    common = np.flatnonzero(np.abs(theirs[near] - mine) <= SAME * max(mine[-1], theirs[-1], 0.0))
    if not len(common):
        raise ModelError(
            "compare", "the results have no stored time in common", "give both the same output_step"
        )
    return Comparison(mine[common], sorted(_all(one, other, points, common, near[common]), key=_size))


def _size(found: Difference) -> float:
    return -found.distance


def _all(one: Any, other: Any, points: Sequence[Any], mine: Any, theirs: Any) -> list[Difference]:
    found, t = [], np.asarray(one.t)[mine]
    for point in points:
        here, there = one.position(point), other.position(str(point) if not isinstance(point, str) else point)
        apart = np.linalg.norm(here[mine] - there[theirs], axis=1)
        k = int(np.argmax(apart))
        moved = float(np.max(np.linalg.norm(here - here[0], axis=1)))
        found.append(Difference(str(point), float(apart[k]), float(t[k]), moved))
    return found
