"""Tables that a line file names: CSV with a head, read cell by cell, errors with row and column."""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping, Sequence
from pathlib import Path

from ...columns import separator_of
from ...errors import ModelError
from ...model.checks import choice, listed, nearest
from ...reading import as_input

MOST_ROWS = 200_000
#: A cell with several numbers, such as places of droppers.
BETWEEN = ";"
Value = float | list[float] | str | bool
Row = dict[str, Value]


def read_table(
    path: Path,
    needed: Sequence[str],
    known: Sequence[str],
    lists: Sequence[str] = (),
    others: bool = False,
    words: Mapping[str, Mapping[str, str | bool]] | None = None,
) -> list[Row]:
    """Rows of a CSV file as numbers; empty cells are left out.

    Entries are parted by commas, or by semicolons or tabs, as the head has them; then numbers may have a
    decimal comma, as spreadsheets write them in many countries.

    Parameters
    ----------
    path : Path
    needed, known : sequences of str
        Columns that must be there, and all that may be.
    lists : sequence of str
        Columns whose cells hold numbers with ";" between them, in quotes in a table with semicolons.
    others : bool
        Columns that nobody asks for are let pass.
    words : mapping
        Columns whose cells hold one of some words, each with its meaning.

    Raises
    ------
    ModelError
        The file cannot be read, a column is missing or unknown, a cell is no number; row 1 is the first below
        the head.

    """
    try:
        with as_input(path).open(newline="", encoding="utf-8-sig") as file:
            text = file.read().splitlines(keepends=True)
        separator = separator_of(next((line for line in text if line.strip()), ""))
        lines = [line for line in csv.reader(text, delimiter=separator) if any(cell.strip() for cell in line)]
    except FileNotFoundError:
        raise ModelError(str(path), "no such file") from None
    except (OSError, ValueError, csv.Error) as error:
        raise ModelError(str(path), f"cannot be read: {error}", "CSV in UTF-8, one head") from None
    if len(lines) < 2 or len(lines) > MOST_ROWS:
        raise ModelError(str(path), f"has {max(len(lines) - 1, 0)} rows", "a head and a row for each item")
    head = [cell.strip() for cell in lines[0]]
    _check_head(path, head, needed, known, others)
    rows = []

    def point(cell: str) -> str:
        return cell if separator == "," else cell.replace(",", ".")

    for number, line in enumerate(lines[1:], start=1):
        if len(line) != len(head):
            what = f"has {len(line)} cells, the head has {len(head)}"
            decimal = "decimal commas need semicolons or tabs between columns" if separator == "," else ""
            raise ModelError(f"{path}, row {number}", what, decimal)
        cells = {key: cell.strip() for key, cell in zip(head, line, strict=True) if cell.strip()}
        for key in needed:
            if key not in cells:
                raise ModelError(f"{path}, row {number}, column {key}", "is empty")
        rows.append(
            {
                key: _word(cell, words[key], f"{path}, row {number}, column {key}")
                if words and key in words
                else _value(point(cell), key in lists, f"{path}, row {number}, column {key}")
                for key, cell in cells.items()
                if key in known
            }
        )
    return rows


def file_of(folder: Path, name: str, where: str) -> Path:
    """A file that a line file names beside itself; ModelError with its key if it is not there."""
    path = folder / name
    if not path.is_file():
        raise ModelError(where, f"{path}: no such file")
    return path


def _check_head(
    path: Path, head: list[str], needed: Sequence[str], known: Sequence[str], others: bool
) -> None:
    for key in needed:
        if key not in head:
            near = nearest(key, [name for name in head if name not in known])
            raise ModelError(
                f"{path}, column {key}", "is missing", near or f"the head has: {listed(head, 30)}"
            )
    for key in head:
        if key not in known and not others:
            what = f"unknown column, known: {listed(list(known), 30)}"
            raise ModelError(f"{path}, column {key}", what, nearest(key, known))
    if len(set(head)) < len(head):
        twice = next(key for key in head if head.count(key) > 1)
        raise ModelError(f"{path}, column {twice}", "stands there twice")


def _value(cell: str, several: bool, where: str) -> float | list[float]:
    if several:
        return [_number(part, where) for part in cell.split(BETWEEN)]
    return _number(cell, where)


def _word(cell: str, known: Mapping[str, str | bool], where: str) -> str | bool:
    return known[choice(cell, where, list(known))]


def _number(text: str, where: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise ModelError(where, f'is "{text.strip()}", must be a number', "a point for decimals") from None
    if not math.isfinite(value):
        raise ModelError(where, f"is {value}, must be a finite number")
    return value
