"""Projection: three dimensions seen in a plane of two axes, or in space."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


AXES = "xyz"
#: Extent below which a motion counts as plane, and above which both axes cannot have the same scale.
FLAT, LONG = 0.02, 15.0
#: Smallest extent that is shown, in a plane and in space, and the margin around all, of the largest extent.
LEAST, LEAST_SPACE, MARGIN = 0.25, 0.3, 0.05
#: Shares of the width and the height of its place that the box of a picture in space fills.
FILLED = 0.62, 0.9
#: Where the eye is, degrees.
ELEVATION, AZIMUTH = 22.0, -60.0


@dataclass(frozen=True)
class Projection:
    """Axes that are seen, and between which coordinates.

    Parameters
    ----------
    axes : tuple of 2 or 3 numbers
        Which of x, y, z.
    low, high : (d,) m
    equal : bool
        All axes have the same scale.
    """

    axes: tuple[int, ...]
    low: FloatArray
    high: FloatArray
    equal: bool

    def __call__(self, points: FloatArray) -> FloatArray:
        """Coordinates (..., d) of points (..., 3)."""
        seen: FloatArray = points[..., list(self.axes)]
        return seen

    @property
    def space(self) -> bool:
        """Whether it is three-dimensional."""
        return len(self.axes) == 3

    @property
    def extent(self) -> FloatArray:
        """Lengths (d,) of the axes, m."""
        return self.high - self.low

    def add_axes(self, figure: Figure, *place: int) -> Axes:
        """Axes with labels, limits and scale."""
        made = figure.add_subplot(*(place or (1, 1, 1)), **({"projection": "3d"} if self.space else {}))
        for k, axis in enumerate(self.axes):
            getattr(made, f"set_{AXES[k]}label")(f"{AXES[axis]} [m]")
            getattr(made, f"set_{AXES[k]}lim")(self.low[k], self.high[k])
        if self.space:
            self._finish_space(made)
        elif self.equal:
            made.set_aspect("equal")
        return made

    def _finish_space(self, axes: Any) -> None:
        axes.set_in_layout(False)  # it reaches beyond its place, which the layout cannot know
        axes.view_init(elev=ELEVATION, azim=AZIMUTH)
        axes.set_box_aspect(self.box)
        axes.set_box_aspect(self.box, zoom=self._zoom(axes))
        axes.tick_params("both", pad=-1.0)
        for axis, part in zip((axes.xaxis, axes.yaxis, axes.zaxis), self.box, strict=True):
            axis.labelpad = -6.0 if axis is axes.zaxis and part < 0.6 else -1.0
            axis.get_major_locator().set_params(nbins=5 if part > 0.5 else 3)

    def _zoom(self, axes: Any) -> float:
        """What lets the box of all axes fill its place, which is as high as the square they are drawn in."""
        from mpl_toolkits.mplot3d.proj3d import proj_transform

        corners = np.array(list(product(*zip(self.low, self.high, strict=True)))).T
        seen = np.array(proj_transform(*corners, axes.get_proj())[:2])
        width, height = np.ptp(seen, axis=1) / axes.viewLim.size
        return float(min(FILLED[0] * 100.0 / self.height(100.0) / width, FILLED[1] / height))

    @property
    def box(self) -> FloatArray:
        """Lengths (d,) of the axes as drawn, the longest is 1."""
        box: FloatArray = self.extent / self.extent.max()
        if not self.equal:
            np.maximum(box, LEAST_SPACE, out=box)
        return box

    def height(self, width: float) -> float:
        """Height that suits a width of the axes, both in mm."""
        if self.space:
            return (0.35 + 0.45 * float(self.box[2])) * width
        if not self.equal:
            return 0.4 * width
        return float(np.clip(width * self.extent[1] / self.extent[0], 0.3 * width, 1.1 * width))


def parse_plane(given: Any, where: str) -> tuple[int, ...]:
    """Axes written as two or three different letters of "xyz".

    Raises
    ------
    ModelError
        It is something else.
    """
    letters = given if isinstance(given, str) else ""
    if len(letters) not in (2, 3) or len(set(letters)) < len(letters) or not set(letters) <= set(AXES):
        what = f'is {checks.shown(given)}, must be two or three letters of "xyz"'
        raise ModelError(where, what, 'such as "xz" for a plane, "xyz" for space')
    return tuple(AXES.index(letter) for letter in letters)


def projection(points: FloatArray, axes: tuple[int, ...] | None = None) -> Projection:
    """Projection that shows points (..., 3) m; without axes the plane in which they lie, or space."""
    flat = points.reshape(-1, 3)
    low, high = flat.min(axis=0), flat.max(axis=0)
    chosen = list(best_axes(high - low) if axes is None else axes)
    extent = (high - low)[chosen]
    largest = float(extent.max()) or 1.0
    second = float(np.sort(extent)[-2])
    equal = len(chosen) == 3 and second * LONG >= largest
    if len(chosen) == 2:
        equal = second * LONG >= largest or second <= 1e-6 * largest
    least = (LEAST_SPACE if len(chosen) == 3 else LEAST) * largest if equal else MARGIN * extent
    shown = np.maximum(extent, np.maximum(least, 1e-6 * largest))
    middle = 0.5 * (low + high)[chosen]
    half = (0.5 + MARGIN) * shown if not equal else 0.5 * shown + MARGIN * largest
    return Projection(tuple(chosen), middle - half, middle + half, equal)


def best_axes(extent: FloatArray) -> tuple[int, ...]:
    """The two axes of a plane motion, z with the one of a straight one, or all three."""
    order = np.argsort(extent, kind="stable")
    small = extent <= FLAT * extent[order[2]]
    if np.count_nonzero(small) >= 2:
        first = int(order[2])
        return (first, 2) if first != 2 else (0, 2)
    if np.any(small):
        return tuple(sorted(int(k) for k in order[1:]))
    return (0, 1, 2)
