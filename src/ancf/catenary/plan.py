"""Plan of a run: which pantographs start where, how fast they go, and what of their way is evaluated."""

from __future__ import annotations

import copy
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..model import checks
from .assemble import Assembled
from .broken import chosen
from .collectors import Touch
from .forms.form import Form
from .forms.mesh import Mesh
from .forms.route_form import AnyForm, RouteForm
from .lines.catalogue import read_line
from .lines.line import Line
from .lines.route import Route
from .rest import assemble, form
from .underside import checked_underside
from .vehicles.pantograph import Pantograph, find_pantograph
from .vehicles.roof import RoofMotion, roofs
from .vehicles.travel import Travel

#: Where the last pantograph starts, as a share of the first span.
START = 1.0 / 3.0
#: Track that the first pantograph runs before the window, m: its start dies away.
RUN_IN = 50.0
#: Height over the lowest wire from which on a wire is out of a strip's reach, m.
RAISED = 0.15
#: Track beyond the window that the last pantograph still runs, m: a filter needs to see it.
BEYOND = 40.0


@dataclass(frozen=True)
class Door:
    """How the model of a line is made: from its form, or as somebody has changed it.

    Parameters
    ----------
    given : Assembled, optional
        A line that was assembled, and perhaps changed.
    modify : callable, optional
        Changes each model before pantographs are added to it.
    broken : tuple of (int, int)
        Span and number, from 1, of the droppers that are taken away.

    """

    given: Assembled | None = None
    modify: Callable[[Assembled], Any] | None = None
    broken: tuple[tuple[int, int], ...] = ()

    @classmethod
    def of(cls, line: Any, shape: AnyForm, modify: Any, broken: Any, where: str) -> Door:
        """The door of what ``run`` or ``stepper`` was given; ``shape`` is the form of it."""
        given = line if isinstance(line, Assembled) else None
        if modify is not None:
            checks.function(modify, f"{where}.modify", "the overhead")
        return cls(given, modify, chosen(shape.line, broken, f"{where}.broken_droppers"))

    @property
    def changed(self) -> bool:
        """Whether the line may rest in another way than its form says."""
        return self.opened or bool(self.broken)

    @property
    def opened(self) -> bool:
        """Whether somebody may have changed the model by hand."""
        return self.given is not None or self.modify is not None

    def overhead(self, found: AnyForm) -> Assembled:
        """A model that nobody else has."""
        made = assemble(found) if self.given is None else copy.deepcopy(self.given)
        for span, number in self.broken:
            made.break_dropper(span, number)
        if self.modify is not None:
            self.modify(made)
        return made


@dataclass(frozen=True)
class Plan:
    """What is to be run, checked.

    Attributes
    ----------
    form : Form
    travel : Travel
    pantographs : list of Pantograph
        The first one runs ahead.
    places : list of float
        Track positions at t = 0, m.
    raised : list of float
        By how much the lowest spring is relaxed above the place that its pantograph gives, m.
    window : (float, float)
        Track interval that is evaluated, m.
    until : float
        Track position at which the last pantograph stops, m.
    touch : Touch
    step : float
        s.
    spent : float
        CPU time of what was computed to make it, s.
    door : Door
        How the model of the line is made.
    roofs : list of RoofMotion or None
        Of the vehicles, one for each pantograph.
    underside : (n, 2) array or None
        Track positions and heights of the underside of the contact wires, m.

    """

    form: AnyForm
    travel: Travel
    pantographs: list[Pantograph]
    places: list[float]
    raised: list[float]
    window: tuple[float, float]
    until: float
    touch: Touch
    step: float
    spent: float = 0.0
    door: Door = field(default_factory=lambda: Door())
    roofs: list[RoofMotion | None] = field(default_factory=list)
    underside: FloatArray | None = None

    @property
    def duration(self) -> float:
        """Whole steps until the last pantograph stops, s."""
        seconds = self.travel.time(self.until - self.places[-1])
        return float(np.ceil(seconds / self.step - 1e-9) * self.step)

    def lift(self, k: int, t: Any = 0.0) -> Any:
        """Static and aerodynamic force of a pantograph at times t, in s, by default at the start, N."""
        return self.pantographs[k].force(self.travel.speed(t))


