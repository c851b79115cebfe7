"""Fig. 5: y of the pendulum's midpoint (7.2) over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..viz import style
from . import fig4
from .check import Check
from .table import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TITLE = "Fig. 5: sideways motion of the pendulum's midpoint"
EXAMPLE = "7.2"
CLAIM = fig4.CLAIM
COLUMNS = fig4.COLUMNS
SIZE = (110.0, 72.0)  # mm


def data(short: bool = False) -> Table:
    """As Fig. 4."""
    return fig4.renamed(fig4.data(short), "fig5")


def draw(table: Table, figure: Figure) -> None:
    """Y of the midpoint over t."""
    axes = figure.subplots()
    for curve in fig4.CURVES:
        t, y = curve.values(table, "t", "mid_y")
        axes.plot(t, y, **curve.look)
    axes.set(xlabel="$t$ [s]", ylabel="$Y$ of the midpoint [m]", xlim=(0.0, t[-1]))
    axes.locator_params("x", nbins=5)
    style.legend_above(figure, axes, columns=2)


def checks(table: Table) -> list[Check]:
    """Midpoints beside the reference's, at the times that are determinate."""
    return fig4.places(table, "mid")
