"""Fig. 9: configurations of the sliding beam (7.4) in space, 128+8 cable elements."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ..arrays import FloatArray
from ..viz import style
from . import compare, sliding
from .check import Check
from .references import origin, reference
from .table import Table, sampled_rows

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .. import Result


TITLE = "Fig. 9: configurations of the sliding beam"
EXAMPLE = "7.4"
CLAIM = (
    "Views at several times show how slender the cable is, and therefore that more elements are needed than "
    "in the literature before."
)
MESH = sliding.MESHES[0]
TIMES = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)  # s
SAMPLES = {"carrier": 193, "slider": 65}
NAMES = 0.09  # m between tips that both have their time written beside them
ROOM = 0.45  # m, for the names between the tips and the axis
DRIFT = 2e-4  # m, of the joint within 1 s
COLUMNS = (*sliding.KEYS, "t", "body", "arc_length", "x", "y", "z")
SIZE = (110.0, 92.0)  # mm
VIEW = {"elev": 18.0, "azim": -52.0}  # degrees


def data(short: bool = False) -> Table:
    """Points of both centrelines at six times, m, and of the carrier where the joint is.

    The short form shows the first 0.25 s.
    """
    result = sliding.history(MESH, short)
    table = Table("fig9", COLUMNS, [], [*sliding.NOTES, sliding.SENSITIVE])
    for share in TIMES:
        i = int(np.argmin(np.abs(result.t - share * result.t[-1])))
        for body in SAMPLES:
            arc, places = _centreline(result, body, i)
            head = (*MESH.key, float(result.t[i]), body)
            table.rows.extend(sampled_rows(head, arc, places))
        s = float(result.arc_length("joint")[i])
        there: list[float] = result.state(i).position(f"carrier.at({s!r})").tolist()
        table.rows.append((*MESH.key, float(result.t[i]), "joint", s, *there))
        table.notes.append(f"Measured, {MESH.label}, t = {result.t[i]:g} s: s = {s:.6f} m.")
    return table


def draw(table: Table, figure: Figure) -> None:
    """Carrier, sliding beam and mass; the later, the darker."""
    axes: Any = figure.add_subplot(projection="3d")
    times = np.unique(table.values("t"))
    tips: dict[float, FloatArray] = {}
    for k, t in enumerate(times):
        shade = 0.25 + 0.75 * k / max(len(times) - 1, 1)
        for body, color in (("carrier", style.BLUE), ("slider", style.ORANGE)):
            x, y, z = (table.values(c, t=t, body=body) for c in "xyz")
            name = body if k == len(times) - 1 else None
            axes.plot(x, y, z, color=color, alpha=shade, linewidth=1.0, label=name)
        axes.plot(x[-1:], y[-1:], z[-1:], "o", color="black", alpha=shade, markersize=4.0)
        tips[float(t)] = np.array([x[-1], y[-1], z[-1]])
    for t in apart(tips):
        place = tips[t] + (0.07, 0.0, -0.02)
        axes.text(*place, f"{t:.4g} s", fontsize=6.5)
    axes.set(xlabel="$X$ [m]", ylabel="$Y$ [m]", zlabel="$Z$ [m]")
    _arrange(axes)


def apart(tips: dict[float, FloatArray]) -> list[float]:
    """Times whose names do not lie on each other: the last one, and from it back those far enough."""
    kept: list[float] = []
    for t in sorted(tips, reverse=True):
        if not kept or np.linalg.norm(tips[t] - tips[kept[-1]]) > NAMES:
            kept.append(t)
    return kept[::-1]


def checks(table: Table) -> list[Check]:
    """The carrier at rest, and the joint at all times; where the mass goes is judged in Figs. 10 and 11."""
    return [*_at_rest(table), _joint(table)]


def _at_rest(table: Table) -> list[Check]:
    key = "7.4.static.converged.midpoint"
    middle = _line(table, "carrier", 0.0)[SAMPLES["carrier"] // 2]
    found = {f"middle of the carrier {axis}": value for axis, value in zip("xyz", middle, strict=True)}
    return compare.numbers(f"7.4 {MESH.label}, at rest", found, reference(key), 2e-8, "m", origin(key))


def _joint(table: Table) -> Check:
    """Distance of the slider's first point from the carrier's at s, at all times."""
    gaps = [math.dist(_line(table, "slider", t)[0], _line(table, "joint", t)[0]) for t in _times(table)]
    where = "identity: the joint keeps the slider on the carrier; constraints of index 2 let it drift"
    name = f"7.4 {MESH.label}: largest gap in the joint"
    return Check(name, max(gaps), DRIFT, 0.0, "m", where, "at most")


def _times(table: Table) -> list[float]:
    times: list[float] = np.unique(table.values("t")).tolist()
    return times


def _line(table: Table, body: str, t: float) -> FloatArray:
    """Points (n, 3) of a body at a time."""
    return np.column_stack([table.values(column, t=t, body=body) for column in "xyz"])


def _arrange(axes: Any) -> None:
    """One scale for all axes, a view in which the beams do not hide each other, room for the names."""
    axes.set_xlim(right=axes.get_xlim()[1] + ROOM)
    axes.yaxis.labelpad = 10.0
    limits = np.array([axes.get_xlim(), axes.get_ylim(), axes.get_zlim()])
    axes.set_box_aspect(np.ptp(limits, axis=1), zoom=0.86)
    axes.locator_params("x", nbins=3)
    axes.view_init(**VIEW)
    axes.legend(loc="upper left")


def _centreline(result: Result, body: str, i: int) -> tuple[FloatArray, FloatArray]:
    """Reference arc lengths (n,) and positions (n, 3) of points of a beam at the stored time i, m."""
    state = result.state(i)
    beam = state.system.model.beams[body]
    arc = np.linspace(0.0, beam.length, SAMPLES[body])
    return arc, np.array([state.position(beam.at(x)) for x in arc])
