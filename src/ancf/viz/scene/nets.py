"""Nets: grounds and surfaces of fluids, as far as the bodies reach, and surfaces that beams touch."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...model.surfaces.mesh import Mesh
from ...model.surfaces.shapes import Plane
from ...model.surfaces.surface import Surface
from ...model.surroundings.grounds import Ground, Relief
from ...model.surroundings.waves import Waves, wave_numbers
from .parts import Net

#: Lines of a net in each direction, share by which it is larger than the bodies, least width as a share.
LINES, MARGIN, NARROW = 9, 0.1, 0.3
#: A surface that is farther from all bodies than so many of their extents is not drawn.
FAR = 0.5
#: Points of a line of a surface for each length of the waves, and the most.
PER_WAVE, MOST_POINTS = 12, 61
#: Of a surface of revolution: points of a circle, meridians, and the most circles.
CIRCLE, MERIDIANS, RINGS = 48, 12, 7


def make_nets(model: Any, drawn: list[FloatArray], t: FloatArray) -> list[Net]:
    """Nets of a model around points that are drawn; surfaces with waves move at the times t (n,), s."""
    solids = [net for item in model.surfaces if (net := _solid(item)) is not None]
    planes = [item for item in model.surfaces if isinstance(item.shape, Plane) and item.on is None]
    if not model.grounds and not model.fluids and not planes:
        return solids
    points = np.concatenate([part.reshape(-1, 3) for part in drawn])
    low, high = points.min(axis=0), points.max(axis=0)
    size = float(np.max(high - low)) or 1.0
    half = np.maximum((0.5 + MARGIN) * (high - low), 0.5 * NARROW * size)[:2]
    middle = 0.5 * (low + high)[:2]
    x, y = (np.linspace(middle[k] - half[k], middle[k] + half[k], LINES) for k in range(2))
    nets = [Net(item.name, "ground", _lines(x, y, _heights(item, x, y))) for item in model.grounds]
    levels: set[float] = set()
    for item in sorted(model.fluids, key=lambda fluid: fluid.waves is None):
        for level in item.heights:
            near = low[2] - FAR * size <= level <= high[2] + FAR * size
            if near and level not in levels:
                levels.add(level)
                waves = item.waves if level == item.heights[1] else None
                nets.append(_surface(f"surface of {item.name}", level, x, y, waves, t, model.gravity))
    reach = float(np.linalg.norm(half))
    return nets + [_plane(item, 0.5 * (low + high), reach) for item in planes] + solids


def _surface(
    name: str, level: float, x: FloatArray, y: FloatArray, waves: Waves | None, t: FloatArray, g: FloatArray
) -> Net:
    """The surface of a fluid at a height; with waves its points lie close enough to show the peak's."""
    if waves is None:
        return Net(name, "surface", _lines(x, y, np.full((LINES, LINES), level)))
    length = 2.0 * np.pi / wave_numbers(np.array([2.0 * np.pi / waves.period]), waves.depth, -g[2])[0]
    wide = max(float(np.ptp(x)), float(np.ptp(y)))
    count = int(np.clip(PER_WAVE * wide / length, LINES, MOST_POINTS))
    ends = [(axis, np.linspace(axis[0], axis[-1], count)) for axis in (x, y)]
    along = [_net_lines(x, ends[1][1], level), _net_lines(y, ends[0][1], level)[..., [1, 0, 2]]]
    lines = np.concatenate(along)
    return Net(
        name, "surface", lines, heights=level + waves.elevations(t, lines[..., 0], lines[..., 1], -g[2])
    )


def _net_lines(across: FloatArray, along: FloatArray, level: float) -> FloatArray:
    """Level lines (k, m, 3) at places across, with points along."""
    first, second = np.meshgrid(across, along, indexing="ij")
    return np.stack([first, second, np.full_like(first, level)], axis=-1)


def _solid(item: Surface) -> Net | None:
    """Circles and meridians of a surface of revolution, edges of a mesh; None for a plane, which has none."""
    on = "" if item.on is None else item.on.name
    if isinstance(item.shape, Mesh):
        return Net(item.name, "contact", item.shape.place + item.shape.lines, on)
    outline = np.array(item.shape.outline)
    if not len(outline):
        return None
    a, b, c = _triad(item.shape.direction)
    angles = np.linspace(0.0, 2.0 * np.pi, CIRCLE + 1)
    around = np.cos(angles)[:, None] * a + np.sin(angles)[:, None] * b
    rho, z = outline[:, 0], outline[:, 1]
    places = item.shape.place + rho[:, None, None] * around + z[:, None, None] * c
    kept = np.unique(np.linspace(0, len(outline) - 1, min(len(outline), RINGS)).round().astype(int))
    rings = list(places[kept][rho[kept] > 0.0])
    meridians = [places[:, k] for k in range(0, CIRCLE, CIRCLE // MERIDIANS)]
    longest = max(map(len, (*rings, *meridians)))
    lines = np.array([_filled(line, longest) for line in (*rings, *meridians)])
    return Net(item.name, "contact", lines, on)


def _plane(item: Surface, middle: FloatArray, reach: float) -> Net:
    """A piece of a plane below the bodies."""
    a, b, c = _triad(item.shape.direction)
    middle = middle - ((middle - item.shape.place) @ c) * c
    at = np.linspace(-reach, reach, LINES)
    grid = middle + at[:, None, None] * a + at[None, :, None] * b
    return Net(item.name, "contact", np.concatenate([grid, grid.transpose(1, 0, 2)]))


def _triad(axis: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Two unit vectors across an axis, and the axis."""
    a = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
    a = a / np.linalg.norm(a)
    return a, np.cross(axis, a), axis


def _filled(line: FloatArray, count: int) -> FloatArray:
    """A line of so many points: the last one again and again."""
    return np.concatenate([line, np.repeat(line[-1:], count - len(line), axis=0)])


def _heights(item: Ground, x: FloatArray, y: FloatArray) -> FloatArray:
    if isinstance(item.height, Relief):
        return np.array([[item.height.at(a, b) for b in y.tolist()] for a in x.tolist()])
    n = item.up
    slope: FloatArray = item.height - (n[0] * x[:, None] + n[1] * y[None, :]) / n[2]
    return slope


def _lines(x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
    """Lines along y, then along x, (2 LINES, LINES, 3)."""
    grid = np.stack([*np.meshgrid(x, y, indexing="ij"), z], axis=-1)
    return np.concatenate([grid, grid.transpose(1, 0, 2)])
