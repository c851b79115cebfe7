"""Where a wire crosses a strip and how it is pressed there, see :mod:`ancf.connections.contact`."""

from __future__ import annotations

import numpy as np

from ..compiled import formula
from ..vectors import dot
from .carrier import COLUMNS, element_at, line, shape, slider
from .curves import looked_up

# columns of ContactBatch.data
STIFFNESS, DAMPING = range(2)
#: Columns of ContactBatch.found.
FORCE, OVERLAP, ARC, ASIDE = range(4)
#: Iterations for the crossing; a nearly straight wire takes two.
MOST = 20


@formula
def crossing(batch, j, q, p):
    """Whether the wire crosses the strip's plane, and s there; s is kept for the next search."""
    start, stop = batch.first[j], batch.first[j + 1] - 1
    low, high = batch.x[start, 0], batch.x[stop, 0] + batch.x[stop, 1]
    tau = (batch.travel[j, 0], batch.travel[j, 1], batch.travel[j, 2])
    s = batch.found[j, ARC]
    if not (s >= low and s <= high):
        s = 0.5 * (low + high)
    for _ in range(MOST):
        e = element_at(batch, j, s)
        xi = (s - batch.x[e, 0]) / batch.x[e, 1]
        o, t = line(batch, e, xi, q, 0), line(batch, e, xi, q, 1)
        rise = dot(tau, t)
        if not rise > 0.0:
            return False, s
        step = dot(tau, (p[0] - o[0], p[1] - o[1], p[2] - o[2])) / rise
        s += step
        if abs(step) <= 1e-12 * (high - low):
            if s < low or s > high:
                return False, s
            batch.found[j, ARC] = s
            return True, s
        s = min(max(s, low - batch.x[start, 1]), high + batch.x[stop, 1])
    return False, s


@formula
def touch(batch, j, q, v):
    """Whether contact j pushes, with the element, xi, m and the force; fills ``found``."""
    p = slider(batch, j, q, 1.0)
    crosses, s = crossing(batch, j, q, p)
    e = element_at(batch, j, s)
    xi = (s - batch.x[e, 0]) / batch.x[e, 1]
    batch.found[j, FORCE], batch.found[j, OVERLAP] = 0.0, -np.inf
    m = (0.0, 0.0, 0.0)
    if not crosses:
        return False, e, xi, m, 0.0
    n = (batch.normal[j, 0], batch.normal[j, 1], batch.normal[j, 2])
    tau = (batch.travel[j, 0], batch.travel[j, 1], batch.travel[j, 2])
    o, t = line(batch, e, xi, q, 0), line(batch, e, xi, q, 1)
    d = (p[0] - o[0], p[1] - o[1], p[2] - o[2])
    u = (n[1] * tau[2] - n[2] * tau[1], n[2] * tau[0] - n[0] * tau[2], n[0] * tau[1] - n[1] * tau[0])
    stands_out, rise, _ = looked_up(batch, j, s)
    overlap = dot(n, d) + stands_out
    batch.found[j, OVERLAP], batch.found[j, ASIDE] = overlap, -dot(u, d)
    slope = (dot(n, t) - rise) / dot(tau, t)
    m = (n[0] - slope * tau[0], n[1] - slope * tau[1], n[2] - slope * tau[2])
    if not overlap > 0.0:
        return False, e, xi, m, 0.0
    force = batch.data[j, STIFFNESS] * overlap
    if batch.data[j, DAMPING] != 0.0:
        w, o = slider(batch, j, v, 0.0), line(batch, e, xi, v, 0)
        force += batch.data[j, DAMPING] * dot(m, (w[0] - o[0], w[1] - o[1], w[2] - o[2]))
    force = max(force, 0.0)
    batch.found[j, FORCE] = force
    return force > 0.0, e, xi, m, force


@formula
def add_row(batch, j, e, xi, m, weight, r):
    """Add ``weight`` times the gradient of the overlap to r."""
    for k in range(COLUMNS):
        i, o = batch.slot[j, k], batch.line_slot[e, k]
        if i < 0 and o < 0:
            break
        if i >= 0:
            w = weight * batch.factor[j, k]
            for c in range(3):
                r[i + c] += w * m[c]
        if o >= 0:
            w = weight * shape(batch, e, k, xi, 0)
            for c in range(3):
                r[o + c] -= w * m[c]
