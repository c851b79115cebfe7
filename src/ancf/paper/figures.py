"""The figures and tables that can be reproduced, and exhibits beyond the paper, by name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Protocol, cast

from . import (
    closed_forms,
    connections,
    derivatives,
    en50318,
    fig1,
    fig2,
    fig3,
    fig4,
    fig5,
    fig6,
    fig7,
    fig8,
    fig9,
    fig10,
    fig11,
    fig12,
    fig13,
    fig14,
    orders,
    overhead_numbers,
    table2,
)
from .check import Check
from .table import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class FigureModule(Protocol):
    """What the module of a figure, a table or another exhibit offers.

    ``TITLE`` has its number and what it shows, ``EXAMPLE`` the number of the paper's example ("" for none),
    ``CLAIM`` what the paper says of it, or what it verifies where it is not of the paper. ``SIZE`` is in mm.
    """

    TITLE: str
    EXAMPLE: str
    CLAIM: str
    SIZE: tuple[float, float]

    def data(self, short: bool = False) -> Table:
        """Compute the numbers; the short form takes fewer and shorter runs."""

    def draw(self, table: Table, figure: Figure) -> None:
        """Draw the numbers into an empty figure."""

    def checks(self, table: Table) -> list[Check]:
        """Judge the numbers; what the short form has no rows for is left out."""


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
        "closed-forms": closed_forms,
        "connections": connections,
        "orders": orders,
        "derivatives": derivatives,
        "overhead": overhead_numbers,
        "en50318": en50318,
    }.items()
}
