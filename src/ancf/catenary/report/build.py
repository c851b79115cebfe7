"""The report of a run: one HTML file with all figures and tables, which needs nothing else, PDF and DOCX."""

from __future__ import annotations

import datetime
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..._version import __version__
from ...errors import ModelError
from ...files import write_text, writing
from ...model import checks
from ...viz import printed, style
from ...viz.html import element, figure, page, section
from ..answers.acceptance import acceptance, footnote, verdict
from ..answers.clamp_strain import strained
from ..answers.state import at_rest, state, titled
from ..broken import told as broken
from . import measured as measuring
from . import tables
from .content import Content
from .figures import FIGURES, Save, figure_names, picture

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

    from ..answers.measuring import Measured
    from ..answers.quantity import Quantity
    from ..answers.references import Reference
    from ..answers.run_data import Run
    from ..elasticity import Elasticity


def write_report(
    run: Run,
    path: str | Path,
    *,
    reference: Reference | None = None,
    elasticity: Elasticity | None = None,
    measured: Sequence[Measured] = (),
) -> Path:
    """Write the report of a run as one file, in the format that its name ends with.

    Parameters
    ----------
    run : Run
    path : path
        File to write, ``.html``, ``.pdf`` or ``.docx``; its folder is made when it does not exist.
    reference : Reference, optional
        Published ranges to compare the first table with.
    elasticity : Elasticity, optional
        Static elasticity of the line, shown when given.
    measured : sequence of Measured
        What measuring pantographs would have shown, one for each, see :func:`measure`; shown when given.

    Raises
    ------
    ModelError
        matplotlib or what writes the format is missing, the file cannot be written, or the run does not
        cover its window.

    """
    path = checks.path(path, "write_report.path")
    kind = path.suffix.removeprefix(".")
    paper = kind in printed.FORMATS
    if not paper and kind not in (printed.HTML, "htm", ""):
        formats_there = ", ".join((printed.HTML, *printed.FORMATS))
        raise ModelError(str(path), f"ends with .{kind}", f"reports are {formats_there}")
    formats = printed.chosen([kind], str(path)) if paper else (printed.HTML,)
    return _write(Content.of(run, reference, elasticity, measured), [(formats[0], path)])[0]


def write_reports(
    run: Run,
    folder: Path,
    formats: Sequence[str],
    *,
    reference: Reference | None = None,
    elasticity: Elasticity | None = None,
    measured: Sequence[Measured] = (),
) -> list[Path]:
    """Write ``report.html``, ``report.pdf`` and ``report.docx``, those that are asked for, into a folder."""
    content = Content.of(run, reference, elasticity, measured)
    return _write(content, [(kind, folder / f"report.{kind}") for kind in formats])


def _write(content: Content, files: Sequence[tuple[str, Path]]) -> list[Path]:
    style.require_matplotlib()
    for _, path in files:
        with writing(path):  # said before the figures are drawn
            pass
    title = f"{titled(content.run.form.line)}, {content.speed_kmh:.4g} km/h"
    on_paper: list[Element] = []
    for kind, path in files:
        if kind == printed.HTML:
            write_text(path, page(title, *pieces(content, title)))
            continue
        on_paper = on_paper or pieces(content, title, style.png)
        printed.write_printed(path, title, on_paper)
    return [path for _, path in files]


def pieces(content: Content, title: str, save: Save = style.svg) -> list[Element]:
    """Elements of the report, its pictures as SVG or PNG."""
    lists = [] if content.reference is not None else accepted(content)
    judged = [_acceptance(content, lists)] if lists else []
    answers = [*_statistics(content), *_measured(content), _figures(content, save), *_line_tables(content)]
    parts = [*judged, *answers, _computed(content)]
    links = [element("a", str(part[0].text), href=f"#{part.get('id')}") for part in parts]
    return [*_top(content, title, lists), element("nav", *links), *parts, _foot()]


def accepted(content: Content) -> list[list[Quantity]]:
    """What the standards ask for, a list for each pantograph."""
    return [acceptance(content.run, k, found=one) for k, one in enumerate(content.found)]


def _top(content: Content, title: str, lists: Sequence[Sequence[Quantity]]) -> Iterator[Element]:
    yield element("h1", title)
    names = ", ".join(unit.title or unit.name for unit in content.run.pantographs)
    head = [f"{_capital(key)}: {value}" for key, value in content.run.form.line.report.items() if value]
    if head:
        yield element("p", ". ".join(head) + ".")
    units = "Pantographs, the first ahead" if content.several else "Pantograph"
    low, high = content.run.window
    what = f"{units}: {names}. Evaluated from {low:g} m to {high:g} m."
    yield element("p", what, class_="faint")
    found = content.run.form
    yield element("p", f"State: {state(found.line)}; at rest {at_rest(found)}.", class_="faint")
    if content.run.broken_droppers:
        yield element(
            "p", f"{_capital(broken(content.run.broken_droppers))}: left out of slack and extremes."
        )
    if content.reference is None:
        for name, one in zip(content.names, lists, strict=True):
            told = f"{name}: {verdict(one)}" if content.several else _capital(verdict(one))
            yield _box(f"{told} of EN 50367, EN 50119 and practice.", one)
        return
    for k in range(len(content.found)):
        yield _box(_verdict(content, k), content.compared(k))


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _box(text: str, rows: Sequence[Quantity]) -> Element:
    """A verdict in the colour of inside or outside, or of neither where nothing is judged."""
    judged = [q.inside for q in rows if q.inside is not None]
    tone = "" if not judged else " inside" if all(judged) else " outside"
    return element("p", text, class_=f"verdict{tone}")


