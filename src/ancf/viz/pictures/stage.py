"""Stage: a scene drawn with matplotlib, which can be moved to any of its times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks
from ...model.kinds import pushing
from .. import style
from ..scene import QUANTITIES, Arrow, Scene, Thread, looks, strokes
from ..scene.parts import BODIES
from .projection import Projection

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure


COLORS = (*QUANTITIES, "plain")
#: How wide lines are drawn, points.
BODY, EDGE, SPRING, STRIP, AXIS, ARROW = 1.8, 0.4, 0.8, 2.4, 1.4, 1.0
#: Shapes and fills of :class:`ancf.model.kind.Look` in matplotlib.
SHAPES = {"circle": "o", "square": "s", "diamond": "d", "up": "^", "down": "v", "slider": "D"}
FILLS = {
    "black": style.BLACK,
    "grey": "white",
    "light": style.LIGHT,
    "white": "white",
    "orange": style.ORANGE,
}

#: Colours of loads, in the order of their kinds.
PUSHED = (style.WINE, style.GREEN, style.BLUE)


class Trace(NamedTuple):
    """Path of a point: times (k,) s, and its positions (k, 3) m."""

    t: FloatArray
    position: FloatArray


class Stage:
    """A scene in axes, coloured by a quantity.

    Parameters
    ----------
    axes : Axes
    scene : Scene
    view : Projection
    color : str
        One of COLORS.
    traces : sequence of Trace
        Paths of points, drawn until the time that is shown.
    """

    def __init__(
        self, axes: Axes, scene: Scene, view: Projection, color: str, traces: Sequence[Trace] = ()
    ) -> None:
        self.axes, self.scene, self.view, self.color = axes, scene, view, color
        self.traces = traces
        self.norm = None if color == "plain" else norm_of(*scene.limits(color))
        self._paths = [axes.plot([], [], *self._third(), color=style.LIGHT, linewidth=0.8)[0] for _ in traces]
        self._edges = self._lines(style.GREY, EDGE)
        self._springs = self._lines(style.GREY, SPRING)
        self._loose = self._lines(style.LIGHT, SPRING, linestyle=(0, (2, 2)))
        self._strips = self._lines(style.WINE, STRIP)
        self._bodies = self._threads()
        self._triads = [self._lines(color, AXIS) for color in (style.ORANGE, style.GREEN, style.SKY)]
        self._markers = {kind: self._marker(kind) for kind in self.kinds}
        self._arrows = {kind: self._arrow(kind) for kind in pushing() if self._pushed(kind)}
        for artist in (*axes.lines, *axes.collections):
            artist.set_clip_on(False)  # all lies within the limits, which in space are larger than the axes

    @property
    def kinds(self) -> list[str]:
        """Kinds of markers that the scene has."""
        there = {marker.kind for marker in self.scene.markers}
        return [kind for kind in looks() if kind in there]

    def show(self, k: int) -> None:
        """Move to time k of the scene."""
        scene = self.scene
        for path, trace in zip(self._paths, self.traces, strict=True):
            until = int(np.searchsorted(trace.t, scene.t[k], side="right"))
            self._set(path, trace.position[:until])
        self._bodies.set_segments(self._flat([segment for t in scene.threads for segment in segments(t, k)]))
        if self.norm is not None:
            self._bodies.set_array(np.concatenate([middles(t.values[self.color][k]) for t in scene.threads]))
        outlines = [thread.outline[k] for thread in scene.threads if thread.outline is not None]
        self._edges.set_segments(self._flat([line for outline in outlines for line in edges(outline)]))
        for lines, loose in ((self._springs, False), (self._loose, True)):
            lines.set_segments(self._flat([link.ends[k] for link in scene.links if link.slack[k] == loose]))
        self._strips.set_segments(self._flat([strip.ends[k] for strip in scene.strips]))
        for kind, drawn in self._arrows.items():
            lines = [strokes(arrow, k) for arrow in self._pushed(kind)]
            drawn.set_segments(self._flat(list(np.concatenate(lines))))
        for j, lines in enumerate(self._triads):
            tips = [t.centre[k] + t.size * t.axes[k][:, j] for t in scene.triads]
            lines.set_segments(
                self._flat([np.stack([t.centre[k], tip]) for t, tip in zip(scene.triads, tips, strict=True)])
            )
        for kind, points in self._markers.items():
            self._set(points, np.array([m.position[k] for m in scene.markers if m.kind == kind]))

    def add_colorbar(self, figure: Figure) -> None:
        """Bar with the quantity's values beside the axes."""
        if self.norm is not None:
            bar = figure.colorbar(
                self._bodies, ax=self.axes, shrink=0.8, pad=0.2 if self.view.space else 0.02
            )
            bar.set_label(style.axis_label(self.color))
            bar.outline.set_visible(False)

    def _flat(self, lines: Sequence[FloatArray]) -> list[FloatArray]:
        return [self.view(line) for line in lines]

    def _set(self, line: Any, points: FloatArray) -> None:
        columns = self.view(points).T
        line.set_data(*columns[:2])
        if self.view.space:
            line.set_3d_properties(columns[2])

    def _third(self) -> list[list[float]]:
        return [[]] if self.view.space else []

    def _lines(self, color: str, width: float, **more: Any) -> Any:
        return add_lines(self.axes, self.view, [], colors=color, linewidths=width, **more)

    def _pushed(self, kind: str) -> list[Arrow]:
        return [arrow for arrow in self.scene.arrows if arrow.kind == kind]

    def _arrow(self, kind: str) -> Any:
        return self._lines(PUSHED[list(pushing()).index(kind) % len(PUSHED)], ARROW, label=kind, zorder=4.5)

    def _threads(self) -> Any:
        start = self._flat([segment for t in self.scene.threads for segment in segments(t, 0)])
        look: dict[str, Any] = {"colors": style.BLUE}
        if self.norm is not None:
            look = {"cmap": style.colormap(), "norm": self.norm}
        return add_lines(self.axes, self.view, start, linewidths=BODY, capstyle="round", **look)

    def _marker(self, kind: str) -> Any:
        shape, fill, size = astuple(looks()[kind])
        look: dict[str, Any] = {"marker": SHAPES[shape], "markersize": size, "markerfacecolor": FILLS[fill]}
        look |= {"markeredgecolor": style.BLACK, "markeredgewidth": 0.7, "linestyle": ""}
        look["zorder"] = 5 if kind in BODIES else 4
        return self.axes.plot([], [], *self._third(), label=kind, **look)[0]


