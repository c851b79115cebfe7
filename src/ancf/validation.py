"""Groups of quantities beside what they are compared with: a table, ``validate.json`` and a report."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ._version import __version__
from .catenary.answers.quantity import Quantity, shown_limits, verdict
from .files import to_json, write_text
from .viz.html import element, figure, section, table
from .viz.html import page as whole_page

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

Progress = Callable[[int, int], None]
#: What the columns of a table are.
HEAD = ("quantity", "computed", "reference", "unit", "off by", "accepted", "verdict")
CAPTION = "Lines are computed, dots are what they are compared with."


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
    head = element("p", f"{_count(groups)}.", class_="verdict")
    parts = [_section(k, group) for k, group in enumerate(groups)]
    links = [element("a", group.title, href=f"#group-{k}") for k, group in enumerate(groups)]
    foot = element("p", f"ancf {__version__}", class_="faint")
    return whole_page(title, element("h1", title), head, element("nav", *links), *parts, foot)


def _section(k: int, group: Group) -> Element:
    made = table(HEAD, [_cells(q, wanted) for q, wanted in group.pairs], numbers=(1, 2, 4, 5))
    for cell in made.iter("td"):
        if cell.text in ("inside", "outside"):
            cell.set("class", str(cell.text))
    drawn = [figure(f"{k}", group.title, CAPTION, group.picture())] if group.picture is not None else []
    return section(group.title, f"group-{k}", element("p", group.source, class_="faint"), made, *drawn)


def _middle(q: Quantity) -> float:
    return math.nan if q.low is None or q.high is None else 0.5 * (q.low + q.high)


def _count(groups: list[Group]) -> str:
    judged = [q.inside for group in groups for q in group.rows if q.inside is not None]
    return f"{sum(judged)} of {len(judged)} inside the accepted ranges"


def _cells(q: Quantity, wanted: float | None) -> tuple[str, ...]:
    off = f"{100.0 * (q.value / wanted - 1.0):+.2g} %".replace("-", "\N{MINUS SIGN}") if wanted else ""
    return q.name, _number(q.value), _number(wanted), q.unit, off, _limits(q), verdict(q)


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
