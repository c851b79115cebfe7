"""Two panels over the number of elements: a displacement, and how far it is from the finest mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..viz import style
from .curves import line_of, points_of
from .table import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SIZE = (120.0, 64.0)  # mm

#: Marker of each displacement in the second panel.
MARKERS = ("o", "v")


def draw(table: Table, figure: Figure, shown: str, label: str, distances: dict[str, str]) -> None:
    """Draw both panels.

    Parameters
    ----------
    table : Table
        With the columns ``element``, ``elements``, `shown` and those of `distances`.
    figure : Figure
        Empty.
    shown : str
        Column of the first panel.
    label : str
        Its axis.
    distances : dict
        Columns of the second panel, at most two, and what the legend calls them.

    """
    left, right = figure.subplots(1, 2)
    counts = [int(n) for n in np.unique(table.values("elements"))]
    for element in table.kinds():
        n = table.values("elements", element=element)
        left.plot(n, table.values(shown, element=element), **points_of(element))
        for marker, (column, name) in zip(MARKERS, distances.items(), strict=False):
            _distance(right, table, element, column, {"marker": marker, "label": name})
    left.set_ylabel(label)
    right.set_ylabel(f"distance to {counts[-1]} elements [m]")
    right.set_yscale("log")
    for axes, name in ((left, "a"), (right, "b")):
        style.counts_on_x(axes, counts)
        style.panel_name(axes, name)
    _legend(figure, left, right)


def _distance(axes: Axes, table: Table, element: str, column: str, look: dict[str, Any]) -> None:
    n, u = table.values("elements", element=element), table.values(column, element=element)
    if look["marker"] != MARKERS[0]:
        look = {**look, "markerfacecolor": "white"}
    axes.plot(n[:-1], np.abs(u[:-1] - u[-1]), **line_of(element), **look)


def _legend(figure: Figure, left: Axes, right: Axes) -> None:
    """Elements for the first panel, displacements for the second one, above each."""
    for axes in (left, right):
        handles, labels = axes.get_legend_handles_labels()
        unique = dict(zip(labels, handles, strict=True))
        axes.legend(
            unique.values(), unique.keys(), loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=len(unique)
        )
