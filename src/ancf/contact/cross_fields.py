"""What contacts between cables do in states: sums over them, and where they are nearest."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..compiled import kernel
from ..records import Located
from .cross import cross_measure
from .grip import grip_measure
from .near import look
from .rubbed import RUBBED
from .strand import apart, clearance, cubic, on_cubic


@kernel
def cross_values(batch, q, v, out):
    """What ``found`` says of each contact in each state, ``out`` of shape (states, contacts, 4)."""
    for n in range(q.shape[0]):
        cross_measure(batch, q[n], v[n])
        for j in range(batch.found.shape[0]):
            out[n, j, 0], out[n, j, 1] = batch.found[j, 0], batch.found[j, 1]


@kernel
def grip_values(batch, q, v):
    """Fill ``found``."""
    grip_measure(batch, q, v)


@kernel
def cross_nearest(batch, j, q, out):
    """Of contact j in states: the places of both cables that are nearest, ``out`` of shape (states, 2, 3)."""
    for n in range(q.shape[0]):
        look(batch, q[n])
        least = np.inf
        for e in range(batch.base.shape[0]):
            c = cubic(batch, e, q[n])
            for k in range(batch.first[e], batch.first[e + 1]):
                b = batch.near[k]
                if batch.law[batch.cable[e], batch.cable[b]] != j:
                    continue
                reach = batch.radius[e] + batch.radius[b]
                for p in range(2 * batch.cells[0] + 1):
                    x = p / (2.0 * batch.cells[0])
                    f, o, y = clearance(batch, q[n], e, c, x, b, reach)
                    if f < least and apart(batch, e, x, o, y):
                        least = f
                        r, s = on_cubic(c, x), on_cubic(cubic(batch, o, q[n]), y)
                        for i in range(3):
                            out[n, 0, i], out[n, 1, i] = r[i], s[i]


def cross_places(batch: Any, j: int, q: FloatArray) -> FloatArray:
    """Where contact j is nearest in states (n, size), (n, 2, 3) m; not a number where nothing is near."""
    out = np.full((len(q), 2, 3), math.nan)
    cross_nearest(Located(_own(batch)), j, np.ascontiguousarray(q), out)
    return out


def cross_pressures(batch: Any, q: FloatArray, v: FloatArray) -> FloatArray:
    """Force and depth of each contact in states (n, size), NaN behind them, (n, contacts, 4)."""
    out = np.full((len(q), len(batch.found), 4), np.nan)
    cross_values(Located(_own(batch)), q, v, out)
    return out


def grip_frictions(batch: Any, q: FloatArray, v: FloatArray) -> FloatArray:
    """Friction and the share of it that slips of each contact where a run begins, (contacts, 2)."""
    mine = _own(batch)
    grip_values(Located(mine), np.ascontiguousarray(q), np.ascontiguousarray(v))
    return np.array(mine.found[:, RUBBED:])


def _own(batch: Any) -> Any:
    """A batch whose list and sums are its own: a question must not move what a run has."""
    names = "found", "seen", "room", "first", "near", "middle", "head", "link", "zone", "grip", "older"
    return batch._replace(**{name: getattr(batch, name).copy() for name in names})
