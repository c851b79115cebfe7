"""The page of a reproduction: every exhibit beside what the paper says of it, with its checks."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from ...viz.html import element, folded, framed, page, section
from . import numbers, tables

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

    from ..entry import Entry, Reproduction

TITLE = "The paper, recomputed"
PAPER = (
    "J. Gerstmayr, A. A. Shabana: Analysis of thin beams and cables using the absolute nodal co-ordinate "
    "formulation. Nonlinear Dynamics 45 (2006), 109–130."
)
#: Notes that are longer than this, in characters, are folded; this many of them stay visible.
LONG, SHOWN = 240, 90
MEASURED = "Measured"
#: Pixels of a picture that make one of the page: it is drawn for print.
DENSITY = 1.45


def write_page(made: Reproduction) -> Path:
    """Write ``index.html``; pictures are inside, so that it can be sent alone."""
    made.page.write_text(html(made), encoding="utf-8", errors="xmlcharrefreplace")
    return made.page


def html(made: Reproduction) -> str:
    """The page as text."""
    css = files(__package__).joinpath("report.css").read_text(encoding="utf-8")
    ends = [_misprints(), _computed(made)]
    content = element("div", *_top(made), *map(_exhibit, made.entries), *ends, class_="content")
    return page(TITLE, _navigation(made, ends), content, css=css)


def _navigation(made: Reproduction, ends: list[Element]) -> Element:
    signs = [(entry, *tables.SIGNS[entry.verdict]) for entry in made.entries]
    exhibits = [
        element("a", element("span", sign, class_=kind), f" {entry.name}", href=f"#{entry.name}")
        for entry, sign, kind in signs
    ]
    others = [
        element("a", str(end[0].text).split(",")[0], href=f"#{end.get('id')}", class_="more") for end in ends
    ]
    return element("nav", element("a", "All exhibits", href="#top", class_="more"), *exhibits, *others)


def _top(made: Reproduction) -> Iterator[Element]:
    yield element("h1", TITLE, id="top")
    yield element("p", PAPER, class_="faint")
    sign, kind = tables.SIGNS["passed" if made.passed else "failed"]
    yield element("p", element("strong", f"{sign} {made.verdict}"), ".", class_=f"verdict {kind}")
    yield element("p", _remarks(made))
    yield tables.overview(made.entries)


def _remarks(made: Reproduction) -> str:
    form = "This is the quick form, with fewer and shorter runs. " if made.quick else ""
    used = (
        "Tolerance used: the largest share of its tolerance that a check takes up. Of figures that share "
        "runs, and kernels that had to be compiled, the first one has the time. "
    )
    if made.jobs == 1:
        return form + used
    return (
        f"{form}{used}{made.jobs} processes worked at once: processor times, as in Table 2, may be some per "
        "cent longer than of a run alone."
    )


def _exhibit(entry: Entry) -> Element:
    title = entry.title or entry.name
    pieces = [*_said(entry), *_picture(entry), *_judged(entry), *_notes(entry), _foot(entry)]
    return section(title, entry.name, *pieces)


def _said(entry: Entry) -> Iterator[Element]:
    of_paper = entry.name.startswith(("fig", "table"))
    label = "The paper" if of_paper else "What it verifies"
    if of_paper and entry.example:
        label += f", example {entry.example}"
    yield element("p", element("strong", f"{label}. "), entry.claim, class_="claim")


def _picture(entry: Entry) -> Iterator[Element]:
    path = entry.file("png")
    if path is None:
        return
    content = path.read_bytes()
    width = int.from_bytes(content[16:20], "big") / DENSITY  # of the PNG's header
    yield element("figure", framed(content, "png", entry.title, width))


def _judged(entry: Entry) -> Iterator[Element]:
    if entry.error:
        yield element("p", tables.verdict("error"), f": {entry.error}", class_="verdict fail")
    elif not entry.checks:
        yield element("p", "There is nothing to compare this one with.", class_="faint")
    if entry.checks:
        yield from tables.checks(entry)


def _notes(entry: Entry) -> Iterator[Element]:
    measured = [note for note in entry.notes if note.startswith(MEASURED)]
    others = [note for note in entry.notes if note not in measured]
    if others:
        yield element("h3", "Assumptions and settings")
        yield element("ul", *map(_note, others), class_="notes")
    if measured:
        lines = element("ul", *(element("li", note) for note in measured), class_="notes")
        yield folded(f"Measured numbers ({len(measured)})", lines)


def _note(text: str) -> Element:
    if len(text) <= LONG:
        return element("li", text)
    start = text[:SHOWN].rsplit(" ", 1)[0]
    return element("li", folded(f"{start} …", element("p", f"… {text[len(start) :].strip()}")))


def _foot(entry: Entry) -> Element:
    time = f"Run time {numbers.duration(entry.seconds)}. Files: "
    return element(
        "p", time if entry.files else time.split(" Files")[0], *tables.links(entry), class_="faint"
    )


def _misprints() -> Element:
    return section("Misprints and gaps of the paper, and what was taken", "misprints", tables.misprints())


def _computed(made: Reproduction) -> Element:
    return section("Settings and versions", "machine", tables.computed(made))
