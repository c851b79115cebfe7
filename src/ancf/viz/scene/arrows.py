"""Loads as arrows: where they push now, and how hard against the most that a load of the kind pushes.

The velocity of a fluid is drawn as a load is, beside the bodies.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...model.bodies.beam import Beam
from ...model.kind import Push
from ...model.kinds import FLUID, kind_of, pushing
from ...model.loads.state_function import StateFunction
from ...model.points import Point
from .parts import Arrow
from .streams import stream

#: Length of the longest arrow of a kind, of the largest extent, and where lengths are drawn not to scale.
LONGEST, ACROSS = 0.14, 0.3
#: A scene that is longer than this many of its middle extents is not drawn to scale, unless it is straight.
SLENDER, STRAIGHT = 15.0, 1e-6
#: Arrows of a distributed load; an arrow shorter than this, of the longest, is left out.
ROW, SHORTEST = 9, 0.02
#: Length of a head in longest arrows, at most this much of its arrow; its half width in its length.
HEAD, MOST, SLOPE = 0.25, 0.5, 0.4
#: Radius of the arrow of a moment in its length, and the lines of which it is made.
RADIUS, PIECES = 0.4, 24


def make_arrows(shown: Any, drawn: list[FloatArray]) -> list[Arrow]:
    """Arrows of the loads that know how to be drawn as such, at the times that are shown.

    Parameters
    ----------
    shown : Frames
        The states.
    drawn : list of (..., 3) m
        Places of what the arrows are drawn at.
    """
    longest, found = longest_of(drawn), []
    for kind, push in pushing().items():
        items = [item for item in shown.model.loads if kind_of(item).noun == kind]
        known = [(item, *acting(shown, item, push)) for item in items]
        if kind == FLUID.noun:
            known = [(item, *stream(shown, item, drawn)) for item in shown.model.fluids]
        largest = max((float(size.max()) for *_, size in known if size.size), default=0.0)
        for item, places, value, size in known:
            if size.size and float(size.max()) > SHORTEST * largest:
                ends = _ends(places, value * (longest / largest), push)
                reach = _rims(ends) if push.turns else ends
                found.append(Arrow(item.name, kind, ends, size, push, HEAD * longest, reach))
    return found


def acting(shown: Any, item: Any, push: Push) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Places (n, k, 3), m, vectors (n, k or 1, 3) that act there and the largest (n,); none if unknown."""
    end = kind_of(item).ends_of(item)[0]
    points = [end] if isinstance(end, Point) else list(_along(end, item.between))
    places = np.stack([shown.place(point) for point in points], axis=1)
    try:
        function = getattr(item, push.field)
        depends = isinstance(function, StateFunction)
        many = depends or bool(push.frame)
        value = np.stack([_value(shown, function, p) for p in (points if many else points[:1])], axis=1)
        if push.frame:
            value = _turned(shown, item, push, points, value)
    except ModelError:  # a Python function that a file does not hold
        return places, np.zeros((0, 1, 3)), np.zeros(0)
    return places, value, np.linalg.norm(value, axis=2).max(axis=1)


def _turned(shown: Any, item: Any, push: Push, points: list[Any], value: FloatArray) -> FloatArray:
    """Global components (n, k, 3) of what is given in the axes of a body, or as a pressure."""
    if push.frame == "normal":
        slopes = np.stack([shown.slope(point) for point in points], axis=1)
        normal: FloatArray = value[..., :1] * np.cross(slopes, item.axis)
        return normal
    body = points[0].body
    if isinstance(body, Beam) and not body.has_section:
        slope = shown.slope(points[0])
        along: FloatArray = value[..., :1] * (slope / np.linalg.norm(slope, axis=-1, keepdims=True))[:, None]
        return along
    turned: FloatArray = np.einsum("nij,nkj->nki", shown.section_rotation(points[0]), value)
    return turned


