"""Cant: how far the track leans, and where what hangs plumb is across it. `line` is a Line."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from ...arrays import FloatArray

#: Distance of the rails' middles, and largest cant, m.
RAILS, LARGEST = 1.5, 0.3
#: Pieces of a span in which the cant grows.
PIECES = 6


def tilt(line: Any, track: Any) -> FloatArray:
    """Angles of the track at track positions, rad, positive where it leans to the left."""
    angles: FloatArray = np.arcsin(np.interp(track, line.supports, line.cants) / RAILS)
    return angles


def plumb_above(line: Any, height: Any) -> tuple[float, ...]:
    """Sideways places (spans + 1,) in m at heights over the contact wire, plumb above it at the supports."""
    places: list[float] = (
        np.array(line.stagger) - np.asarray(height) * np.tan(tilt(line, line.supports))
    ).tolist()
    return tuple(places)


def sideways_gravity(line: Any, cuts: Sequence[float]) -> Iterator[tuple[float, float, float]]:
    """Pieces of the track between cuts, m, and gravity's part across it there, m/s^2.

    Where the cant grows it is that of the middle of each piece.
    """
    for a, b in pairwise(cuts):
        ends = tilt(line, [a, b])
        if not np.any(ends):
            continue
        places = np.linspace(a, b, 1 + (PIECES if ends[0] != ends[1] else 1))
        for x0, x1 in pairwise(places.tolist()):
            yield x0, x1, line.gravity * float(np.sin(tilt(line, 0.5 * (x0 + x1))))
