"""The report of a comparison: runs side by side, their forces over each other."""

from __future__ import annotations

import csv
import datetime
import io
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..._version import __version__
from ...files import write_text
from ...viz import printed, style
from ...viz.html import element, figure, page, section
from ..answers.kept import Kept
from ..answers.quantity import shown
from . import tables

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

    from matplotlib.figure import Figure

    from .figures import Save

TITLE = "Comparison of runs"
WIDTH = 180.0  # mm


def compared(runs: Sequence[Kept]) -> list[tuple[int, int]]:
    """Which are compared: places of minuend and subtrahend.

    Each pantograph with the one of the first run that has its place in the train; those of one run alone with
    its first.
    """
    first = runs[0].folder
    if all(run.folder == first for run in runs):
        return [(k, 0) for k in range(1, len(runs))]
    by_place = {run.place: k for k, run in enumerate(runs) if run.folder == first}
    return [
        (k, by_place[run.place])
        for k, run in enumerate(runs)
        if run.folder != first and run.place in by_place
    ]


def heads(runs: Sequence[Kept]) -> list[str]:
    """Heads of the columns of values and differences: "before-1", "after-1 less before-1"."""
    labels = [run.label or run.name for run in runs]
    return [*labels, *(f"{labels[i]} less {labels[j]}" for i, j in compared(runs))]


def differences(runs: Sequence[Kept]) -> list[tuple[str, str, list[float | None], list[float | None]]]:
    """Name and unit of each quantity, its values (runs,), and their differences, of those `compared`."""
    by_key = [{q.key: q for q in run.quantities} for run in runs]
    keys = dict.fromkeys(key for one in by_key for key in one)
    found = []
    for key in keys:
        first = next(one[key] for one in by_key if key in one)
        values = [one[key].value if key in one else None for one in by_key]
        changes = [_less(values[i], values[j]) for i, j in compared(runs)]
        found.append((first.name, first.unit, values, changes))
    return found


def _less(value: float | None, base: float | None) -> float | None:
    return None if value is None or base is None else value - base


def write_table(runs: Sequence[Kept], path: Path) -> Path:
    """CSV with a row for each quantity: values of all runs, and their differences."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["quantity", "unit", *heads(runs)])
    for name, unit, values, changes in differences(runs):
        cells = ("" if value is None else f"{value:.9g}" for value in [*values, *changes])
        writer.writerow([name, unit, *cells])
    return write_text(path, text.getvalue())


def write_comparison(runs: Sequence[Kept], folder: Path, formats: Sequence[str]) -> list[Path]:
    """Write ``report.html``, ``report.pdf`` and ``report.docx``, those that are asked for.

    Raises
    ------
    ModelError
        matplotlib or what writes a format is missing, or a file cannot be written.

    """
    style.require_matplotlib()
    files = []
    for kind in formats:
        path = folder / f"report.{kind}"
        if kind == printed.HTML:
            write_text(path, page(TITLE, *pieces(runs, style.svg)))
        else:
            printed.write_printed(path, TITLE, pieces(runs, style.png))
        files.append(path)
    return files


def pieces(runs: Sequence[Kept], save: Save) -> list[Element]:
    """Elements of the report, its pictures as SVG or PNG."""
    parts = [element("h1", TITLE)]
    for run in runs:
        low, high = run.window
        what = f"{told(run)}: {run.line}, {run.speed_kmh:.4g} km/h, evaluated from {low:g} m to {high:g} m"
        what += f"; {run.state}." if run.state else "."
        parts.append(element("p", what, class_="faint"))
    names = [run.label or run.name for run in runs]
    parts.append(
        section(
            "Acceptance",
            "acceptance",
            tables.beside(names, [run.acceptance for run in runs]),
            tables.tags([q for run in runs for q in run.acceptance]),
        )
    )
    parts.append(section("All quantities", "quantities", _all(runs)))
    drawn = [
        (
            "force",
            "Contact force below 20 Hz",
            "Over the track; shaded: what is evaluated, which sets the scale.",
            _draw_force,
            90.0,
        ),
        ("uplift", "Uplift at the supports", "Largest while the pantograph passes.", _draw_uplift, 75.0),
    ]
    made = []
    for name, title, caption, draw, height in drawn:
        with style.new_figure(WIDTH, height) as canvas:
            draw(canvas, runs)
            made.append(figure(name, title, caption, save(canvas)))
    parts.append(section("Figures", "figures", *made))
    day = datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d %H:%M UTC")
    return [*parts, element("p", f"ancf {__version__}, {day}", class_="faint")]


def _all(runs: Sequence[Kept]) -> Element:
    """Values of all runs, and their differences."""
    from ...viz.html import table

    columns, rows = heads(runs), []
    for name, unit, values, changes in differences(runs):
        rows.append((name, "" if unit == "count" else unit, *(shown(v, unit) for v in [*values, *changes])))
    return table(("quantity", "unit", *columns), rows, numbers=range(2, 2 + len(columns)))


def told(run: Kept) -> str:
    """Label, and of which pantograph it is: "before-2 (before, dsa380 (2))"."""
    return run.name if run.label in ("", run.name) else f"{run.label} ({run.name})"


def _draw_force(canvas: Figure, runs: Sequence[Kept]) -> None:
    axes = canvas.subplots()
    for k, run in enumerate(runs):
        axes.plot(run.position, run.force, label=run.label or run.name, **style.line(k))
    for low, high in dict.fromkeys(run.window for run in runs):
        axes.axvspan(low, high, color=style.SHADE, linewidth=0, zorder=0)
    axes.set(xlabel="track position [m]", ylabel="contact force [N]")
    inside = [run.force[(run.position >= run.window[0]) & (run.position <= run.window[1])] for run in runs]
    least, most = min(map(np.min, inside)), max(map(np.max, inside))
    axes.set_ylim(least - 0.3 * (most - least), most + 0.3 * (most - least))  # ends of lines are no part
    low = min(float(np.min(run.position)) for run in runs)
    axes.set_xlim(low, max(float(np.max(run.position)) for run in runs))
    style.legend_above(canvas, axes, 3)


def _draw_uplift(canvas: Figure, runs: Sequence[Kept]) -> None:
    axes = canvas.subplots()
    for k, run in enumerate(runs):
        if run.uplift:
            x, size = zip(*run.uplift, strict=True)
            look = {"marker": style.look(k).marker, "linestyle": "none", "color": style.line(k)["color"]}
            axes.plot(x, size, label=run.label or run.name, **look)
    axes.set(xlabel="track position [m]", ylabel="largest uplift [mm]")
    style.from_zero(axes)
    style.legend_above(canvas, axes, 3)
