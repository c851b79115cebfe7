"""Bodies that stood above all that holds them and hang below it in an equilibrium: they have fallen over.

What stands upright without being held from the side has an equilibrium, which is unstable: a stable one is
found, far from what was drawn.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..model.bodies.beam import Beam
from ..model.bodies.rigid import RigidBody
from ..model.kinds import kind_of
from ..model.points import Point, initial_position

#: Share of the length of a body, and of the size of the model, by which its middle is above or below.
CLEAR, SMALL = 0.25, 0.02
#: Points along a beam whose mean is its middle.
POINTS = 9


def notes(known: Any) -> list[str]:
    """What is said of an equilibrium in which a body has fallen over, of the first one."""
    model = known.system.model
    weight = float(np.linalg.norm(model.gravity))
    holders = _holders(model)
    if not (known.known.balanced and weight > 0.0 and holders):
        return []
    up = -np.asarray(model.gravity) / weight
    first = [float(initial_position(end) @ up) for end in holders]
    now = [float((known.position(end) if isinstance(end, Point) else end) @ up) for end in holders]
    for body in model.bodies.values():
        if not isinstance(body, Beam | RigidBody):
            continue
        clear = CLEAR * body.length if isinstance(body, Beam) else SMALL * model.size
        stood = float(_middle(body, initial_position) @ up) > max(first) + clear
        if stood and float(_middle(body, known.position) @ up) < min(now) - clear:
            what = f'"{body.name}" stood above all that holds it and hangs below it: it has fallen over'
            return [f"{what}; clamp it, hold its top from the side, or draw it as it should hang"]
    return []


def _holders(model: Any) -> list[Any]:
    """Points that supports hold, and fixed positions to which connections go."""
    ends = [end for item in model.connections for end in kind_of(item).ends_of(item)]
    fixed = [end for end in ends if isinstance(end, np.ndarray)]
    return [*(item.point for item in model.supports if item.held), *fixed]


def _middle(body: Beam | RigidBody, place: Callable[[Any], FloatArray]) -> FloatArray:
    if isinstance(body, Beam):
        points = [body.at(x) for x in np.linspace(0.0, body.length, POINTS)]
    else:
        points = [body.centre]
    middle: FloatArray = np.mean([place(point) for point in points], axis=0)
    return middle
