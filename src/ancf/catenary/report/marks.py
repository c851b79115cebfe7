"""What figures of a report share: looks of pantographs, masts, droppers, the evaluated window."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...viz import style
from ..drawn import mark_line, shade_window

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .content import Content

__all__ = ["along_track", "legend", "look", "mark_line", "shade_window"]

WIDTH = 180.0  # mm, of all figures
RAW: dict[str, Any] = {"color": style.LIGHT, "linewidth": 0.5}
FINE: dict[str, Any] = {"color": style.GREY, "linewidth": 0.7}


def look(k: int) -> dict[str, Any]:
    """Colour and line of pantograph k."""
    return style.line(k)


def along_track(axes: Axes, content: Content, limits: tuple[float, float] | None = None) -> None:
    """Make x the track position, over the whole run or some limits, in m, with masts and droppers marked."""
    positions = [recording.position for recording in content.run.recordings]
    whole = (min(float(x.min()) for x in positions), max(float(x.max()) for x in positions))
    axes.set_xlim(limits or whole)
    mark_line(axes, content.run.form.line)


def legend(figure: Figure, axes: Axes, columns: int = 6) -> None:
    """One legend above all panels, each label once."""
    style.legend_above(figure, axes, columns)
