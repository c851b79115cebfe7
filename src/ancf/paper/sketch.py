"""Parts of a mechanical sketch: ground, mass, spring, damper, arrow, dimension."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..viz import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

INK: dict[str, Any] = {"color": "black", "linewidth": 0.9, "solid_capstyle": "butt"}
LEAD = 0.22  # share of a spring's or damper's length that is a straight line at each end


def ground(axes: Axes, y: float, width: float, strokes: int = 9) -> None:
    """A line with hatching under it, centred at x = 0."""
    half = 0.5 * width
    axes.plot([-half, half], [y, y], **INK)
    for x in np.linspace(-half + width / strokes, half, strokes):
        axes.plot([x, x - width / strokes], [y, y - 0.35], **{**INK, "linewidth": 0.5})


def mass(axes: Axes, bottom: float, height: float, width: float, name: str) -> None:
    """A box with its name inside, centred at x = 0."""
    from matplotlib.patches import Rectangle

    box = Rectangle(
        (-0.5 * width, bottom), width, height, facecolor=style.FACE, edgecolor="black", linewidth=0.9
    )
    axes.add_patch(box)
    axes.text(0.0, bottom + 0.5 * height, name, ha="center", va="center")


def spring(axes: Axes, x: float, low: float, high: float, turns: int = 5, width: float = 0.3) -> None:
    """A zigzag between two heights."""
    a, b = low + LEAD * (high - low), high - LEAD * (high - low)
    y = np.linspace(a, b, 2 * turns + 2)
    swing = np.where(np.arange(y.size) % 2, width, -width)
    swing[[0, -1]] = 0.0
    axes.plot(x + np.concatenate([[0.0], swing, [0.0]]), np.concatenate([[low], y, [high]]), **INK)


def damper(axes: Axes, x: float, low: float, high: float, width: float = 0.35) -> None:
    """A cup with a piston between two heights."""
    length = high - low
    cup, rim, piston = low + 0.3 * length, low + 0.68 * length, low + 0.5 * length
    axes.plot([x, x], [low, cup], **INK)
    axes.plot([x - width, x - width, x + width, x + width], [rim, cup, cup, rim], **INK)
    axes.plot([x - 0.75 * width, x + 0.75 * width], [piston, piston], **{**INK, "linewidth": 1.6})
    axes.plot([x, x], [piston, high], **INK)


def arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float], color: str) -> None:
    """A straight arrow."""
    look = {"arrowstyle": "-|>", "color": color, "linewidth": 1.2, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", xy=end, xytext=start, arrowprops=look)


def dimension(axes: Axes, left: float, right: float, y: float, text: str) -> None:
    """A dimension line with arrows at both ends and its text above."""
    ends = {"arrowstyle": "<|-|>", "color": "black", "linewidth": 0.6, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", xy=(right, y), xytext=(left, y), arrowprops=ends)
    for x in (left, right):
        axes.plot([x, x], [y - 0.2, y + 0.2], **{**INK, "linewidth": 0.5})
    look = {"facecolor": "white", "edgecolor": "none", "pad": 0.8}
    axes.text(0.5 * (left + right), y + 0.3, text, ha="center", va="bottom", fontsize=7.0, bbox=look)
