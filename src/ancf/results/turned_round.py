"""States in which a body has turned round in its clamp: a slope that points backwards.

A clamp that leaves the stretch free holds the directions of slopes, not their signs: where a body is pressed
far beyond buckling, or bends sharply in long elements, Newton's method may pass through a slope of no length
and find what satisfies all equations, but what no material does.
"""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..model.bodies.beam import Beam
from ..model.elements import KINDS
from ..model.supports.support import Clamp
from ..system.nodes import node_of, start_vectors
from ..system.system import System


def notes(system: System, q: FloatArray) -> list[str]:
    """What is to be said of the first clamp at rest whose body points backwards in a state (size,)."""
    for support in system.model.supports:
        if not isinstance(support, Clamp) or support.stretch != "free" or _turns(support):
            continue
        body = support.point.body
        if not isinstance(body, Beam):
            continue
        node = node_of(body, support.point.x)
        slopes = slice(1, KINDS[body.element].vectors)
        before = start_vectors(body)[node][slopes]
        now = q[system.slots[body.name][node][slopes][:, None] + np.arange(3)]
        if np.any(np.sum(now * before, axis=1) < 0.0):
            where = f'"{body.name}" has turned round in "{support.name}", its slope points backwards there'
            advice = 'it carries less; take a stiffer section, and there shorter elements or stretch="fixed"'
            return [f"{where}: no material does; {advice}"]
    return []


def _turns(clamp: Clamp) -> bool:
    return clamp.rotation is not None or clamp.rotation_vector is not None
