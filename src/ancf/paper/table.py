"""Table: the numbers behind a figure, as rows with named columns and notes."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..files import cell, to_json
from .check import Check

Value = str | int | float


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of numbers with named columns.

    Parameters
    ----------
    name : str
        Name of the figure, ``fig2``.
    columns : sequence of str
    rows : list of tuples
        As long as `columns`.
    notes : list of str
        Assumptions, settings and measured numbers.

    """

    name: str
    columns: Sequence[str]
    rows: list[tuple[Value, ...]]
    notes: list[str]

    def values(self, column: str, **only: Value) -> FloatArray:
        """Numbers of a column, of those rows whose other columns have the given values."""
        at = self.columns.index(column)
        wanted = {self.columns.index(key): value for key, value in only.items()}
        found = [row[at] for row in self.rows if all(row[i] == value for i, value in wanted.items())]
        return np.array(found, dtype=np.float64)

    def row(self, **only: Value) -> dict[str, Any] | None:
        """First row with these texts and, within 1e-9, these numbers, by column; None if there is none."""
        wanted = [(self.columns.index(key), value) for key, value in only.items()]
        for row in self.rows:
            if all(_same(row[i], value) for i, value in wanted):
                return dict(zip(self.columns, row, strict=True))
        return None

    def kinds(self, column: str = "element") -> list[str]:
        """Different texts of a column, in the order of the rows."""
        at = self.columns.index(column)
        return list(dict.fromkeys(str(row[at]) for row in self.rows))

    def write(self, folder: Path, checks: Iterable[Check] = ()) -> list[Path]:
        """Write NAME.csv, and NAME.json with the checks."""
        table, full = folder / f"{self.name}.csv", folder / f"{self.name}.json"
        with table.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([cell(value) for value in row] for row in (self.columns, *self.rows))
        full.write_text(self._json(checks), encoding="utf-8")
        return [table, full]

    def _json(self, checks: Iterable[Check]) -> str:
        rows = ",\n".join("  " + json.dumps(row) for row in self.rows)
        head = json.dumps({"name": self.name, "columns": list(self.columns)}, ensure_ascii=False)
        notes = json.dumps(self.notes, indent=1, ensure_ascii=False)
        judged = to_json([check.plain() for check in checks]).rstrip()
        return f'{head[:-1]},\n "rows": [\n{rows}\n ],\n "notes": {notes},\n "checks": {judged}\n}}\n'


def _same(found: Value, wanted: Value) -> bool:
    if isinstance(found, float) and isinstance(wanted, (int, float)):
        return abs(found - wanted) < 1e-9
    return found == wanted


def sampled_rows(head: Iterable[Value], *histories: FloatArray) -> list[tuple[Value, ...]]:
    """One row for each time: the values of `head`, then those of the histories (n,) or (n, k)."""
    numbers = np.column_stack(histories).tolist()
    start = tuple(head)
    return [(*start, *row) for row in numbers]