def _along(beam: Beam, between: tuple[float, float]) -> Iterator[Point]:
    return (beam.at(x) for x in np.linspace(*between, ROW).tolist())


def _value(shown: Any, function: Any, point: Point) -> FloatArray:
    if isinstance(function, StateFunction):
        states = zip(shown.t.tolist(), shown.place(point), shown.velocity(point), strict=True)
        return np.stack([function(*state) for state in states])
    if function.constant:
        constant: FloatArray = np.broadcast_to(function(0.0), (len(shown.t), function.size))
        return constant
    values: FloatArray = function.table(shown.t)
    return values


def longest_of(drawn: list[FloatArray]) -> float:
    """Length of the longest arrow, m."""
    points = np.concatenate([part.reshape(-1, 3) for part in drawn])
    _, middle, largest = np.sort(np.ptp(points, axis=0)).tolist()
    if STRAIGHT * largest < middle < largest / SLENDER:
        return float(ACROSS * middle)
    return float(LONGEST * (largest or 1.0))


def _ends(places: FloatArray, vector: FloatArray, push: Push) -> FloatArray:
    """Tails and tips (n, k, 2, 3), m: a force ends where it acts, the axis of a moment begins there."""
    along = np.broadcast_to(vector, places.shape)
    ends = (places, places + along) if push.turns else (places - along, places)
    return np.stack(ends, axis=2)


def strokes(arrow: Arrow, k: int) -> FloatArray:
    """Lines (m, 2, 3) that draw an arrow at time k: straight or round, with a head; none without length."""
    tail, tip = arrow.ends[k, :, 0], arrow.ends[k, :, 1]
    length = np.linalg.norm(tip - tail, axis=1)
    there = length > 0.0
    if not np.any(there):
        return np.zeros((0, 2, 3))
    tail, tip, length = tail[there], tip[there], length[there, None]
    axes = _axes((tip - tail) / length)
    lines = _round(tail, length, axes) if arrow.push.turns else [np.stack([tail, tip], axis=1)]
    end, along, *sides = (lines[-1][:, 1], axes[1], axes[2], axes[0]) if arrow.push.turns else (tip, *axes)
    size = np.minimum(arrow.head, MOST * length)
    for side in (s * part for part in sides for s in (1.0, -1.0)):
        lines.append(np.stack([end, end + size * (SLOPE * side - along)], axis=1))
    return np.concatenate(lines)


def _axes(along: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Unit vectors (k, 3) and two normal to each; of one in a plane of two axes, the first lies in it."""
    least = np.eye(3)[np.argmin(np.abs(along), axis=1)]
    first = np.cross(along, least)
    first /= np.linalg.norm(first, axis=1)[:, None]
    return along, first, np.cross(along, first)


def _rims(ends: FloatArray) -> FloatArray:
    """Four places (n, k, 4, 3) on the circles of round arrows, m; their centres where nothing acts."""
    centre, whole = ends[:, :, 0].reshape(-1, 3), (ends[:, :, 1] - ends[:, :, 0]).reshape(-1, 3)
    length = np.linalg.norm(whole, axis=1)[:, None]
    _, first, second = _axes(np.divide(whole, length, where=length > 0.0, out=np.full_like(whole, 0.5)))
    places = [centre + RADIUS * length * side for side in (first, -first, second, -second)]
    rims: FloatArray = np.stack(places, axis=1).reshape(*ends.shape[:2], 4, 3)
    return rims


def _round(centre: FloatArray, length: FloatArray, axes: tuple[FloatArray, ...]) -> list[FloatArray]:
    """Three quarters of circles about axes, as lines (k, 2, 3); they end where `axes[1]` is the direction."""
    _, first, second = axes
    angle = np.linspace(-1.5 * np.pi, 0.0, PIECES + 1)
    points = [centre + RADIUS * length * (np.sin(a) * first - np.cos(a) * second) for a in angle.tolist()]
    return [np.stack(pair, axis=1) for pair in pairwise(points)]
