"""What forms draw of themselves."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...model import checks
from ..told import Told
from .reach import STRIP

if TYPE_CHECKING:
    from ...viz.pictures.picture import Picture


class Pictured(Told):
    """A form that draws itself."""

    __slots__ = ()

    def plot(self: Any, *, size: tuple[float, float] = (180.0, 150.0)) -> Picture:
        """Draw the line at rest: from the side, the contact wire over its nominal height, from above.

        Parameters
        ----------
        size : (float, float)
            Width and height, mm.

        Returns
        -------
        Picture
            Shows in a notebook; ``.save("form.png")``, .svg or .pdf. Dashed: ends of strips of 1.45 m.

        Raises
        ------
        ModelError
            matplotlib is missing.
        """
        from ...viz import style
        from ...viz.pictures.picture import Picture
        from .drawn import draw_form

        width, height = checks.array(size, "plot.size", (2,)).tolist()
        style.require_matplotlib()
        with style.new_figure(width, height) as figure:
            draw_form(self, figure, 2.0 * STRIP)
        return Picture(figure)
