"""Contact forces along beams on surfaces in states, element by element, for pictures."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..compiled import kernel
from ..records import Located
from ..vectors import dot
from .press import pressed
from .touch import place_on, relative, row_of

#: Columns of a tooth: place of the axis, normal force per length on the beam, speed past the surface.
PLACE, FORCE, SLIDE, COLUMNS = 0, 3, 6, 7


@kernel
def comb_values(batch, j, q, v, out):
    """Teeth of the elements of contact j in a state, ``out`` of shape (elements, 7).

    The place is that of the middle point, force and speed are means over an element, the speed weighted by
    the force.
    """
    m, points = 0, batch.weight.shape[1]
    for e in range(batch.base.shape[0]):
        if batch.contact[e] != j:
            continue
        row, total, length = row_of(batch, e, q, v), 0.0, 0.0
        for c in range(out.shape[1]):
            out[m, c] = 0.0
        middle = place_on(batch, e, points // 2, row[0])
        for p in range(points):
            _, x, N, _, _, n, _, _, _ = pressed(batch, e, p, row)
            w = batch.weight[e, p]
            length += w
            if N > 0.0:
                u = relative(place_on(batch, e, p, row[1]), row[3], x)
                s = dot(u, n)
                total += w * N
                out[m, SLIDE] += w * N * math.sqrt(max(dot(u, u) - s * s, 0.0))
                for c in range(3):
                    out[m, FORCE + c] += w * N * n[c]
        for c in range(3):
            out[m, PLACE + c] = middle[c]
            out[m, FORCE + c] /= length
        if total > 0.0:
            out[m, SLIDE] /= total
        m += 1


def teeth(batch: Any, j: int, q: FloatArray, v: FloatArray) -> FloatArray:
    """Place, force per length and speed of the elements of contact j in states, (n, elements, 7)."""
    out = np.zeros((len(q), int(np.sum(batch.contact == j)), COLUMNS))
    for k in range(len(q)):
        comb_values(Located(batch), j, np.ascontiguousarray(q[k]), np.ascontiguousarray(v[k]), out[k])
    return out
