"""What a run shows while it works: a bar in a terminal, otherwise one line for every ten per cent."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any, TextIO, cast

from rich.console import Console
from rich.progress import BarColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.progress import Progress as Bar
from rich.table import Table
from rich.text import Text

from ..files import visible

WIDTH_OF_A_FILE = 120
COMPILING = "compiling the numerical core: this happens only once on this machine ..."
Report = Callable[[Any], None]


class PlainConsole(Console):
    """Text appears as it is; what a terminal would take for a command, say in a title, is spelt out."""

    def render_str(self, text: str, **options: Any) -> Text:
        """Text from a str, also in tables."""
        return super().render_str(visible(text), **options)


class Steady:
    """A stream whose reader may go away: what is written then is lost, and nothing fails."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        """Write if somebody reads."""
        self._try(lambda: self._stream.write(text))
        return len(text)

    def flush(self) -> None:
        """Flush if somebody reads."""
        self._try(self._stream.flush)

    def _try(self, action: Callable[[], Any]) -> None:
        try:
            action()
        except (UnicodeError, BlockingIOError):
            pass
        except (OSError, ValueError):
            with suppress(OSError, ValueError):  # what is left in the buffer goes nowhere
                nowhere = os.open(os.devnull, os.O_WRONLY)
                os.dup2(nowhere, self._stream.fileno())
                os.close(nowhere)


def console(stderr: bool = False) -> Console:
    """A console for results, or with `stderr` for remarks and errors; colours only in a terminal."""
    stream = sys.stderr if stderr else sys.stdout
    file = cast(TextIO, Steady(stream)) if stream is not None else None  # a closed pipe stops no work
    options: dict[str, Any] = {"stderr": stderr, "markup": False, "highlight": False, "emoji": False}
    made = PlainConsole(file=file, **options)
    return made if made.is_terminal else PlainConsole(file=file, width=WIDTH_OF_A_FILE, **options)


def table(*columns: str) -> Table:
    """A plain table; the first column is text, the others are numbers."""
    made = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="bold")
    for i, column in enumerate(columns):
        made.add_column(column, justify="right" if i else "left", overflow="fold")
    return made


def whole_words(made: Table) -> Table:
    """The same table with no column narrower than its longest word, however narrow the screen is."""
    longest = []
    for column in made.columns:
        texts = [str(text) for text in (column.header, *column.cells)]
        longest.append(max(map(len, texts)))
        column.min_width = max((len(word) for text in texts for word in text.split()), default=1)
    if sum(longest) + 2 * len(longest) > console().width:  # the first column alone takes what is left
        for column in made.columns[1:]:
            column.width = column.min_width
    return made


def fits(made: Table) -> bool:
    """Whether the screen is wide enough for the columns of a table."""
    gaps = 2 * (len(made.columns) - 1)
    return sum(column.min_width or 1 for column in made.columns) + gaps <= console().width


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
        from ..compilation import announce
        from ..kernel_cache import announce_compilation

        announce_compilation(lambda: self.say(COMPILING))
        announce(self.say)

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


def bar_of(where: Console, things: str) -> Bar:
    """A bar that counts things, with a text and the time left."""
    return Bar(
        BarColumn(bar_width=24),
        TextColumn("{task.completed:.0f} of {task.total:.0f} " + things),
        TextColumn("{task.fields[told]}"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        console=where,
        transient=True,
    )


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
            f"t = {progress.t:.4g} s, {duration(elapsed)} elapsed, about {duration(left)} left"
        )


def duration(seconds: float) -> str:
    """Seconds, minutes or hours as text."""
    if seconds < 60:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d} h" if hours else f"{minutes}:{rest:02d} min"
