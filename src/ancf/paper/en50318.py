"""EN 50318: the reference models of the standard, beside the ranges that it accepts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .. import catenary
from ..catenary.answers.references import filter_note, second_reading
from ..viz import style
from .check import Check
from .table import Table, Value

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..catenary import Run

TITLE = "EN 50318: reference models of the standard"
EXAMPLE = ""
CLAIM = (
    "Not in the paper. The standard for simulations of pantograph and overhead line accepts a program whose "
    "results for a reference model lie inside published ranges, here those of 2002."
)
COLUMNS = ("case", "speed_kmh", "quantity", "unit", "value", "low", "high", "verdict", "tag")
SIZE = (170.0, 96.0)  # mm
#: The case that is judged, and one whose ranges could not be checked yet.
JUDGED, SHOWN = "en50318-2002", "en50318-2018-ac-simple"
SHORT_CASES = ((JUDGED, 250.0),)
CASES = (*SHORT_CASES, (JUDGED, 300.0), (SHOWN, 275.0), (SHOWN, 320.0))
INSIDE, OUTSIDE = "inside", "outside"
FARTHEST = 1.7  # half ranges; dots farther out stand there
LOOKS: tuple[dict[str, Any], ...] = (
    {"color": style.BLUE, "marker": "o"},
    {"color": style.ORANGE, "marker": "s"},
)

NOTES = [
    "Lines and pantographs of the catalogue, default mesh and step, two spans in the middle of the line; "
    "forces below 20 Hz, Butterworth filter of order 6, forward and backward. The order is not told by the "
    "standard: where another one, 4, turns a verdict, it is said with the measured numbers.",
    "Tags of the ranges: V read in a public source, V2 in two, U not yet checked against a copy of the "
    "standard.",
]
NOTE_2018 = (
    "The ranges of the case of 2018 all have the tag U: its rows are shown with their verdict, but are not "
    "checks. What is outside, and on which of the unverified data it depends, is told in the documentation's "
    "page on overhead lines."
)


def data(short: bool = False) -> Table:
    """Quantities with their ranges; the short form is the case of 2002 at 250 km/h alone."""
    table = Table("en50318", COLUMNS, [], [*NOTES, *([] if short else [NOTE_2018])])
    for case, speed in SHORT_CASES if short else CASES:
        run = catenary.reference_run(case, speed)
        rows = _rows(case, run)
        table.rows.extend(rows)
        table.notes.append(f"{_measured(case, speed, rows)}; {_filtered(case, run)}.")
    return table


def checks(table: Table) -> list[Check]:
    """Rows of the case of 2002: not farther from the middle of the range than half its width."""
    reference = catenary.reference_case(JUDGED)
    rows = [dict(zip(COLUMNS, row, strict=True)) for row in table.rows if row[0] == JUDGED]
    return [_check(row, reference.title, reference.source) for row in rows]


def draw(table: Table, figure: Figure) -> None:
    """Each value in its range, which reaches from -1 to 1."""
    cases = table.kinds("case")
    panels = figure.subplots(1, len(cases), squeeze=False)[0]
    for axes, case in zip(panels, cases, strict=True):
        _panel(axes, table, case)
        axes.set_title(catenary.reference_case(case).title)


def _rows(case: str, run: Run) -> list[tuple[Value, ...]]:
    rows: list[tuple[Value, ...]] = []
    for row in catenary.rows(run, case):
        verdict = INSIDE if row["inside"] else OUTSIDE
        numbers = (row["value"], row["low"], row["high"])
        head = (case, round(run.speed_kmh, 6), row["quantity"], row["unit"])
        rows.append((*head, *numbers, verdict, row["tag"]))
    return rows


def _measured(case: str, speed: float, rows: list[tuple[Value, ...]]) -> str:
    out = [f"{row[2]} {row[4]:.4g} {row[3]} ({row[5]:g} to {row[6]:g})" for row in rows if row[7] == OUTSIDE]
    told = f"; outside: {', '.join(out)}" if out else ""
    return f"Measured, {case}, {speed:g} km/h: {len(rows) - len(out)} of {len(rows)} inside{told}"


def _filtered(case: str, run: Run) -> str:
    reference = catenary.reference_case(case)
    first = reference.compare(catenary.statistics(run), run.speed_kmh)
    return filter_note(first, second_reading(run, reference))


def _check(row: dict[str, Any], title: str, source: str) -> Check:
    middle, half = 0.5 * (row["low"] + row["high"]), 0.5 * (row["high"] - row["low"])
    name = f"{title}, {row['speed_kmh']:g} km/h: {row['quantity']}"
    return Check(name, row["value"], middle, half, row["unit"], f"{source}; tag {row['tag']}")


def _panel(axes: Axes, table: Table, case: str) -> None:
    rows = [dict(zip(COLUMNS, row, strict=True)) for row in table.rows if row[0] == case]
    names = list(dict.fromkeys(str(row["quantity"]) for row in rows))
    y = np.arange(len(names))
    axes.barh(y, 2.0, left=-1.0, height=0.5, color=style.LIGHT, alpha=0.4, label="accepted")
    speeds = list(dict.fromkeys(row["speed_kmh"] for row in rows))
    for speed, look, shift in zip(speeds, LOOKS, (-0.12, 0.12), strict=False):
        x = [_place(row) for row in rows if row["speed_kmh"] == speed]
        axes.plot(x, y + shift, linestyle="none", label=f"{speed:g} km/h", **look)
    axes.set_yticks(y, names)
    axes.set(xlim=(-FARTHEST - 0.15, FARTHEST + 0.15), ylim=(len(y) - 0.5, -0.5))
    axes.set(xlabel="place in the range", xticks=(-1.0, 0.0, 1.0), xticklabels=("low", "middle", "high"))
    axes.legend(loc="upper right", bbox_to_anchor=(1.05, -0.16), ncols=3)


def _place(row: dict[str, Any]) -> float:
    """Distance from the middle of the range in half ranges; a range of one value has no width."""
    middle, half = 0.5 * (row["low"] + row["high"]), 0.5 * (row["high"] - row["low"])
    place = (row["value"] - middle) / (half or 1.0)
    return float(np.clip(place, -FARTHEST, FARTHEST))
