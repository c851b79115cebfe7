"""Columns of numbers and words from CSV files, each number to its last bit."""

from __future__ import annotations

import csv
import re
from pathlib import Path
from typing import Any

from .errors import ModelError
from .reading import as_input

#: What may part the entries of a row; a comma is also a decimal point beside the others.
SEPARATORS = ("\t", ";", ",")
#: A head with a unit: "x [mm]", "x (mm)" or "x / mm".
UNIT = re.compile(r"(.*\S)\s*(?:\[(.*)\]|\((.*)\)|\s/\s*(\S+))")


def read_columns(path: Path, where: str) -> dict[str, list[Any]]:
    """Columns of a CSV file with a head, by name: whole numbers, numbers or texts.

    Entries are parted by commas, semicolons or tabs, as the head has them; lines that begin with ``#`` are
    left out. Beside semicolons and tabs a decimal comma is read as well.

    Raises
    ------
    ModelError
        The file cannot be read, has no rows, or a row has another length than the head.
    """
    try:
        with as_input(path).open(encoding="utf-8-sig", newline="") as file:
            lines = [line for line in file if not line.lstrip().startswith("#") and line.strip()]
        separator = separator_of(lines[0] if lines else "")
        read = csv.reader(lines, delimiter=separator, skipinitialspace=True)
        rows = [row for row in read if any(entry.strip() for entry in row)]
    except FileNotFoundError:
        raise ModelError(where, f"{path}: no such file") from None
    except (OSError, ValueError, csv.Error) as error:
        raise ModelError(where, f"{path} cannot be read: {error}") from None
    if len(rows) < 2:
        raise ModelError(where, f"{path} has no rows below its head")
    head = [name.strip() for name in rows[0]]
    for number, row in enumerate(rows[1:], 2):
        if len(row) != len(head):
            raise ModelError(where, f"{path}, row {number}: has {len(row)} entries, the head has {len(head)}")
    for k, name in enumerate(head):
        if not name or name in head[:k]:
            hint = "" if name else "a table of pandas has its rows' numbers there: to_csv(..., index=False)"
            raise ModelError(where, f'{path}: column {k + 1} has the name "{name}", must be unique', hint)
    comma = separator != ","
    return {name: _column([row[k].strip() for row in rows[1:]], comma) for k, name in enumerate(head)}


def separator_of(head: str) -> str:
    """What parts the entries of a table, by its head: tab, semicolon or comma."""
    return next((s for s in SEPARATORS if s in head), ",")


def split_unit(head: str) -> tuple[str, str]:
    """Name and unit of a column's head, ``"x [mm]"``; without a unit "" stands for it."""
    found = UNIT.fullmatch(head.strip())
    if found is None:
        return head.strip(), ""
    return found[1], next(part for part in found.groups()[1:] if part is not None).strip()


def _column(texts: list[str], comma: bool) -> list[Any]:
    given = [text.replace(",", ".") for text in texts] if comma else texts
    for kind in (int, float):
        try:
            return [kind(text) for text in given]
        except ValueError:
            continue
    return texts
