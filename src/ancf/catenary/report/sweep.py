"""The report of a sweep: acceptance over speeds and distances of pantographs, as figures and tables."""

from __future__ import annotations

import datetime
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..._version import __version__
from ...files import write_text
from ...viz import printed, style
from ...viz.html import element, figure, page, section, table
from ..answers.quantity import shown
from ..answers.statistics import LARGEST_DEVIATION

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .figures import Save

#: Numbers of a text, which differ from case to case.
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
#: A case: its numbers by name, "status" and "message".
Row = Mapping[str, Any]
#: Quantities of the tables: key, head, unit.
COLUMNS = (
    ("mean_force", "Fm [N]", "N"),
    ("deviation", "σ [N]", "N"),
    ("minimum", "smallest [N]", "N"),
    ("maximum", "largest [N]", "N"),
    ("arcing", "NQ [%]", "%"),
    ("uplift", "uplift [mm]", "mm"),
    ("strip_strain", "strain [1e-6]", "1e-6"),
)
LIMITS = (
    "Limits of EN 50367, EN 50119 and practice, as in the report of a run; none is checked against a copy of "
    "the standards."
)
#: Panels of the figure: key, label.
PANELS = (
    ("mean_force", "mean force [N]"),
    ("deviation", "standard deviation [N]"),
    ("minimum", "smallest force [N]"),
    ("uplift", "uplift at support [mm]"),
)


@dataclass(frozen=True)
class Sweep:
    """Cases of a sweep.

    Parameters
    ----------
    title : str
        Of the line.
    rows : sequence of Row
    speed, spacing : str
        Names of the columns of what varies, km/h and m.
    pantographs : sequence of str
        Names, the first ahead.
    settings : sequence of (str, str)
        What all cases share.
    """

    title: str
    rows: Sequence[Row]
    speed: str
    spacing: str
    pantographs: Sequence[str]
    settings: Sequence[tuple[str, str]]

    @property
    def done(self) -> list[Row]:
        """Cases that did not fail."""
        return [row for row in self.rows if row["status"] == "ok"]

    @property
    def count(self) -> int:
        """Pantographs of a case."""
        return len(self.pantographs)

    def values(self, name: str) -> list[float]:
        """Different values of what varies, ascending; empty if it does not."""
        return sorted({float(row[name]) for row in self.rows if name in row})

    @property
    def across(self) -> tuple[str, str]:
        """What the figures have as x, and its label: speeds, or distances at one speed."""
        if len(self.values(self.speed)) == 1 and len(self.values(self.spacing)) > 1:
            return self.spacing, "distance of the pantographs [m]"
        return self.speed, "speed [km/h]"


def write_sweep(sweep: Sweep, folder: Path, formats: Sequence[str]) -> list[Path]:
    """Write ``report.html``, ``report.pdf`` and ``report.docx``, those that are asked for.

    Raises
    ------
    ModelError
        matplotlib or what writes a format is missing, or a file cannot be written.
    """
    style.require_matplotlib()
    title, files = f"{sweep.title}: sweep", []
    for kind in formats:
        path = folder / f"report.{kind}"
        if kind == printed.HTML:
            write_text(path, page(title, *pieces(sweep, title, style.svg)))
        else:
            printed.write_printed(path, title, pieces(sweep, title, style.png))
        files.append(path)
    return files


def pieces(sweep: Sweep, title: str, save: Save) -> list[Element]:
    """Elements of the report, its pictures as SVG or PNG."""
    parts = [element("h1", title)]
    parts += [element("p", f"{name}: {value}.", class_="faint") for name, value in sweep.settings]
    good, counted = _verdict(sweep)
    parts.append(element("p", counted, class_=f"verdict {'inside' if good else 'outside'}"))
    if sweep.done:
        parts.append(section("Figures", "figures", *_figures(sweep, save)))
    for k, name in enumerate(sweep.pantographs):
        head = f"Cases, {name}" if sweep.count > 1 else "Cases"
        parts.append(section(head, f"cases-{k + 1}", _cases(sweep, k)))
    failed = [row for row in sweep.rows if row["status"] != "ok"]
    if failed:
        told = [(*_place(sweep, row), str(row["message"])) for row in failed]
        shows = table((*_heads(sweep), "message"), told, numbers=range(len(_heads(sweep))))
        parts.append(section("Failed cases", "failed", shows))
    warnings = warned(sweep.rows, sweep.speed, sweep.spacing)
    if warnings:
        texts = [(", ".join(places), text) for text, places in warnings]
        parts.append(section("Warnings", "warnings", table(("cases", "warning"), texts)))
    day = datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d %H:%M UTC")
    foot = (LIMITS, f"ancf {__version__}, {day}")
    return [*parts, *(element("p", text, class_="faint") for text in foot)]


def _verdict(sweep: Sweep) -> tuple[bool, str]:
    """Whether all cases are accepted, and how many."""
    good = [row for row in sweep.done if all(row[f"accepted_{k + 1}"] for k in range(sweep.count))]
    text = f"{len(good)} of {len(sweep.rows)} cases are accepted with all pantographs"
    failed = len(sweep.rows) - len(sweep.done)
    return len(good) == len(sweep.rows), text + (f", {failed} could not be run." if failed else ".")


