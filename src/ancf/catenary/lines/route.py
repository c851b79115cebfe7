"""Route: several tension lengths along one track, which share strips where they overlap."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import reduce
from typing import Any

import numpy as np

from ...arrays import FloatArray, IntArray
from ...errors import ModelError
from ...model import checks
from .fittings import Droppers
from .line import Line
from .span import Span
from .wire import Wire

#: How far a wire may begin or end below the one beside it, m.
LEVEL = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class Route:
    """Tension lengths along one track, each a line with its own anchors.

    Where two overlap, a pantograph touches the wire that is lower, or both: give their wires heights and
    staggers there that hand it over.

    Parameters
    ----------
    lines : sequence of Line
        In the order of the track.
    starts : sequence of float, m
        Track positions of their first supports.
    title, source : str
    report : mapping of str to str
        As of :class:`Line`.
    tags : mapping of str to str

    Raises
    ------
    ModelError
        Two that follow each other do not overlap or do not meet, or differ in gravity or conditions.

    """

    lines: tuple[Line, ...]
    starts: tuple[float, ...]
    title: str = ""
    source: str = ""
    report: Mapping[str, str] = field(default_factory=dict, hash=False)
    tags: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        lines = checks.items(self.lines, "route.lines", "of Line, one for each tension length")
        object.__setattr__(
            self, "lines", tuple(checks.kind(one, f"route.lines[{k}]", Line) for k, one in enumerate(lines))
        )
        given = list(checks.items(self.starts, "route.starts", "m, one for each line"))
        starts = checks.array(given, "route.starts", (len(self.lines),)).tolist()
        object.__setattr__(self, "starts", tuple(starts))
        if not self.lines:
            raise ModelError("route.lines", "has no line")
        for k in range(1, len(self.lines)):
            before = starts[k - 1] + self.lines[k - 1].length
            if not starts[k - 1] < starts[k] < before:
                what = (
                    f"is {starts[k]:g} m, the section before reaches from {starts[k - 1]:g} to {before:g} m"
                )
                hint = "sections have to overlap, else nothing carries the pantograph between them"
                raise ModelError(f"sections[{k}].start", what, hint)
            for key in ("gravity", "conditions", "temperature"):
                if getattr(self.lines[k], key) != getattr(self.lines[0], key):
                    raise ModelError(f"sections[{k}].{key}", "differs from that of the first section")
            self._check_meeting(k)

    def _check_meeting(self, k: int) -> None:
        """Where a section begins or ends its wire is not below the other one: there they hand over."""
        one, other, away = self.lines[k - 1], self.lines[k], self.starts[k] - self.starts[k - 1]
        first = sum(line.supports.size for line in self.lines[:k])
        begins = float(one.height_at(away)) - other.heights[0]
        ends = float(other.height_at(one.length - away)) - one.heights[-1]
        for low, support, what in ((begins, first, "begins"), (ends, first - 1, "ends")):
            if low > LEVEL:
                text = f"is {self.heights[support]:g} m: the wire {what} {low:.3g} m below the one beside it"
                hint = "raise it at its anchor, so that one wire hands pantographs over to the other"
                raise ModelError(self.place_of_support("height", support), text, hint)

    def joined(self, values: Callable[[Line], Any]) -> Any:
        """Values of all lines one after the other."""
        return np.concatenate([values(line) for line in self.lines])

    @property
    def parts(self) -> tuple[Line, ...]:
        """The lines."""
        return self.lines

    @property
    def spans(self) -> tuple[Span, ...]:
        """Spans of all sections."""
        return tuple(span for line in self.lines for span in line.spans)

    @property
    def supports(self) -> FloatArray:
        """Track positions of the supports of all sections, one section after the other, m."""
        places: FloatArray = np.concatenate(
            [x + one.supports for x, one in zip(self.starts, self.lines, strict=True)]
        )
        return places

    @property
    def marks(self) -> FloatArray:
        """Track positions of all supports, ascending, each once, m."""
        return np.unique(np.round(self.supports, 6))

    @property
    def reach(self) -> tuple[FloatArray, FloatArray]:
        """From where to where on the track a support counts as passed, m."""
        pairs = [line.reach for line in self.lines]
        low, high = (
            np.concatenate([x + pair[side] for x, pair in zip(self.starts, pairs, strict=True)])
            for side in (0, 1)
        )
        return low, high

    @property
    def stagger(self) -> tuple[float, ...]:
        """Staggers of all supports, m."""
        return tuple(self.joined(lambda line: line.stagger).tolist())

    def place_of_support(self, key: str, k: int) -> str:
        """Where a value of a support stands in its table, or in its section."""
        for number, line in enumerate(self.lines):
            if k < line.supports.size:
                place = line.place_of_support(key, k)
                return place if line.rows else f"sections[{number}].{place.removeprefix('line.')}"
            k -= line.supports.size
        raise IndexError(k)

    @property
    def heights(self) -> tuple[float, ...]:
        """Heights of the contact wires at all supports, m."""
        return tuple(self.joined(lambda line: line.heights).tolist())

    def height_at(self, track: Any) -> Any:
        """Nominal height of the lowest contact wire at track positions, m."""
        x = np.asarray(track, dtype=np.float64)
        levels = [
            np.where(
                (x >= start - 1e-9) & (x <= start + line.length + 1e-9), line.height_at(x - start), np.inf
            )
            for start, line in zip(self.starts, self.lines, strict=True)
        ]
        ends = np.where(x < self.starts[0], levels_at(self, 0), levels_at(self, -1))
        lowest = reduce(np.minimum, levels)
        return np.where(np.isfinite(lowest), lowest, ends)

    @property
    def begin(self) -> float:
        """Track position of the first support, m."""
        return self.starts[0]

    @property
    def end(self) -> float:
        """Track position of the last support of all sections, m."""
        return max(start + line.length for start, line in zip(self.starts, self.lines, strict=True))

    @property
    def length(self) -> float:
        """From the first support to the last, m."""
        return self.end - self.begin

    @property
    def dropper_x(self) -> FloatArray:
        """Track positions of all droppers, section after section, m."""
        pairs = zip(self.starts, self.lines, strict=True)
        return np.concatenate([start + line.dropper_x for start, line in pairs])

    @property
    def dropper_span(self) -> IntArray:
        """Index of the span of each dropper, counted over all sections."""
        first = np.cumsum([0, *(len(line.spans) for line in self.lines)])
        pairs = zip(first, self.lines, strict=False)
        return np.concatenate([k + line.dropper_span for k, line in pairs])

    @property
    def dropper_number(self) -> IntArray:
        """Index of each dropper in its span."""
        numbers: IntArray = self.joined(lambda line: line.dropper_number)
        return numbers

    @property
    def dropper_wire(self) -> IntArray:
        """Index of the contact wire of its section that each dropper carries."""
        wires: IntArray = self.joined(lambda line: line.dropper_wire)
        return wires

    @property
    def droppers(self) -> Droppers:
        """Droppers of the first section."""
        return self.lines[0].droppers

    @property
    def contact_wire(self) -> Wire:
        """Contact wire of the first section."""
        return self.lines[0].contact_wire

    @property
    def anchors(self) -> str:
        """Anchors of the first section."""
        return self.lines[0].anchors

    @property
    def wave_speed(self) -> float:
        """Lowest wave speed of all contact wires, m/s."""
        return min(line.wave_speed for line in self.lines)


def levels_at(route: Route, k: int) -> float:
    """Height at the outer end of the first or the last section, m."""
    return route.lines[k].heights[0 if k == 0 else -1]
