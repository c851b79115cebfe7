"""How the roof of a vehicle moves: along the track, and by its own motion upwards and sideways."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...columns import read_columns, split_unit
from ...errors import ModelError
from ...model import checks
from ...model.functions.function import TimeFunction
from ...model.functions.series import Series
from .travel import Travel

WAYS = ("up", "side")
#: Difference of times for the velocity at the start, s.
SHORT = 1e-6
#: Motions of a roof beyond this, m, are a slip of units.
FAR = 0.5


@dataclass(frozen=True)
class RoofMotion:
    """Motion of a roof beside its way along the track.

    Parameters
    ----------
    up, side : TimeFunction, m
        Upwards, and to the left of the track.

    """

    up: TimeFunction
    side: TimeFunction

    def at(self, t: float) -> tuple[float, float]:
        """Sideways and upwards, m."""
        return float(self.side(t)[0]), float(self.up(t)[0])


@dataclass(frozen=True)
class Track:
    """How masses move along the track, which are held by the roof."""

    travel: Travel
    roof: RoofMotion | None = None

    def at(self, t: float) -> tuple[float, float, float]:
        """Displacement of the roof since t = 0 along the track, and its own sideways and upwards, m."""
        y, z = (0.0, 0.0) if self.roof is None else self.roof.at(t)
        return float(self.travel.distance(t)), y, z

    def velocity(self, upwards: float) -> tuple[float, float, float]:
        """Velocity at t = 0, m/s; ``upwards`` is 0 for masses that the roof does not lift."""
        (_, y0, z0), (_, y1, z1) = self.at(0.0), self.at(SHORT)
        return float(self.travel.speed(0.0)), (y1 - y0) / SHORT, upwards * (z1 - z0) / SHORT

    @property
    def along(self) -> Any:
        """Displacement of the masses along and across the track, a function of time."""
        return self._motion(0.0)

    @property
    def above(self) -> Any:
        """The same of the roof, which also moves upwards."""
        return self._motion(1.0)

    def _motion(self, upwards: float) -> Any:
        if self.travel.constant and self.roof is None:
            return (f"{self.travel.top!r}*t", 0.0, 0.0)

        def motion(t: float) -> tuple[float, float, float]:
            x, y, z = self.at(t)
            return x, y, upwards * z

        return motion


def roofs(given: Any, count: int) -> list[RoofMotion | None]:
    """Motions of the roofs of so many pantographs: none, one for all, or a list with one each.

    Raises
    ------
    ModelError
        A motion is wrong, or there are not as many as pantographs.

    """
    if given is None:
        return [None] * count
    if isinstance(given, Sequence) and not isinstance(given, str):
        if len(given) != count:
            what = f"has {len(given)} motions for {count} pantographs"
            raise ModelError("run.roof", what, "give one, or one for each pantograph")
        return [None if one is None else _roof(one, f"run.roof[{k}]") for k, one in enumerate(given)]
    return [_roof(given, "run.roof")] * count


def _roof(given: Any, where: str) -> RoofMotion:
    if isinstance(given, Path) or (isinstance(given, str) and given.endswith(".csv")):
        given = read_roof(given)
    ways = given if isinstance(given, Mapping) and set(given) <= set(WAYS) else {"up": given}
    made = RoofMotion(*(TimeFunction(ways.get(way, 0.0), 1, f"{where}.{way}", "m") for way in WAYS))
    for way, motion in zip(WAYS, (made.up, made.side), strict=True):
        far = float(motion(0.0)[0])
        if not abs(far) <= FAR:
            raise ModelError(f"{where}.{way}", f"is {far:g} m at the start, at most {FAR:g} m", "units are m")
    return made


def read_roof(path: str | Path) -> dict[str, Series]:
    """Motion of a roof from a CSV file: a column of times, ``up`` and, if it sways, ``side``.

    Units stand in the heads, ``up [mm]``; default s and m.

    Raises
    ------
    ModelError
        The file cannot be read, or has no column ``up``.

    """
    names = [split_unit(head)[0] for head in read_columns(Path(path), "run.roof")]
    known = [way for way in WAYS if way in names]
    if "up" not in known:
        near = checks.nearest("up", names)
        raise ModelError(f"{path}, column up", "is missing", near or f"the head has: {checks.listed(names)}")
    return {way: Series.read(path, way) for way in known}
