"""The figures of a report, by name: caption, size and picture."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...viz import style
from . import droppers, force, frequency, line_answer, line_shape, measured

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .content import Content


#: ``style.svg`` or ``style.png``.
Save = Callable[["Figure"], str | bytes]


@dataclass(frozen=True)
class FigureKind:
    """One figure of a report.

    Parameters
    ----------
    title, caption : str
    size : callable
        Width and height of the figure of a content, mm.
    draw : callable
        Draws a content into an empty figure.

    """

    title: str
    caption: str
    size: Callable[[Content], tuple[float, float]]
    draw: Callable[[Content, Figure], None]


FIGURES = {
    "form": FigureKind(
        "The line at rest",
        "From the side, sag of the contact wire, and from above; the evaluated window is shaded.",
        line_shape.size,
        line_shape.draw,
    ),
    "force": FigureKind(
        "Contact force over the track",
        "Unfiltered and below 20 Hz; the evaluated window is shaded. The scale leaves the end spans out.",
        force.size,
        force.draw,
    ),
    "force-window": FigureKind(
        "Contact force in the evaluated window",
        "Mean force and three standard deviations to each side are those of the force below 20 Hz.",
        force.size,
        force.draw_window,
    ),
    "measured": FigureKind(
        "The force as it would be measured",
        "True contact force and that of a measuring pantograph, below 20 Hz, in the evaluated window.",
        measured.size,
        measured.draw,
    ),
    "histogram": FigureKind(
        "Histogram of the contact force",
        "Force below 20 Hz in the evaluated window; dotted: normal distribution of equal mean and deviation.",
        frequency.size,
        frequency.draw_histogram,
    ),
    "spectrum": FigureKind(
        "Spectrum of the contact force",
        "One-sided amplitude of the unfiltered force without its mean, in the evaluated window, Hann window.",
        frequency.size,
        frequency.draw_spectrum,
    ),
    "uplift": FigureKind(
        "Uplift at the supports",
        "Above: largest uplift while the pantograph passes. Below: history at supports of the window.",
        line_answer.uplift_size,
        line_answer.draw_uplift,
    ),
    "dropper-extremes": FigureKind(
        "Dropper forces",
        "Of each dropper over the whole run. The scale leaves the end spans out.",
        droppers.extremes_size,
        droppers.draw_extremes,
    ),
    "dropper-history": FigureKind(
        "Dropper forces over time",
        "Droppers of the first span of the window.",
        droppers.history_size,
        droppers.draw_history,
    ),
    "height": FigureKind(
        "Height of the contact point",
        "Below 20 Hz, above the nominal height of the contact wire.",
        line_answer.height_size,
        line_answer.draw_height,
    ),
    "elasticity": FigureKind(
        "Static elasticity",
        "Uplift per force where a constant force lifts the contact wire, along one span.",
        line_answer.height_size,
        line_answer.draw_elasticity,
    ),
}


def figure_names(content: Content) -> list[str]:
    """Names of the figures that a content has: all, elasticity and measurement when they are given."""
    given = {"elasticity": content.elasticity is not None, "measured": bool(content.measured)}
    return [name for name in FIGURES if given.get(name, True)]


def picture(name: str, content: Content, save: Save) -> str | bytes:
    """A figure as ``style.svg`` or ``style.png`` save it.

    Raises
    ------
    ModelError
        matplotlib is missing.

    """
    if name in content.drawn:
        return save(content.drawn[name])
    kind = FIGURES[name]
    with style.new_figure(*kind.size(content)) as figure:
        kind.draw(content, figure)
        made = save(figure)
    figure.set_layout_engine("none")  # its axes stay where they are: to find their places takes a third
    content.drawn[name] = figure
    return made
