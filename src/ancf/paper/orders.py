"""Orders: how fast the errors fall with the element length and with the step."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ..viz import style
from .check import Check
from .curves import LOOKS
from .order_studies import MESH, STEP, Study, studies
from .table import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

TITLE = "Orders of convergence"
EXAMPLE = ""
CLAIM = (
    "Not in the paper. Elements with a cubic axis have order 4 where their section follows it; the original "
    "element, whose section is linear along it, has order 2. The methods of integration have the orders of "
    "their theory."
)
COLUMNS = ("study", "over", "element", "order", "size", "error", "rate")
SIZE = (170.0, 104.0)  # mm
#: How far the last rate may be from the order.
BARS = {MESH: 0.2, STEP: 0.1}
#: Colour, line and marker of the studies over the step, in their order.
STEP_LOOKS = (
    (style.BLUE, "-", "o"),
    (style.ORANGE, "--", "s"),
    (style.GREEN, ":", "^"),
    (style.GREY, "-.", "v"),
    ("black", "-", "D"),
)

NOTES = [
    "rate: logarithm to the base 2 of the ratio of two successive errors, each with half the size of the one "
    "before. Sizes: element length in m, step in s.",
    "Over the element length, relative errors against closed forms: tip of a cable that an end moment bends "
    "to half a circle; third bending frequency of a clamped cable; second frequency of a thick simply "
    "supported beam (Timoshenko).",
    "Over the step: tip of a soft damped cable of three elements that falls for 0.24 s, place and velocity "
    "times 20 ms, in m, against Radau IIA with 3 stages and 0.5 ms.",
]


def data(short: bool = False) -> Table:
    """Errors and rates; the short form has two sizes each."""
    rows = [row for study in studies(short) for row in _rows(study)]
    return Table("orders", COLUMNS, rows, [*NOTES])


def checks(table: Table) -> list[Check]:
    """Rate of the last refinement of each study beside its order."""
    found = []
    for (study, over, element), rows in _grouped(table).items():
        name, (order, rate) = f"Order over the {over}, {element}, {study}", (rows[-1][3], rows[-1][6])
        found.append(Check(name, float(rate), float(order), BARS[over], "", "theory"))
    return found


def draw(table: Table, figure: Figure) -> None:
    """Errors over element length and over step; thin lines have the slopes of theory."""
    panels = figure.subplots(1, 2)
    looks = iter(STEP_LOOKS)
    for (study, over, element), rows in _grouped(table).items():
        axes = panels[0] if over == MESH else panels[1]
        look = _mesh_look(study, element) if over == MESH else _step_look(study, next(looks))
        _curve(axes, rows, look)
    for axes, name, x in zip(panels, "ab", ("element length [m]", "step [ms]"), strict=True):
        axes.set(xscale="log", yscale="log", xlabel=x)
        style.panel_name(axes, name)
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), fontsize=6.5)
        _ticks(axes, table, name)
    panels[0].set_ylabel("relative error")
    panels[1].set_ylabel("error [m]")


def _rows(study: Study) -> list[tuple[Any, ...]]:
    """Rows of a study; the first size has no rate."""
    rates: list[float | None] = [None]
    rates += [math.log2(a / b) for a, b in zip(study.errors, study.errors[1:], strict=False)]
    head = (study.name, study.over, study.element, study.order)
    return [(*head, *row) for row in zip(study.sizes, study.errors, rates, strict=True)]


def _grouped(table: Table) -> dict[tuple[str, str, str], list[tuple[Any, ...]]]:
    """Rows by study, what is refined, and element."""
    found: dict[tuple[str, str, str], list[tuple[Any, ...]]] = {}
    for row in table.rows:
        found.setdefault((str(row[0]), str(row[1]), str(row[2])), []).append(row)
    return found


def _mesh_look(study: str, element: str) -> dict[str, Any]:
    look = LOOKS[element]
    hollow = {"markerfacecolor": "white"} if study.startswith("roll-up") else {}
    label = f"{element}: {study}"
    return {"color": look.color, "linestyle": look.line, "marker": look.marker, "label": label, **hollow}


def _step_look(study: str, look: tuple[str, str, str]) -> dict[str, Any]:
    return {"color": look[0], "linestyle": look[1], "marker": look[2], "label": study}


def _ticks(axes: Axes, table: Table, name: str) -> None:
    """A tick for each size, without minor ones; steps in ms."""
    over, factor = (MESH, 1.0) if name == "a" else (STEP, 1e3)
    sizes = np.unique(table.values("size", over=over))
    axes.set_xticks(sizes, [f"{factor * size:.3g}" for size in sizes])
    axes.xaxis.minorticks_off()


def _curve(axes: Axes, rows: list[tuple[Any, ...]], look: dict[str, Any]) -> None:
    size, error = (np.array([row[k] for row in rows], dtype=np.float64) for k in (4, 5))
    order = rows[0][3]
    look["label"] += f", order {order}"
    axes.plot(size, error, **look)
    axes.plot(size, error[-1] * (size / size[-1]) ** order, color=look["color"], linewidth=0.5, zorder=1)
