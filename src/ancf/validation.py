"""Groups of quantities beside what they are compared with: a table, ``validate.json`` and a report."""

from __future__ import annotations

import html
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ._version import __version__
from .catenary.quantity import Quantity, shown, shown_limits, verdict
from .files import to_json, write_text

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Group:
    """Quantities with one source."""

    title: str
    source: str
    rows: list[Quantity]


def validation(case: str, groups: list[Group]) -> dict[str, Any]:
    """What ``validate.json`` holds: the case, all rows as of a line, whether all are inside, the sources."""
    rows = [
        {**quantity.row, "quantity": f"{group.title}: {quantity.name}"}
        for group in groups
        for quantity in group.rows
    ]
    judged = [row["inside"] for row in rows if row["inside"] is not None]
    return {
        "case": case,
        "rows": rows,
        "all_inside": all(judged),
        "source": {group.title: group.source for group in groups},
        "ancf": __version__,
    }


def write(case: str, title: str, groups: list[Group], folder: Path, report: bool = True) -> list[Path]:
    """Write ``validate.json`` and, if wanted, ``report.html``; returns the files."""
    written = [folder / "validate.json"]
    write_text(written[0], to_json(validation(case, groups)))
    if report:
        written.append(folder / "report.html")
        write_text(written[1], page(title, groups))
    return written


def page(title: str, groups: list[Group]) -> str:
    """The report: a table of each group with its source."""
    parts = [
        "<!doctype html>",
        f'<html lang="en"><head><meta charset="utf-8"><title>{title}</title>',
        f"<style>{STYLE}</style></head><body>",
        f"<h1>{title}</h1><p>ancf {__version__}</p>",
    ]
    for group in groups:
        cells = "".join(_cells(q) for q in group.rows)
        head = "".join(f"<th>{name}</th>" for name in ("quantity", "value", "unit", "accepted", ""))
        parts.append(
            f"<h2>{html.escape(group.title)}</h2><p>{html.escape(group.source)}</p>"
            f"<table><thead><tr>{head}</tr></thead><tbody>{cells}</tbody></table>"
        )
    return "\n".join([*parts, "</body></html>", ""])


def _cells(q: Quantity) -> str:
    texts = (q.name, shown(q.value, q.unit), q.unit, shown_limits(q), verdict(q))
    kind = {True: "inside", False: "outside", None: ""}[q.inside]
    return f'<tr class="{kind}">' + "".join(f"<td>{html.escape(text)}</td>" for text in texts) + "</tr>"


STYLE = (
    "body{font:15px/1.5 system-ui,sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem}"
    "table{border-collapse:collapse}td,th{padding:.2rem .8rem .2rem 0;text-align:left}"
    "td:nth-child(2){text-align:right}.inside td:last-child{color:#1a7f37}"
    ".outside td:last-child{color:#c1121f;font-weight:bold}"
)
