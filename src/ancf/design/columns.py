"""Columns of numbers and words from CSV files, each number to its last bit."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

from ..errors import ModelError


def read_columns(path: Path, where: str) -> dict[str, list[Any]]:
    """Columns of a CSV file with a head, by name: whole numbers, numbers or texts.

    Raises
    ------
    ModelError
        The file cannot be read, has no rows, or a row has another length than the head.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = [row for row in csv.reader(file, skipinitialspace=True) if row]
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
            raise ModelError(where, f'{path}: column {k + 1} has the name "{name}", must be unique')
    return {name: _column([row[k].strip() for row in rows[1:]]) for k, name in enumerate(head)}


def _column(texts: list[str]) -> list[Any]:
    for kind in (int, float):
        try:
            return [kind(text) for text in texts]
        except ValueError:
            continue
    return texts
