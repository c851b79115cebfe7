"""Table 2: processor time of the sliding beam (7.4), 1 s of motion in 5000 steps."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from . import kinds, sliding, trajectory
from .check import Check
from .references import origin, reference
from .table import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .. import Result

TITLE = "Table 2: processor times of the sliding beam"
EXAMPLE = "7.4"
CLAIM = (
    "The nonlocking element takes more time than the original one; the cable takes much less, also with many "
    "more elements. Times are shown, not judged: what is judged is that the timed runs are right."
)
#: Meshes and the paper's times, s.
ROWS = (
    (sliding.Mesh(kinds.ORIGINAL, 6, 2), 38.0),
    (sliding.Mesh(kinds.NONLOCKING, 6, 2), 72.0),
    (sliding.Mesh(kinds.CABLE, 6, 2), 6.0),
    (sliding.Mesh(kinds.CABLE, 64, 4), 71.0),
    (sliding.Mesh(kinds.CABLE, 128, 8), None),
)
COUNTERS = ("steps", "newton_iterations", "jacobians")
PLACE = ("tip_x", "tip_y", "tip_z")
COLUMNS = (*sliding.KEYS, "t", *COUNTERS, "cpu_seconds", "paper_seconds", *PLACE)
#: Largest distance of the mass from the reference, m, at 0.25 and at 1 s. GGL and the tolerance of Newton's
#: method are not those of the reference; near 1 s round-off is seen in the beams.
BARS = {kinds.CABLE: (5e-6, 5e-6), kinds.ORIGINAL: (2e-5, 1e-3), kinds.NONLOCKING: (2e-5, 1e-3)}
SIZE = (130.0, 42.0)  # mm
REPEATS = 3

#: Heads of the picture and where their columns end, as shares of its width.
HEADS = ("element", "carrier + slider", "steps", "Newton\niterations", "Jacobians", "CPU\n[s]", "paper\n[s]")
RIGHT = (0.13, 0.33, 0.44, 0.58, 0.72, 0.86, 0.98)


def data(short: bool = False) -> Table:
    """Counters, processor times and where the mass ends, the best of three runs of 1 s.

    The short form runs 0.25 s, once. ``paper_seconds`` is None where the paper has no time.
    """
    rows: list[tuple[Any, ...]] = []
    for mesh, paper in ROWS:
        result = _best(mesh, short)
        counts = (int(getattr(result.stats, name)) for name in COUNTERS)
        place: list[float] = result.position("slider.end")[-1].tolist()
        head = (*mesh.key, float(result.t[-1]))
        rows.append((*head, *counts, result.stats.cpu_seconds, paper, *place))
    return Table("table2", COLUMNS, rows, [*_notes(short), *map(_measured, rows)])


def draw(table: Table, figure: Figure) -> None:
    """Draw the table itself."""
    axes = figure.subplots()
    axes.set(xlim=(0.0, 1.0), ylim=(len(table.rows), -1.4))
    axes.axis("off")
    _line(axes, -0.7, HEADS)
    for k, row in enumerate(table.rows):
        _line(axes, k + 0.5, _texts(row))
    for y, width in ((-1.4, 1.0), (0.0, 0.5), (len(table.rows), 1.0)):
        axes.axhline(y, color="black", linewidth=width, clip_on=False)


def checks(table: Table) -> list[Check]:
    """How far the timed runs with a reference end from it, and their Jacobians; no time is judged.

    Coordinates are compared in Figs. 10 and 11, of runs without the default settings that are timed here.
    """
    return [check for row in table.rows for check in (*_place(row), _work(row))]


def _place(row: tuple[Any, ...]) -> list[Check]:
    """Distance of the mass at the end from the reference of the same mesh; the fine ones have none."""
    mesh, t, place = sliding.Mesh(*row[:3]), row[3], row[-3:]
    if mesh.carrier != sliding.COARSE:
        return []
    key, bar = f"{trajectory.start_of_key(mesh)}.t{t:g}", BARS[mesh.element][int(t > sliding.SHORT_END)]
    name, far = f"7.4 timed, {mesh.label}: distance of the mass", math.dist(place, reference(key)[:3])
    return [Check(name, far, 0.0, bar, "m", origin(key))]


def _work(row: tuple[Any, ...]) -> Check:
    mesh, (steps, _, jacobians) = sliding.Mesh(*row[:3]), row[4:7]
    kept = "modified Newton method: a matrix lasts for more than one step"
    name = f"7.4 timed, {mesh.label}: Jacobians for a step"
    return Check(name, jacobians / steps, 1.0, 0.0, "", kept, "at most")


def _best(mesh: sliding.Mesh, short: bool) -> Result:
    """The fastest of several runs with default settings."""
    model = sliding.build(mesh.carrier, mesh.slider, mesh.element)
    start, t_end = sliding.start(model), sliding.SHORT_END if short else sliding.T_END
    repeats = range(1 if short else REPEATS)
    runs = [sliding.run(model, t_end, output_step=t_end, state=start) for _ in repeats]
    return min(runs, key=lambda run: float(run.stats.cpu_seconds))


def _notes(short: bool) -> list[str]:
    repeats = "one run" if short else f"the best of {REPEATS} runs"
    return [
        *sliding.NOTES[:-1],
        "Trapezoidal rule, step 0.2 ms, GGL, all settings at their defaults.",
        f"Processor time of the stepping alone, {repeats}, one thread; no state is stored on the way.",
    ]


def _measured(row: tuple[Any, ...]) -> str:
    element, carrier, slider, _, _, iterations, jacobians, seconds, paper = row[:9]
    compared = "" if paper is None else f", in the paper {paper:g} s"
    counts = f"{iterations} Newton iterations, {jacobians} Jacobians"
    return f"Measured, {element}, {carrier}+{slider}: {seconds:.3g} s{compared}; {counts}."


def _texts(row: tuple[Any, ...]) -> tuple[str, ...]:
    element, carrier, slider, _, *counts, seconds, paper = row[:9]
    times = f"{seconds:.3f}", "" if paper is None else f"{paper:g}"
    return str(element), f"{carrier} + {slider}", *(f"{count}" for count in counts), *times


def _line(axes: Axes, y: float, texts: tuple[str, ...]) -> None:
    """One line: the first column to the left, numbers to the right."""
    for k, (x, text) in enumerate(zip(RIGHT, texts, strict=True)):
        place, side = (0.01, "left") if k == 0 else (x, "right")
        axes.text(place, y, text, ha=side, va="center")
