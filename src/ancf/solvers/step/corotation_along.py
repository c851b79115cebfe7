"""Co-rotation where elements are short: what a turned correction changes between two nodes.

A node at rotation R turns r and r_x of a correction, but R differs from node to node.  A field u(x) that is
turned at each point has the derivative (R u)' = R (u' + k x u), with R' = R [k]x, while nodes that turn their
r_x alone leave out k x u.  The wire between two nodes is then bent by k u / h, which costs 12 EI k^2 u^2/h^2
per length: nothing where h is long, but of short elements more than all inertia, and the kept matrix is stiff
against motions that cost nothing.

R takes the old tangent to the present one, so that k = t_old x (R^T t' - t_old'); a twist of the smallest
rotation is left out.  Residuals turn back by the transposed of the same.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray, IntArray
from ...compiled import formula
from ...model.bodies.beam import Beam
from ...records import recorded
from ...simd import LANES, gather, gather_nodes, load, put_nodes, store, vector
from ...system.system import System
from ...vectors import dot

#: Stiffness that would be wrong, of a beam whose curvature changes by one over its length, in inertias.
STIFF = 0.4


@recorded
class Along(NamedTuple):
    """Chunks of nodes between short elements; a node without neighbours that turn has no share in it."""

    row: IntArray  # (chunks,) of each chunk in the arrays below, -1: none
    beside: IntArray  # (rows, 2, LANES) slots of r_x before and behind
    over: FloatArray  # (rows, LANES) one over the arc length between these, 0 without a share
    curved: FloatArray  # (rows, 3, LANES) t x t' when the matrix was made
    k: FloatArray  # (rows, 3, LANES) see above


def none_along(chunks: int) -> Along:
    """Nothing of the kind in so many chunks."""
    rows = np.zeros((0, 3, LANES))
    return Along(np.full(chunks, -1), np.zeros((0, 2, LANES), dtype=np.int64), rows[:, 0], rows, rows.copy())


def along_of(system: System, step: float, first: IntArray, slot: IntArray) -> Along:
    """What steps of a length need of a system whose nodes turn in these chunks, see ``Frames``."""
    here = slot[first[:-1]]  # (chunks, LANES) slots of r
    turns = np.zeros(system.size, dtype=bool)
    turns[here] = np.diff(first)[:, None] == 2
    held = np.isin(here[..., None] + np.arange(6), system.core.supports.held).any(axis=-1)
    free = turns.copy()
    free[here[held]] = False  # what is held gets no correction, and none of a part of it
    beside, over = np.zeros((system.size, 2), dtype=np.int64), np.zeros(system.size)
    for name in system.numbering.slots:
        body = system.model.bodies[name]
        if not (isinstance(body, Beam) and _is_short(body, step)):
            continue
        r, r_x = system.numbering.each(name)[:, :2].T
        x = body.node_x[: len(r)]
        before, behind = np.maximum(np.arange(len(r)) - 1, 0), np.minimum(np.arange(len(r)) + 1, len(r) - 1)
        beside[r] = np.column_stack([r_x[before], r_x[behind]])
        whole = free[r] & turns[r[before]] & turns[r[behind]]
        over[r] = whole / (x[behind] - x[before])
    rows = np.flatnonzero(over[here].any(axis=1))
    if not len(rows):
        return none_along(len(here))
    row = np.full(len(here), -1)
    row[rows] = np.arange(len(rows))
    room = np.zeros((2, len(rows), 3, LANES))
    return Along(row, np.ascontiguousarray(beside[here[rows]].transpose(0, 2, 1)), over[here[rows]], *room)


def _is_short(beam: Beam, step: float) -> bool:
    """Whether what is wrong between the nodes of a beam would be felt in steps of this length, s."""
    if beam.has_section or beam.elements < 2:
        return False
    wrong = 12.0 * beam.section.EI / (np.min(np.diff(beam.node_x)) * beam.length) ** 2
    return bool(wrong * step**2 > STIFF * 4.0 * beam.section.rhoA)


@formula
def rows_of(array, k, first):
    """Vectors in three rows of a chunk."""
    return vector(load(array, k, first), load(array, k, first + 1), load(array, k, first + 2))


@formula
def set_rows_of(array, k, first, x):
    """Write vectors into three rows of a chunk."""
    store(x[0], array, k, first)
    store(x[1], array, k, first + 1)
    store(x[2], array, k, first + 2)


@formula
def cross(a, b):
    """Vector products."""
    return vector(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@formula
def slope(along, q, m):
    """r_x' at the nodes of row m, as differences of their neighbours."""
    return load(along.over, m) * (gather(q, along.beside, m, 1) - gather(q, along.beside, m, 0))


@formula
def remember_along(along, q, m, t):
    """The matrix is being made now: nothing has bent yet."""
    set_rows_of(along.curved, m, 0, cross(t, slope(along, q, m)))
    for c in range(3):
        for lane in range(LANES):
            along.k[m, c, lane] = 0.0


@formula
def bend(along, q, m, old, a, b, c):
    """Set k of row m; the rotations have the rows a, b, c."""
    d = slope(along, q, m)
    k = cross(old, d[0] * a + d[1] * b + d[2] * c) - rows_of(along.curved, m, 0)
    set_rows_of(along.k, m, 0, k)


@formula
def turn_back_along(along, m, r, slot, n, a, b, c):
    """Residuals of nodes, whose slots are in row n."""
    x, y = gather_nodes(r, slot, n)
    y = y[0] * a + y[1] * b + y[2] * c
    x = x[0] * a + x[1] * b + x[2] * c + cross(y, rows_of(along.k, m, 0))
    put_nodes(x, y, r, slot, n)


@formula
def turn_forth_along(along, m, r, slot, n, a, b, c):
    """Corrections of nodes, whose slots are in row n."""
    x, y = gather_nodes(r, slot, n)
    y = y + cross(rows_of(along.k, m, 0), x)
    put_nodes(vector(dot(a, x), dot(b, x), dot(c, x)), vector(dot(a, y), dot(b, y), dot(c, y)), r, slot, n)
