"""Sheets: a heading, facts and tables, as plain text for ``print`` and as HTML for notebooks."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

#: Rows of a table that are shown, and of a longer one those at its beginning and at its end.
MOST_ROWS, FIRST, LAST = 12, 8, 2
#: Characters of a cell, and of a fact before it goes on in the next line.
WIDEST, LINE = 72, 88

_NUMBER = re.compile(r"[-+]?(\d[\d.]*(e[-+]?\d+)?|inf|nan)?", re.IGNORECASE)


class Readable:
    """What prints as a sheet and shows as HTML in a notebook; ``repr`` stays one line."""

    __slots__ = ()

    def _sheet(self) -> Sheet:
        raise NotImplementedError

    def __str__(self) -> str:
        return self._sheet().text()

    def _repr_html_(self) -> str:
        return self._sheet().html()


@dataclass(frozen=True)
class Table:
    """Cells of text under headings; columns without any text are left out.

    Parameters
    ----------
    columns : sequence of str
    rows : sequence of sequences of str
        Of a long table the first and the last are kept; `most` is the number that is shown.
    most : int
    """

    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    most: int = MOST_ROWS

    def shown(self) -> tuple[list[str], list[list[str]], int]:
        """Headings and rows that are shown, and after how many of them rows are left out, or -1."""
        kept, gap = [*self.rows], -1
        if len(kept) > self.most:
            kept, gap = [*kept[:FIRST], *kept[-LAST:]], FIRST
        cells = [[_cut(cell) for cell in row] for row in kept]
        used = [j for j in range(len(self.columns)) if any(row[j] for row in cells)]
        return [self.columns[j] for j in used], [[row[j] for j in used] for row in cells], gap

    def text(self) -> str:
        """Aligned columns under a ruled heading."""
        columns, rows, gap = self.shown()
        width = [max(map(len, column)) for column in zip(columns, *rows, strict=True)]
        right = _numeric(rows, len(columns))
        lines = [_line(row, width, right) for row in (columns, ["-" * w for w in width], *rows)]
        if gap >= 0:
            lines.insert(2 + gap, self._left_out())
        return "\n".join(lines)

    def html(self) -> str:
        """Element ``table``."""
        columns, rows, gap = self.shown()
        right = _numeric(rows, len(columns))
        body = [_row(row, right, "td") for row in rows]
        if gap >= 0:
            body.insert(gap, f'<tr><td colspan="{len(columns)}">{self._left_out()}</td></tr>')
        head = _row(columns, right, "th")
        return f"<table><thead>{head}</thead><tbody>{''.join(body)}</tbody></table>"

    def _left_out(self) -> str:
        return f"... {len(self.rows) - FIRST - LAST} more ..."


@dataclass(frozen=True)
class Sheet:
    """What there is to say of an object.

    Parameters
    ----------
    title : str
    facts : list of (name, text)
        Those without text are left out.
    tables : list of Table
        Those without rows are left out.
    """

    title: str
    facts: Sequence[tuple[str, str]] = ()
    tables: Sequence[Table] = ()

    def text(self) -> str:
        """Plain text of many lines."""
        facts = [(name, text) for name, text in self.facts if text]
        width = max((len(name) for name, _ in facts), default=0)
        lines = [f"  {name:<{width}}  {_wrapped(text, width + 4)}" for name, text in facts]
        blocks = ["\n".join([self.title, *lines])]
        return "\n\n".join(blocks + [table.text() for table in self.tables if table.rows])

    def html(self) -> str:
        """Elements for a notebook, without a style of their own."""
        facts = [f"<b>{escape(name)}</b> {escape(text)}" for name, text in self.facts if text]
        lines = f"<div>{'<br>'.join(facts)}</div>" if facts else ""
        tables = "".join(table.html() for table in self.tables if table.rows)
        return f"<div><p><b>{escape(self.title)}</b></p>{lines}{tables}</div>"


def number(value: float, digits: int = 6) -> str:
    """A number with at most so many digits."""
    return f"{value + 0.0:.{digits}g}"


def numbers(values: Iterable[float], digits: int = 6) -> str:
    """A vector in brackets; what is rounding noise beside the largest is 0."""
    given = [float(value) for value in values]
    noise = 1e-12 * max((abs(value) for value in given), default=0.0)
    return f"({', '.join(number(x if abs(x) > noise else 0.0, digits) for x in given)})"


def plural(count: int, one: str, many: str = "") -> str:
    """``1 body``, ``2 bodies``."""
    return f"{count} {one if count == 1 else many or one + 's'}"


def counted(kinds: Iterable[str]) -> str:
    """``3 springs, 1 contact`` from the kinds of many items, in the order of their first."""
    counts: dict[str, int] = {}
    for kind in kinds:
        counts[kind] = counts.get(kind, 0) + 1
    return ", ".join(plural(count, kind, PLURALS.get(kind, "")) for kind, count in counts.items())


#: Plurals that do not only take an s.
PLURALS = {"point mass": "point masses", "rigid body": "rigid bodies"}


def with_units(values: Iterable[tuple[str, Any, str]]) -> str:
    """``EA = 5000 N, nu = 0.3`` from (symbol, value, unit); values of None are left out."""
    shown = [(name, number(float(x)), unit) for name, x, unit in values if x is not None]
    return ", ".join(f"{name} = {text}{f' {unit}' if unit else ''}" for name, text, unit in shown)


def _numeric(rows: Sequence[Sequence[str]], columns: int) -> list[bool]:
    """Which columns hold nothing but numbers."""
    return [all(_NUMBER.fullmatch(row[j]) for row in rows) for j in range(columns)]


def _line(cells: Sequence[str], width: Sequence[int], right: Sequence[bool]) -> str:
    parts = [f"{c:>{w}}" if r else f"{c:<{w}}" for c, w, r in zip(cells, width, right, strict=True)]
    return "  ".join(parts).rstrip()


def _row(cells: Sequence[str], right: Sequence[bool], tag: str) -> str:
    sides = ("left", "right")
    made = [
        f'<{tag} style="text-align: {sides[r]}">{escape(c)}</{tag}>'
        for c, r in zip(cells, right, strict=True)
    ]
    return f"<tr>{''.join(made)}</tr>"


def _cut(cell: str) -> str:
    line = " ".join(cell.split())
    return line if len(line) <= WIDEST else line[: WIDEST - 3] + "..."


def _wrapped(text: str, indent: int) -> str:
    """Text in lines that begin under each other, broken at spaces."""
    lines, current = [], ""
    for word in text.split():
        if current and len(current) + len(word) + 1 > LINE:
            lines.append(current)
            current = word
        else:
            current = f"{current} {word}" if current else word
    return ("\n" + " " * indent).join([*lines, current])
