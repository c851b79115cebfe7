"""Fig. 4: path of the pendulum's tip (7.2) in the plane of x and z, 2 s."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ..viz import style
from . import kinds, pendulum
from .curves import Curve
from .table import Table, sampled_rows

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CURVES = (Curve(kinds.ORIGINAL, 32, reference=True), *(Curve(element, 4) for element in kinds.KINDS))
COLUMNS = ("element", "elements", "t", "tip_x", "tip_y", "tip_z", "mid_x", "mid_y", "mid_z")
OUTPUT_STEP = 2e-3  # s
SIZE = (100.0, 56.0)  # mm


def data(short: bool = False) -> Table:
    """Positions of the tip and the midpoint every 2 ms, m; the short form ends at 0.1 s."""
    table = Table("fig4", COLUMNS, [], [*pendulum.NOTES, pendulum.SENSITIVE])
    for curve in CURVES:
        model = pendulum.build(curve.elements, element=curve.element)
        result = pendulum.run(model, 0.1 if short else pendulum.T_END, OUTPUT_STEP, pendulum.exact_newton())
        tip, mid = result.position("rope.end"), result.position("rope.at(0.5)")
        table.rows.extend(sampled_rows(curve.head, result.t, tip, mid))
        table.notes.append(_measured(curve, result.t[-1], tip[-1].tolist(), mid[-1].tolist()))
    return table


def draw(table: Table, figure: Figure) -> None:
    """Z over X of the tip; it starts at X = 1 m, Z = 0."""
    axes = figure.subplots()
    for curve in CURVES:
        x, z = curve.values(table, "tip_x", "tip_z")
        axes.plot(x, z, **curve.look)
    axes.plot(x[:1], z[:1], "o", color=style.GREY, label="start")
    axes.set(xlabel="$X$ of the tip [m]", ylabel="$Z$ of the tip [m]", aspect="equal")
    axes.locator_params("both", nbins=5)
    style.legend_above(figure, axes, columns=3)


def renamed(table: Table, name: str) -> Table:
    """Return the same table for another figure."""
    return replace(table, name=name)


def _measured(curve: Curve, t: float, tip: list[float], mid: list[float]) -> str:
    places = [", ".join(f"{value:.6f}" for value in point) for point in (tip, mid)]
    return f"Measured, {curve.label}, t = {t:g} s: tip ({places[0]}) m, midpoint ({places[1]}) m."
