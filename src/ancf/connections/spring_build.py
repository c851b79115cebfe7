"""From springs of the model to the flat arrays of a SpringBatch."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..model.bodies.beam import Beam
from ..model.joints.connections import Spring
from ..model.model import Model
from ..model.points import Point
from .curves import curves
from .spring_damper import SpringBatch

CABLE, SOLID = 4, 10  # slots of an element at most


def springs(model: Model, locate: Callable[[Point], Any]) -> SpringBatch:
    """Batch of all springs; ``locate`` finds a point's slots and shape functions."""
    return _batch([c for c in model.connections if isinstance(c, Spring)], locate)


def no_springs() -> SpringBatch:
    """Batch without springs."""
    return _batch([], lambda point: None)


def _batch(items: list[Spring], locate: Callable[[Point], Any]) -> SpringBatch:
    n, k = len(items), max((_slots(c) for c in items), default=CABLE)
    base = np.full((n, 2 * k), -1, dtype=np.int64)
    factor, offset, data = np.zeros((n, 2 * k)), np.zeros((n, 3)), np.zeros((n, 7))
    for e, spring in enumerate(items):
        data[e, :4] = _numbers(spring)
        data[e, 4:6] = spring.friction, spring.friction_velocity
        for end, first, sign in ((spring.a, 0, -1.0), (spring.b, k, 1.0)):
            if isinstance(end, Point):
                probe = locate(end)
                S = probe.S[0]
                columns = slice(first, first + len(S))
                factor[e, columns] = sign * S
                base[e, columns] = np.where(S != 0.0, probe.slots, -1)
            else:
                offset[e] = end
    dest, inside = np.full((n, 4 * k * k), -1, dtype=np.int64), np.zeros(n, dtype=np.int64)
    given = [curve for item in items for curve in (item.law, item.damper)]
    return SpringBatch(
        base,
        dest,
        factor,
        offset,
        data,
        inside,
        **curves(given),
        wanted=np.zeros(0, dtype=np.int64),
        found=np.zeros((0, 2)),
    )


def renumbered(batch: SpringBatch, before: Model, model: Model) -> SpringBatch:
    """The batch of a System of the model ``before`` with the numbers of springs of another one.

    They have other stiffnesses, dampings and lengths alone.
    """
    data = batch.data.copy()
    pairs = zip(before.connections, model.connections, strict=True)
    springs = ((one, other) for one, other in pairs if isinstance(one, Spring))
    for e, (one, other) in enumerate(springs):
        if other is not one:
            data[e, :4] = _numbers(other)
    return batch._replace(data=data)


def _numbers(spring: Any) -> tuple[float, float, float, bool]:
    return spring.stiffness, spring.damping, spring.length, spring.slack


def _slots(spring: Spring) -> int:
    """Columns for one end of a spring."""
    ends = [end for end in (spring.a, spring.b) if isinstance(end, Point)]
    plain = all(not isinstance(end.body, Beam) or not end.body.has_section for end in ends)
    return CABLE if plain else SOLID
