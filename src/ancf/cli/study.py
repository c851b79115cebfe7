"""``ancf study``: the cases of a study file, in parallel; or how far a study is."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from .guard import FAILED
from .screen import Screen, bar_of, console, duration, table
from .summary import plural

if TYPE_CHECKING:
    from ..design.study import Step

NUMBERS = ("mean", "deviation", "minimum", "maximum")


def run_study(path: Path, folder: Path, options: dict[str, Any], quiet: bool = False) -> None:
    """Compute what is left, write the files and print the outputs.

    Raises
    ------
    ModelError
        The file, the folder or the scheduler is wrong.
    typer.Exit
        With code 1 when cases failed.
    """
    from ..design.finished import finished, hashes

    files, report = hashes(path), options.get("report", True)
    done = None if options.get("retry") else finished(folder, files, report)
    if done is not None:
        return _tell(done, folder, report, quiet)
    from ..design.file import read_study_file
    from ..design.study import study
    from ..viz.style import require_matplotlib

    if report:
        require_matplotlib()
    given, screen = read_study_file(path), Screen(quiet)
    try:
        with cases_progress(screen) as progress:
            more = {"folder": folder, "progress": progress, "title": given.title, "files": files}
            more["units"] = given.units
            study(given.case, given.samples, **more, **options)
    except KeyboardInterrupt as error:
        error.add_note(f"what has ended is kept in {folder}: the same command goes on")
        raise
    made = finished(folder, files, report)
    assert made is not None
    _tell(made, folder, report, quiet)


def show_status(folder: Path) -> None:
    """Print how far the study in a folder is; another process may be at work on it."""
    from ..design.journal import progress_of

    now = progress_of(folder)
    mean = f", {now.seconds / now.done:.3g} s each" if now.done else ""
    text = f"{folder}: {now.done} of {now.wanted} cases done, {now.failed} failed{mean}"
    console().print(text, soft_wrap=True)


@contextmanager
def cases_progress(screen: Screen) -> Iterator[Any]:
    """What ``study(progress=...)`` gets: a bar in a terminal, else a line for every tenth."""
    if screen.quiet:
        yield None
    elif screen.console.is_terminal:
        with bar_of(screen.console, "cases") as bar:
            task = bar.add_task("", total=1, told="")

            def report(step: Step) -> None:
                told = f"{step.failed} failed" if step.failed else ""
                bar.update(task, completed=step.done, total=step.wanted, told=told)

            yield report
    else:
        yield _Lines(screen)


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.6g}"


class _Lines:
    """One line whenever another tenth is done."""

    def __init__(self, screen: Screen) -> None:
        self.screen, self.tenths = screen, -1

    def __call__(self, step: Step) -> None:
        tenths = 10 * step.done // step.wanted
        if tenths <= self.tenths:
            return
        first, self.tenths = self.tenths < 0, tenths
        if first and step.done < step.wanted and tenths == 0:
            return
        failed = f", {step.failed} failed" if step.failed else ""
        left = f"about {duration(step.left)} left" if step.done < step.wanted else "done"
        self.screen.say(
            f"{100 * step.done // step.wanted:3} %  case {step.done} of {step.wanted}{failed}, "
            f"{duration(step.elapsed)} elapsed, {left}"
        )


def _tell(made: dict[str, Any], folder: Path, report: bool, quiet: bool) -> None:
    """Print what study.json says.

    Raises
    ------
    typer.Exit
        With code 1 when cases failed.
    """
    if not quiet:
        _show(made, folder, report)
    if made["failed"]:
        text = f"{made['failed']} of {made['cases']} cases failed"
        first = f"; the first, case {made['first_failed']['case']}: {made['first_failed']['message']}"
        console(stderr=True).print(text + first, style="bold", soft_wrap=True)
        raise typer.Exit(FAILED)


def _show(made: dict[str, Any], folder: Path, report: bool) -> None:
    from ..design.finished import FILES
    from ..design.report.tables import extreme_cases
    from ..design.statistics import labelled

    where, shown = console(), table("output", "mean", "deviation", "smallest", "case", "largest", "case")
    found, units = made["statistics"], made.get("units", {})
    for name, row in found["outputs"].items():
        mean, deviation, least, most = (_number(row.get(key)) for key in NUMBERS)
        cases = (str(row.get(key, "-")) for key in ("minimum_case", "maximum_case"))
        shown.add_row(labelled(units, name), mean, deviation, least, next(cases), most, next(cases))
    where.print(shown)
    if found["extremes"]:
        heads, rows = extreme_cases(found, [*found["outputs"]], units)
        shown = table(*heads)
        for cells in rows:
            shown.add_row(*cells)
        where.print(shown)
    if found["noted"]:
        first = made["first_noted"]
        text = f"{plural(found['noted'], 'case')} with notes, in the column message; the first, "
        where.print(f"{text}case {first['case']}: {first['message']}", soft_wrap=True)
    names = [name for name in FILES if report or name != "report.html"]
    where.print("written: " + ", ".join(str(folder / name) for name in names), soft_wrap=True)
