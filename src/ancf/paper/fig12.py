"""Fig. 12: sketch of the linear pantograph model of example 7.5, and the data taken for it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..viz import style
from . import overhead, sketch
from .check import Check
from .table import Table, Value

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

TITLE = "Fig. 12: sketch of the pantograph"
EXAMPLE = "7.5"
CLAIM = (
    "A linear model of two masses on springs and dampers, pressed against the wire. The paper announces its "
    "data in a table 4 that it does not contain."
)
COLUMNS = ("symbol", "meaning", "value", "unit", "tag")
SIZE = (150.0, 92.0)  # mm
#: Where things are in the sketch, in its own units.
FRAME, HEAD, WIRE = 3.0, 6.2, 8.0
NUMBER: dict[str, Any] = {"color": style.GREY, "fontsize": 7.0}


def data(short: bool = False) -> Table:
    """Symbols and values; tags: V from the paper, U not in the paper."""
    unit = overhead.pantograph()
    lower = (("m_1", "mass of the frame", unit.masses[0], "kg", "masses"),
             ("k_1", "stiffness, roof to frame", unit.stiffness[0], "N/m", "stiffness"),
             ("c_1", "damping, roof to frame", unit.damping[0], "N s/m", "damping"))  # fmt: skip
    upper = (("m_2", "mass of the pan-head", unit.masses[1], "kg", "masses"),
             ("k_2", "stiffness, frame to pan-head", unit.stiffness[1], "N/m", "stiffness"),
             ("c_2", "damping, frame to pan-head", unit.damping[1], "N s/m", "damping"))  # fmt: skip
    force = ("F_H", "static contact force, applied to the frame", unit.static_force, "N", "static_force")
    rows: list[tuple[Value, ...]] = [(*row[:4], unit.tags[row[4]]) for row in (*lower, *upper, force)]
    rows.append(("b", "length of the collector strip", unit.strip_length, "m", "U"))
    rows.append(("y_max", "largest zigzag of the contact wire", max(overhead.line().stagger), "m", "V"))
    return Table("fig12", COLUMNS, rows, _notes())


def draw(table: Table, figure: Figure) -> None:
    """Side view with springs and dampers; front view of strip and wire."""
    values = dict(zip(table.kinds("symbol"), table.values("value").tolist(), strict=True))
    units = dict(zip(table.kinds("symbol"), (str(row[3]) for row in table.rows), strict=True))
    texts = {s: f"{values[s]:g} {units[s]}" for s in values}
    side, front = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
    _side(side, texts)
    _front(front, texts)
    for axes, name, title in ((side, "a", "along the track"), (front, "b", "across the track")):
        axes.set_aspect("equal")
        axes.axis("off")
        axes.set_title(title)
        axes.set_title(name, loc="left", x=0.0, fontweight="bold")
        axes.set_ylim(-0.9, 9.3)


def checks(table: Table) -> list[Check]:
    """Nothing: what the sketch shows is what was given, no result."""
    return []


def _notes() -> list[str]:
    return [
        overhead.NOTES[2],
        "The weight of the pantograph is balanced: F_H on the frame is what the contact carries at "
        "standstill. F is the contact force; it only pushes. The strip is free sideways: the zigzag wire "
        "sweeps along it.",
        "Tags: V from the paper, U not in the paper.",
    ]


def _side(axes: Axes, texts: dict[str, str]) -> None:
    """The chain of masses, the force on it and the contact with the wire."""
    sketch.ground(axes, 0.0, 3.4)
    for low, high, k in ((0.0, FRAME, 1), (FRAME + 1.0, HEAD, 2)):
        sketch.spring(axes, -0.9, low, high)
        sketch.damper(axes, 0.9, low, high)
        middle = 0.5 * (low + high)
        _label(axes, -1.5, middle, f"$k_{k}$", texts[f"k_{k}"], "right")
        _label(axes, 1.5, middle, f"$c_{k}$", texts[f"c_{k}"], "left")
    sketch.mass(axes, FRAME, 1.0, 3.4, "$m_1$")
    sketch.mass(axes, HEAD, 0.7, 2.6, "$m_2$")
    _label(axes, 1.85, FRAME + 0.5, "frame", texts["m_1"], "left")
    _label(axes, 1.45, HEAD + 0.35, "pan-head", texts["m_2"], "left")
    sketch.arrow(axes, (-2.9, FRAME - 1.1), (-2.9, FRAME + 0.5), style.ORANGE)
    axes.plot([-2.9, -1.7], [FRAME + 0.5] * 2, color=style.ORANGE, linewidth=0.8)
    _label(axes, -3.1, FRAME - 0.4, "$F_H$", texts["F_H"], "right")
    _contact(axes)


def _contact(axes: Axes) -> None:
    x = np.linspace(-3.4, 3.4, 80)
    axes.plot(x, WIRE - 0.03 * x**2, color=style.BLUE, linewidth=1.6)
    axes.text(3.4, WIRE + 0.15, "contact wire", color=style.BLUE, ha="right")
    axes.plot([0.0], [WIRE - 0.14], "o", color="black", markersize=4.0)
    sketch.arrow(axes, (0.0, HEAD + 0.7), (0.0, WIRE - 0.2), style.ORANGE)
    axes.text(0.2, 0.5 * (HEAD + 0.7 + WIRE), "$F$", va="center")
    sketch.arrow(axes, (-3.6, HEAD + 0.7), (-2.2, HEAD + 0.7), "black")
    axes.text(-3.6, HEAD + 0.85, "$v$", va="bottom")


def _front(axes: Axes, texts: dict[str, str]) -> None:
    """The strip as the driver sees it, the wire as a dot that sweeps along it."""
    top, half, sweep = HEAD + 0.7, 2.6, 2.6 * 0.3 / 0.725
    axes.plot([-half, half], [top, top], color="black", linewidth=3.0, solid_capstyle="butt")
    for sign in (-1, 1):
        axes.plot([sign * half, sign * (half + 0.5)], [top, top - 0.5], color="black", linewidth=1.5)
    sketch.mass(axes, FRAME, 1.0, 2.6, "$m_1$")
    axes.plot([0.0, 0.0], [0.0, FRAME], color=style.GREY, linewidth=0.8)
    axes.plot([0.0, 0.0], [FRAME + 1.0, top], color=style.GREY, linewidth=0.8)
    sketch.ground(axes, 0.0, 3.4)
    for y, filled in ((-sweep, False), (0.4 * sweep, True), (sweep, False)):
        colour = style.BLUE if filled else "white"
        axes.plot([y], [top + 0.22], "o", color=colour, markeredgecolor=style.BLUE, markersize=6.0)
    axes.text(0.4 * sweep, top + 0.5, "wire", color=style.BLUE, ha="center")
    sketch.dimension(axes, -sweep, sweep, top + 1.35, f"zigzag ±{texts['y_max']}")
    sketch.dimension(axes, -half, half, top - 1.3, f"$b$ = {texts['b']}")
    axes.text(0.3, top - 2.1, "no sideways force\nbetween wire and strip", va="center", **NUMBER)
    axes.set_xlim(-3.6, 3.6)


def _label(axes: Axes, x: float, y: float, symbol: str, value: str, side: str) -> None:
    """A symbol or name with its value in grey under it."""
    place: dict[str, Any] = {"ha": side}
    axes.text(x, y, symbol, va="bottom", **place)
    axes.text(x, y - 0.08, value, va="top", **place, **NUMBER)
