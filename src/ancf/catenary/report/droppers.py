"""Figures of the droppers: extremes along the line, and histories in one span."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...viz import style
from ..answers.passing import broken_places, can_slacken, dropper_forces, dropper_places, passing_time
from . import marks
from .line_answer import span_of_passings

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .content import Content

#: Marker of a broken dropper.
BROKEN: dict[str, Any] = {"color": "black", "markerfacecolor": "none", "markersize": 5, "zorder": 7}
PANEL, REST = 14.0, 24.0  # mm: height of a history, of legend and labels


def extremes_size(content: Content) -> tuple[float, float]:
    """Width and height, mm."""
    return marks.WIDTH, 75.0


def draw_extremes(content: Content, figure: Figure) -> None:
    """Smallest, static and largest force of each dropper over the whole run; the slack ones marked."""
    axes = figure.subplots()
    every = dropper_forces(content.run)
    found = [d for d in every if not d.broken]
    x = np.array([d.position for d in found])
    marks.shade_window(axes, content.run.window)
    low, high = [d.smallest for d in found], [d.largest for d in found]
    axes.vlines(x, low, high, color=style.BLUE, linewidth=1.6, label="smallest to largest")
    axes.plot(x, [d.rest for d in found], "_", color="black", markersize=4, label="at rest")
    slack = [d.position for d in found if d.slack.number]
    axes.plot(
        slack, np.zeros(len(slack)), "x", color=style.ORANGE, markersize=4, label="went slack", zorder=6
    )
    gone = [d.position for d in every if d.broken]
    if gone:
        axes.plot(gone, np.zeros(len(gone)), "D", **BROKEN, label="broken")
    marks.along_track(axes, content)
    axes.set(xlabel="track position [m]", ylabel="dropper force [N]")
    shown = np.array(high)[marks.clear(content, x)] if len(x) else np.ones(1)
    most = float(np.max(shown, initial=1.0))
    axes.set_ylim(-0.08 * most, 1.05 * most)
    marks.legend(figure, axes)


def history_size(content: Content) -> tuple[float, float]:
    """Width and height, mm: one panel for each dropper of the span."""
    return marks.WIDTH, REST + PANEL * max(len(_shown(content)), 1)


def draw_history(content: Content, figure: Figure) -> None:
    """Force of each dropper of the first span of the window over time, with the passing pantographs."""
    run, shown = content.run, _shown(content)
    places, gone = dropper_places(run), broken_places(run)
    panels = figure.subplots(len(shown), sharex=True, sharey=True, squeeze=False)[:, 0]
    for axes, j in zip(panels, shown, strict=True):
        _one(axes, content, j)
        span, number, x = places[j]
        title = f"span {span}, dropper {number}, {x:g} m{', broken' if gone[j] else ''}"
        axes.set_title(title, loc="left", fontsize=7, pad=1.5)
    panels[-1].set_xlabel("time [s]")
    panels[-1].set_xlim(*span_of_passings(content, [places[j][2] for j in shown]))
    figure.supylabel("dropper force [N]", fontsize=8)
    marks.legend(figure, panels[0])


def _one(axes: Axes, content: Content, j: int) -> None:
    run = content.run
    force, x = run.dropper_force[:, j], dropper_places(run)[j][2]
    axes.plot(run.t, force, color=style.BLUE, linewidth=0.9, label="force")
    axes.axhline(float(run.form.dropper_force[j]), linestyle=":", label="at rest", **marks.FINE)
    slack = (force <= 0) & can_slacken(run)[j] & (not broken_places(run)[j])
    axes.fill_between(
        run.t, 0, 1, where=slack, transform=axes.get_xaxis_transform(), color=style.ORANGE, alpha=0.35,
        linewidth=0, label="slack",
    )  # fmt: skip
    for k in range(len(content.found)):
        t = passing_time(run, x, k)
        if t is not None:
            axes.axvline(t, color="black", linewidth=0.8, linestyle="--", label="pantograph passes")


def _shown(content: Content) -> list[int]:
    """Indices of the droppers of the first span of the window."""
    run, low = content.run, content.run.window[0]
    places = dropper_places(run)
    spans = [span for span, _, x in places if x >= low]
    return [j for j, place in enumerate(places) if spans and place[0] == spans[0]]
