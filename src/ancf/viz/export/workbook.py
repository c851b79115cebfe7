"""A result as a workbook for a spreadsheet: a sheet for each table, and one about their columns."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ...errors import ModelError
from ...files import cell, drafted, writing
from ...model.functions.inputs import Input
from ...results.result import Result
from .csv_files import all_tables
from .frames import library
from .tables import Column

#: Rows of a sheet below its head, as spreadsheets have it.
ROWS = 1_048_575
#: Name and unit of a column: "rope.end position x [m]".
HEAD = re.compile(r"(.*) \[(.*)\]")
#: That of an input of the model.
INPUT = "input "
#: What columns hold, by the end of their names; the first that fits.
WORDS = (
    (r"t", "time"),
    (r".*position ([xyz])", "global coordinate {0} of the point"),
    (r".*velocity ([xyz])", "its rate"),
    (r".*tension", "axial force, positive in tension"),
    (r".*curvature", "curvature of the axis"),
    (r".*length", "distance of the ends of the spring"),
    (r".*gap", "smallest distance of what may touch; negative where it presses"),
    (r".*friction", "friction added up by its size"),
    (r".*slipping", "share of the contact that slips"),
    (r".* s", "arc length at which the joint or contact is"),
    (r".*force ([xyz])", "component {0} of the force of the joint, global axes"),
    (r".*angle", "angle of the first end against the second about the axis of the joint or spring"),
    (r".*moment \d", "moment of the joint, about an axis that it holds"),
    (r".*force", "force of the spring, positive in tension, or of the contact, positive in pressure"),
    (r"kinetic|strain|potential|total", "energy"),
    (r"dissipated|supplied", "work up to this time"),
    (r"balance|drift", "what of the energies does not add up"),
)


def write_xlsx(result: Result, path: str | Path, points: Sequence[str] | None = None) -> Path:
    """Write the tables of :func:`ancf.viz.export.write_csv` as the sheets of one workbook.

    The first sheet names the run, and of every column its unit and what it is.

    Parameters
    ----------
    result : Result
    path : path
        Ends in ``.xlsx``.
    points : sequence of str, optional
        As for ``write_csv``.

    Raises
    ------
    ModelError
        As of ``write_csv``; openpyxl is missing, or a table has more rows than a sheet.
    """
    openpyxl = library("openpyxl", "write_xlsx")
    target = Path(path)
    _, found = all_tables(result, target.parent, points, "write_xlsx")
    for name, columns in found:
        if len(columns[0][1]) > ROWS:
            what = f"the table {name} has {len(columns[0][1])} rows, a sheet holds {ROWS}"
            raise ModelError("write_xlsx", what, "ancf export --to csv, or a longer output_step")
    book = openpyxl.Workbook(write_only=True)
    _describe(book.create_sheet("about"), result, found)
    for name, columns in found:
        sheet = book.create_sheet(name)
        sheet.freeze_panes = "B2"
        sheet.append([cell(head) for head, _ in columns])
        for row in zip(*(values.tolist() for _, values in columns), strict=True):
            sheet.append(row)
    with writing(target), drafted(target) as draft:
        book.save(draft)
    return target


def _describe(sheet: Any, result: Result, found: list[tuple[str, list[Column]]]) -> None:
    """The first sheet; a text that a spreadsheet would take for a formula stays a text."""
    plain = result.provenance
    versions = plain.get("versions", {})
    for column, width in zip("ABCD", (14, 48, 10, 70), strict=True):
        sheet.column_dimensions[column].width = width
    sheet.append(["title", cell(result.model.title)])
    sheet.append(["status", result.status])
    sheet.append(["made", f"ancf {versions.get('ancf', '')}, {str(plain.get('created', ''))[:10]}"])
    sheet.append([])
    sheet.append(["sheet", "column", "unit", "what it is"])
    for name, columns in found:
        for head, _ in columns:
            sheet.append([name, *map(cell, described(head, result.model.inputs))])


def described(head: str, inputs: Mapping[str, Input] | None = None) -> tuple[str, str, str]:
    """Name, unit and meaning of a column; what an input is, its model says."""
    parts = HEAD.fullmatch(head)
    name, unit = (parts[1], parts[2]) if parts else (head, "")
    item = (inputs or {}).get(name.removeprefix(INPUT)) if name.startswith(INPUT) else None
    if item is not None:
        return name, unit, item.description or "input, given while the run went on"
    for pattern, words in WORDS:
        if (fits := re.fullmatch(pattern, name)) is not None:
            return name, unit, words.format(*fits.groups())
    return name, unit, ""
