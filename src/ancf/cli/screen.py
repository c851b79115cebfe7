"""What a run shows while it works: a bar in a terminal, otherwise one line for every ten per cent."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.progress import Progress as Bar
from rich.table import Table

WIDTH_OF_A_FILE = 120
COMPILING = "compiling the numerical core: this happens only once on this machine ..."
Report = Callable[[Any], None]


def console(stderr: bool = False) -> Console:
    """A console that prints text as it is; colours only in a terminal and without NO_COLOR."""
    made = Console(stderr=stderr, markup=False, highlight=False, emoji=False)
    return (
        made
        if made.is_terminal
        else Console(stderr=stderr, markup=False, highlight=False, emoji=False, width=WIDTH_OF_A_FILE)
    )


def table(*columns: str) -> Table:
    """A plain table; the first column is text, the others are numbers."""
    made = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="bold")
    for i, column in enumerate(columns):
        made.add_column(column, justify="right" if i else "left", overflow="fold")
    return made


class Screen:
    """Progress and remarks of one run, on stderr.

    Parameters
    ----------
    quiet : bool
        Show nothing.

    """

    def __init__(self, quiet: bool = False) -> None:
        self.quiet = quiet
        self.console = console(stderr=True)

    def say(self, text: str) -> None:
        """Print a remark."""
        if not self.quiet:
            self.console.print(text, style="dim", soft_wrap=True)

    def announce_compilation(self) -> None:
        """Say it once when kernels must be compiled."""
        from ancf.compiled import announce_compilation

        announce_compilation(lambda: self.say(COMPILING))

    @contextmanager
    def progress(self, steps: int) -> Iterator[Report | None]:
        """What ``simulate(progress=...)`` gets."""
        if self.quiet:
            yield None
        elif self.console.is_terminal:
            with _bar(self.console) as bar:
                yield _in_bar(bar, steps)
        else:
            yield _Lines(self.say)


def exhibits_bar(where: Console) -> Bar:
    """Bars with a name, a text and the time since they began."""
    text = TextColumn("{task.description}: {task.fields[text]}")
    return Bar(BarColumn(bar_width=24), text, TimeElapsedColumn(), console=where, transient=True)


def _bar(where: Console) -> Bar:
    return Bar(
        BarColumn(bar_width=24),
        TextColumn("{task.percentage:>3.0f} %  step {task.completed:.0f} of {task.total:.0f}"),
        TextColumn("t = {task.fields[t]:.4g} s"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        console=where,
        transient=True,
    )


def _in_bar(bar: Bar, steps: int) -> Report:
    task = bar.add_task("", total=steps, t=0.0)

    def report(progress: Any) -> None:
        bar.update(task, completed=progress.step, total=progress.steps, t=progress.t)

    return report


class _Lines:
    """One line whenever another tenth is done; times count from the first report, after compiling."""

    def __init__(self, say: Callable[[str], None]) -> None:
        self.say = say
        self.first: tuple[int, float] | None = None
        self.tenths = 0

    def __call__(self, progress: Any) -> None:
        now = time.monotonic()
        if self.first is None:
            self.first = progress.step, now
        tenths = 10 * progress.step // progress.steps
        if tenths <= self.tenths:
            return
        self.tenths = tenths
        elapsed, steps = now - self.first[1], progress.step - self.first[0]
        left = elapsed / max(steps, 1) * (progress.steps - progress.step)
        self.say(
            f"{100 * progress.step // progress.steps:3} %  step {progress.step} of {progress.steps}, "
            f"t = {progress.t:.4g} s, {_duration(elapsed)} elapsed, about {_duration(left)} left"
        )


def _duration(seconds: float) -> str:
    if seconds < 60:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d} h" if hours else f"{minutes}:{rest:02d} min"
