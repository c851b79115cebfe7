"""Picture: a figure that shows in a notebook by itself and saves itself; no window, no display."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...errors import ModelError
from ...files import writing
from ...model import checks
from .. import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: Pixels per inch on a screen; a notebook gets the picture finer and shows it in this size.
SCREEN = 110
#: Kinds of files, by suffix.
FILES = (".png", ".svg", ".pdf")


class Picture:
    """A figure of matplotlib that belongs to no window.

    Parameters
    ----------
    figure : Figure
        For what the picture lacks: ``picture.axes[0].set_title("...")``.
    """

    def __init__(self, figure: Figure) -> None:
        self.figure = figure

    def __repr__(self) -> str:
        width, height = (style.MM_PER_INCH * side for side in self.figure.get_size_inches())
        return f'Picture({width:.0f} x {height:.0f} mm; .save("picture.png"), .figure, .axes)'

    @property
    def axes(self) -> list[Axes]:
        """Panels, from the top; a colour bar is the last."""
        return list(self.figure.axes)

    def save(self, path: str | Path) -> Path:
        """Write a PNG, SVG or PDF file, as the suffix says.

        Raises
        ------
        ModelError
            The suffix is another one, or the file cannot be written.
        """
        if not isinstance(path, str | Path):
            raise ModelError("Picture.save", f"must be given a path, is given {checks.shown(path)}")
        target = Path(path)
        if target.suffix.lower() not in FILES:
            raise ModelError(
                str(path), f'is no kind of picture: "{target.suffix}"', f"use {', '.join(FILES)}"
            )
        with writing(target), style.settings():
            self.figure.savefig(target)
        return target

    def _repr_png_(self) -> tuple[bytes, dict[str, Any]]:
        """Picture for a notebook, twice as fine as its size on the screen."""
        width, height = (round(SCREEN * side) for side in self.figure.get_size_inches())
        return style.png(self.figure, 2 * SCREEN), {"width": width, "height": height}
