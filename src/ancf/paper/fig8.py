"""Fig. 8: tip displacement of the rotating beam (7.3) over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..arrays import FloatArray
from ..viz import style
from . import kinds, spin_up
from .check import Check
from .curves import Curve
from .fig7 import BARS
from .references import SHORT, origin, reference
from .table import Table, sampled_rows

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TITLE = "Fig. 8: tip of the rotating beam over time"
EXAMPLE = "7.3"
CLAIM = (
    "Four elements of each kind beside a reference of 16 original elements; the well-known spin-up, which "
    "shows the stiffening by centrifugal forces and serves to verify the programs."
)
CURVES = (Curve(kinds.ORIGINAL, 16, reference=True), *(Curve(element, 4) for element in kinds.KINDS))
COLUMNS = ("element", "elements", "t", "u_transverse")
STRIDE = 20  # rows every 20 ms
SHORT_END = 7.0  # s
SIZE = (110.0, 72.0)  # mm


def data(short: bool = False) -> Table:
    """Transverse displacement every 20 ms in the frame of the clamp, m; the short form ends at 7 s.

    The time of the largest lag has a row of its own.
    """
    table = Table("fig8", COLUMNS, [], [*spin_up.NOTES])
    for curve in CURVES:
        model, t_end = spin_up.build(curve.elements, curve.element), SHORT_END if short else spin_up.T_END
        result = spin_up.run(model, t_end)
        u, _ = spin_up.tip_displacement(result)
        shown = np.union1d(np.arange(0, u.size, STRIDE), np.argmin(u))
        table.rows.extend(sampled_rows(curve.head, result.t[shown], u[shown]))
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


def checks(table: Table) -> list[Check]:
    """The largest lag and the displacement at 20 s beside the reference's; that at 7 s is in Fig. 7."""
    return [check for curve in CURVES for check in (*_lag(table, curve), *_end(table, curve))]


def _end(table: Table, curve: Curve) -> list[Check]:
    row = table.row(element=curve.element, elements=curve.elements, t=spin_up.T_END)
    if row is None:
        return []
    key, name = _key(curve), f"7.3 {curve.label}, {spin_up.T_END:g} s: transverse"
    bar, wanted = BARS[curve.element], reference(key)["uy20"]
    return [Check(name, float(row["u_transverse"]), wanted, bar, "m", origin(key))]


def _lag(table: Table, curve: Curve) -> list[Check]:
    """Largest lag and its time, where the run is long enough to have it."""
    t, u = curve.values(table, "t", "u_transverse")
    key, lowest = _key(curve), int(np.argmin(u))
    if t[-1] < reference(key)["tmin"] + 0.1:
        return []
    return [
        Check(f"7.3 {curve.label}: largest lag", float(u[lowest]), reference(key)["uymin"],
              BARS[curve.element], "m", origin(key)),
        Check(f"7.3 {curve.label}: time of the largest lag", float(t[lowest]), reference(key)["tmin"],
              2e-3, "s", origin(key)),
    ]  # fmt: skip


def _key(curve: Curve) -> str:
    return f"7.3.{SHORT[curve.element]}.n{curve.elements}.h1ms"


def _measured(curve: Curve, t: FloatArray, u: FloatArray) -> str:
    lowest = int(np.argmin(u))
    lag = f"largest lag {u[lowest]:.6f} m at {t[lowest]:g} s"
    return f"Measured, {curve.label}: {lag}; {u[-1]:.6f} m at {t[-1]:g} s."
