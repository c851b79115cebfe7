"""Figures of the line's answer: uplift at the supports, height of the contact point, static elasticity."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..answers.passing import SupportUplift, passing_time, uplift_in_window
from ..answers.signals import CUT_OFF, sample_rate
from . import marks

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .content import Content

MM = 1e3
MOST_LINES = 4  # histories in one panel, as many as there are looks
BEFORE_AND_AFTER = 1.5  # s around the passings that a history shows


def uplift_size(content: Content) -> tuple[float, float]:
    """Width and height, mm."""
    return marks.WIDTH, 130.0


def draw_uplift(content: Content, figure: Figure) -> None:
    """Largest uplift at each support, and its history at the supports of the window."""
    upper, lower = figure.subplots(2)
    marks.shade_window(upper, content.run.window)
    for k, found in enumerate(content.found):
        x, uplift = [s.position for s in found.supports], [MM * s.uplift for s in found.supports]
        marker = {"marker": "osD^"[k % 4], "linestyle": "none", "color": marks.look(k)["color"]}
        upper.plot(x, uplift, label=content.name(k), **marker)
    marks.along_track(upper, content)
    upper.set(xlabel="track position [m]", ylabel="largest uplift at support [mm]")
    highest = max((MM * s.uplift for found in content.found for s in found.supports), default=0.0)
    upper.set_ylim(0, 1.15 * max(highest, 1.0))
    upper.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=6)
    _histories(lower, content)


def _histories(axes: Axes, content: Content) -> None:
    run, supports = content.run, _middle(uplift_in_window(content.run))
    for i, support in enumerate(supports):
        label = f"support {support.number} at {support.position:g} m"
        axes.plot(run.t, MM * run.uplift[:, support.number - 1], label=label, **marks.look(i))
    axes.set(xlabel="time [s]", ylabel="uplift at support [mm]")
    axes.set_xlim(*span_of_passings(content, [s.position for s in supports]))
    if supports:
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4)


def _middle(supports: list[SupportUplift]) -> list[SupportUplift]:
    first = max(0, (len(supports) - MOST_LINES) // 2)
    return supports[first : first + MOST_LINES]


def span_of_passings(content: Content, places: list[float]) -> tuple[float, float]:
    """Times from before the first pantograph passes the places until after the last one, s."""
    run = content.run
    times = [passing_time(run, x, k) for k in range(len(content.found)) for x in places]
    passed = [t for t in times if t is not None] or [float(run.t[0]), float(run.t[-1])]
    first, last = min(passed) - BEFORE_AND_AFTER, max(passed) + BEFORE_AND_AFTER
    return max(first, float(run.t[0])), min(last, float(run.t[-1]))


def height_size(content: Content) -> tuple[float, float]:
    """Width and height, mm."""
    return marks.WIDTH, 70.0


def draw_height(content: Content, figure: Figure) -> None:
    """Height of the contact point, below 20 Hz, over the track."""
    axes = figure.subplots()
    rate = sample_rate(content.run.t)
    marks.shade_window(axes, content.run.window)
    shown = []
    for k, found in enumerate(content.found):
        recording = content.run.recordings[k]
        height = found.filter.low_pass(recording.height, rate, CUT_OFF)
        axes.plot(recording.position, MM * height, label=content.name(k), **marks.look(k))
        shown.append(MM * height[marks.clear(content, recording.position)])
    marks.scale(axes, *shown)
    marks.along_track(axes, content)
    axes.set(xlabel="track position [m]", ylabel="height of the contact point [mm]")
    marks.legend(figure, axes)


def draw_elasticity(content: Content, figure: Figure) -> None:
    """Static elasticity along one span."""
    found = content.elasticity
    assert found is not None
    axes = figure.subplots()
    x = content.run.form.line.supports[found.span] + found.x
    for i, (force, values) in enumerate(zip(found.force, found.value, strict=True)):
        axes.plot(x, values, label=f"at {force:g} N", **marks.look(i))
    marks.along_track(axes, content, (float(np.min(x)), float(np.max(x))))
    axes.set(xlabel="track position [m]", ylabel="static elasticity [mm/N]")
    axes.set_ylim(bottom=0)
    marks.legend(figure, axes)
