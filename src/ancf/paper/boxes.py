"""An element as a solid box in parallel projection: small drawings of shapes in space, without axes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..arrays import FloatArray
from ..viz import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

AZIMUTH, ELEVATION = -62.0, 22.0  # degrees, of the eye
LIGHT = np.array([0.25, -0.75, 0.6])  # direction to the light
LINE = 0.35  # points

#: Corners of the section in units of its half width, in order around it.
CORNERS = ((-1, -1), (1, -1), (1, 1), (-1, 1))


def eye() -> FloatArray:
    """Rows: directions to the right, up and to the eye, (3, 3)."""
    a, e = np.radians([AZIMUTH, ELEVATION])
    to_eye = np.array([np.cos(a) * np.cos(e), np.sin(a) * np.cos(e), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return np.stack([right, np.cross(to_eye, right), to_eye])


def draw_box(axes: Axes, edges: FloatArray, color: str) -> None:
    """Draw the surface of a box, farther patches first.

    Parameters
    ----------
    axes : Axes
    edges : (4, n, 3) array
        Its four long edges, in the order of CORNERS, at n stations.
    color : str

    """
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import to_rgb

    following = np.roll(edges, -1, axis=0)
    sides = np.stack([edges[:, :-1], edges[:, 1:], following[:, 1:], following[:, :-1]], axis=2)
    ends = np.stack([edges[::-1, 0], edges[:, -1]])
    patches = np.concatenate([sides.reshape(-1, 4, 3), ends])
    view = patches @ eye().T
    order = np.argsort(view[..., 2].mean(axis=1))
    shade = _shades(patches)[order, None]
    colors = np.clip(shade * np.array(to_rgb(color)) + (1 - shade), 0, 1)
    surface = PolyCollection(list(view[order, :, :2]), facecolors=colors, edgecolors=color, linewidths=LINE)
    axes.add_collection(surface)


def draw_frame(axes: Axes, edges: FloatArray) -> None:
    """Draw the outline of a box (4, n, 3) with dashes."""
    flat = edges @ eye()[:2].T
    rings = [np.concatenate([flat[:, i], flat[:1, i]]) for i in (0, -1)]
    for line in (*flat, *rings):
        axes.plot(*line.T, color=style.GREY, linewidth=0.6, linestyle=(0, (3, 2)), zorder=3)


def draw_directions(axes: Axes, origin: FloatArray, length: float) -> None:
    """Draw three arrows along x, y and z."""
    start = eye()[:2] @ origin
    for name, column in zip("xyz", eye()[:2].T, strict=True):
        tip = start + length * column
        arrow = {"arrowstyle": "-|>", "linewidth": 0.6, "color": "black", "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", tuple(tip), tuple(start), arrowprops={**arrow, "mutation_scale": 5})
        place = tip + 0.09 * column / float(np.linalg.norm(column))
        axes.text(place[0], place[1], name, fontsize=6.5, ha="center", va="center")


def _shades(patches: FloatArray) -> FloatArray:
    """How dark each patch (n, 4, 3) is, from 0.25 to 0.75: by its direction to the light."""
    normal = np.cross(patches[:, 2] - patches[:, 0], patches[:, 3] - patches[:, 1])
    size = np.linalg.norm(normal, axis=1)
    lit = np.abs(normal @ LIGHT) / (size * np.linalg.norm(LIGHT) + 1e-300)
    shades: FloatArray = 0.75 - 0.5 * lit
    return shades
