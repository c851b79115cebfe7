"""Nets: the grounds and the surfaces of fluids, as lines about as far as the bodies reach."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...model.grounds import Ground, Relief
from .parts import Net

#: Lines of a net in each direction, share by which it is larger than the bodies, least width as a share.
LINES, MARGIN, NARROW = 9, 0.1, 0.3
#: A surface that is farther from all bodies than so many of their extents is not drawn.
FAR = 0.5


def make_nets(model: Any, drawn: list[FloatArray]) -> list[Net]:
    """Nets of a model around points that are drawn."""
    if not model.grounds and not model.fluids:
        return []
    points = np.concatenate([part.reshape(-1, 3) for part in drawn])
    low, high = points.min(axis=0), points.max(axis=0)
    size = float(np.max(high - low)) or 1.0
    half = np.maximum((0.5 + MARGIN) * (high - low), 0.5 * NARROW * size)[:2]
    middle = 0.5 * (low + high)[:2]
    x, y = (np.linspace(middle[k] - half[k], middle[k] + half[k], LINES) for k in range(2))
    nets = [Net(item.name, "ground", _lines(x, y, _heights(item, x, y))) for item in model.grounds]
    levels: set[float] = set()
    for item in model.fluids:
        for level in item.heights:
            near = low[2] - FAR * size <= level <= high[2] + FAR * size
            if near and level not in levels:
                levels.add(level)
                flat = np.full((LINES, LINES), level)
                nets.append(Net(f"surface of {item.name}", "surface", _lines(x, y, flat)))
    return nets


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
