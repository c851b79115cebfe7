"""``ancf reproduce``: figures of the paper, their checks, and a page with all."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from .guard import FAILED
from .output import OutputFolder
from .screen import COMPILING, Screen, console, exhibits_bar

if TYPE_CHECKING:
    from rich.progress import Progress as Bar

    from ..paper.entry import Entry, Reproduction

MOST_SHOWN = 20  # failed checks on the screen


def reproduce_figures(
    names: list[str], folder: Path, quick: bool = False, jobs: int | None = None, quiet: bool = False
) -> None:
    """Compute and judge the named figures, or all, and print what came out.

    Raises
    ------
    typer.Exit
        With code 1 when a check failed or a figure could not be computed.

    """
    from .. import paper

    wanted = paper.resolve(names)
    output, screen = OutputFolder(folder), Screen(quiet)
    with output.locked(), _watching(screen, len(wanted)) as watch:
        made = paper.verify(wanted, folder, short=quick, jobs=jobs, watch=watch)
    if not quiet or not made.passed:
        show(made, quiet)
    if not made.passed:
        raise typer.Exit(FAILED)


def show(made: Reproduction, errors_alone: bool = False) -> None:
    """Print what failed, and one line for all."""
    screen = console(stderr=errors_alone)
    for entry in made.errors:
        screen.print(f"{entry.name}: {entry.error}", style="red", soft_wrap=True)
    if made.failed:
        screen.print(failed_table(made))
    if len(made.failed) > MOST_SHOWN:
        screen.print(f"... and {len(made.failed) - MOST_SHOWN} more")
    screen.print(f"{made.verdict}; see {made.page}", style="bold", soft_wrap=True)


def failed_table(made: Reproduction) -> Any:
    """Failed checks with value, reference and tolerance."""
    from .screen import table

    rows = table("failed check", "value", "reference", "tolerance", "unit")
    for entry, check in made.failed[:MOST_SHOWN]:
        rule = "" if check.rule == "within" else f"{check.rule} "
        numbers = (f"{check.value:.8g}", f"{rule}{check.reference:.8g}", f"{check.tolerance:.3g}", check.unit)
        rows.add_row(f"{entry.name}: {check.name}", *numbers)
    return rows


def outcome(entry: Entry) -> str:
    """What came out of a figure: ``fig2: 12 checks passed, 3.4 s``."""
    count = len(entry.checks)
    if entry.error:
        text = entry.error
    elif entry.failed:
        text = f"{len(entry.failed)} of {count} checks FAILED"
    else:
        text = f"{count} check{'' if count == 1 else 's'} passed" if count else "nothing to check"
    return f"{entry.name}: {text}, {entry.seconds:.1f} s"


class _Lines:
    """A line whenever a figure is done."""

    def __init__(self, screen: Screen, count: int) -> None:
        self.screen, self.count, self.done = screen, count, 0
        self.compiling = False

    def __call__(self, kind: str, name: str, made: Any) -> None:
        if kind == "compiling" and not self.compiling:
            self.compiling = True
            self.screen.say(COMPILING)
        elif kind == "done":
            self.done += 1
            self.screen.say(f"{outcome(made)} ({self.done} of {self.count})")


class _Bars(_Lines):
    """The same above bars: one for all figures, one line for each that is running."""

    def __init__(self, screen: Screen, count: int, bar: Bar) -> None:
        super().__init__(screen, count)
        self.bar, self.running = bar, {"": bar.add_task("all", total=count, text=f"0 of {count} done")}

    def __call__(self, kind: str, name: str, made: Any) -> None:
        super().__call__(kind, name, made)
        if kind == "start":
            self.running[name] = self.bar.add_task(name, total=None, text="running")
        elif kind == "done":
            if name in self.running:
                self.bar.remove_task(self.running.pop(name))
            self.bar.update(self.running[""], advance=1, text=f"{self.done} of {self.count} done")


@contextmanager
def _watching(screen: Screen, count: int) -> Iterator[_Lines]:
    if screen.quiet or not screen.console.is_terminal:
        yield _Lines(screen, count)
        return
    with exhibits_bar(screen.console) as bar:
        yield _Bars(screen, count, bar)
