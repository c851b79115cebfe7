"""What distinguishes the curves of a figure: kind of element, number of elements, how they are drawn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..viz import style
from .table import Table, Value

#: Look of each kind of element.
LOOKS = dict(zip(("cable", "nonlocking", "original"), style.LOOKS, strict=False))


@dataclass(frozen=True, slots=True)
class Curve:
    """One curve over time.

    Parameters
    ----------
    element : str
        Kind of element.
    elements : int
        Number of elements.
    reference : bool
        A converged solution, drawn behind the others.

    """

    element: str
    elements: int
    reference: bool = False

    @property
    def label(self) -> str:
        """Text of the legend."""
        return f"{self.element}, {counted(self.elements, 'element')}"

    @property
    def look(self) -> dict[str, Any]:
        """Arguments of ``Axes.plot``: a wide grey band for a reference, a thin line otherwise."""
        if self.reference:
            return {"color": style.LIGHT, "linewidth": 3.0, "label": self.label}
        return {**line_of(self.element), "label": self.label}

    @property
    def head(self) -> tuple[str, int]:
        """First columns of its rows."""
        return self.element, self.elements

    def values(self, table: Table, *columns: str) -> list[Any]:
        """Columns of its rows."""
        only: dict[str, Value] = {"element": self.element, "elements": self.elements}
        return [table.values(column, **only) for column in columns]


def counted(number: int, noun: str) -> str:
    """Return "1 element", "2 elements"."""
    return f"{number} {noun}" + ("" if number == 1 else "s")


def look_of(element: str) -> style.Look:
    """Colour, line and marker of a kind of element."""
    return LOOKS[element]


def line_of(element: str) -> dict[str, Any]:
    """Colour and line of a kind of element."""
    look = LOOKS[element]
    return {"color": look.color, "linestyle": look.line}


def points_of(element: str) -> dict[str, Any]:
    """Colour, line, marker and label of a kind of element, for curves of a few computed points."""
    return {**line_of(element), "marker": LOOKS[element].marker, "label": element}
