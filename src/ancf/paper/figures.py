"""The figures that can be reproduced, by name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Protocol, cast

from . import fig1, fig2, fig3, fig4, fig5, fig6, fig7, fig8, fig9, fig10, fig11, fig12, fig13, fig14, table2
from .table import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class FigureModule(Protocol):
    """What a figure's module offers: its size in mm, its numbers and its picture."""

    SIZE: tuple[float, float]

    def data(self, short: bool = False) -> Table:
        """Compute the numbers; the short form takes fewer and shorter runs."""

    def draw(self, table: Table, figure: Figure) -> None:
        """Draw the numbers into an empty figure."""


FIGURES: Mapping[str, FigureModule] = {
    name: cast(FigureModule, module)
    for name, module in {
        "fig1": fig1,
        "fig2": fig2,
        "fig3": fig3,
        "fig4": fig4,
        "fig5": fig5,
        "fig6": fig6,
        "fig7": fig7,
        "fig8": fig8,
        "fig9": fig9,
        "fig10": fig10,
        "fig11": fig11,
        "fig12": fig12,
        "fig13": fig13,
        "fig14": fig14,
        "table2": table2,
    }.items()
}
