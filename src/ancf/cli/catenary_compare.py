"""``ancf catenary compare``: runs in folders side by side, with a report."""

from __future__ import annotations

from pathlib import Path

from .output import OutputFolder
from .screen import console, table


def compare_runs(folders: list[Path], output: Path, to: str | None = None, quiet: bool = False) -> None:
    """Print the quantities of all runs and their differences, write ``table.csv`` and the reports.

    Raises
    ------
    ModelError
        A folder holds no run, a package is missing, or the folder cannot be written.

    """
    from ..catenary.kept import read_runs
    from ..catenary.quantity import shown
    from ..catenary.report.comparison import differences, write_comparison, write_table
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
    names = [run.name for run in runs]
    made = table("quantity", "unit", *names, *(f"less {names[0]}" for _ in names[1:]))
    for name, unit, values, changes in differences(runs):
        cells = (shown(value, unit) for value in [*values, *changes])
        made.add_row(name, "" if unit == "count" else unit, *cells)
    for run in runs:
        console().print(f"{run.name}: {run.line}{f'; {run.state}' if run.state else ''}", soft_wrap=True)
    console().print(made)
    console().print("written: " + ", ".join(map(str, files)), soft_wrap=True)
