"""Movies: a scene as an MP4 or GIF file."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import ModelError
from ...files import writing
from ...model import checks
from .. import style
from ..scene import Scene
from .projection import parse_plane, projection
from .shape import finish, points_of
from .stage import Stage, Trace, check_color

if TYPE_CHECKING:
    from matplotlib.animation import AbstractMovieWriter
    from matplotlib.figure import Figure

FILES = (".mp4", ".gif")
WIDTH_MM, REST_MM = 150.0, 24.0  # of the figure, and for legend, labels and time
FPS, WIDTH = 25, 960


def write_movie(
    scene: Scene,
    path: str | Path,
    *,
    color: str = "tension",
    fps: int = FPS,
    width: int = WIDTH,
    view: str | None = None,
    traces: Sequence[Trace] = (),
) -> Path:
    """Write a scene as a movie, one picture for each of its times.

    Parameters
    ----------
    scene : Scene
    path : path
        ``.mp4``, which needs the program ffmpeg or the package imageio-ffmpeg, or ``.gif``.
    color : "tension", "curvature", "speed" or "plain"
    fps : int
        Pictures per second.
    width : int
        Pixels.
    view : str
        Two or three letters of "xyz": seen in this plane, or in space; default as the model moves.
    traces : sequence of Trace
        Paths of points, drawn until the time of the picture.

    Returns
    -------
    Path

    Raises
    ------
    ModelError
        An option is wrong, ffmpeg or matplotlib is missing, or the file cannot be written.
    """
    style.require_matplotlib()
    checks.integer(fps, "movie.fps", 1, 100)
    checks.integer(width, "movie.width", 100, 4000)
    target, seen = _file(path), None if view is None else parse_plane(view, "movie.view")
    if color != "plain" and scene.threads and not scene.threads[0].values:
        color = "plain"  # a mode
    color = check_color(color, scene, "movie.color")
    shown = projection(np.concatenate([points_of(scene), *(trace.position for trace in traces)]), seen)
    height = shown.height(WIDTH_MM - 40.0) + REST_MM
    with style.new_figure(WIDTH_MM, height) as figure:
        stage = Stage(shown.add_axes(figure), scene, shown, color, traces)
        finish(figure, stage)
        _write(figure, stage, target, fps, _even(figure, width))
    return target


def _write(figure: Figure, stage: Stage, target: Path, fps: int, dpi: float) -> None:
    clock = stage.axes.set_title("", loc="left")
    writer = _writer(target, fps)
    t = stage.scene.t
    digits = int(np.clip(np.ceil(-np.log10(max(float(np.ptp(t)), 1e-9) / 1000.0)), 0, 9))
    with writing(target), writer.saving(figure, str(target), dpi):
        for k in range(len(t)):
            stage.show(k)
            clock.set_text(f"t = {t[k]:.{digits}f} s")
            if k == 0:  # the first picture finds the place of everything
                _lay_out(figure, dpi)
            writer.grab_frame()


def _lay_out(figure: Figure, dpi: float) -> None:
    """Find the place of everything in the picture, in two rounds, and keep it from then on."""
    figure.set_dpi(dpi)
    for _ in range(2):
        figure.draw_without_rendering()
    figure.set_layout_engine("none")


def _writer(target: Path, fps: int) -> AbstractMovieWriter:
    from matplotlib.animation import FFMpegWriter, PillowWriter

    if target.suffix.lower() == ".gif":
        return PillowWriter(fps=fps)
    style.set_ffmpeg(ffmpeg())
    pixels = ["-pix_fmt", "yuv420p", "-loglevel", "error"]  # every player knows this format
    return FFMpegWriter(fps=fps, codec="h264", extra_args=pixels)


def _file(path: Any) -> Path:
    """Path of a movie that can be written here."""
    if not isinstance(path, str | Path):
        raise ModelError("movie", f"must be given a path, is given {checks.shown(path)}")
    target = Path(path)
    if target.suffix.lower() not in FILES:
        raise ModelError(str(path), f'is no kind of movie: "{target.suffix}"', f"use {' or '.join(FILES)}")
    if target.suffix.lower() == ".mp4" and not ffmpeg():
        hint = "install it, or pip install imageio-ffmpeg, or write a .gif"
        raise ModelError(str(path), "needs the program ffmpeg, which is not here", hint)
    return target


def ffmpeg() -> str:
    """The program ffmpeg, of the system or else of the package imageio-ffmpeg; "" if neither is here."""
    if found := shutil.which("ffmpeg"):
        return found
    try:
        return str(import_module("imageio_ffmpeg").get_ffmpeg_exe())
    except (ImportError, RuntimeError):
        return ""


def _even(figure: Figure, width: int) -> float:
    """Make both sides of a figure even numbers of pixels, as movies need, and return its pixels per inch."""
    dpi = (width - width % 2) / float(figure.get_size_inches()[0])
    pixels = 2 * np.round(0.5 * dpi * figure.get_size_inches())
    figure.set_size_inches(*(pixels / dpi))
    return dpi
