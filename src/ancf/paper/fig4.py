"""Fig. 4: path of the pendulum's tip (7.2) in the plane of x and z, 2 s."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from ..arrays import FloatArray
from ..viz import style
from . import compare, kinds, pendulum
from .check import Check
from .curves import Curve
from .references import SHORT, origin, reference
from .table import Table, sampled_rows

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TITLE = "Fig. 4: path of the pendulum's tip"
EXAMPLE = "7.2"
CLAIM = (
    "Four cable or nonlocking elements follow the converged solution of 32 original elements well; four "
    "original elements err considerably more."
)
CURVES = (Curve(kinds.ORIGINAL, 32, reference=True), *(Curve(element, 4) for element in kinds.KINDS))
COLUMNS = ("element", "elements", "t", "tip_x", "tip_y", "tip_z", "mid_x", "mid_y", "mid_z")
OUTPUT_STEP = 2e-3  # s
TIMES = (0.5, 1.0, 1.5, 2.0)  # s, of the references
#: Largest difference of 4 elements from the reference, m, by time. The original element's motion is compared
#: where it is determinate; after 1 s round-off decides about more than 0.1 mm.
BARS = {
    kinds.CABLE: (2e-6,) * 4,
    kinds.ORIGINAL: (1e-8, 5e-6),
    kinds.NONLOCKING: (1e-7,) * 4,
}
#: Of the 32 original elements from the limit of many cable elements, m.
BARS_32 = (1e-3, 1e-3)
SIZE = (100.0, 56.0)  # mm


def data(short: bool = False) -> Table:
    """Positions of the tip and the midpoint every 2 ms, m; the short form ends at 0.5 s."""
    table = Table("fig4", COLUMNS, [], [*pendulum.NOTES, pendulum.SENSITIVE])
    for curve in CURVES:
        t, tip, mid = _motion(curve, short)
        table.rows.extend(sampled_rows(curve.head, t, tip, mid))
        table.notes.append(_measured(curve, t[-1], tip[-1].tolist(), mid[-1].tolist()))
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


def checks(table: Table) -> list[Check]:
    """Tips beside the reference's, and how far the three kinds of four elements stray from the limit."""
    return [*places(table, "tip"), *_trend(table)]


def places(table: Table, point: str) -> list[Check]:
    """Positions of "tip" or "mid" beside the reference's, at the times that are determinate."""
    found = []
    for curve in CURVES:
        bars = BARS_32 if curve.reference else BARS[curve.element]
        for t, bar in zip(TIMES, bars, strict=False):
            found += _place(table, curve, point, t, bar)
    return found


def _place(table: Table, curve: Curve, point: str, t: float, bar: float) -> list[Check]:
    row = table.row(element=curve.element, elements=curve.elements, t=t)
    if row is None:
        return []
    start = "7.2.cable.converged" if curve.reference else f"7.2.{SHORT[curve.element]}.n4.h0.1ms.trap"
    key, part = f"{start}.t{t:g}", slice(0, 3) if point == "tip" else slice(3, 6)
    name, text = f"7.2 {curve.label}, {t:g} s", {"tip": "tip", "mid": "midpoint"}[point]
    found = {f"{text} {axis}": float(row[f"{point}_{axis}"]) for axis in "xyz"}
    return compare.numbers(name, found, reference(key)[part], bar, "m", origin(key))


def _trend(table: Table) -> list[Check]:
    """Largest distances of the tip from 32 elements, over the run."""
    far = {curve.element: _strays(table, curve) for curve in CURVES[1:]}
    said = "the paper, section 7.2: considerably larger error; the factor is our bound"
    return [
        Check(f"7.2, 4 elements: distance of the tip from 32, original over {e}",
              far[kinds.ORIGINAL] / far[e], 1.5, 0.0, "", said, "at least")
        for e in (kinds.CABLE, kinds.NONLOCKING)
    ]  # fmt: skip


def _strays(table: Table, curve: Curve) -> float:
    mine, wanted = (np.array(c.values(table, "tip_x", "tip_y", "tip_z")) for c in (curve, CURVES[0]))
    return float(np.linalg.norm(mine - wanted, axis=0).max())


def renamed(table: Table, name: str) -> Table:
    """Return the same table for another figure."""
    return replace(table, name=name)


@cache
def _motion(curve: Curve, short: bool) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Times (n,) and positions (n, 3) of tip and midpoint; kept, as two figures show them."""
    model = pendulum.build(curve.elements, element=curve.element)
    t_end = TIMES[0] if short else pendulum.T_END
    result = pendulum.run(model, t_end, OUTPUT_STEP, pendulum.exact_newton())
    return result.t, result.position("rope.end"), result.position("rope.at(0.5)")


def _measured(curve: Curve, t: float, tip: list[float], mid: list[float]) -> str:
    places = [", ".join(f"{value:.6f}" for value in point) for point in (tip, mid)]
    return f"Measured, {curve.label}, t = {t:g} s: tip ({places[0]}) m, midpoint ({places[1]}) m."
