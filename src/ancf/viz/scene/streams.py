"""Velocity of fluids as arrows beside the bodies: the current or the mean wind, without waves and gusts."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...model.surroundings.fluids import Fluid

#: Arrows over the height of what is drawn, and their place beside it, as a share of its size.
HEIGHTS, BESIDE = 7, 0.15


def stream(shown: Any, item: Fluid, drawn: list[FloatArray]) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Places (n, k, 3), m, velocities there, m/s, and the largest (n,); none where it rests or is unknown."""
    nothing = np.zeros((len(shown.t), 0, 3)), np.zeros((0, 1, 3)), np.zeros(0)
    points = np.concatenate([part.reshape(-1, 3) for part in drawn])
    low, high = points.min(axis=0), points.max(axis=0)
    below, above = item.heights
    bottom, top = max(low[2], below), min(high[2], above)
    if not item.velocity.moves or item.velocity.missing or bottom > top:
        return nothing
    aside = BESIDE * float(np.max(high - low))
    heights = np.linspace(bottom, top, HEIGHTS if top > bottom else 1)
    places = np.stack(
        [np.full_like(heights, low[0] - aside), np.full_like(heights, 0.5 * (low[1] + high[1])), heights],
        axis=1,
    )
    try:
        values = [[item.velocity.at(t, place) for place in places] for t in shown.t.tolist()]
    except ModelError:  # a Python function that has no value there
        return nothing
    velocity = np.array(values)
    size: FloatArray = np.linalg.norm(velocity, axis=2).max(axis=1)
    return np.broadcast_to(places, velocity.shape), velocity, size
