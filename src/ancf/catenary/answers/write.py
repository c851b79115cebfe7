"""Write a run as JSON and CSV files."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..._version import __version__
from ...errors import ModelError
from ...files import cell, to_json, write_text
from ...model import checks
from .acceptance import acceptance
from .clamp_strain import bends, clamp_strains
from .cycles import rainflow
from .passing import DropperForces, broken_places, check_run, dropper_forces, dropper_places
from .state import state, tensions
from .statistics import Statistics, statistics

if TYPE_CHECKING:
    from .run_data import Run

Cell = str | int | float | bool | None
#: Share of the largest range of a history below which cycles are not listed.
LEAST_RANGE = 0.01
#: Significant digits of a number in a history.
DIGITS = 9


def write_run(run: Run, folder: str | Path, found: Sequence[Statistics] | None = None) -> list[Path]:
    """Write statistics as CSV and JSON, ``force_N.csv``, ``uplift.csv``, ``droppers.csv`` and ``cycles.csv``.

    Parameters
    ----------
    run : Run
    folder : str or Path
        Made when it does not exist.
    found : sequence of Statistics, optional
        One for each pantograph; computed when not given.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    ModelError
        A file cannot be written.

    """
    check_run(run, "write_run")
    folder = checks.path(folder, "write_run.folder")
    chosen = [statistics(run, k) for k in range(len(run.recordings))] if found is None else _given(found, run)
    files = [write_statistics(chosen, folder / "statistics.csv")]
    files.append(write_json(summary(run, chosen), folder / "statistics.json"))
    for k in range(len(run.recordings)):
        files.append(write_force(run, k, chosen[k], folder / f"force_{k + 1}.csv"))
    files.append(write_uplift(run, chosen, folder / "uplift.csv"))
    files.append(write_droppers(run, folder / "droppers.csv"))
    files.append(write_cycles(run, folder / "cycles.csv"))
    return files


def _given(found: Any, run: Run) -> tuple[Statistics, ...]:
    """Statistics that were given; ModelError where they are none, or not one for each pantograph."""
    hint = "one for each pantograph; or leave it out, they are computed"
    chosen = checks.items(found, "write_run.found", hint)
    for k, one in enumerate(chosen):
        checks.kind(one, f"write_run.found[{k}]", Statistics, hint)
    if len(chosen) != len(run.recordings):
        raise ModelError("write_run.found", f"are {len(chosen)} for {len(run.recordings)} pantographs", hint)
    return chosen


def summary(run: Run, found: Sequence[Statistics]) -> dict[str, Any]:
    """What there is to know about a run in a few numbers, for JSON."""
    return {
        "ancf": __version__,
        "line": run.form.line.title,
        "state": state(run.form.line),
        "broken_droppers": list(run.broken_droppers),
        "tensions": [
            {"wire": name, "designed_N": was, "smallest_N": low, "largest_N": high}
            for name, was, low, high in tensions(run.form)
        ],
        "speed_kmh": round(found[0]["speed"].value, 6),
        "window_m": list(run.window),
        "filter": found[0].filter.text,
        "real_time_factor": run.real_time_factor,
        "cpu_seconds": run.cpu_seconds,
        "simulated_seconds": run.simulated_seconds,
        "settings": dict(run.settings),
        "pantographs": [_of_pantograph(run, k, statistic) for k, statistic in enumerate(found)],
    }


def _of_pantograph(run: Run, k: int, found: Statistics) -> dict[str, Any]:
    return {
        "name": found.pantograph,
        "title": run.pantographs[k].title,
        "statistics": [{"key": q.key, **q.row} for q in found.quantities],
        "acceptance": [{"key": q.key, **q.row} for q in acceptance(run, k, found=found)],
        "uplift_mm": [
            {"support": s.number, "position_m": s.position, "uplift_mm": 1e3 * s.uplift}
            for s in found.supports
        ],
    }


def write_json(data: dict[str, Any], path: Path) -> Path:
    """Write JSON that any reader takes: null instead of NaN and infinity."""
    return write_text(path, to_json(data))


def write_statistics(found: Sequence[Statistics], path: Path) -> Path:
    """One row for each quantity of each pantograph."""
    head = ("pantograph", "key", "quantity", "unit", "value", "low", "high", "inside", "tag")
    rows = [
        (s.pantograph, q.key, q.name, q.unit, q.value, q.low, q.high, q.inside, q.tag)
        for s in found
        for q in s.quantities
    ]
    return _write_csv(path, head, rows)


def write_force(run: Run, pantograph: int, found: Statistics, path: Path) -> Path:
    """Contact force of one pantograph, unfiltered and below 20 Hz, over time and track position."""
    recording = run.recordings[pantograph]
    columns = {
        "t_s": run.t,
        "position_m": recording.position,
        "force_raw_N": recording.force,
        "force_20hz_N": found.force,
        "height_m": recording.height,
        "stagger_m": recording.stagger,
        "strip_m": recording.strip,
    }
    return write_columns(path, columns)


def write_uplift(run: Run, found: Sequence[Statistics], path: Path) -> Path:
    """One row for each support: largest uplift while each pantograph passes; empty where it does not."""
    supports = run.form.line.supports
    passed = [{s.number: 1e3 * s.uplift for s in statistic.supports} for statistic in found]
    head = ["support", "position_m", *(f"uplift_{k + 1}_mm" for k in range(len(found)))]
    rows = [(j + 1, float(x), *(p.get(j + 1) for p in passed)) for j, x in enumerate(supports)]
    return _write_csv(path, head, rows)


def write_droppers(run: Run, path: Path) -> Path:
    """One row for each dropper: force at rest, extremes and slack over the whole run; state.

    A broken one has no numbers.
    """
    head = ("span", "dropper", "position_m", "rest_N", "largest_N", "smallest_N")
    slack = ("slack_count", "slack_s", "longest_slack_s")
    rows = [(d.span, d.number, d.position, *_carried(d)) for d in dropper_forces(run)]
    return _write_csv(path, (*head, *slack, "state"), rows)


def write_cycles(run: Run, path: Path) -> Path:
    """One row for each cycle, by rainflow: of the droppers of the window in N, of the strain at their clamps.

    Ranges below a hundredth of the largest one are left out.
    """
    places, (low, high) = dropper_places(run), run.window
    forces = [(*place, rainflow(run.dropper_force[:, j])) for j, place in enumerate(places)]
    strains = clamp_strains(run) if bends(run.form.line) else []
    whole = [not gone for gone in broken_places(run)]
    counted = [
        ("force_N", *one) for one, there in zip(forces, whole, strict=True) if there and low <= one[2] <= high
    ]
    counted += [("strain", c.span, c.number, c.position, c.cycles) for c in strains]
    rows = [
        (kind, span, number, x, *row)
        for kind, span, number, x, cycles in counted
        for row in zip(cycles.range.tolist(), cycles.mean.tolist(), cycles.count.tolist(), strict=True)
        if row[0] >= LEAST_RANGE * cycles.largest
    ]
    return _write_csv(path, ("quantity", "span", "dropper", "position_m", "range", "mean", "count"), rows)


def _carried(d: DropperForces) -> tuple[Cell, ...]:
    """Forces, slack and state of one dropper."""
    if d.broken:
        return (*[None] * 6, "broken")
    return d.rest, d.largest, d.smallest, d.slack.number, d.slack.seconds, d.slack.longest, "whole"


def write_columns(path: Path, columns: dict[str, Any]) -> Path:
    """Write a CSV file with some arrays as its columns."""
    numbers = np.column_stack(list(columns.values()))
    lines = [",".join(f"{value:.{DIGITS}g}" for value in row) for row in numbers.tolist()]
    return write_text(path, "\n".join([",".join(columns), *lines]) + "\n")


def _write_csv(path: Path, head: Sequence[str], rows: Iterable[Sequence[Cell]]) -> Path:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows([cell(_text(value)) for value in row] for row in rows)
    return write_text(path, text.getvalue())


def _text(value: Cell) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"{value:.{DIGITS}g}" if isinstance(value, float) else str(value)
