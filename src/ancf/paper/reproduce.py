"""Write figures and tables of the paper, and judge them: pictures, numbers, checks and a page with all."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from ..errors import ModelError, SolveError
from ..files import writable
from ..kernel_cache import announce_compilation
from ..model.checks import listed, nearest
from ..viz import style
from . import exhibit, schedule
from .entry import Entry, Reproduction
from .figures import FIGURES
from .report import write_page, write_summary
from .workers import Kind, Watch, run_groups

#: Called with the name of a figure, how many are done and how many there are.
Progress = Callable[[str, int, int], None]


def reproduce(
    names: Iterable[str],
    folder: str | os.PathLike[str],
    short: bool = False,
    progress: Progress | None = None,
) -> list[Path]:
    """Compute figures and write NAME.png, NAME.csv and NAME.json; an error ends it.

    Parameters
    ----------
    names : iterable of str
        Names of figures, ``fig2``, or ``all``.
    folder : path
        Where to write; made when it does not exist.
    short : bool
        Fewer and shorter runs, to try it out.
    progress : callable, optional
        Called with (name, done, count) before each figure, and with (last name, count, count) at the end.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    ModelError
        An unknown name, a folder that cannot be written, or matplotlib is missing.

    """
    wanted, target = _prepared(names, folder)
    files: list[Path] = []
    for done, name in enumerate(wanted):
        _report(progress, name, done, len(wanted))
        files += exhibit.make(name, target, short).files
    _report(progress, wanted[-1], len(wanted), len(wanted))
    return files


def verify(
    names: Iterable[str],
    folder: str | os.PathLike[str],
    short: bool = False,
    jobs: int | None = 1,
    watch: Watch | None = None,
) -> Reproduction:
    """Reproduce figures, judge them, and write ``index.html`` and ``checks.json`` as well.

    Parameters
    ----------
    names, folder, short
        As for :func:`reproduce`.
    jobs : int, optional
        Processes that compute; None takes one for each core. With more than one a script needs its
        ``if __name__ == "__main__":``.
    watch : callable, optional
        Called with ("start", name, None), ("done", name, entry), and ("compiling", "", None).

    Returns
    -------
    Reproduction
        An exhibit that could not be computed is an entry with its error; the others go on.

    Raises
    ------
    ModelError
        An unknown name, fewer than one process, a folder that cannot be written, or matplotlib is missing.

    """
    wanted, target = _prepared(names, folder)
    count = _checked(jobs, wanted)
    found, start = _Found(watch, target), time.perf_counter()
    for old in ("index.html", "checks.json"):
        (target / old).unlink(missing_ok=True)
    make = partial(exhibit.attempt, folder=target, short=short)
    _run(wanted, count, make, found)
    entries = tuple(found.entries[name] for name in wanted)
    made = Reproduction(entries, target, short, count, time.perf_counter() - start)
    write_summary(made)
    write_page(made)
    return made


def resolve(names: Iterable[str]) -> list[str]:
    """Names of figures in the order given, each once; ``all`` for all there are."""
    given = [names] if isinstance(names, str) else list(names)
    if not given:
        raise ModelError("reproduce", f"no figure named, there are {listed(FIGURES)}", 'or "all"')
    for name in given:
        if name != "all" and name not in FIGURES:
            problem = f'unknown figure "{name}", there are {listed(FIGURES)} and "all"'
            raise ModelError("reproduce", problem, nearest(name, FIGURES))
    return list(dict.fromkeys(n for name in given for n in (FIGURES if name == "all" else [name])))


class _Found:
    """Collects the entries and tells who watches."""

    def __init__(self, watch: Watch | None, folder: Path) -> None:
        self.watch, self.folder = watch, folder
        self.entries: dict[str, Entry] = {}

    def __call__(self, kind: Kind, name: str, made: Any) -> None:
        if kind == "died":
            error = SolveError(
                "reproduce", f"its process ended with code {made}", "out of memory, or killed?"
            )
            kind, made = "done", exhibit.failed(name, error, self.folder, 0.0, 0.0)
        if kind == "done":
            self.entries[name] = made
        if self.watch is not None:
            self.watch(kind, name, made)


def _run(names: Sequence[str], jobs: int, make: Callable[[str], Entry], watch: Watch) -> None:
    if jobs > 1:
        run_groups(schedule.grouped(names), make, jobs, watch)
        return
    announce_compilation(lambda: watch("compiling", "", None))
    for name in names:
        watch("start", name, None)
        watch("done", name, make(name))


def _checked(jobs: int | None, names: Sequence[str]) -> int:
    """As many processes as were asked for, or as there are cores; not more than have something to do."""
    wanted = schedule.cores() if jobs is None else jobs
    if wanted < 1:
        raise ModelError("reproduce", f"jobs must be at least 1, is {jobs}", "leave it out for all cores")
    return min(wanted, len(schedule.grouped(names)))


def _prepared(names: Iterable[str], folder: str | os.PathLike[str]) -> tuple[list[str], Path]:
    wanted = resolve(names)
    style.require_matplotlib()
    return wanted, writable(Path(folder))


def _report(progress: Progress | None, name: str, done: int, count: int) -> None:
    if progress is not None:
        progress(name, done, count)