def make_plan(
    shape: AnyForm,
    travel: Travel,
    pantograph: Any,
    spacing: Any,
    start: float | None,
    window: tuple[float, float] | None,
    until: float | None,
    touch: Touch,
    step: float,
    door: Door,
    roof: Any = None,
    underside: Any = None,
    evaluated: bool = True,
) -> Plan:
    """Check what ``run`` was given, or ``stepper``, of which nothing is ``evaluated`` over a window."""
    line, units = shape.line, _units(pantograph, spacing)
    behind, train = _start(line, start), units[-1][1]
    kinds = [unit for unit, _ in units]
    _check_strips(line, kinds)
    if evaluated or window is not None or any(unit.relaxed_at == "mean" for unit in kinds):
        interval = _window(line, window, behind + train, train, until)
        last = interval[1] + BEYOND if until is None else until
    else:
        interval, last = (behind + train, line.end), line.end - train
    _check_sweep(shape, kinds, behind, last + train)
    return Plan(
        form=shape,
        travel=travel,
        pantographs=kinds,
        places=[behind + train - distance for _, distance in units],
        raised=[0.0] * len(units),
        window=interval,
        until=last,
        touch=touch,
        step=checks.positive(step, "run.step"),
        door=door,
        roofs=roofs(roof, len(units)),
        underside=_under(underside, touch),
    )


def _under(given: Any, touch: Touch) -> FloatArray | None:
    """The underside of the wires, which a sliding joint does not know."""
    rows = checked_underside(given)
    if rows is not None and touch.kind != "penalty":
        raise ModelError("run.underside", 'has no effect with contact = "joint"', "leave one of both out")
    return rows


def formed(line: Line | Route | AnyForm | Assembled | str | Path, mesh: Mesh | None) -> AnyForm:
    """Form of a line, of a name or a path, of its model, or as given."""
    if isinstance(line, Assembled):
        line = line.form
    if isinstance(line, Form | RouteForm):
        if mesh is not None:
            raise ModelError("run.mesh", "has no effect: a form has its mesh", "give the line instead")
        return line
    return form(line if isinstance(line, Line | Route) else read_line(line), mesh)


def _units(pantograph: Any, spacing: Any) -> list[tuple[Pantograph, float]]:
    """Pantographs and their distances behind the first, m."""
    behind = [0.0]
    if spacing is not None:
        given = spacing if isinstance(spacing, Sequence) else [spacing]
        for k, value in enumerate(given):
            where = "run.spacing" if len(given) == 1 else f"run.spacing[{k}]"
            behind.append(behind[-1] + checks.positive(value, where))
    many = isinstance(pantograph, Sequence) and not isinstance(pantograph, str)
    kinds = [find_pantograph(p) for p in (pantograph if many else [pantograph] * len(behind))]
    if len(kinds) != len(behind):
        what = f"{len(kinds)} pantographs with {len(behind) - 1} distances between them"
        raise ModelError("run.spacing", what, "give one less than pantographs")
    return list(zip(kinds, behind, strict=True))


def _start(line: Line | Route, given: float | None) -> float:
    """Track position of the last pantograph at t = 0."""
    first = line.begin + START * line.spans[0].length
    place = first if given is None else checks.number(given, "run.start")
    if not line.begin < place < line.end:
        what = f"the last pantograph starts at {place:g} m, {_reaches(line)}"
        raise ModelError("run.start", what)
    return place


def _reaches(line: Line | Route) -> str:
    return f"the line reaches from {line.begin:g} to {line.end:g} m"


