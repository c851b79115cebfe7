"""Closed forms: what formulas give, beside what the package computes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..viz import style
from .check import Check
from .closed import rigid, statics, vibration
from .curves import LOOKS
from .table import Table

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .closed.case import Case

TITLE = "Closed forms: statics, vibration, rigid bodies"
EXAMPLE = ""
CLAIM = (
    "Not in the paper. Deflections, cable shapes and tensions, frequencies and motions of rigid bodies "
    "beside their formulas: what is left is the error of the mesh or the step."
)
COLUMNS = ("name", "element", "value", "reference", "deviation", "tolerance", "unit", "origin")
SIZE = (170.0, 158.0)  # mm
LOWEST, HIGHEST = 1e-12, 3e-2  # of the axis: smaller deviations are round-off
#: Marker and colour of numbers without an element.
BODY = {"color": style.GREY, "marker": "D"}

NOTES = [
    "deviation: value over reference, less one; tolerance: the largest one that is accepted.",
    'Cables: strain measures "material", EA = 1e5 N, EI = 3 N m^2, rhoA = 0.6 kg/m, 2 m, 2 to 64 elements '
    "as the case needs; the hanging cables 10.5 m on a span of 10 m, 80 elements.",
    "Nonlocking beams: 2 m, square section of 0.1 m, E = 1e9 N/m^2, nu = 0.3, 1000 kg/m^3, 4 or 16 elements; "
    "torsion includes the package's correction for warping of rectangles.",
    "Rings: the same beams with heights of 0.02 and 0.04 m and 64 (nonlocking) or 256 (original) elements.",
    "Rigid bodies: trapezoidal rule, step 0.5 ms.",
]


def data(short: bool = False) -> Table:
    """All cases; the short form leaves out the rigid bodies, which take the longest to compile."""
    found = [*statics.cases(), *vibration.cases(), *([] if short else rigid.cases())]
    return table_of("closed-forms", found, NOTES)


def table_of(name: str, found: Sequence[Case], notes: Sequence[str]) -> Table:
    """Cases as the table of an exhibit."""
    rows = [
        (c.name, c.element, c.value, c.reference, c.value / c.reference - 1.0, c.tolerance, c.unit, c.origin)
        for c in found
    ]
    return Table(name, COLUMNS, [*rows], [*notes])


def checks(table: Table) -> list[Check]:
    """Each number within its share of the formula's."""
    rows = [dict(zip(COLUMNS, row, strict=True)) for row in table.rows]
    return [_check(row) for row in rows]


def draw(table: Table, figure: Figure) -> None:
    """Relative deviations on a logarithmic axis; a bar marks what is accepted."""
    axes = figure.subplots()
    y = np.arange(len(table.rows))
    axes.vlines(table.values("tolerance"), y - 0.35, y + 0.35, color="black", linewidth=1.2, label="accepted")
    for element in table.kinds():
        _dots(axes, table, element)
    axes.set(xscale="log", xlim=(LOWEST, HIGHEST), xlabel="relative deviation from the closed form")
    axes.set_yticks(y, [str(row[0]) for row in table.rows], fontsize=6.5)
    axes.set_ylim(len(y) - 0.4, -0.6)
    style.legend_above(figure, axes)


def _dots(axes: Axes, table: Table, element: str) -> None:
    """Deviations of an element; round-off stands at the left edge."""
    y = [k for k, row in enumerate(table.rows) if row[1] == element]
    deviation = np.maximum(np.abs(table.values("deviation", element=element)), 1.3 * LOWEST)
    look: dict[str, Any] = BODY
    if element in LOOKS:
        look = {"color": LOOKS[element].color, "marker": LOOKS[element].marker}
    text = element if element in LOOKS else "mass or rigid body"
    axes.plot(deviation, y, linestyle="none", label=text, **look)


def _check(row: dict[str, Any]) -> Check:
    name = f"Closed form, {row['name']}"
    bar = row["tolerance"] * abs(row["reference"])
    return Check(name, row["value"], row["reference"], bar, row["unit"], row["origin"])
