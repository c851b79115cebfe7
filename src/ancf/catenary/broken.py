"""Broken droppers: which of a line are meant, and which of its model are gone."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..errors import ModelError
from ..model import checks

if TYPE_CHECKING:
    from .assemble import Assembled
    from .lines.line import Line
    from .lines.route import Route


def labels(line: Line | Route) -> list[str]:
    """Span and number of each dropper, both from 1: "8-3"."""
    pairs = zip(line.dropper_span, line.dropper_number, strict=True)
    return [f"{span + 1}-{number + 1}" for span, number in pairs]


def place_of(line: Line | Route, label: Any, where: str) -> int:
    """Place among the droppers of a line of one such as "6-1"."""
    known = labels(line)
    if label in known:
        return known.index(label)
    span = str(label).partition("-")[0]
    beside = [one for one in known if one.startswith(f"{span}-")]
    hint = checks.nearest(str(label), known)
    if beside:
        hint = f"span {span} has the droppers {beside[0]} to {beside[-1]}"
    elif span.isdigit():
        hint = f"the line has {len(line.spans)} spans: a dropper is its span and its number there, from 1"
    raise ModelError(where, f"there is no dropper {checks.shown(label)}", hint)


def chosen(line: Line | Route, given: Any, where: str) -> tuple[tuple[int, int], ...]:
    """Span and number, both from 1, of droppers of which the labels are given.

    Raises
    ------
    ModelError
        There is no such dropper, or one is given twice.

    """
    if isinstance(given, str) or not isinstance(given, Sequence):
        raise ModelError(where, f"must be labels of droppers, is {checks.shown(given)}", 'such as ["8-3"]')
    found: list[tuple[int, int]] = []
    for label in given:
        j = place_of(line, label, where)
        pair = int(line.dropper_span[j]) + 1, int(line.dropper_number[j]) + 1
        if pair in found:
            raise ModelError(where, f"dropper {label} is given twice")
        found.append(pair)
    return tuple(found)


def broken_of(overhead: Assembled) -> tuple[str, ...]:
    """Labels of the droppers that a model no longer has."""
    known = labels(overhead.form.line)
    return tuple(label for label, spring in zip(known, overhead.droppers, strict=True) if spring is None)


def told(broken: Sequence[str]) -> str:
    """In words: "broken droppers 8-3, 8-4"; nothing where all are whole."""
    if not broken:
        return ""
    return f"broken dropper{'s' if len(broken) > 1 else ''} {', '.join(broken)}"
