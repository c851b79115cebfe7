"""One exhibit: its numbers, picture, checks and files."""

from __future__ import annotations

import os
import time
import traceback
import warnings
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from .. import __version__
from ..errors import ModelError, SolveError
from ..viz import style
from .entry import Entry
from .figures import FIGURES

if TYPE_CHECKING:
    from .figures import FigureModule
    from .table import Table

KINDS = ("png", "csv", "json")


def make(name: str, folder: Path, short: bool) -> Entry:
    """Compute an exhibit and write NAME.png, NAME.csv and NAME.json; errors go up."""
    module, start = FIGURES[name], _clocks()
    for path in _files(name, folder):
        path.unlink(missing_ok=True)  # what is there afterwards is of this run
    table = module.data(short)
    table.notes.append(f"ancf {__version__}" + (", short form: fewer and shorter runs." if short else "."))
    _draw(module, table, folder / f"{name}.png")
    checks = tuple(module.checks(table))
    table.write(folder, checks)
    wall, cpu = (now - then for now, then in zip(_clocks(), start, strict=True))
    files = tuple(_files(name, folder))
    made = Entry(name, checks=checks, notes=tuple(table.notes), files=files, seconds=wall, cpu_seconds=cpu)
    return _with_texts(made)


def attempt(name: str, folder: Path, short: bool) -> Entry:
    """The same, but an error becomes part of the entry; Ctrl-C goes up."""
    start = _clocks()
    try:
        with warnings.catch_warnings(record=True) as caught:
            made = make(name, folder, short)
        remarks = (f"Warning: {warning.message}" for warning in caught)
        return replace(made, notes=(*made.notes, *dict.fromkeys(remarks)))
    except Exception as error:
        wall, cpu = (now - then for now, then in zip(_clocks(), start, strict=True))
        return failed(name, error, folder, wall, cpu)


def failed(name: str, error: Exception, folder: Path, seconds: float, cpu_seconds: float) -> Entry:
    """Entry of an exhibit that raised an error."""
    expected = isinstance(error, ModelError | SolveError | OSError)
    made = Entry(
        name,
        files=tuple(path for path in _files(name, folder) if path.exists()),
        seconds=seconds,
        cpu_seconds=cpu_seconds,
        error=str(error) if expected else f"internal error: {type(error).__name__}: {error}",
        traceback="" if expected else _trace(error),
    )
    return _with_texts(made)


def _trace(error: Exception) -> str:
    """Where it arose; files of the package without the folder where it is installed."""
    root = Path(__file__).parents[2]
    return "".join(traceback.format_exception(error)).replace(f"{root}{os.sep}", "")


def _with_texts(entry: Entry) -> Entry:
    module = FIGURES[entry.name]
    return replace(entry, title=module.TITLE, example=module.EXAMPLE, claim=module.CLAIM)


def _draw(module: FigureModule, table: Table, picture: Path) -> None:
    with style.new_figure(*module.SIZE) as figure:
        module.draw(table, figure)
        figure.savefig(picture)


def _files(name: str, folder: Path) -> list[Path]:
    return [folder / f"{name}.{kind}" for kind in KINDS]


def _clocks() -> tuple[float, float]:
    return time.perf_counter(), time.process_time()
