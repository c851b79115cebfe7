"""Three panels over the number of elements: a displacement, and how far two are from the finest mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..arrays import FloatArray
from ..viz import style
from .curves import points_of
from .kinds import NONLOCKING, ORIGINAL
from .table import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SIZE = (170.0, 66.0)  # mm

NOTE = (
    "The distances in the picture are from the finest mesh of the same element; the original element, still "
    "far from its limit there, is compared with the finest mesh of the nonlocking one: the same body and the "
    "same strains, hence the same limit."
)


def draw(table: Table, figure: Figure, shown: tuple[str, str], distances: dict[str, str]) -> None:
    """Draw the panels.

    Parameters
    ----------
    table : Table
        With the columns ``element``, ``elements`` and those that follow.
    figure : Figure
        Empty.
    shown : (str, str)
        Column of the first panel and its axis.
    distances : dict
        Columns of the other two panels and what they are called.

    """
    panels = figure.subplots(1, 3)
    counts = [int(n) for n in np.unique(table.values("elements"))]
    for element in table.kinds():
        n = table.values("elements", element=element)
        panels[0].plot(n, table.values(shown[0], element=element), **points_of(element))
        for axes, column in zip(panels[1:], distances, strict=True):
            far = distance(table, element, column)
            axes.plot(n[: far.size], far, **points_of(element))
    panels[0].set_ylabel(shown[1])
    for axes, name in zip(panels[1:], distances.values(), strict=True):
        axes.set(yscale="log", ylabel=f"distance to {counts[-1]} el. [m]", title=name)
    for axes, name in zip(panels, "abc", strict=True):
        style.counts_on_x(axes, counts)
        style.panel_name(axes, name)
    style.legend_above(figure, panels[0])


def distance(table: Table, element: str, column: str) -> FloatArray:
    """Distances of a displacement from the finest mesh, which is left out where it is its own."""
    u = table.values(column, element=element)
    if element == ORIGINAL and NONLOCKING in table.kinds():
        far: FloatArray = np.abs(u - table.values(column, element=NONLOCKING)[-1])
        return far
    own: FloatArray = np.abs(u[:-1] - u[-1])
    return own
