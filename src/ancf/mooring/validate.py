"""Mooring lines computed and compared with MoorPy, MoorDyn, OrcaFlex's list and a measured chain."""

from __future__ import annotations

import html
import math
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

from .._version import __version__
from ..catenary.quantity import Quantity, shown, shown_limits, verdict
from ..files import to_json, write_text
from . import cases

CASE = "mooring"
TITLE = "Mooring lines against other programs and measurements"
Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Group:
    """Quantities with one source."""

    title: str
    source: str
    rows: list[Quantity]


def references() -> dict[str, Any]:
    """The stored numbers with their origins."""
    return tomllib.loads(files(__package__).joinpath("references.toml").read_text(encoding="utf-8"))


def compare(progress: Progress | None = None) -> list[Group]:
    """Compute all cases and put them beside their references; ``progress(done, of)`` is called after each."""
    found = references()
    measured = found["measured"]
    makers: dict[str, Callable[[], dict[str, float]]] = {
        "catenary": lambda: cases.catenary(0.0),
        "rubbing catenary": lambda: cases.catenary(0.1),
        "chain": cases.forces_of_chain,
        "heaving chain": cases.heaving_chain,
    }
    places = [(float(T), k) for T in measured["periods"] for k in range(len(measured["radii"]))]
    total = len(makers) + len(places)
    numbers: dict[str, dict[str, float]] = {}
    for name, make in makers.items():
        numbers[name] = make()
        if progress is not None:
            progress(len(numbers), total)
    groups = [
        Group(g["title"], g["source"], [_row(row, numbers[row["case"]][row["key"]]) for row in g["row"]])
        for g in found["group"]
    ]
    peaks = []
    for number, (period, k) in enumerate(places):
        peaks.append(cases.mean_peak(measured["radii"][k], period))
        if progress is not None:
            progress(len(makers) + number + 1, total)
    return [*groups, _measured(measured, places, peaks)]


def _row(row: dict[str, Any], value: float) -> Quantity:
    reference = row["value"]
    within = row["within"] if "within" in row else row["share"] * reference
    return Quantity(
        row["key"], row["name"], row["unit"], value, reference - within, reference + within, "program"
    )


def _measured(given: dict[str, Any], places: list[tuple[float, int]], peaks: list[float]) -> Group:
    """A row for each motion, whose range is twice the accepted mean error, and that of all of them."""
    printed = [row for rows in given["periods"].values() for row in rows]
    rows = []
    for (period, k), peak, value in zip(places, peaks, printed, strict=True):
        name = f"peak, r = {given['radii'][k]:g} m, T = {period:g} s, measured {value:g} N"
        rows.append(Quantity("peak", name, "N", peak))
    error = math.sqrt(sum((a - b) ** 2 for a, b in zip(peaks, printed, strict=True)) / len(peaks))
    rows.append(
        Quantity("rmse", "root mean square error of all", "N", error, None, given["most"], "measured")
    )
    return Group(given["title"], given["source"], rows)


def validation(groups: list[Group]) -> dict[str, Any]:
    """What ``validate.json`` holds: the case, all rows as of a line, whether all are inside, the sources."""
    rows = [
        {**quantity.row, "quantity": f"{group.title}: {quantity.name}"}
        for group in groups
        for quantity in group.rows
    ]
    judged = [row["inside"] for row in rows if row["inside"] is not None]
    return {
        "case": CASE,
        "rows": rows,
        "all_inside": all(judged),
        "source": {group.title: group.source for group in groups},
        "ancf": __version__,
    }


def write(groups: list[Group], folder: Path, report: bool = True) -> list[Path]:
    """Write ``validate.json`` and, if wanted, ``report.html``; returns the files."""
    written = [folder / "validate.json"]
    write_text(written[0], to_json(validation(groups)))
    if report:
        written.append(folder / "report.html")
        write_text(written[1], page(groups))
    return written


def page(groups: list[Group]) -> str:
    """The report: a table of each group with its source."""
    parts = [
        "<!doctype html>",
        f'<html lang="en"><head><meta charset="utf-8"><title>{TITLE}</title>',
        f"<style>{STYLE}</style></head><body>",
        f"<h1>{TITLE}</h1><p>ancf {__version__}</p>",
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
