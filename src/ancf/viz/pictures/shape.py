"""Shapes: the model at some times, at one time, and its modes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks
from .. import style
from ..scene import Arrow, Link, Marker, Scene, Strip, Thread, Triad, chosen_times, make_scene
from .picture import Picture
from .plot import size_of
from .projection import Projection, parse_plane, projection
from .stage import Stage, add_lines, check_color

if TYPE_CHECKING:
    from matplotlib.figure import Figure


WIDTH, BAR, REST = 140.0, 30.0, 22.0  # mm: of a figure, for the colour bar, for legend and labels
FRAME = 24.0  # mm: title and labels of one of several panels
TIMES = 200  # shapes in a picture, at most
MODES = 24
STILL = 1e-9  # of the model's size: a smaller displacement is none


def plot_shapes(result: Any, times: int | Sequence[float], *, plane: Any, color: Any, size: Any) -> Picture:
    """Picture of a model at some times; see :meth:`ancf.Result.plot_shape`."""
    style.require_matplotlib()
    chosen = times_of(result.t, times)
    scene = together(make_scene(result, start=t, end=t) for t in chosen.tolist())
    checked = check_color(color, scene, "plot_shape.color", ("t",))
    return _picture(scene, plane, "plain" if checked == "t" and len(chosen) == 1 else checked, size)


def plot_state(state: Any, *, plane: Any, color: Any, size: Any) -> Picture:
    """Picture of a model at one time; see :meth:`ancf.State.plot`."""
    style.require_matplotlib()
    scene = make_scene(state)
    return _picture(scene, plane, check_color(color, scene, "plot.color"), size)


def plot_modes(modes: Any, count: int, *, plane: Any, size: Any) -> Picture:
    """Picture of the lowest modes; see :meth:`ancf.Modes.plot`."""
    style.require_matplotlib()
    shown = min(checks.integer(count, "plot.count", 1, MODES), len(modes.frequencies))
    if shown == 0:
        raise ModelError("plot", "there are no modes")
    rest = make_scene(modes.about)
    scenes = [make_scene(modes, mode=k, frames=1) for k in range(shown)]
    views = [_view_of_mode(rest, scene, plane) for scene in scenes]
    columns = min(2, shown)
    rows = -(-shown // columns)
    width = style.TWO_COLUMNS / columns
    height = rows * (max(view.height(width - 18.0) for view in views) + FRAME)
    with style.new_figure(*size_of(size, (style.TWO_COLUMNS, height))) as figure:
        for k, (scene, view) in enumerate(zip(scenes, views, strict=True)):
            axes = view.add_axes(figure, rows, columns, k + 1)
            add_lines(
                axes, view, [view(t.position[0]) for t in rest.threads], colors=style.LIGHT, linewidths=1.0
            )
            Stage(axes, scene, view, "plain").show(0)
            axes.set_title(f"{k + 1}: {modes.frequencies_hz[k]:.4g} Hz")
        return Picture(figure)


def times_of(stored: FloatArray, times: Any) -> FloatArray:
    """So many stored times, evenly spaced, or those nearest to given ones.

    Raises
    ------
    ModelError
        Nothing is stored, the number is wrong, or a time lies outside.
    """
    where = "plot_shape.times"
    if len(stored) == 0:
        raise ModelError("plot_shape", "nothing was stored, so there is nothing to draw")
    if not np.ndim(times):
        return stored[chosen_times(stored, checks.integer(times, where, 1, TIMES), None, None)]
    given = checks.array(times, where, (None,))
    slack = 1e-6 * (stored[-1] - stored[0])
    outside = given[(given < stored[0] - slack) | (given > stored[-1] + slack)]
    if outside.size or not 1 <= given.size <= TIMES:
        what = f"{outside[0]:g} s is outside" if outside.size else f"are {given.size}, must be 1 to {TIMES}"
        raise ModelError(where, f"{what}: there are states from t = {stored[0]:g} to {stored[-1]:g} s")
    nearest = np.abs(stored[:, None] - given).argmin(axis=0)
    found: FloatArray = stored[np.unique(nearest)]
    return found


def together(scenes: Iterable[Scene]) -> Scene:
    """One scene at one time with what some scenes show; threads know their time as "t"."""
    given = list(scenes)
    threads: list[Thread] = []
    links: list[Link] = []
    markers: list[Marker] = []
    triads: list[Triad] = []
    strips: list[Strip] = []
    arrows: list[Arrow] = []
    for scene in given:
        threads += [_timed(thread, scene.t[0]) for thread in scene.threads]
        links, markers, triads = links + scene.links, markers + scene.markers, triads + scene.triads
        strips, arrows = strips + scene.strips, arrows + scene.arrows
    title, t, stored = given[0].title, given[0].t, given[0].stored
    return Scene(title, t, threads, links, markers, triads, strips, stored, arrows)


def _timed(thread: Thread, t: float) -> Thread:
    return replace(thread, values=thread.values | {"t": np.full((1, len(thread.x)), t)})


def _picture(scene: Scene, plane: Any, color: str, size: Any) -> Picture:
    axes_of = None if plane is None else parse_plane(plane, "plot.plane")
    view = projection(points_of(scene), axes_of)
    if color == "t" and not scene.threads:
        color = "plain"
    width = WIDTH + (0.0 if color == "plain" else BAR)
    with style.new_figure(*size_of(size, (width, view.height(WIDTH - 20.0) + REST))) as figure:
        stage = Stage(view.add_axes(figure), scene, view, color)
        stage.show(0)
        finish(figure, stage)
        return Picture(figure)


def finish(figure: Figure, stage: Stage) -> None:
    """Add the colour bar and the legend of the markers."""
    stage.add_colorbar(figure)
    if stage.kinds or stage.scene.arrows:
        style.legend_above(figure, stage.axes, columns=6)


def points_of(scene: Scene) -> FloatArray:
    """All points (m, 3) of a scene that a picture must hold, m."""
    return np.concatenate([part.reshape(-1, 3) for part in _parts(scene)])


def _parts(scene: Scene) -> list[FloatArray]:
    parts = [thread.position for thread in scene.threads]
    parts += [thread.outline for thread in scene.threads if thread.outline is not None]
    parts += [link.ends for link in scene.links] + [strip.ends for strip in scene.strips]
    parts += [triad.centre[:, None] + triad.size * np.swapaxes(triad.axes, 1, 2) for triad in scene.triads]
    parts += [arrow.reach for arrow in scene.arrows]
    return parts + [marker.position for marker in scene.markers]


def _view_of_mode(rest: Scene, scene: Scene, plane: Any) -> Projection:
    """Plane of the direction in which a mode moves most and of the longest one beside it."""
    both = np.concatenate([points_of(rest), points_of(scene)])
    if plane is not None:
        return projection(both, parse_plane(plane, "plot.plane"))
    moved = np.abs(_bodies(scene) - _bodies(rest)).max(axis=0)
    extent = np.ptp(_bodies(rest), axis=0)
    along = int(np.argmax(moved))
    extent[along] = -1.0
    return projection(both, tuple(sorted((along, int(np.argmax(extent))))))


def _bodies(scene: Scene) -> FloatArray:
    """Points (m, 3) of bodies alone, m: links and markers of a mode may be others than those at rest."""
    parts = [thread.position for thread in scene.threads]
    parts += [thread.outline for thread in scene.threads if thread.outline is not None]
    parts += [triad.centre[:, None] + triad.size * np.swapaxes(triad.axes, 1, 2) for triad in scene.triads]
    parts += [marker.position for marker in scene.markers if marker.kind in ("point mass", "rigid body")]
    return np.concatenate([part.reshape(-1, 3) for part in parts])
