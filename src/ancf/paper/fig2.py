"""Fig. 2: tip of the cantilever (7.1) at 0.4 s against the number of elements."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import cantilever, convergence, kinds
from .curves import counted
from .table import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

KINDS = kinds.KINDS
COUNTS, SHORT_COUNTS = (1, 2, 4, 8, 16, 32, 64), (1, 2, 4)
COLUMNS = ("element", "elements", "tip_x", "tip_z")
SIZE = convergence.SIZE


def data(short: bool = False) -> Table:
    """Tip position at 0.4 s, m; z is the vertical."""
    counts = SHORT_COUNTS if short else COUNTS
    rows = [_row(element, n) for element in KINDS for n in counts]
    measured = [
        f"Measured, {e}, {counted(n, 'element')}: tip at ({x:.7f}, {z:.7f}) m." for e, n, x, z in rows
    ]
    return Table("fig2", COLUMNS, [*rows], [*cantilever.NOTES, convergence.NOTE, *measured])


def draw(table: Table, figure: Figure) -> None:
    """Vertical displacement, and how far both are from the finest mesh."""
    names = {"tip_z": "vertical", "tip_x": "horizontal"}
    convergence.draw(table, figure, ("tip_z", "vertical tip displacement [m]"), names)


def _row(element: str, elements: int) -> tuple[str, int, float, float]:
    result = cantilever.run(cantilever.build(elements, element=element))
    x, _, z = result.position("beam.end")[-1].tolist()
    return element, elements, x, z
