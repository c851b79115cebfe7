"""Published ranges of the reference cases, by speed, and the rows that compare a run with them."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from ...errors import ModelError
from ...model import checks
from ...model.checks import listed, nearest
from .signals import Butterworth
from .statistics import Statistics, statistics

if TYPE_CHECKING:
    from .quantity import Quantity
    from .run_data import Run

#: Two speeds are the same within this, km/h.
SAME_SPEED = 1e-3
#: The filter with which verdicts are read a second time: the standards name the cut-off and no order.
SECOND_FILTER = Butterworth(4)
#: What finds a reference.
REFERENCE = "ancf.catenary.reference_case(name) finds one"


@dataclass(frozen=True)
class Range:
    """Accepted values of a quantity.

    Parameters
    ----------
    low, high : float
        Both are inside.
    tag : str
        How sure they are: V, V2 or U.

    """

    low: float
    high: float
    tag: str


@dataclass(frozen=True)
class Reference:
    """A reference case of a standard.

    Parameters
    ----------
    name, title, source : str
    line, pantograph : str
        Names in the catalogue.
    spans : int
        Number of spans that are evaluated, in the middle of the line.
    ranges : dict
        Of each speed, km/h: ranges by key of the quantity.

    """

    name: str
    title: str
    source: str
    line: str
    pantograph: str
    spans: int
    ranges: dict[float, dict[str, Range]]

    @property
    def speeds(self) -> list[float]:
        """Speeds that have ranges, km/h."""
        return sorted(self.ranges)

    def at(self, speed_kmh: float) -> dict[str, Range]:
        """Ranges at a speed; empty when the reference has none there. Nothing is interpolated."""
        speed = checks.number(speed_kmh, "reference.speed_kmh")
        same = [v for v in self.ranges if abs(v - speed) <= SAME_SPEED]
        return self.ranges[same[0]] if same else {}

    def note(self, speed_kmh: float) -> str:
        """What to say about a speed without ranges; nothing about one that has them."""
        if self.at(speed_kmh):
            return ""
        known = " and ".join(f"{v:g}" for v in self.speeds)
        return f"no accepted ranges at {speed_kmh:g} km/h: {self.title} gives them at {known} km/h"

    def compare(self, found: Statistics, speed_kmh: float) -> list[Quantity]:
        """Quantities of the reference, in its order, with their ranges at a speed."""
        ranges = self.at(speed_kmh)
        keys = ranges or self.ranges[self.speeds[0]]
        return [_limited(found[key], ranges.get(key)) for key in keys]


def _limited(quantity: Quantity, limits: Range | None) -> Quantity:
    if limits is None:
        return replace(quantity, low=None, high=None, tag=None)
    return replace(quantity, low=limits.low, high=limits.high, tag=limits.tag)


def rows(run: Run, reference: Reference | str, pantograph: int = 0) -> list[dict[str, Any]]:
    """Compare a run with the published ranges.

    Parameters
    ----------
    run : Run
    reference : Reference or str
        Or its name.
    pantograph : int
        Place in ``run.recordings``.

    Returns
    -------
    list of dict
        ``quantity, unit, value, low, high, inside, tag``; at a speed without ranges the last four are None.

    """
    given: object = reference
    if isinstance(given, str):
        given = reference_case(given)
    chosen = checks.kind(given, "rows.reference", Reference, REFERENCE)
    found = statistics(run, pantograph)
    return [quantity.row for quantity in chosen.compare(found, run.speed_kmh)]


def second_reading(run: Run, reference: Reference, pantograph: int = 0) -> list[Quantity]:
    """Compare once more, with :data:`SECOND_FILTER`."""
    return reference.compare(statistics(run, pantograph, SECOND_FILTER), run.speed_kmh)


def filter_note(first: list[Quantity], second: list[Quantity]) -> str:
    """In a sentence whether verdicts depend on the order of the filter; nothing without verdicts.

    Parameters
    ----------
    first, second : list of Quantity
        The same quantities with the default filter and with :data:`SECOND_FILTER`.

    """
    judged = [q for q in second if q.inside is not None]
    if not judged:
        return ""
    start = f"with a filter of order {SECOND_FILTER.order} instead of {Butterworth().order}"
    turned = [q for q, before in zip(second, first, strict=True) if q.inside is not before.inside]
    if not turned:
        return f"{start} no verdict changes"
    inside = sum(q.inside is True for q in judged)
    return f"{start} {inside} of {len(judged)} are inside: {'; '.join(map(_turned, turned))}"


def _turned(q: Quantity) -> str:
    where = "inside" if q.inside else "outside"
    return f"{q.name} {q.value:.5g} {q.unit} is {where} {q.low:g} to {q.high:g}"


def reference_names() -> list[str]:
    """Names of the reference cases."""
    folder = files("ancf.catenary").joinpath("data", "references")
    return sorted(
        entry.name.removesuffix(".toml") for entry in folder.iterdir() if entry.name.endswith(".toml")
    )


def reference_case(name: str) -> Reference:
    """A reference case by name, or by a beginning that one alone has: ``en50318-2018``.

    Raises
    ------
    ModelError
        There is none of that name.

    """
    known = reference_names()
    begun = [other for other in known if other.startswith(f"{name}-")]
    if name not in known and len(begun) == 1:
        name = begun[0]
    if name not in known:
        hint = nearest(name, known)
        raise ModelError("reference case", f'there is no "{name}", there are {listed(known)}', hint)
    return _read(name)


@cache
def _read(name: str) -> Reference:
    text = files("ancf.catenary").joinpath("data", "references", f"{name}.toml").read_text(encoding="utf-8")
    data = tomllib.loads(text)
    ranges = {
        float(entry["kmh"]): {key: Range(*limits) for key, limits in entry["ranges"].items()}
        for entry in data.pop("speeds")
    }
    return Reference(name=name, ranges=ranges, **data)
