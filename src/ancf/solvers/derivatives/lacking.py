"""The columns of what the factors of a step lack of its matrix, where these are few.

What rows of joints have of velocities, accelerations and friction is in the rows of their multipliers and of
the places of sliding joints alone: columns of the unit matrix.  Contacts are in no factors at all; a strip
on a wire, say, changes the forces on the nodes that it touches in three directions.  The product N c of what
is lacking with eight vectors that are known to nobody spans the range of N, if that has fewer dimensions
(Halko, Martinsson and Tropp 2011); Gram and Schmidt's method, the largest one first, tells how many and gives
orthonormal columns E, with which N = E (E^T N).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray, IntArray
from ...compiled import formula, inline_kernel
from ...linalg.eight import lane_rows
from ...records import recorded
from ...simd import LANES, every, load, store
from ..rare import add_slopes_beside_all
from .abreast_room import follow_abreast

#: Most rows with entries, and how many steps no columns are looked for where there are more, or too many.
MOST_ROWS, PAUSE = 96, 64
#: Part of the largest product that is round-off, and none that spans anything.
ROUND_OFF = 1e-13


@recorded
class Columns(NamedTuple):
    """Orthonormal columns E, by the rows in which they have entries."""

    number: IntArray  # (4,) columns, rows, steps until some are looked for again, columns of unit matrices
    row: IntArray  # (MOST_ROWS,)
    base: FloatArray  # (MOST_ROWS, 8)
    probe: FloatArray  # (3, size, 8) the vectors, or (3, 0, 8): no columns are looked for


def columns_for(size: int, rows: IntArray, looked_for: bool) -> Columns:
    """Columns of these rows, to which others may come that are ``looked_for``; none if they are too many."""
    number, row, base = np.zeros(4, dtype=np.int64), np.zeros(MOST_ROWS, dtype=np.int64), lane_rows(MOST_ROWS)
    probe = lane_rows(3 * size if looked_for else 0).reshape(3, -1, LANES)
    if len(rows) <= LANES:
        number[[0, 1, 3]] = len(rows)
        row[: len(rows)] = rows
        base[: len(rows), : len(rows)] = np.eye(len(rows))
    if looked_for:
        probe[0] = np.random.default_rng(0).uniform(-1.0, 1.0, probe[0].shape)
    return Columns(number, row, base, probe)


@formula
def none(r):
    """Set all lanes to zero."""
    for i in range(r.shape[0]):
        store(every(0.0), r, i)


@formula
def to_local_abreast(supports, r):
    """Components along local axes, as :func:`ancf.system.core.to_local`."""
    for k in range(supports.rot_slot.shape[0]):
        i, j = supports.rot_slot[k], supports.rot_shadow[k]
        for c in range(3):
            R = supports.rot_R[k, 0]
            store(R[0, c] * load(r, j) + R[1, c] * load(r, j + 1) + R[2, c] * load(r, j + 2), r, i + c)


@formula
def with_rates(core, d, by_v, by_a):
    """Let changes d of positions have their share in velocities and accelerations; shadows follow."""
    for i in range(core.weight.shape[0]):
        c = load(d, 0, i)
        store(by_v * c, d, 1, i)
        store(by_a * c, d, 2, i)
    for k in range(core.joints.multipliers.shape[0]):
        store(every(0.0), d, 1, core.joints.multipliers[k])
        store(every(0.0), d, 2, core.joints.multipliers[k])
    follow_abreast(core.supports, d)


@inline_kernel
def beside(core, m, x, d, r):
    """r = N d in components of the solve."""
    supports = core.supports
    none(r)
    add_slopes_beside_all(m.joined, x[0], x[1], x[2], d, r, core.ws)
    to_local_abreast(supports, r)
    for k in range(supports.held.shape[0]):
        store(every(0.0), r, supports.held[k])


@formula
def along_columns(columns, r, out):
    """The parts of r along the columns."""
    for k in range(columns.number[0]):
        part = every(0.0)
        for i in range(columns.number[1]):
            part = part + columns.base[i, k] * load(r, columns.row[i])
        store(part, out, k)


@inline_kernel
def touched(columns, r, n):
    """List the rows of r with entries, of n, behind those of the unit matrix; whether there is room."""
    own = columns.number[3]
    count = own
    for i in range(n):
        size = 0.0
        for lane in range(LANES):
            size += abs(r[i, lane])
        known = size == 0.0
        for k in range(own):
            known = known or columns.row[k] == i
        if not known:
            if count == MOST_ROWS:
                return False
            columns.row[count] = i
            for lane in range(LANES):
                columns.base[count, lane] = r[i, lane]
            count += 1
    columns.number[1] = count
    return True


@inline_kernel
def product_of(columns, j, k):
    """Scalar product of two columns behind the rows of the unit matrix."""
    total = 0.0
    for i in range(columns.number[3], columns.number[1]):
        total += columns.base[i, j] * columns.base[i, k]
    return total


@inline_kernel
def exchange(columns, j, k):
    """Let two columns change places."""
    for i in range(columns.number[3], columns.number[1]):
        columns.base[i, j], columns.base[i, k] = columns.base[i, k], columns.base[i, j]


@inline_kernel
def made_orthonormal(columns):
    """Make eight columns behind the rows of the unit matrix orthonormal; how many count."""
    begin, end, largest = columns.number[3], columns.number[1], 0.0
    for k in range(LANES):
        most, place = -1.0, k
        for j in range(k, LANES):
            size = product_of(columns, j, j) ** 0.5
            if size > most:
                most, place = size, j
        largest = max(largest, most)
        if not most > ROUND_OFF * largest:
            return k
        exchange(columns, k, place)
        for _ in range(2):
            for j in range(k):
                f = product_of(columns, j, k)
                for i in range(begin, end):
                    columns.base[i, k] -= f * columns.base[i, j]
        size = product_of(columns, k, k) ** 0.5
        for i in range(begin, end):
            columns.base[i, k] /= size
        for j in range(k + 1, LANES):
            f = product_of(columns, k, j)
            for i in range(begin, end):
                columns.base[i, j] -= f * columns.base[i, k]
    return LANES


@inline_kernel
def columns_anew(core, m, columns, x, r, by_v, by_a):
    """Look for the columns of a step, if they change; whether they are known.

    r is used up.
    """
    if columns.probe.shape[1] == 0:
        return True
    if columns.number[2] > 0:
        columns.number[2] -= 1
        return False
    with_rates(core, columns.probe, by_v, by_a)
    beside(core, m, x, columns.probe, r)
    own, count = columns.number[3], LANES
    if touched(columns, r, core.weight.shape[0]):
        count = made_orthonormal(columns)
    if count == LANES or own + count > LANES:  # eight vectors span no more
        columns.number[2] = PAUSE
        return False
    for i in range(own, columns.number[1]):  # behind the columns of the unit matrix
        for k in range(count - 1, -1, -1):
            columns.base[i, own + k] = columns.base[i, k]
        for k in range(own):
            columns.base[i, k] = 0.0
    for i in range(own):
        for k in range(own, own + count):
            columns.base[i, k] = 0.0
    columns.number[0] = own + count
    return True
