"""From springs of the model to the flat arrays of a SpringBatch."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..model.connections import Spring
from ..model.model import Model
from ..model.points import Point
from .spring_damper import SpringBatch


def springs(model: Model, locate: Callable[[Point], Any]) -> SpringBatch:
    """Batch of all springs; ``locate`` finds a point's slots and shape functions."""
    items = [c for c in model.connections if isinstance(c, Spring)]
    n = len(items)
    base = np.full((n, 8), -1, dtype=np.int64)
    factor, offset, data = np.zeros((n, 8)), np.zeros((n, 3)), np.zeros((n, 4))
    for e, spring in enumerate(items):
        data[e] = spring.stiffness, spring.damping, spring.length, spring.slack
        for end, first, sign in ((spring.a, 0, -1.0), (spring.b, 4, 1.0)):
            if isinstance(end, Point):
                probe = locate(end)
                factor[e, first : first + 4] = sign * probe.S[0]
                base[e, first : first + 4] = np.where(probe.S[0] != 0.0, probe.slots, -1)
            else:
                offset[e] = end
    return SpringBatch(base, np.full((n, 64), -1, dtype=np.int64), factor, offset, data)
