"""``ancf catenary compare``: runs in folders side by side, with a report."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .output import OutputFolder
from .screen import console, fits, table, whole_words

if TYPE_CHECKING:
    from rich.table import Table


def compare_runs(folders: list[Path], output: Path, to: str | None = None, quiet: bool = False) -> None:
    """Print the quantities of all runs and their differences, write ``table.csv`` and the reports.

    Raises
    ------
    ModelError
        A folder holds no run, a package is missing, or the folder cannot be written.

    """
    from ..catenary.answers.kept import read_runs
    from ..catenary.answers.quantity import shown
    from ..catenary.report.comparison import differences, heads, told, write_comparison, write_table
    from ..viz.printed import chosen
    from ..viz.style import require_matplotlib

    formats = chosen(to)
    require_matplotlib()
    runs = read_runs(folders)
    if output.resolve() in [folder.resolve() for folder in folders]:
        from ..errors import ModelError

        raise ModelError("--output", f"{output} is one of the runs", "give another folder")
    place = OutputFolder(output).path
    files = [write_table(runs, place / "table.csv"), *write_comparison(runs, place, formats)]
    if quiet:
        return
    columns, count = heads(runs), len(runs)
    rows = [
        (name, "" if unit == "count" else unit, *(shown(value, unit) for value in [*values, *changes]))
        for name, unit, values, changes in differences(runs)
    ]
    for run in runs:
        console().print(f"{told(run)}: {run.line}{f'; {run.state}' if run.state else ''}", soft_wrap=True)
    whole = _table(columns, rows)
    parts = [whole] if fits(whole) else [_table(columns, rows, 0, count), _table(columns, rows, count)]
    for made in parts:
        console().print(made, crop=False)
    console().print("written: " + ", ".join(map(str, files)), soft_wrap=True)


def _table(
    columns: Sequence[str], rows: Sequence[Sequence[str]], first: int = 0, last: int | None = None
) -> Table:
    """Quantity, unit and some of the columns; rows that are empty there are left out."""
    made = table("quantity", "unit", *columns[first:last])
    for name, unit, *cells in rows:
        if any(cells[first:last]):
            made.add_row(name, unit, *cells[first:last])
    return whole_words(made)
