"""What contacts between cables add to the matrix: rows b_i with stiffnesses k_i, sum k_i b_i b_i^T."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..compiled import Role, implements, kernel
from ..connections.in_matrix import no_pairs, no_places
from ..records import Located, beginning
from .cross import (
    cross_energy,
    cross_force,
    cross_measure,
    cross_passed,
    cross_remember,
    factors,
    look_everywhere,
    not_in_matrix,
    pressed_at,
)
from .cross_along import cross_slopes_along
from .cross_changes import cross_changes, kinds_of, numbers_of
from .grip import LIMIT, OTHER, X, Y, drawn, rows_of, slopes, springs
from .near import look_if_live
from .strand import DAMPING, ELEMENT, POINTS, StrandBatch, find_zones

__all__ = ["StrandBatch", "find_rows", "rows_in"]

#: Fields whose sizes and numbers say nothing about forces: the list of what is near, zones, the solver's.
WORKSPACE = ("seen", "room", "first", "near", "box", "middle", "zone", "at", "row", "basis", "small", "older")
#: Columns of ``row``: three for each slot of both elements, then the stiffness.
STIFF = 24


@beginning(StrandBatch)
def put(batch, m, side, s, f):
    """Add a vector with the factors of the slots of an element to row m."""
    for k in range(4):
        for c in range(3):
            batch.row[m, 12 * side + 3 * k + c] += s[k] * f[c]


@beginning(StrandBatch)
def begin(batch, m, e, b, stiffness):
    """An empty row of two elements."""
    batch.at[m, 0], batch.at[m, 1] = e, b
    for i in range(STIFF):
        batch.row[m, i] = 0.0
    batch.row[m, STIFF] = stiffness


@beginning(StrandBatch)
def add_pressed(batch, count, z, p, q, v, c_damping, c_stiffness):
    """Row of a point of a zone, along the normal; how that turns is left out."""
    e, b, sa, sb, _, n, N, by_g, by_rate = pressed_at(batch, z, p, q, v)
    if N <= 0.0 or count + 1 > batch.row.shape[0]:
        return count
    begin(batch, count, e, b, c_stiffness * by_g + c_damping * by_rate)
    put(batch, count, 0, sa, n)
    put(batch, count, 1, sb, (-n[0], -n[1], -n[2]))
    return count + 1


@beginning(StrandBatch)
def add_gripped(batch, count, g, q, v, c_damping, c_stiffness):
    """Rows of friction: along the way that it is drawn, if it sticks, and across that."""
    if g[LIMIT] == 0.0 or count + 1 > batch.row.shape[0]:
        return count
    e, b = int(g[ELEMENT]), int(g[OTHER])
    w1, w2, f, slips, d1, pa1, pb1, d2, pa2, pb2, phi = drawn(batch, g, q, v)
    k, c = springs(batch, g)
    stiffness, size = f * (c_stiffness * k + c_damping * c), math.sqrt(w1 * w1 + w2 * w2)
    x, y = (w1 / size, w2 / size) if size > 0.0 else (1.0, 0.0)
    for across in range(1 if slips else 0, 2):
        one, other = (-y, phi * x) if across else (x, phi * y)
        begin(batch, count, e, b, stiffness)
        h, i = batch.length[e], batch.length[b]
        for d, pa, pb, w in ((d1, pa1, pb1, one), (d2, pa2, pb2, other)):
            put(batch, count, 0, factors(g[X], h), (w * d[0], w * d[1], w * d[2]))
            put(batch, count, 1, factors(g[Y], i), (-w * d[0], -w * d[1], -w * d[2]))
            put(batch, count, 0, slopes(g[X], h), (w * pa[0], w * pa[1], w * pa[2]))
            put(batch, count, 1, slopes(g[Y], i), (w * pb[0], w * pb[1], w * pb[2]))
        count += 1
    return count


@beginning(StrandBatch)
def find_rows(batch, q, v, c_damping, c_stiffness):
    """Fill ``row`` and ``at`` for c_damping C + c_stiffness K; their number."""
    look_if_live(batch, q)
    count = 0
    for z in range(find_zones(batch, q)):
        for p in range(POINTS):
            count = add_pressed(batch, count, z, p, q, v, c_damping, c_stiffness)
    for m in range(rows_of(batch)):
        count = add_gripped(batch, count, batch.grip[m], q, v, c_damping, c_stiffness)
    return count


@kernel
def rows_at_rest(batch, q, v, c_damping, c_stiffness):
    """See :func:`find_rows`."""
    return find_rows(batch, q, v, c_damping, c_stiffness)


def rows_in(batch: Any, q: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Rows (m, size), stiffnesses and dampings (m,) of an equilibrium in the state q."""
    still = np.zeros_like(q)
    braked = rows_at_rest(Located(batch), q, still, 1.0, 0.0)
    damping = batch.row[:braked, STIFF].copy()
    count = rows_at_rest(Located(batch), q, still, 0.0, 1.0)
    rows = np.zeros((count, len(q)))
    for m in range(count):
        slots = batch.base[batch.at[m]].ravel()
        for c in range(3):
            np.add.at(rows[m], slots + c, batch.row[m, c:STIFF:3])
    return rows, batch.row[:count, STIFF].copy(), damping


implements(
    StrandBatch,
    force=cross_force,
    tangent=not_in_matrix,
    energy=cross_energy,
    measure=cross_measure,
    remember=cross_remember,
    force_slopes=cross_slopes_along,
    slopes_beside=cross_slopes_along,
    changes=cross_changes,
    kinds=kinds_of,
    numbers=numbers_of,
    numbered=("data", "radius", *WORKSPACE),
    inverted=cross_passed,
    early=look_everywhere,
    couples=no_pairs,
    bind=no_places,
    role=Role.DISSIPATES | Role.MEASURES,
    rows=rows_in,
    memory=("last",),
    damped=lambda batch: bool(np.any(batch.data[:, DAMPING])),
)
