"""Figures of the contact force over the track: the whole run, and the evaluated window."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...arrays import FloatArray
from ...viz import style
from . import marks

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .content import Content

PANEL, REST = 50.0, 22.0  # mm: height of a panel, of legend and labels
LABEL = "contact force [N]"


def size(content: Content) -> tuple[float, float]:
    """Width and height, mm: one panel for each pantograph."""
    return marks.WIDTH, REST + PANEL * len(content.found)


def draw(content: Content, figure: Figure) -> None:
    """Force, unfiltered and below 20 Hz, over the whole run."""
    panels = figure.subplots(len(content.found), sharex=True, squeeze=False)[:, 0]
    for k, axes in enumerate(panels):
        marks.shade_window(axes, content.run.window)
        _curves(axes, content, k)
        recording = content.run.recordings[k]
        marks.scale(axes, recording.force[marks.clear(content, recording.position)])
        marks.along_track(axes, content)
    panels[-1].set_xlabel("track position [m]")
    marks.legend(figure, panels[0])


def draw_window(content: Content, figure: Figure) -> None:
    """The same in the evaluated window, with mean and three standard deviations."""
    panels = figure.subplots(len(content.found), sharex=True, squeeze=False)[:, 0]
    for k, axes in enumerate(panels):
        _curves(axes, content, k)
        marks.scale(axes, content.run.recordings[k].force[content.found[k].window], _levels(axes, content, k))
        marks.along_track(axes, content, content.run.window)
    panels[-1].set_xlabel("track position [m]")
    marks.legend(figure, panels[0])


def _curves(axes: Axes, content: Content, k: int) -> None:
    recording = content.run.recordings[k]
    axes.plot(recording.position, recording.force, label="unfiltered", **marks.RAW)
    axes.plot(recording.position, content.found[k].force, color=style.BLUE, label="below 20 Hz")
    axes.set_ylabel(LABEL)
    if content.several:
        axes.set_title(content.name(k), loc="left")


def _levels(axes: Axes, content: Content, k: int) -> FloatArray:
    """Draw mean and three standard deviations to each side, and give them, N."""
    found, end = content.found[k], content.run.window[1]
    levels = (
        ("mean_plus_3_sigma", "$F_m + 3\\sigma$"),
        ("mean_force", "$F_m$"),
        ("mean_minus_3_sigma", "$F_m - 3\\sigma$"),
    )
    for key, text in levels:
        value = found[key].value
        axes.axhline(value, linestyle="--", **marks.FINE)
        axes.annotate(text, (end, value), xytext=(3, 0), textcoords="offset points", va="center", fontsize=7)
    return np.array([found[key].value for key, _ in levels])
