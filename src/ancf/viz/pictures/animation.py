"""Animation: a moving picture that shows in a notebook and saves itself as a page or a movie."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

from ...errors import ModelError
from ...model import checks
from ...model.points import Point
from ...results.modes import Modes
from ...results.result import Result
from ..scene import QUANTITIES, Scene, make_scene
from .movie import FILES, FPS, WIDTH, write_movie
from .stage import Trace

HEIGHT = 560  # pixels of the frame in a notebook
MOST_FRAMES = 100_000


@dataclass(frozen=True)
class Animation:
    """A moving picture of a Result or of a mode; made by ``animate``.

    Parameters
    ----------
    source : Result or Modes
    color : str
    trace : tuple of str
        Points whose paths are drawn.
    frames : int
    start, end : float or None, s
    mode : int
    """

    source: Result | Modes
    color: str
    trace: tuple[str, ...]
    frames: int
    start: float | None
    end: float | None
    mode: int

    def __repr__(self) -> str:
        return f'Animation({self.source!r}; .save("movie.html"), ".mp4", ".gif")'

    def page(self) -> str:
        """HTML text of the page with the viewer, complete in itself.

        Raises
        ------
        ModelError
            plotly is not installed.
        """
        from ..view import view_page

        return str(view_page(self.source, **self._options()))

    def scene(self) -> Scene:
        """What is drawn, at the times that are shown."""
        return make_scene(self.source, frames=self.frames, start=self.start, end=self.end, mode=self.mode)

    def save(self, path: str | Path, *, fps: int = FPS, width: int = WIDTH, view: str | None = None) -> Path:
        """Write a page (``.html``, plays in a browser) or a movie (``.mp4`` or ``.gif``).

        Parameters
        ----------
        path : path
        fps, width, view
            Of a movie: pictures per second, pixels, and the plane that is seen, such as "xz"; default as
            the model moves.

        Raises
        ------
        ModelError
            The suffix is another one, a part is missing that draws or saves, or the file cannot be written.
        """
        if not isinstance(path, str | Path):
            raise ModelError("Animation.save", f"must be given a path, is given {checks.shown(path)}")
        target = Path(path)
        if target.suffix.lower() in (".html", ".htm"):
            from ..view import write_view

            return Path(write_view(self.source, target, **self._options()))
        if target.suffix.lower() not in FILES:
            what = f'is no kind of moving picture: "{target.suffix}"'
            raise ModelError(str(path), what, f"use .html, {', '.join(FILES)}")
        scene = self.scene()
        options: dict[str, Any] = {"fps": fps, "width": width, "view": view, "traces": self._traces(scene)}
        return write_movie(scene, target, color=self.color, **options)

    def _repr_html_(self) -> str:
        """The page in a frame of its own."""
        style = f"width: 100%; height: {HEIGHT}px; border: 0"
        return f'<iframe style="{style}" srcdoc="{escape(self.page())}"></iframe>'

    def _options(self) -> dict[str, Any]:
        """What the page is told; without traces that are asked for it chooses some."""
        span = {"start": self.start, "end": self.end, "mode": self.mode}
        return {"frames": self.frames, "color": self.color, "trace": self.trace or None, **span}

    def _traces(self, scene: Scene) -> list[Trace]:
        """Paths at all stored times from the first to the last that is shown."""
        if not isinstance(self.source, Result):
            return []
        t = self.source.t
        inside = (t >= scene.t[0]) & (t <= scene.t[-1])
        return [Trace(t[inside], self.source.position(point)[inside]) for point in self.trace]


def animate(
    source: Any,
    color: str,
    *,
    trace: Sequence[Any] = (),
    frames: int = 240,
    start: float | None = None,
    end: float | None = None,
    mode: int = 0,
) -> Animation:
    """Moving picture, with what it was given checked; see :meth:`ancf.Result.animate`."""
    if isinstance(color, str) and color.lower().endswith((".gif", ".mp4", ".png")):
        what = f"is {checks.shown(color)}, the name of a file"
        raise ModelError("animate.color", what, f'animate().save("{color}") writes it')
    checks.choice(color, "animate.color", (*QUANTITIES, "plain"))
    checks.integer(frames, "animate.frames", 1, MOST_FRAMES)
    if isinstance(source, Modes):
        checks.integer(mode, "animate.mode", 0, max(len(source.frequencies) - 1, 0))
    elif len(source.t) == 0:
        raise ModelError("animate", "nothing was stored, so there is nothing to draw")
    given = [trace] if isinstance(trace, str | Point) else list(trace)
    names = tuple(str(point) if isinstance(point, str | Point) else str(point.name) for point in given)
    for name in names:
        source.position(name)  # a wrong name is told now
    return Animation(source, color, names, frames, start, end, mode)
