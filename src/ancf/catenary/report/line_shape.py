"""Figure of the line at rest: from the side with droppers, sag of the contact wire, staggers in plan."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..forms.drawn import draw_form
from . import marks

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .content import Content


def size(content: Content) -> tuple[float, float]:
    """Width and height, mm."""
    return marks.WIDTH, 150.0


def draw(content: Content, figure: Figure) -> None:
    """The line at rest over the whole track, with what is evaluated."""
    strip = min(unit.strip_length for unit in content.run.pantographs)
    draw_form(content.run.form, figure, strip, content.run.window)
