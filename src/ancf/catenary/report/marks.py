"""What figures of a report share: looks of pantographs, masts, droppers, the evaluated window."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...viz import style
from ..forms.drawn import mark_line, shade_window

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .content import Content

__all__ = ["along_track", "clear", "legend", "look", "mark_line", "scale", "shade_window"]

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


def clear(content: Content, x: FloatArray) -> BoolArray:
    """Which of track positions (n,) are in the window, or not in the first and last span of the line.

    There a wire is stiff: a force at its end is no part of what is evaluated, and would set the scale.
    """
    (low, high), line = content.run.window, content.run.form.line
    first, last = line.begin + line.spans[0].length, line.end - line.spans[-1].length
    return ((x >= low) & (x <= high)) | ((x >= first) & (x <= last))


def scale(axes: Axes, *values: FloatArray) -> None:
    """Make y show some values with a little room, whatever else is drawn."""
    every = np.concatenate(values)
    if every.size:
        low, high = float(np.min(every)), float(np.max(every))
        room = 0.06 * (high - low) or 1.0
        axes.set_ylim(low - room, high + room)


def legend(figure: Figure, axes: Axes, columns: int = 6) -> None:
    """One legend above all panels, each label once."""
    style.legend_above(figure, axes, columns)
