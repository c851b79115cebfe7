"""Path of the mass at the tip of the sliding beam (7.4): what Figs. 10 and 11 share."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..viz import style
from . import kinds, sliding
from .check import Check
from .references import SHORT, origin, reference
from .table import Table, sampled_rows

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .. import Result

COLUMNS = (*sliding.KEYS, "t", "x", "y", "z", "s")
SIZE = (140.0, 88.0)  # mm
EXAMPLE = "7.4"
CLAIM = (
    "Converged results are obtained with 128+8 cable elements and compared with 64+4 cable elements and the "
    "original element."
)
TIMES = (0.25, 0.5, 0.75, 1.0)  # s, of the references
LIMIT = "7.4.converged"
#: Largest differences of the mass, m, at these times: from the limit, or from the same mesh and step.
BARS = {
    LIMIT: (2e-5, 2e-5, 1.2e-3, 0.02),
    kinds.CABLE: (2e-8,) * 4,
    kinds.ORIGINAL: (1e-9, 1e-8, 1e-6, 2e-5),
    kinds.NONLOCKING: (1e-8, 1e-6, 2e-5, 1e-3),
}
#: The same of s, m, as long as it is determinate.
BARS_S = {
    LIMIT: (5e-5, 2e-4, 0.012, 0.02),
    kinds.CABLE: (1e-7,) * 4,
    kinds.ORIGINAL: (1e-6,),
    kinds.NONLOCKING: (1e-6,),
}
COORDINATES = ("x", "y", "z", "s")  # in the references
#: Least widths of the two panels over their heights, in m of both.
NARROW = {"a": 0.6, "b": 0.02}
LAST = 0.75  # share of the time from which the second panel shows the path


def data(name: str, short: bool = False) -> Table:
    """Rows of all meshes for the figure of this name; the short form ends at 0.25 s."""
    table = Table(name, COLUMNS, [], [*sliding.NOTES, sliding.SENSITIVE])
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
        axes.locator_params("y", nbins=5)
        axes.locator_params("x", nbins=3)
        style.panel_name(axes, name)
        widen(axes, NARROW[name])
    whole.set_aspect("equal", adjustable="box")
    end.set_title(f"from {LAST * t[-1]:.3g} s on")
    style.legend_above(figure, whole, columns=3)


def widen(axes: Axes, share: float) -> None:
    """Show at least a share of the height across: at first the mass falls all but straight down."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    more = 0.5 * max(share * (high - low) - (right - left), 0.0)
    axes.set_xlim(left - more, right + more)


def checks(table: Table, columns: str) -> list[Check]:
    """Some of x, y, z and s beside the references."""
    found = []
    for mesh in (sliding.MESHES[0], *sliding.MESHES[2:]):
        for column in columns:
            found += _at_times(table, mesh, column)
    return found


def _at_times(table: Table, mesh: sliding.Mesh, column: str) -> list[Check]:
    kind = LIMIT if mesh.reference else mesh.element
    bars, found = (BARS_S if column == "s" else BARS)[kind], []
    text = "s" if column == "s" else f"mass {column}"
    for t, bar in zip(TIMES, bars, strict=False):
        row, key = table.row(**mesh.only, t=t), f"{start_of_key(mesh)}.t{t:g}"
        if row is not None:
            wanted = reference(key)[COORDINATES.index(column)]
            name = f"7.4 {mesh.label}, {t:g} s: {text}"
            found.append(Check(name, float(row[column]), wanted, bar, "m", origin(key)))
    return found


def start_of_key(mesh: sliding.Mesh) -> str:
    """Key of the reference with a mesh, without the time; the limit for the converged solution."""
    if mesh.reference:
        return LIMIT
    nu = "" if mesh.element == kinds.CABLE else f".nu{sliding.NU:g}"
    return f"7.4.{SHORT[mesh.element]}{nu}.n{mesh.carrier}+{mesh.slider}.h0.2ms.trap2"


def agreement(table: Table) -> Check:
    """Largest distance of the paths of 64+4 and 128+8 cable elements."""
    fine, half = (
        np.array([table.values(column, **mesh.only) for column in "xyz"]) for mesh in sliding.MESHES[:2]
    )
    far = float(np.linalg.norm(fine - half, axis=0).max())
    said = "the paper, section 7.4: converged; the bound of 1 % of the sliding beam's length is ours"
    name = "7.4 cable: largest distance of the mass, 64+4 from 128+8"
    return Check(name, far, 0.01, 0.0, "m", said, "at most")


def _measured(mesh: sliding.Mesh, result: Result) -> str:
    x, y, z = result.position("slider.end")[-1].tolist()
    s = float(result.arc_length("joint")[-1])
    place = f"mass at ({x:.6f}, {y:.6f}, {z:.6f}) m, s = {s:.6f} m"
    return f"Measured, {mesh.label}, t = {result.t[-1]:g} s: {place}."