def _window(
    line: Line | Route, given: tuple[float, float] | None, first: float, train: float, until: float | None
) -> tuple[float, float]:
    """Interval that is evaluated; all pantographs must come to it from outside and pass it on the line.

    ``first`` is where the first pantograph starts, ``train`` its distance from the last one, which goes on
    ``until`` there, or BEYOND the window.
    """
    if until is not None and checks.number(until, "run.until") + train > line.end:
        what = f"is {until:g} m, the first pantograph is then at {until + train:g} m"
        raise ModelError("run.until", what, f"the line ends at {line.end:g} m")
    room = BEYOND + train
    low, high = _middle(line, first, room) if given is None else _given(line, given, first)
    if until is not None and high > until:
        what = f"is {until:g} m, inside the window from {low:g} m to {high:g} m"
        hint = f"run until {high:g} m or further"
        if first < until:
            hint += ", or give a window that ends before"
        raise ModelError("run.until", what, hint)
    ahead = high + room
    if until is None and ahead > line.end:
        what = (
            f"the first pantograph is at {ahead:g} m when the last one has passed the window, "
            f"beyond the end of the line at {line.end:g} m"
        )
        raise ModelError("run.window", what, "use a longer line or an earlier window")
    return low, high


def _given(line: Line | Route, given: tuple[float, float], first: float) -> tuple[float, float]:
    """A window that somebody wants, on the line and ahead of the first pantograph."""
    low, high = checks.array(given, "run.window", (2,)).tolist()
    if not low < high:
        what = f"begins at {low:g} m and ends at {high:g} m"
        hint = f"the smaller place first: {high:g} {low:g}" if low > high else "two places"
        raise ModelError("run.window", what, hint)
    if not line.begin <= low < high <= line.end:
        what = f"is {low:g} m to {high:g} m, {_reaches(line)}"
        raise ModelError("run.window", what)
    if first > low:
        what = f"the first pantograph starts at {first:g} m, behind the start of the window at {low:g} m"
        raise ModelError("run.start", what, "use a longer line, or a window further on")
    return low, high


def _middle(line: Line | Route, first: float, room: float) -> tuple[float, float]:
    """A third of the spans, fewer if need be, as near the middle as the train allows; never the end spans.

    Where no span begins behind the run-in, those that begin where the first pantograph has started.
    """
    supports, spans = line.marks, line.marks.size - 1
    for lead in (RUN_IN, 0.0):
        for count in range(max(1, spans // 3), 0, -1):
            starts = [
                k
                for k in range(1, spans - count)
                if supports[k] >= first + lead and supports[k + count] + room <= line.end
            ]
            if starts:
                twice = line.begin + line.end
                best = min(starts, key=lambda k: abs(supports[k] + supports[k + count] - twice))
                return float(supports[best]), float(supports[best + count])
    what = f"no span is left to evaluate: the train starts up to {first:g} m and needs {room:g} m beyond"
    hint = f"use a line longer than {line.length:g} m, or less spacing"
    low, high = float(np.ceil(first)), float(np.floor(line.end - room))
    if low < high:
        hint += f"; or give a part of a span, --window {low:g} {high:g}, window=({low:g}, {high:g})"
    raise ModelError("run.window", what, hint)


def _check_strips(line: Line | Route, pantographs: list[Pantograph]) -> None:
    """Staggers of the supports at which the wire is low enough to be touched."""
    low = np.array(line.heights) < line.height_at(line.supports) + RAISED
    for pantograph in pantographs:
        for k, side in enumerate(line.stagger):
            if low[k] and abs(side) > 0.5 * pantograph.strip_length:
                reach = 0.5 * pantograph.strip_length
                what = f"is {side:g} m, the strip of {pantograph.name} reaches to {reach:g} m"
                raise ModelError(line.place_of_support("stagger", k), what, "less stagger or a longer strip")


def _check_sweep(shape: AnyForm, pantographs: list[Pantograph], start: float, end: float) -> None:
    """Between the supports, in curves and wind, the wire at rest has to lie on the strips too."""
    reach = 0.5 * min(unit.strip_length for unit in pantographs)
    place = np.concatenate(shape.contact_places)
    low = place[:, 2] < shape.line.height_at(place[:, 0]) + RAISED
    passed = place[low & (place[:, 0] >= start) & (place[:, 0] <= end)]
    worst = int(np.argmax(np.abs(passed[:, 1]))) if len(passed) else 0
    if len(passed) and abs(passed[worst, 1]) > reach:
        x, y, _ = passed[worst]
        what = f"lies {y:.3f} m beside the track at {x:.1f} m, the strips reach to {reach:g} m"
        raise ModelError("line.contact_wire", what, "other staggers, shorter spans, or less wind")
