"""The dropper schedule: what droppers are cut and hung by."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Protocol

from ...arrays import FloatArray
from ...files import writing
from ..lines.line import Line
from ..lines.route import Route


@dataclass(frozen=True, slots=True)
class LongRow:
    """One dropper, whatever wires it is between.

    Attributes
    ----------
    span, dropper : int
        Counted from 1.
    position : float, m
        From the start of the span.
    track : float, m
        From the first support.
    length : float, mm
        From clamp to clamp, hanging under its load.
    natural : float, mm
        From clamp to clamp, unstretched at the temperature of the design: what is cut.
    load : float, N
        Tension at the lower end, without the dropper's own weight.

    """

    span: int
    dropper: int
    position: float
    track: float
    length: float
    natural: float
    load: float


@dataclass(frozen=True, slots=True)
class Row(LongRow):
    """One dropper to the contact wire, which hangs with its load.

    Attributes
    ----------
    contact_height, messenger_height : float, mm
        Of the wires there, over the nominal height of the contact wire.

    """

    contact_height: float
    messenger_height: float


#: Heads of the columns of the CSV file, in the order of the fields.
LONG_COLUMNS = ("span", "dropper", "position_m", "track_m", "length_mm", "natural_length_mm", "load_N")
COLUMNS = (*LONG_COLUMNS, "contact_height_mm", "messenger_height_mm")
DECIMALS = (0, 0, 3, 3, 1, 1, 1, 1, 1)


class Formed(Protocol):
    """What a form has; arrays in the order of the droppers along the track."""

    @property
    def line(self) -> Line | Route:
        """The line."""
        ...

    @property
    def dropper_length(self) -> FloatArray:
        """From clamp to clamp, m."""
        ...

    @property
    def cut_length(self) -> FloatArray:
        """The same without force at the temperature of the design, m."""
        ...

    @property
    def dropper_load(self) -> FloatArray:
        """Tension at the lower end, N."""
        ...

    @property
    def contact_height(self) -> FloatArray:
        """Height of the contact wire, m."""
        ...

    @property
    def messenger_height(self) -> FloatArray:
        """Height of the messenger wire, m."""
        ...


def rows(form: Formed) -> list[Row]:
    """Rows in the order of the droppers along the track."""
    line = form.line
    places = [x for part in line.parts for span in part.spans for x in span.droppers for _ in _wires(part)]
    return [
        Row(
            span=int(line.dropper_span[j]) + 1,
            dropper=int(line.dropper_number[j]) + 1,
            position=places[j],
            track=float(line.dropper_x[j]),
            length=1e3 * float(form.dropper_length[j]),
            natural=1e3 * float(form.cut_length[j]),
            load=float(form.dropper_load[j]),
            contact_height=1e3 * float(form.contact_height[j]),
            messenger_height=1e3 * float(form.messenger_height[j]),
        )
        for j in range(line.dropper_x.size)
    ]


def _wires(part: Line) -> range:
    """The contact wires of a tension length."""
    return range(part.contact_wires)


def texts(row: Any) -> list[str]:
    """A row as it is printed and written; one of fewer columns ends with the first ones of them."""
    values = [getattr(row, item.name) for item in fields(row)]
    return [f"{round(value, n) + 0.0:.{n}f}" for value, n in zip(values, DECIMALS, strict=False)]


def write(schedule: list[Row], path: Path) -> Path:
    """Write a schedule as CSV; ModelError if the file cannot be written."""
    return write_rows([texts(row) for row in schedule], COLUMNS, path)


def write_rows(rows: Iterable[Sequence[str]], columns: Sequence[str], path: Path) -> Path:
    """Write a table as CSV; ModelError if the file cannot be written."""
    with writing(path), path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(rows)
    return path
