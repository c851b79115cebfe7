"""Table 2: processor time of the sliding beam (7.4), 1 s of motion in 5000 steps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import kinds, sliding
from .table import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ancf.solvers.stepping import Stats

#: Meshes and the paper's times, s.
ROWS = (
    (sliding.Mesh(kinds.ORIGINAL, 6, 2), 38.0),
    (sliding.Mesh(kinds.NONLOCKING, 6, 2), 72.0),
    (sliding.Mesh(kinds.CABLE, 6, 2), 6.0),
    (sliding.Mesh(kinds.CABLE, 64, 4), 71.0),
    (sliding.Mesh(kinds.CABLE, 128, 8), None),
)
COUNTERS = ("steps", "newton_iterations", "jacobians")
COLUMNS = (*sliding.KEYS, *COUNTERS, "cpu_seconds", "paper_seconds")
SIZE = (130.0, 42.0)  # mm
REPEATS = 3

#: Heads of the picture and where their columns end, as shares of its width.
HEADS = ("element", "carrier + slider", "steps", "Newton\niterations", "Jacobians", "CPU\n[s]", "paper\n[s]")
RIGHT = (0.13, 0.33, 0.44, 0.58, 0.72, 0.86, 0.98)


def data(short: bool = False) -> Table:
    """Counters and processor times, the best of three runs; the short form runs 20 ms, once.

    ``paper_seconds`` is None where the paper has no time.
    """
    rows: list[tuple[Any, ...]] = []
    for mesh, paper in ROWS:
        stats = _best(mesh, short)
        counts = (int(getattr(stats, name)) for name in COUNTERS)
        rows.append((*mesh.key, *counts, stats.cpu_seconds, paper))
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


def _best(mesh: sliding.Mesh, short: bool) -> Stats:
    """Counters of the fastest of several runs with default settings."""
    model = sliding.build(mesh.carrier, mesh.slider, mesh.element)
    start, t_end = sliding.start(model), 0.02 if short else sliding.T_END
    repeats = range(1 if short else REPEATS)
    runs = [sliding.run(model, t_end, output_step=t_end, state=start).stats for _ in repeats]
    return min(runs, key=lambda stats: stats.cpu_seconds)


def _notes(short: bool) -> list[str]:
    repeats = "one run" if short else f"the best of {REPEATS} runs"
    return [
        *sliding.NOTES[:-1],
        "Trapezoidal rule, step 0.2 ms, GGL, all settings at their defaults.",
        f"Processor time of the stepping alone, {repeats}, one thread; no state is stored on the way.",
    ]


def _measured(row: tuple[Any, ...]) -> str:
    element, carrier, slider, _, iterations, jacobians, seconds, paper = row
    compared = "" if paper is None else f", in the paper {paper:g} s"
    counts = f"{iterations} Newton iterations, {jacobians} Jacobians"
    return f"Measured, {element}, {carrier}+{slider}: {seconds:.3g} s{compared}; {counts}."


def _texts(row: tuple[Any, ...]) -> tuple[str, ...]:
    element, carrier, slider, *counts, seconds, paper = row
    times = f"{seconds:.3f}", "" if paper is None else f"{paper:g}"
    return str(element), f"{carrier} + {slider}", *(f"{count}" for count in counts), *times


def _line(axes: Axes, y: float, texts: tuple[str, ...]) -> None:
    """One line: the first column to the left, numbers to the right."""
    for k, (x, text) in enumerate(zip(RIGHT, texts, strict=True)):
        place, side = (0.01, "left") if k == 0 else (x, "right")
        axes.text(place, y, text, ha=side, va="center")
