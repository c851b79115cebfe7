"""The page: what was found first, then each output, then the data."""

from __future__ import annotations

import datetime
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..._version import __version__
from ...files import write_text
from ...model.tables import plural
from ...viz import style
from ...viz.html import element, figure, folded, page, pairs, section
from ..statistics import is_drawn, outputs_of, parameters_of
from . import tables
from .figures import FIGURES, picture

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

    from pandas import DataFrame

#: Outputs that are shown one by one, and messages of failed cases.
MOST_OUTPUTS, MOST_MESSAGES = 12, 30


def write_report(path: Path, table: DataFrame, found: dict[str, Any], about: dict[str, Any]) -> Path:
    """Write the report as one HTML file.

    Parameters
    ----------
    path : Path
    table : DataFrame
        As :func:`ancf.study` returns it.
    found : dict
        What :func:`ancf.design.statistics.summary` says of it.
    about : dict
        ``title``, ``design`` and ``seconds``.

    Raises
    ------
    ModelError
        matplotlib is missing, or the file cannot be written.
    """
    style.require_matplotlib()
    title = about.get("title") or "Study"
    names = outputs_of(table)
    parts = [section("Outputs", "outputs", *_outputs(table, found, names))] if names else []
    parts += [_of_output(table, found, name) for name in names[:MOST_OUTPUTS]]
    if found["failed"]:
        parts.append(section("Failed cases", "failed", tables.failed(table, MOST_MESSAGES)))
    if found["noted"]:
        parts.append(section("Notes", "notes", tables.noted(table, MOST_MESSAGES)))
    parts.append(section("Data", "data", pairs(tables.data(table, found, about)), *_varied(table, about)))
    links = [element("a", str(part[0].text), href=f"#{part.get('id')}") for part in parts]
    head = [element("h1", title), element("p", _head(table, about), class_="faint")]
    head.append(element("p", found["note"], class_="verdict"))
    return write_text(path, page(title, *head, element("nav", *links), *parts, _foot()))


def _head(table: DataFrame, about: dict[str, Any]) -> str:
    design = about.get("design") or {}
    method = design.get("method", "a table of its own")
    cases, varied = plural(len(table), "case"), plural(len(parameters_of(table)), "parameter")
    return f"{cases} of {varied}, sampling: {method}."


def _outputs(table: DataFrame, found: dict[str, Any], names: list[str]) -> Iterator[Element]:
    units = table.attrs.get("units", {})
    yield tables.summary(found, names, units)
    if found["extremes"]:
        yield element("h3", "Smallest and largest")
        yield tables.extremes(found, names, units)
    if any("percentiles" in found["outputs"][name] for name in names):
        yield element("h3", "Percentiles")
        yield tables.percentiles(found, names, units)
        text = (
            "Below each percentile its 95 % confidence interval, from the order of the values alone; "
            "an end is open where there are too few cases."
        )
        yield element("p", text, class_="faint")


def _of_output(table: DataFrame, found: dict[str, Any], name: str) -> Element:
    pieces: list[Element] = []
    for key, kind in FIGURES.items():
        if kind.shown(table, found, name):
            svg = picture(key, table, found, name)
            pieces.append(figure(f"{key}-{_slug(name)}", kind.title, kind.caption, svg))
    for method in ("saltelli", "morris"):
        if found.get(method, {}).get(name, {}).get("indices"):
            pieces.append(tables.indices(found[method][name], method))
    if not pieces:
        pieces.append(element("p", "The same in all cases.", class_="faint"))
    return section(name, f"output-{_slug(name)}", *pieces)


def _varied(table: DataFrame, about: dict[str, Any]) -> Iterator[Element]:
    design = about.get("design") or {}
    if design.get("parameters"):
        yield element("h3", "Parameters")
        yield tables.varied(table, design)
    yield folded("Columns of table.csv", tables.columns(table, is_drawn(design.get("method", ""))))


def _slug(name: str) -> str:
    return "".join(c if c.isalnum() else "-" for c in name)


def _foot() -> Element:
    day = datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d %H:%M UTC")
    return element("p", f"ancf {__version__}, {day}", class_="faint")
