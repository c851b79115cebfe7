"""What a measuring pantograph would have shown, beside the true force: figure and table."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...viz import style
from ...viz.html import table
from ..answers.measuring_file import compared
from . import marks

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

    from matplotlib.figure import Figure

    from .content import Content

PANEL, REST = 45.0, 22.0  # mm: height of a panel, of legend and labels


def size(content: Content) -> tuple[float, float]:
    """Width and height, mm: a panel for each pantograph, one for the errors."""
    return marks.WIDTH, REST + PANEL * (1 + len(content.measured))


def draw(content: Content, figure: Figure) -> None:
    """True and measured force in the window, and what is between them."""
    panels = figure.subplots(1 + len(content.measured), sharex=True)
    for k, measured in enumerate(content.measured):
        x, axes = measured.position, panels[k]
        axes.plot(x, measured.true, color=style.BLUE, label="true")
        axes.plot(x, measured.force, color=style.ORANGE, linestyle="--", label="measured")
        axes.set_ylabel("contact force [N]")
        if content.several:
            axes.set_title(content.name(k), loc="left")
        panels[-1].plot(x, measured.force - measured.true, label=content.name(k), **marks.look(k))
        low, high = (np.min(measured.error), np.max(measured.error))
        room = 0.1 * (high - low) + 1e-3
        bottom, top = (low - room, high + room) if k == 0 else panels[-1].get_ylim()
        panels[-1].set_ylim(min(bottom, low - room), max(top, high + room))
    for axes in panels:
        marks.along_track(axes, content, content.run.window)
    panels[-1].set(xlabel="track position [m]", ylabel="measured less true [N]")
    if content.several:
        panels[-1].legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=4)
    marks.legend(figure, panels[0])


def numbers(content: Content) -> Element:
    """What is read off the forces, true and measured, and the largest error between them."""
    rows = []
    for k, measured in enumerate(content.measured):
        name = (content.name(k),) if content.several else ()
        for quantity, true, force in compared(measured):
            error = round(force - true, 2) + 0.0  # no negative zero
            rows.append((*name, quantity, f"{true:.1f}", f"{force:.1f}", f"{error:+.2f}"))
        rows.append((*name, "largest difference", "", "", f"{measured.largest_error:.2f}"))
    first = ("pantograph",) if content.several else ()
    head = (*first, "quantity below 20 Hz", "true [N]", "measured [N]", "difference [N]")
    return table(head, rows, numbers=range(len(head) - 3, len(head)))
