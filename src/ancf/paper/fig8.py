"""Fig. 8: tip displacement of the rotating beam (7.3) over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..viz import style
from . import kinds, spin_up
from .curves import Curve
from .table import FloatArray, Table, sampled_rows

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CURVES = (Curve(kinds.ORIGINAL, 16, reference=True), *(Curve(element, 4) for element in kinds.KINDS))
COLUMNS = ("element", "elements", "t", "u_transverse")
STRIDE = 20  # rows every 20 ms
SIZE = (110.0, 72.0)  # mm


def data(short: bool = False) -> Table:
    """Transverse displacement every 20 ms in the frame of the clamp, m; the short form ends at 0.5 s."""
    table = Table("fig8", COLUMNS, [], [*spin_up.NOTES])
    for curve in CURVES:
        result = spin_up.run(spin_up.build(curve.elements, curve.element), 0.5 if short else spin_up.T_END)
        u, _ = spin_up.tip_displacement(result)
        table.rows.extend(sampled_rows(curve.head, result.t[::STRIDE], u[::STRIDE]))
        table.notes.append(_measured(curve, result.t, u))
    return table


def draw(table: Table, figure: Figure) -> None:
    """Transverse displacement over t."""
    axes = figure.subplots()
    for curve in CURVES:
        axes.plot(*curve.values(table, "t", "u_transverse"), **curve.look)
    axes.set(xlabel="$t$ [s]", ylabel="transverse tip displacement [m]")
    axes.set_xlim(0.0, float(table.values("t").max()))
    axes.locator_params("x", nbins=5)
    style.legend_above(figure, axes, columns=2)


def _measured(curve: Curve, t: FloatArray, u: FloatArray) -> str:
    lowest = int(np.argmin(u))
    lag = f"largest lag {u[lowest]:.6f} m at {t[lowest]:g} s"
    return f"Measured, {curve.label}: {lag}; {u[-1]:.6f} m at {t[-1]:g} s."