def verdict(row: Row, k: int) -> str:
    """Whether pantograph k is "inside", or which limits it misses, "outside: σ, uplift"."""
    if row[f"accepted_{k + 1}"]:
        return "inside"
    before, behind = "outside_", f"_{k + 1}"
    keys = [str(key) for key, value in row.items() if str(key).startswith(before) and value == 1.0]
    names = {key: head.partition(" [")[0] for key, head, _ in COLUMNS}
    missed = [key.removeprefix(before).removesuffix(behind) for key in keys if key.endswith(behind)]
    told = ", ".join(names.get(key, key.replace("_", " ")) for key in missed)
    return f"outside: {told}" if told else "outside"


def warned(rows: Sequence[Row], speed: str, spacing: str) -> list[tuple[str, list[str]]]:
    """Each text of a warning, numbers aside, with the cases of which it was said: "250 km/h, 200 m"."""
    found: dict[str, tuple[str, list[str]]] = {}
    for row in rows:
        place = f"{row[speed]:g} km/h" + (f", {row[spacing]:g} m" if spacing in row else "")
        for part in str(row["message"] if row["status"] == "ok" else "").split("warning: ")[1:]:
            text = part.rstrip("; ")
            told = found.setdefault(text.partition(":")[0] + NUMBER.sub("#", text), (text, []))
            if place not in told[1]:
                told[1].append(place)
    return list(found.values())


def _heads(sweep: Sweep) -> tuple[str, ...]:
    return ("speed [km/h]", *(["distance [m]"] if sweep.values(sweep.spacing) else []))


def _place(sweep: Sweep, row: Row) -> tuple[str, ...]:
    return (f"{row[sweep.speed]:g}", *([f"{row[sweep.spacing]:g}"] if sweep.spacing in row else []))


def _cases(sweep: Sweep, k: int) -> Element:
    """A row for each case with the numbers of one pantograph."""
    rows = []
    for row in sweep.done:
        numbers = [shown(row.get(f"{key}_{k + 1}"), unit) for key, _, unit in COLUMNS]
        ratio = row[f"deviation_{k + 1}"] / row[f"mean_force_{k + 1}"]
        rows.append((*_place(sweep, row), *numbers[:2], f"{ratio:.3f}", *numbers[2:], verdict(row, k)))
    heads = [head for _, head, _ in COLUMNS]
    first = _heads(sweep)
    made = table((*first, *heads[:2], "σ/Fm", *heads[2:], "all limits"), rows, numbers=range(len(first) + 8))
    for cell in made.iter("td"):
        word = str(cell.text).partition(":")[0]
        if word in ("inside", "outside"):
            cell.set("class", word)
    return made


def _figures(sweep: Sweep, save: Save) -> list[Element]:
    made = []
    for k, name in enumerate(sweep.pantographs):
        with style.new_figure(style.TWO_COLUMNS, 130.0) as canvas:
            _draw(canvas, sweep, k)
            drawn = save(canvas)
        title = f"Over the {'distance' if sweep.across[0] == sweep.spacing else 'speed'}"
        caption = "Dashed grey: limits of the mean force, 0.3 of the mean force for the standard deviation."
        made.append(
            figure(f"sweep-{k + 1}", f"{title}, {name}" if sweep.count > 1 else title, caption, drawn)
        )
    return made


def _draw(canvas: Figure, sweep: Sweep, k: int) -> None:
    """One panel for each quantity, one curve for each value of what is not across."""
    name, label = sweep.across
    other = sweep.spacing if name == sweep.speed else sweep.speed
    panels = canvas.subplots(2, 2, sharex=True).ravel()
    groups: list[float | None] = [*sweep.values(other)] or [None]
    for axes, (key, text) in zip(panels, PANELS, strict=True):
        for i, value in enumerate(groups):
            rows = [row for row in sweep.done if value is None or row.get(other) == value]
            rows.sort(key=lambda row: float(row[name]))
            found = [row for row in rows if f"{key}_{k + 1}" in row]
            told = "" if value is None else f"{value:g} m" if other == sweep.spacing else f"{value:g} km/h"
            look = style.line(i) | {"marker": style.look(i).marker}
            x = [row[name] for row in found]
            axes.plot(x, [row[f"{key}_{k + 1}"] for row in found], label=told or None, **look)
        _limits(axes, sweep, key, k)
        axes.set_ylabel(text)
        style.from_zero(axes)
    for axes in panels[2:]:
        axes.set_xlabel(label)
    if groups != [None]:
        style.legend_above(canvas, panels[0], 6)


def _limits(axes: Axes, sweep: Sweep, key: str, k: int) -> None:
    name, number = sweep.across[0], k + 1
    rows = sorted(sweep.done, key=lambda row: float(row[name]))
    x = np.array([row[name] for row in rows])
    fine: dict[str, Any] = {"color": style.GREY, "linestyle": "--", "linewidth": 0.8}
    if key == "mean_force":
        for side in ("low", "high"):
            axes.plot(x, [row[f"mean_force_{side}_{number}"] for row in rows], **fine)
    elif key == "deviation":
        axes.plot(x, [LARGEST_DEVIATION * row[f"mean_force_{number}"] for row in rows], **fine)
    elif key == "minimum":
        axes.axhline(0.0, **fine)