def add_lines(axes: Axes, view: Projection, lines: Sequence[FloatArray], **look: Any) -> Any:
    """Collection of lines in a plane or in space; each line is (m, 2) or (m, 3)."""
    if view.space:
        from mpl_toolkits.mplot3d.art3d import Line3DCollection

        # an empty collection in space has no limits; the first line is a point that nobody sees
        collection: Any = Line3DCollection(list(lines) or [np.zeros((2, 3))], **look)
        axes.add_collection3d(collection, autolim=False)  # type: ignore[attr-defined]
    else:
        from matplotlib.collections import LineCollection

        collection = LineCollection(list(lines), **look)
        axes.add_collection(collection, autolim=False)
    return collection


def segments(thread: Thread, k: int) -> FloatArray:
    """Pieces (m - 1, 2, 3) of a thread's centreline at time k, m."""
    position = thread.position[k]
    return np.stack([position[:-1], position[1:]], axis=1)


def middles(values: FloatArray) -> FloatArray:
    """Values (m - 1,) of the pieces between m points."""
    between: FloatArray = 0.5 * (values[:-1] + values[1:])
    return between


def edges(outline: FloatArray) -> list[FloatArray]:
    """Long edges and end faces of an outline (m, k, 3)."""
    faces = [np.concatenate([outline[i], outline[i, :1]]) for i in (0, -1)]
    return [*np.swapaxes(outline, 0, 1), *faces]


def norm_of(low: float, high: float) -> Normalize:
    """Range of the colours; a constant has some width, so that rounding is not coloured."""
    from matplotlib.colors import Normalize

    least = 1e-6 * max(abs(low), abs(high)) or 1.0
    if high - low < least:
        low, high = low - 0.5 * least, high + 0.5 * least
    return Normalize(low, high)


def check_color(given: Any, scene: Scene, where: str, more: Sequence[str] = ()) -> str:
    """One of COLORS, or of more; "plain" where the scene has no values.

    Raises
    ------
    ModelError
        It is another one.
    """
    color = checks.choice(given, where, (*COLORS, *more))
    if color in QUANTITIES and not scene.threads:
        return "plain"
    if color in QUANTITIES and not scene.threads[0].values:
        raise ModelError(where, "a mode has no values to colour by", 'give "plain"')
    return color