def _verdict(content: Content, k: int) -> str:
    assert content.reference is not None
    judged = [q for q in content.compared(k) if q.inside is not None]
    before = f"{content.name(k)}: " if content.several else ""
    if not judged:
        return before + content.reference.note(content.run.speed_kmh) + "."
    outside = [q.name for q in judged if not q.inside]
    found = f"{len(judged) - len(outside)} of {len(judged)} quantities inside the accepted ranges"
    told = f"; outside: {', '.join(outside)}" if outside else ""
    return f"{before}{found}{told}; {content.filter_note(k)}."


def _acceptance(content: Content, lists: Sequence[Sequence[Quantity]]) -> Element:
    """What the standards ask for, of all pantographs side by side."""
    limits = (
        "Limits of EN 50367, EN 50119 and the TSI Energy for AC 25 kV, and the bending strain of contact "
        "wires that RTRI allows (Quarterly Report 66 (2025) 84-89)."
    )
    notes = dict.fromkeys(filter(None, map(footnote, content.found)))
    return section(
        "Acceptance",
        "acceptance",
        tables.beside(content.names, lists),
        tables.tags([q for one in lists for q in one]),
        element("p", limits, class_="faint"),
        *(element("p", text, class_="faint") for text in notes),
        element("h3", "Time above a force, % of the time evaluated"),
        tables.times_above(content),
    )


def _statistics(content: Content) -> Iterator[Element]:
    for k in range(len(content.found) if content.reference is not None else 0):
        assert content.reference is not None
        compared = content.compared(k)
        source = f"Ranges: {content.reference.source}. They are not interpolated between speeds."
        yield section(
            f"Statistics, {content.name(k)}" if content.several else "Statistics",
            f"statistics-{k + 1}",
            element("h3", content.reference.title),
            tables.quantities(compared),
            tables.tags(compared),
            element("p", source, class_="faint"),
        )
    yield section(
        "All quantities",
        "statistics",
        tables.beside(content.names, [found.quantities for found in content.found]),
        tables.tags([q for found in content.found for q in found.quantities]),
        element("p", _remarks(content), class_="faint"),
    )


def _remarks(content: Content) -> str:
    filtered = f"Forces and heights are filtered over the whole record ({content.found[0].filter.text})"
    return (
        f"{filtered} and then cut to the window, unless they say unfiltered. Contact is lost, and a dropper "
        "slack, while its force is zero, unfiltered. Uplift: the largest at the supports of the window, its "
        "ends included, while the pantograph passes. Dropper forces: those of the window while the "
        "pantograph is in it."
    )


def _measured(content: Content) -> Iterator[Element]:
    if content.measured:
        text = (
            "What sensors of a measuring pantograph after EN 50317 would have shown: forces below the strip, "
            "corrected for the inertia of what is above them and for the wind on it."
        )
        title = "Measured beside the true force"
        yield section(title, "measured", measuring.numbers(content), element("p", text, class_="faint"))


def _figures(content: Content, save: Save) -> Element:
    made = [
        figure(n, FIGURES[n].title, FIGURES[n].caption, picture(n, content, save))
        for n in figure_names(content)
    ]
    return section("Figures", "figures", *made)


def _line_tables(content: Content) -> Iterator[Element]:
    low, high = content.run.window
    if content.elasticity is not None:
        title = f"Static elasticity of span {content.elasticity.span + 1}"
        gone = "Of the line with all its droppers." if content.run.broken_droppers else ""
        yield section(title, "elasticity", tables.elasticity(content), element("p", gone, class_="faint"))
    yield section("Loads and uplift at the supports", "supports", tables.supports(content))
    for k in range(len(content.found)):
        title = "Droppers in the window" + (f", {content.name(k)}" if content.several else "")
        yield section(title, f"droppers-{k + 1}", tables.droppers(content, k))
    if strained(content.run) and any(low <= x <= high for x in content.run.form.line.dropper_x):
        yield section("Cycles of clamps and droppers", "cycles", tables.clamps(content), *_of_cycles())


def _of_cycles() -> Iterator[Element]:
    text = (
        "Strain of the upper edge of the contact wire by bending at the clamps of the window, over the whole "
        "run with all pantographs, from the forces of droppers and strips by the closed form of a beam under "
        "tension. Cycles by rainflow (ASTM E1049)."
    )
    yield element("p", text, class_="faint")


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
