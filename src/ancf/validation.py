"""Groups of quantities beside what they are compared with: a table, ``validate.json`` and a report."""

from __future__ import annotations

import html
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ._version import __version__
from .catenary.quantity import Quantity, shown_limits, verdict
from .files import to_json, write_text

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Group:
    """Quantities with one source.

    Parameters
    ----------
    title, source : str
    rows : list of Quantity
    wanted : list of float, optional
        What the source has for each row, NaN: nothing; default the middles of the accepted ranges.
    picture : callable, optional
        Makes an SVG of the group.
    """

    title: str
    source: str
    rows: list[Quantity]
    wanted: list[float] = field(default_factory=list)
    picture: Callable[[], str] | None = None

    @property
    def pairs(self) -> list[tuple[Quantity, float | None]]:
        """Each row with what its source has."""
        wanted = self.wanted or [_middle(q) for q in self.rows]
        return [(q, None if math.isnan(x) else x) for q, x in zip(self.rows, wanted, strict=True)]


def validation(case: str, groups: list[Group]) -> dict[str, Any]:
    """What ``validate.json`` holds: the case, all rows as of a line, whether all are inside, the sources."""
    rows = [
        {**quantity.row, "quantity": f"{group.title}: {quantity.name}", "reference": wanted}
        for group in groups
        for quantity, wanted in group.pairs
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
    """The report: a table of each group with its source, and what it draws."""
    parts = [
        "<!doctype html>",
        f'<html lang="en"><head><meta charset="utf-8"><title>{title}</title>',
        f"<style>{STYLE}</style></head><body>",
        f"<h1>{title}</h1><p>ancf {__version__}: {_count(groups)}</p>",
    ]
    for group in groups:
        cells = "".join(_cells(q, wanted) for q, wanted in group.pairs)
        head = "".join(f"<th>{name}</th>" for name in HEAD)
        parts.append(
            f"<h2>{html.escape(group.title)}</h2><p>{html.escape(group.source)}</p>"
            f"<table><thead><tr>{head}</tr></thead><tbody>{cells}</tbody></table>"
        )
        if group.picture is not None:
            parts.append(f"<figure>{group.picture()}</figure>")
    return "\n".join([*parts, "</body></html>", ""])


def _middle(q: Quantity) -> float:
    return math.nan if q.low is None or q.high is None else 0.5 * (q.low + q.high)


def _count(groups: list[Group]) -> str:
    judged = [q.inside for group in groups for q in group.rows if q.inside is not None]
    return f"{sum(judged)} of {len(judged)} inside the accepted ranges"


def _cells(q: Quantity, wanted: float | None) -> str:
    off = f"{100.0 * (q.value / wanted - 1.0):+.2g} %".replace("-", "\N{MINUS SIGN}") if wanted else ""
    texts = (q.name, _number(q.value), _number(wanted), q.unit, off, _limits(q), verdict(q))
    kind = {True: "inside", False: "outside", None: ""}[q.inside]
    return f'<tr class="{kind}">' + "".join(f"<td>{html.escape(text)}</td>" for text in texts) + "</tr>"


def _number(x: float | None) -> str:
    """Five digits without an exponent, and a thin space between thousands."""
    if x is None:
        return ""
    digits = max(0, 4 - math.floor(math.log10(abs(x)))) if x else 0
    text = f"{x:,.{min(digits, 9)}f}".replace(",", "\N{THIN SPACE}")
    return text.replace("-", "\N{MINUS SIGN}")


def _limits(q: Quantity) -> str:
    if q.low is None or q.high is None:
        return shown_limits(q)
    return f"{_number(q.low)} to {_number(q.high)}"


#: What the columns of a table are.
HEAD = ("quantity", "computed", "reference", "unit", "off by", "accepted", "verdict")
STYLE = (
    "body{font:15px/1.5 system-ui,sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem}"
    "table{border-collapse:collapse}td,th{padding:.2rem .8rem .2rem 0;text-align:left}"
    "td:nth-child(2),td:nth-child(3),td:nth-child(5){text-align:right}figure{margin:1rem 0}"
    ".inside td:last-child{color:#1a7f37}"
    ".outside td:last-child{color:#c1121f;font-weight:bold}"
)
