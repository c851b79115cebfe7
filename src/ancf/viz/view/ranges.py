"""Smallest and largest values along bodies over a run, for the plots along the arc length."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...model.bodies.beam import Beam
from ..scene import Scene, Thread
from ..scene.sampling import tensions
from .curve import within
from .histories import Histories

#: Places on all bodies together, and their values over time for each quantity, at most.
PLACES, VALUES = 400, 1_500_000
#: A beam with a cross-section costs about so many times as much.
SOLID = 10
#: Displacements since the start, by what they are called in the page.
MOVES = {"x displacement": 0, "y displacement": 1, "z displacement": 2}


@dataclass(frozen=True, slots=True)
class Range:
    """Extremes along a body.

    Parameters
    ----------
    name : str
        The thread's.
    x : (m,) m
        Reference arc lengths.
    values : dict of str to (2, m)
        Least and greatest of each of QUANTITIES and MOVES.
    states : int
        How many stored states were looked at.
    """

    name: str
    x: FloatArray
    values: dict[str, FloatArray]
    states: int


def ranges(states: Histories, scene: Scene) -> list[Range]:
    """Extremes over all states of a scene's time, or over as many as can be looked at in a second or two."""
    inside = within(states.t, (float(scene.t[0]), float(scene.t[-1])))
    count = inside.stop - inside.start
    total = sum(len(thread.x) for thread in scene.threads)
    if count < 2 or total == 0:
        return []
    stride = max(1, -(-total // PLACES))
    kept = sum(-(-len(thread.x) // stride) + 1 for thread in scene.threads)
    solid = any(thread.outline is not None for thread in scene.threads)
    some = states.every(inside, -(-count * kept * (SOLID if solid else 1) // VALUES))
    return [_range(some, thread, stride) for thread in scene.threads]


def _range(states: Histories, thread: Thread, stride: int) -> Range:
    beam = states.bodies[thread.name]
    assert isinstance(beam, Beam)
    x = np.union1d(thread.x[::stride], thread.x[-1:])
    points = [beam.at(place) for place in x.tolist()]
    questions: dict[str, Callable[[Any], FloatArray]] = {
        "curvature": states.curvature,
        "speed": lambda point: np.linalg.norm(states.velocity(point), axis=-1),
    }
    values = {"tension": _extremes(tensions(states, beam, x))}
    values |= {name: np.stack([_extremes(ask(p)) for p in points], axis=1) for name, ask in questions.items()}
    moved = [_extremes((r := states.position(p)) - r[0]) for p in points]  # each (2, 3)
    for name, axis in MOVES.items():
        values[name] = np.stack([both[:, axis] for both in moved], axis=1)
    return Range(thread.name, x, values, len(states.t))


def _extremes(values: FloatArray) -> FloatArray:
    return np.stack([values.min(axis=0), values.max(axis=0)])
