"""Parts of a line that are reduced to their modes while nothing touches them.

A span of an overhead line between two supports, with its droppers, is a *part*: its boundary, the nodes at
the supports, separates it from all others.  While no strip is near it and its droppers are taut it moves
linearly about its rest.  It is then described by the displacements x of its boundary and by modes with this
boundary fixed (Craig and Bampton 1968) up to some frequency,

    u = Psi x + Phi y,      K_ii Phi = M_ii Phi diag(w^2),      Phi^T M_ii Phi = 1,      Psi = -K_ii^-1 K_ib,

and is *asleep*: its cables have no stiffness and no mass, its rows of the matrix are those of the identity.
Psi are the static deflections.  The modes that are left out alone would give the two ends of a part a common
mass, which couples them within a step where waves do not: modes of higher frequencies are added in which lies
what a boundary moves within one step.
Parts that are alike share their matrices, and are of one *kind*.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..arrays import FloatArray, IntArray
from ..compiled import inline_kernel
from ..linalg.reach import clear
from ..records import recorded
from ..simd import LANES, every, load, store
from .near import clear_beyond

# columns of Far.kind: first row of its modes and their number of rows of eight, boundary unknowns, first row
# of the coupling, first row of the boundary's matrices and rows of eight of a column of these, first row of
# `sight`, unknowns inside, of which the first so many are watched, first row of `across`
MODES, ROWS, EDGES, COUPLING, COLUMN, HIGH, SIGHT, INSIDE, WATCHED, ACROSS = range(10)
# columns of Far.part: kind, first row of its coordinates, first boundary unknown and first row of eight of
# these, first place in `entry`, first unknown inside, first dropper and their number, whether it is asleep,
# looks at it for which it has been calm, what the last look found
KIND, PLACE, EDGE, BORDER, ENTRY, INNER, HUNG, DROPPERS, ASLEEP, CALM, DUE = range(11)
# what a look finds: a part has to wake, or may sleep; or neither
TO_WAKE, TO_SLEEP = 1, 2
# rows of the coordinates of a mode: y, dy/dt, d2y/dt2, the algorithmic acceleration, and for the step at hand
# predictions of the first two and what the boundary feels
POSITION, RATE, SECOND, BAR, GUESS, GUESS_RATE, FELT = range(7)
# entries of Far.counts: ranges of blocks that are awake, parts that are asleep, first unknown of the shadows
RANGES, SLEEPING = range(2)
# entries of Far.memo: step for which matrices are made; distances of a strip, m, at which a part wakes at the
# latest and may sleep at the earliest, and looks for which it has to be calm
STEP, NEAR, AWAY, CALMED = range(4)


@recorded
class Far(NamedTuple):
    """Parts of a line that can sleep; k parts of t kinds, (.., 8): numbers of modes or unknowns by lanes.

    Columns of boundary unknowns are as many as is even, the last one perhaps zero.
    """

    part: IntArray  # (k, 11) columns KIND ... DUE
    place: FloatArray  # (k, 2) where it begins and ends along the track, m
    kind: IntArray  # (t, 10) columns MODES ... ACROSS
    square: FloatArray  # (.., 8) w^2 of the modes
    loss: FloatArray  # (.., 8) their damping, 1/s
    drag: FloatArray  # (.., 8) damping over mass of their coupling with the boundary, 1/s
    inverse: FloatArray  # (.., 8) 1/D
    by_place: FloatArray  # (.., 8) what the boundary feels of the prediction of y
    by_rate: FloatArray  # (.., 8) and of dy/dt
    coupling: FloatArray  # (.., 8) P = Phi^T (M_ib + M_ii Psi), all of the boundary for eight modes each
    across: FloatArray  # (.., 8) P, mode by mode
    sight: FloatArray  # (.., 8) rows of [Psi Phi]: all columns for eight unknowns inside each
    mass: FloatArray  # (.., 8) of the boundary with the part condensed to it, column by column
    damping: FloatArray  # (.., 8)
    stiffness: FloatArray  # (.., 8)
    felt_mass: FloatArray  # (.., 8) the first two with what modes follow within a step
    felt_damping: FloatArray  # (.., 8)
    matrix: FloatArray  # (.., 8) of the step, with the modes condensed too
    entry: IntArray  # (..) places of its numbers in the values of the iteration matrix, -1: none
    state: FloatArray  # (7, .., 8) coordinates of the modes, rows POSITION ... FELT
    edge: IntArray  # (..) unknowns of the boundaries
    still: FloatArray  # (..) their values at rest
    force: FloatArray  # (.., 8) what the part does to them at rest, N
    guess: FloatArray  # (..) their predictions in the step at hand
    push: FloatArray  # (.., 8) the residual for these
    room: FloatArray  # (4, ..) workspace
    inner: IntArray  # (..) unknowns inside
    rest: FloatArray  # (..) their values at rest
    hung: IntArray  # (..) springs that may go slack
    sleeps: IntArray  # (blocks,) 1: asleep
    range: IntArray  # (.., 2) ranges of blocks that are awake
    counts: IntArray  # (2,) RANGES, SLEEPING
    memo: FloatArray  # (4,) STEP ... CALMED


def no_far() -> Far:
    """A line without parts that can sleep."""
    shapes: dict[str, Any] = {"part": (0, 11), "place": (0, 2), "kind": (0, 10), "state": (7, 0, LANES)}
    shapes |= {"room": (4, 0), "range": (0, 2), "counts": (2,), "memo": (4,)}
    shapes |= dict.fromkeys(("entry", "edge", "still", "guess", "inner", "rest", "hung", "sleeps"), (0,))
    numbers = ("part", "kind", "entry", "edge", "inner", "hung", "sleeps", "range", "counts")
    made: dict[str, Any] = {name: np.zeros(shapes.get(name, (0, LANES))) for name in Far._fields}
    return Far(**made | {name: made[name].astype(np.int64) for name in numbers})


@inline_kernel
def add_far(far, s):
    """Add to s.r what parts that sleep do to their boundaries."""
    for p in range(far.part.shape[0]):
        if far.part[p, ASLEEP] != 0:
            add_part(far, p, s)


@inline_kernel
def add_far_near(far, near, count, s):
    """The same of those parts whose boundaries some ranges of blocks touch."""
    if far.counts[SLEEPING] == 0:
        return
    for p in range(far.part.shape[0]):
        if far.part[p, ASLEEP] != 0 and is_beside(far, p, near, count):
            add_part(far, p, s)


@inline_kernel
def is_beside(far, p, near, count):
    """Whether the boundary of a part is in some of the ranges."""
    first = far.part[p, EDGE]
    for i in range(first, first + far.kind[far.part[p, KIND], EDGES]):
        block = far.edge[i] // 6
        for k in range(count):
            if near.low[k] <= block < near.high[k]:
                return True
    return False


@inline_kernel
def add_part(far, p, s):
    """Add to s.r what a part does to its boundary."""
    t, first, border = far.part[p, KIND], far.part[p, EDGE], far.part[p, BORDER]
    n, o, high = far.kind[t, EDGES], far.kind[t, COLUMN], far.kind[t, HIGH]
    for i in range(n):
        far.room[0, i] = s.q[far.edge[first + i]] - far.guess[first + i]
    for k in range(high):
        even, odd = load(far.push, border + k), every(0.0)
        for j in range(0, n + n % 2, 2):
            even = even + load(far.matrix, o + high * j + k) * far.room[0, j]
            odd = odd + load(far.matrix, o + high * (j + 1) + k) * far.room[0, j + 1]
        store(even + odd, far.room[1], LANES * k)
    for i in range(n):
        s.r[far.edge[first + i]] += far.room[1, i]


@inline_kernel
def hush(far, low, high, count, r):
    """Zero in the blocks of some ranges that are asleep."""
    if far.counts[SLEEPING] == 0:
        return
    for k in range(count):
        for b in range(low[k], high[k]):
            if far.sleeps[b] != 0:
                for i in range(6 * b, 6 * b + 6):
                    r[i] = 0.0


@inline_kernel
def clear_settled(far, near, count, n, r):
    """Zero in all blocks beyond the ranges; where something sleeps, of those that are awake."""
    if far.counts[SLEEPING] == 0:
        clear_beyond(near, count, n, r)
        return
    m = 0
    for k in range(far.counts[RANGES]):
        begin, end = far.range[k, 0], far.range[k, 1]
        while m < count and near.high[m] <= begin:
            m += 1
        j = m
        while j < count and near.low[j] < end:
            clear(r, begin, near.low[j])
            begin = near.high[j]
            j += 1
        clear(r, begin, end)
