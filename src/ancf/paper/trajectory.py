"""Path of the mass at the tip of the sliding beam (7.4): what Figs. 10 and 11 share."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..viz import style
from . import sliding
from .table import Table, sampled_rows

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ancf import Result

COLUMNS = (*sliding.KEYS, "t", "x", "y", "z", "s")
SIZE = (140.0, 88.0)  # mm
LAST = 0.75  # share of the time from which the second panel shows the path


def data(name: str, short: bool = False) -> Table:
    """Rows of all meshes for the figure of this name; the short form ends at 20 ms."""
    table = Table(name, COLUMNS, [], [*sliding.NOTES])
    for mesh in sliding.MESHES:
        result = sliding.history(mesh, short)
        place, s = result.position("slider.end"), result.arc_length("joint")
        table.rows.extend(sampled_rows(mesh.key, result.t, place, s))
        table.notes.append(_measured(mesh, result))
    return table


def draw(table: Table, figure: Figure, across: str, up: str) -> None:
    """Draw one coordinate of the mass over another: all of the path, and its last part, enlarged."""
    whole, end = figure.subplots(1, 2, width_ratios=(0.75, 1.0))
    for mesh in sliding.MESHES:
        t, u, w = (table.values(column, **mesh.only) for column in ("t", across, up))
        late = t >= LAST * t[-1]
        whole.plot(u, w, **mesh.look)
        end.plot(u[late], w[late], **mesh.look)
    whole.plot(u[:1], w[:1], "o", color=style.GREY, label="start")
    for axes, name in ((whole, "a"), (end, "b")):
        axes.set(xlabel=f"${across.upper()}$ of the mass [m]", ylabel=f"${up.upper()}$ of the mass [m]")
        axes.locator_params("both", nbins=5)
        style.panel_name(axes, name)
    whole.set_aspect("equal", adjustable="box")
    end.set_title(f"from {LAST * t[-1]:.3g} s on")
    style.legend_above(figure, whole, columns=3)


def _measured(mesh: sliding.Mesh, result: Result) -> str:
    x, y, z = result.position("slider.end")[-1].tolist()
    s = float(result.arc_length("joint")[-1])
    place = f"mass at ({x:.6f}, {y:.6f}, {z:.6f}) m, s = {s:.6f} m"
    return f"Measured, {mesh.label}, t = {result.t[-1]:g} s: {place}."
