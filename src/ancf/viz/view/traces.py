"""Traces: the paths of some points."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ..scene import Scene
from .curve import within
from .histories import Histories

#: How many are shown when none is asked for, and points of a path at most.
COUNT, POINTS = 3, 2000
#: Below this part of the model's size a point does not move, and two paths of the same form are one.
STILL, ALIKE = 1e-4, 0.02


@dataclass(frozen=True, slots=True)
class Trace:
    """The path of a point.

    Parameters
    ----------
    name : str
    t : (k,) s
    position : (k, 3) m
    """

    name: str
    t: FloatArray
    position: FloatArray


def traces(states: Histories, scene: Scene, wanted: Sequence[str] | None) -> list[Trace]:
    """Paths, over the scene's time, of the points that are asked for, or of a few that move most.

    Raises
    ------
    ModelError
        There is no such point.
    """
    span = float(scene.t[0]), float(scene.t[-1])
    if wanted is not None:
        return [_trace(states, point, span) for point in {str(point): point for point in wanted}.values()]
    found = most_moved((_trace(states, point, span) for point in states.ends()), scene)
    return found or most_moved((_trace(states, point, span) for point in states.middles()), scene)


def traces_of_scene(scene: Scene) -> list[Trace]:
    """The same for a scene alone, such as a mode's: ends of its threads and its masses."""
    found = []
    for thread in scene.threads:
        for k, end in ((-1, "end"), (0, "start")):
            found.append(Trace(f"{thread.name}.{end}", scene.t, thread.position[:, k]))
    bodies = [marker for marker in scene.markers if marker.kind in ("point mass", "rigid body")]
    return most_moved(found + [Trace(marker.name, scene.t, marker.position) for marker in bodies], scene)


def most_moved(found: Iterable[Trace], scene: Scene) -> list[Trace]:
    """The traces that reach farthest, without those of the same form; points on strips come first."""
    strips = [strip.ends[0].mean(axis=0) for strip in scene.strips]

    def rank(trace: Trace) -> tuple[bool, float]:
        near = any(np.allclose(trace.position[0], place, atol=1e-6 * scene.size) for place in strips)
        return not near, -_reach(trace.position)

    kept: list[Trace] = []
    for trace in sorted(found, key=rank):
        moves = _reach(trace.position) > STILL * scene.size
        if moves and not any(_alike(trace, other) for other in kept):
            kept.append(trace)
        if len(kept) == COUNT:
            break
    return kept


def short_label(point: Any) -> str:
    """A point's label with its numbers to four digits."""
    return re.sub(r"\d+\.\d{4,}", lambda number: f"{float(number[0]):.4g}", str(point))


def _trace(states: Histories, point: str, span: tuple[float, float]) -> Trace:
    inside = within(states.t, span)
    if inside.stop - inside.start < 2:  # a short span of a long run, of which not all states are here
        inside = slice(max(inside.start - 1, 0), inside.stop + 1)
    t, position = states.t[inside], states.position(point)[inside]
    stride = max(1, -(-len(t) // POINTS))
    return Trace(short_label(point), t[::stride], position[::stride])


def _reach(path: FloatArray) -> float:
    """Largest extent of a path, m."""
    return float(np.ptp(path, axis=0).max())


def _alike(one: Trace, other: Trace) -> bool:
    """Whether two paths have the same form."""
    apart = (one.position - one.position[0]) - (other.position - other.position[0])
    return float(np.abs(apart).max()) < ALIKE * max(_reach(one.position), _reach(other.position))
