"""What figures of a report share: looks of pantographs, masts, droppers, the evaluated window."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...viz import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..line import Line
    from ..route import Route
    from .content import Content

WIDTH = 180.0  # mm, of all figures
RAW: dict[str, Any] = {"color": style.LIGHT, "linewidth": 0.5}
FINE: dict[str, Any] = {"color": style.GREY, "linewidth": 0.7}


def look(k: int) -> dict[str, Any]:
    """Colour and line of pantograph k."""
    return style.line(k)


def shade_window(axes: Axes, window: tuple[float, float]) -> None:
    """Shade the track interval that is evaluated."""
    axes.axvspan(*window, color=style.SHADE, linewidth=0, zorder=0, label="evaluated")


def mark_line(axes: Axes, line: Line | Route) -> None:
    """Masts as triangles and droppers as ticks along the lower edge, masts as thin lines above."""
    edge = axes.get_xaxis_transform()
    axes.vlines(line.supports, 0, 1, transform=edge, color=style.LIGHT, linewidth=0.4, zorder=0.5)
    at: dict[str, Any] = {
        "transform": edge,
        "clip_on": False,
        "linestyle": "none",
        "color": "black",
        "zorder": 5,
    }
    supports, droppers = _seen(axes, line.supports), _seen(axes, line.dropper_x)
    axes.plot(supports, np.zeros(len(supports)), marker="^", markersize=4.5, label="mast", **at)
    axes.plot(droppers, np.zeros(len(droppers)), marker="|", markersize=4, label="dropper", **at)


def along_track(axes: Axes, content: Content, limits: tuple[float, float] | None = None) -> None:
    """Make x the track position, over the whole run or some limits, in m, with masts and droppers marked."""
    positions = [recording.position for recording in content.run.recordings]
    whole = (min(float(x.min()) for x in positions), max(float(x.max()) for x in positions))
    axes.set_xlim(limits or whole)
    mark_line(axes, content.run.form.line)


def legend(figure: Figure, axes: Axes, columns: int = 6) -> None:
    """One legend above all panels, each label once."""
    style.legend_above(figure, axes, columns)


def _seen(axes: Axes, x: Any) -> Any:
    low, high = axes.get_xlim()
    places = np.asarray(x)
    return places[(places >= low - 1e-6) & (places <= high + 1e-6)]
