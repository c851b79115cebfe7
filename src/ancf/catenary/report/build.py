"""The report of a run: one HTML file with all figures and tables, which needs nothing else."""

from __future__ import annotations

import datetime
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from ..._version import __version__
from ...files import write_text
from ...viz import style
from ...viz.html import element, figure, page, section
from . import tables
from .content import Content
from .figures import FIGURES, figure_names, picture

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

    from ..elasticity import Elasticity
    from ..references import Reference
    from ..run_data import Run


def write_report(
    run: Run,
    path: str | Path,
    *,
    reference: Reference | None = None,
    elasticity: Elasticity | None = None,
) -> Path:
    """Write the report of a run as one HTML file.

    Parameters
    ----------
    run : Run
    path : path
        File to write; its folder is made when it does not exist.
    reference : Reference, optional
        Published ranges to compare the first table with.
    elasticity : Elasticity, optional
        Static elasticity of the line, shown when given.

    Raises
    ------
    ModelError
        matplotlib is missing, the file cannot be written, or the run does not cover its window.

    """
    style.require_matplotlib()
    return write_text(Path(path), report(Content.of(run, reference, elasticity)))


def report(content: Content) -> str:
    """HTML of the report."""
    run = content.run
    title = f"{run.form.line.title}, {content.speed_kmh:.4g} km/h"
    parts = [*_statistics(content), _figures(content), *_line_tables(content), _computed(content)]
    links = [element("a", str(part[0].text), href=f"#{part.get('id')}") for part in parts]
    return page(title, *_top(content, title), element("nav", *links), *parts, _foot())


def _top(content: Content, title: str) -> Iterator[Element]:
    yield element("h1", title)
    names = ", ".join(unit.title or unit.name for unit in content.run.pantographs)
    head = "Pantographs, the first ahead" if content.several else "Pantograph"
    low, high = content.run.window
    what = f"{head}: {names}. Evaluated from {low:g} m to {high:g} m."
    yield element("p", what, class_="faint")
    if content.reference is None:
        return
    for k in range(len(content.found)):
        yield element("p", _verdict(content, k), class_="verdict")


def _verdict(content: Content, k: int) -> str:
    assert content.reference is not None
    rows = content.compared(k)
    judged = [q for q in rows if q.inside is not None]
    before = f"{content.name(k)}: " if content.several else ""
    if not judged:
        return before + content.reference.note(content.run.speed_kmh) + "."
    outside = [q.name for q in judged if not q.inside]
    found = f"{len(judged) - len(outside)} of {len(judged)} quantities inside the accepted ranges"
    told = f"; outside: {', '.join(outside)}" if outside else ""
    return f"{before}{found}{told}; {content.filter_note(k)}."


def _statistics(content: Content) -> Iterator[Element]:
    for k, found in enumerate(content.found):
        title = f"Statistics, {content.name(k)}" if content.several else "Statistics"
        pieces = []
        if content.reference is not None:
            compared = content.compared(k)
            pieces += [
                element("h3", content.reference.title),
                tables.quantities(compared),
                tables.tags(compared),
            ]
            source = f"Ranges: {content.reference.source}. They are not interpolated between speeds."
            pieces.append(element("p", source, class_="faint"))
        pieces += [
            element("h3", "All quantities"),
            tables.quantities(found.quantities),
            tables.tags(found.quantities),
        ]
        pieces.append(element("p", _remarks(content), class_="faint"))
        yield section(title, f"statistics-{k + 1}", *pieces)


def _remarks(content: Content) -> str:
    filtered = f"Forces and heights are filtered over the whole record ({content.found[0].filter.text})"
    return (
        f"{filtered} and then cut to the window, unless they say unfiltered. Contact is lost, and a dropper "
        "slack, while its force is zero, unfiltered. Uplift: the largest at the supports of the window, its "
        "ends included, while the pantograph passes. Dropper forces: those of the window while the "
        "pantograph is in it."
    )


def _figures(content: Content) -> Element:
    made = [
        figure(n, FIGURES[n].title, FIGURES[n].caption, picture(n, content)) for n in figure_names(content)
    ]
    return section("Figures", "figures", *made)


def _line_tables(content: Content) -> Iterator[Element]:
    if content.elasticity is not None:
        title = f"Static elasticity of span {content.elasticity.span + 1}"
        yield section(title, "elasticity", tables.elasticity(content))
    yield section("Uplift at the supports", "supports", tables.supports(content))
    for k in range(len(content.found)):
        title = "Droppers in the window" + (f", {content.name(k)}" if content.several else "")
        yield section(title, f"droppers-{k + 1}", tables.droppers(content, k))


def _computed(content: Content) -> Element:
    pantographs: list[Element] = []
    for k in range(len(content.found)):
        title = f"Pantograph: {content.name(k)}" if content.several else "Pantograph"
        pantographs += [element("h3", title), tables.pantograph_data(content, k)]
    pieces = [
        element("h3", "Run"),
        tables.run_data(content),
        element("h3", "Line"),
        tables.line_data(content),
        *pantographs,
        element("h3", "Dropper schedule"),
        tables.schedule(content),
    ]
    return section("Data", "data", *pieces)


def _foot() -> Element:
    day = datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d %H:%M UTC")
    return element("p", f"ancf {__version__}, {day}", class_="faint")
