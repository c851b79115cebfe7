"""What distinguishes the curves of a figure: kind of element, number of elements, how they are drawn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..viz import style


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


#: Colour, line and marker of each kind of element.
LOOKS: dict[str, tuple[str, str, str]] = {
    "cable": (style.BLUE, "-", "o"),
    "nonlocking": (style.ORANGE, "--", "s"),
    "original": (style.GREEN, "-.", "^"),
}


def counted(number: int, noun: str) -> str:
    """Return "1 element", "2 elements"."""
    return f"{number} {noun}" + ("" if number == 1 else "s")


def line_of(element: str) -> dict[str, Any]:
    """Colour and line of a kind of element."""
    color, line, _ = LOOKS[element]
    return {"color": color, "linestyle": line}


def points_of(element: str) -> dict[str, Any]:
    """Colour, line, marker and label of a kind of element, for curves of a few computed points."""
    return {**line_of(element), "marker": LOOKS[element][2], "label": element}
