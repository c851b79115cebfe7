"""Tables of the page: all exhibits, the checks of one, misprints, settings."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from ...viz.html import element, pairs, table
from ..entry import use_of_tolerance
from . import numbers
from .errata import errata
from .machine import machine, now

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

    from ..check import Check
    from ..entry import Entry, Reproduction

#: Sign and class of each verdict; the word stands beside them.
SIGNS = {"passed": ("✓", "pass"), "failed": ("✗", "fail"), "error": ("✗", "fail"), "no check": ("–", "faint")}
CHECK_HEAD = ("check", "verdict", "ours", "reference", "unit", "deviation", "tolerance", "used", "origin")
LETTERS = "abcdefghijklmnopqrstuvwxyz"


def verdict(word: str) -> Element:
    """A verdict as sign, word and colour."""
    sign, kind = SIGNS[word]
    return element("span", f"{sign} {word}", class_=kind)


def overview(entries: Iterable[Entry]) -> Element:
    """One row for each exhibit."""
    head = ("exhibit", "shows", "verdict", "checks", "tolerance used", "run time", "files")
    rows = list(entries)
    made = table(head, map(_overview_texts, rows), numbers=(3, 4, 5), class_="overview")
    for entry, row in zip(rows, next(made.iter("tbody")), strict=True):
        row[0].append(element("a", entry.name, href=f"#{entry.name}"))
        row[2].append(verdict(entry.verdict))
        row[6].extend(links(entry))
    return made


def _overview_texts(entry: Entry) -> tuple[str, ...]:
    count, time = len(entry.checks), numbers.duration(entry.seconds)
    passed = f"{count - len(entry.failed)} of {count}" if count else ""
    return "", entry.title, "", passed, numbers.share(entry.largest_use), time, ""


def links(entry: Entry) -> list[Element]:
    """Links to the files of an exhibit, which lie beside the page."""
    return [element("a", _kind(path), href=path.name, class_="file") for path in entry.files]


def checks(entry: Entry) -> list[Element]:
    """The checks of an exhibit, and where their references come from."""
    origins = list(dict.fromkeys(check.origin for check in entry.checks))
    marks = {origin: _mark(k) for k, origin in enumerate(origins)}
    rows = [_check_texts(check, marks[check.origin]) for check in entry.checks]
    made = table(CHECK_HEAD, rows, numbers=(2, 3, 5, 6, 7), class_="checks")
    for check, row in zip(entry.checks, next(made.iter("tbody")), strict=True):
        row[1].append(verdict("passed" if check.passed else "failed"))
        if not check.passed:
            row.set("class", "failed")
        row[7].set("style", _bar(check))
    lines = [
        element("li", element("span", mark, class_="mark"), f" {origin}") for origin, mark in marks.items()
    ]
    return [
        made,
        element("p", "Origin of the references:", class_="faint"),
        element("ul", *lines, class_="origins"),
    ]


def misprints() -> Element:
    """Misprints and gaps of the paper, and what was taken."""
    rows = [(e.where, e.kind, e.printed, e.taken) for e in errata()]
    return table(("where", "kind", "in the paper", "taken, and why"), rows, class_="errata")


def computed(made: Reproduction) -> Element:
    """Form, processes, time, versions and machine."""
    form = "quick: fewer and shorter runs" if made.quick else "full"
    total = sum(entry.cpu_seconds for entry in made.entries)
    rows = [
        ("form", form),
        ("date", now()),
        ("processes", str(made.jobs)),
        ("run time", f"{numbers.duration(made.seconds)}, {numbers.duration(total)} of processor time"),
    ]
    return pairs([*rows, *((name, str(value)) for name, value in machine().items())])


def _check_texts(check: Check, mark: str) -> tuple[str, ...]:
    texts = (numbers.value(check), numbers.reference(check), check.unit, numbers.deviation(check))
    return check.name, "", *texts, numbers.tolerance(check), numbers.share(use_of_tolerance(check)), mark


def _bar(check: Check) -> str:
    """Style of a cell that is filled as far as the tolerance is used."""
    width = 100.0 * min(use_of_tolerance(check), 1.0)
    return f"background: linear-gradient(to right, var(--fill) {width:.1f}%, transparent 0)"


def _kind(path: Path) -> str:
    return path.suffix.removeprefix(".").upper()


def _mark(k: int) -> str:
    return f"({LETTERS[k]})" if k < len(LETTERS) else f"({k + 1})"
