"""``ancf calibrate``: parameters of a model file from measured histories."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING

from ..files import cell, drafted, to_json, writing
from .output import OutputFolder
from .screen import Screen, console, table

if TYPE_CHECKING:
    from ..design.fit import Fit

FILES = ("fit.json", "fit.csv", "report.html")


def calibrate_file(path: Path, folder: Path, workers: int | None, report: bool, quiet: bool = False) -> None:
    """Fit, write and print.

    Raises
    ------
    ModelError
        The file, its model or its data are wrong, or the folder cannot be written.
    SolveError
        The model cannot be computed at the start.
    """
    from ..design.calibration_file import read_calibration
    from ..design.study import cores
    from ..viz.style import require_matplotlib

    if report:
        require_matplotlib()
    given, screen = read_calibration(path), Screen(quiet)
    OutputFolder(folder, FILES)
    screen.announce_compilation()
    screen.say(f"looking for {len(given.bounds)} parameters ...")
    fit = given.fit(cores() if workers is None else workers)
    files = _write(fit, folder, given.title, report)
    if not quiet:
        _show(fit)
        console().print("written: " + ", ".join(map(str, files)), soft_wrap=True)


def _write(fit: Fit, folder: Path, title: str, report: bool) -> list[Path]:
    from .._version import __version__
    from ..design.calibration_file import table_of

    files = [folder / name for name in FILES[:2]]
    with writing(files[0]), drafted(files[0]) as draft:
        about = {"title": title, **fit.as_dict(), "versions": {"ancf": __version__}}
        draft.write_text(to_json(about, indent=2), encoding="utf-8", errors="backslashreplace")
    head, rows = table_of(fit)
    with writing(files[1]), drafted(files[1]) as draft, draft.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([cell(name) for name in head])
        writer.writerows([["" if x != x else repr(x) for x in row] for row in rows])
    if report:
        from ..design.report.calibration import write_calibration

        files.append(write_calibration(folder / "report.html", fit, title))
    return files


def _show(fit: Fit) -> None:
    where, shown = console(), table("parameter", "value", "standard error", "95 % confidence")
    intervals = fit.confidence()
    for name, x in fit.values.items():
        low, high = intervals[name]
        shown.add_row(name, f"{x:.6g}", f"{fit.deviations[name]:.3g}", f"{low:.6g} to {high:.6g}")
    where.print(shown)
    for note in fit.notes():
        where.print(f"note: {note}", soft_wrap=True)
