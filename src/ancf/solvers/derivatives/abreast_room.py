"""What sensitivities by eight parameters abreast are kept in, and how these come in and go out.

One parameter is in each lane of every unknown, see :mod:`ancf.solvers.derivatives.abreast`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray, IntArray
from ...compiled import formula, inline_kernel
from ...linalg.eight import lane_rows
from ...records import recorded
from ...simd import LANES, absolute, every, gather_lanes, load, put_lanes, store
from .mixing_abreast import ROOM
from .sensitivity import ABAR, A, Q, V


@recorded
class Abreast(NamedTuple):
    """Room for eight sensitivities."""

    d: FloatArray  # (3, size, 8) s_q, s_v, s_a
    r: FloatArray  # (size, 8)
    seen: FloatArray  # (size, 8)
    before: FloatArray  # (8,) sizes of the last corrections
    open: FloatArray  # (8,) 1 while corrections go on, else 0
    norm: FloatArray  # (8,) sizes of corrections, and of what they correct
    size: FloatArray  # (8,)
    shift: FloatArray  # (8,) sizes of shifts onto the constraints
    last: FloatArray  # (size, 8) corrections before, see foreseen
    ratio: FloatArray  # (8,) by which corrections shrink
    used: FloatArray  # (8,) what of it the last ones have foreseen
    rows: FloatArray  # (size, 8) what rows of joints are out of balance by
    place: IntArray  # (1, 8) where the lanes of eight parameters begin in an array of all
    mix: FloatArray  # (ROOM, size, 8) of ancf.solvers.derivatives.mixing_abreast, or (0, size, 8)
    first: FloatArray  # (8,) the size of the first correction that it mixes, squared
    block: FloatArray  # (2, 36) of a product


def room_for(size: int, mixes: bool = False) -> Abreast:
    """Room for the unknowns of a model, perhaps for corrections that do not shrink."""
    d = lane_rows(3 * size).reshape(3, size, LANES)
    r, seen, last, rows = lane_rows(size), lane_rows(size), lane_rows(size), lane_rows(size)
    before, open, norm, sizes, shift, ratio, used, first = np.zeros((8, LANES))
    place = np.zeros((1, LANES), dtype=np.int64)
    vectors = ROOM if mixes else 0
    mix = lane_rows(vectors * size).reshape(vectors, size, LANES)
    one = before, open, norm, sizes, shift, last, ratio, used, rows
    return Abreast(d, r, seen, *one, place, mix, first, np.zeros((2, 36)))


def abreast(rows: FloatArray) -> FloatArray:
    """Vectors (p, k, size) as they are followed, one in each lane, (p/8 rounded up, k, size, 8)."""
    count, *shape = rows.shape
    groups = -(-count // LANES)
    made = lane_rows(groups * shape[0] * shape[1]).reshape(groups, *shape, LANES)
    for k in range(groups):
        own = rows[k * LANES : (k + 1) * LANES]
        made[k, ..., : len(own)] = np.moveaxis(own, 0, -1)
    return made


@formula
def follow_abreast(supports, d):
    """Shadows from the unknowns, as :func:`ancf.system.core.follow`."""
    for k in range(supports.rot_slot.shape[0]):
        i, j = supports.rot_slot[k], supports.rot_shadow[k]
        for c in range(3):
            x, dx, ddx = every(0.0), every(0.0), every(0.0)
            for m in range(3):
                R, dR, ddR = (
                    supports.rot_R[k, 0, c, m],
                    supports.rot_R[k, 1, c, m],
                    supports.rot_R[k, 2, c, m],
                )
                q, v, a = load(d, 0, i + m), load(d, 1, i + m), load(d, 2, i + m)
                x = x + R * q
                dx = dx + R * v + dR * q
                ddx = ddx + R * a + (2.0 * dR) * v + ddR * q
            store(x, d, 0, j + c)
            store(dx, d, 1, j + c)
            store(ddx, d, 2, j + c)


@formula
def turn_abreast(supports, turn, x, d):
    """Add to the shadows that their local axes turn with parameters: R' y of the state x = (q, v, a).

    ``turn``: R', (k, 3, 3, 8), or nothing.
    """
    for k in range(turn.shape[0]):
        i, j = supports.rot_slot[k], supports.rot_shadow[k]
        for c in range(3):
            for n in range(3):
                found = load(d, n, j + c)
                for m in range(3):
                    found = found + x[n][i + m] * load(turn, k, c, m)
                store(found, d, n, j + c)


@formula
def larger(x, X, weight, i):
    """The larger ones of x and of the weighted sizes of row i; no number if one is none."""
    size = weight[i] * absolute(load(X, i))
    return 0.5 * (x + size + absolute(x - size))


@formula
def sizes_of(X, weight, out):
    """Largest entry of each lane by size, weighted; four rows at a time, none of which waits for another."""
    n, none = weight.shape[0], every(0.0)
    x0, x1, x2, x3 = none, none, none, none
    for i in range(0, n - n % 4, 4):
        x0, x1 = larger(x0, X, weight, i), larger(x1, X, weight, i + 1)
        x2, x3 = larger(x2, X, weight, i + 2), larger(x3, X, weight, i + 3)
    for i in range(n - n % 4, n):
        x0 = larger(x0, X, weight, i)
    x0, x2 = 0.5 * (x0 + x1 + absolute(x0 - x1)), 0.5 * (x2 + x3 + absolute(x2 - x3))
    store(0.5 * (x0 + x2 + absolute(x0 - x2)), out, 0)


@formula
def predicted(s, d, h, scheme, keep):
    """d = (s_q, s_v, s_a) at the end of a step from the sensitivities s at its start, with ``keep`` s_a."""
    am, af = scheme.alpha_m, scheme.alpha_f
    c1, c2, c3 = (1.0 - af) / (1.0 - am), af / (1.0 - am), -am / (1.0 - am)
    for i in range(s.shape[1]):
        q, v, a, bar = load(s, Q, i), load(s, V, i), load(s, A, i), load(s, ABAR, i)
        new = (keep * c1 + c2) * a + c3 * bar
        store(q + h * v + (h * h) * ((0.5 - scheme.beta) * bar + scheme.beta * new), d, 0, i)
        store(v + h * ((1.0 - scheme.gamma) * bar + scheme.gamma * new), d, 1, i)
        store(keep * a, d, 2, i)


@inline_kernel
def lanes_at(place, first, count, of_each, row):
    """Let ``place`` be where a row of each of the parameters from ``first`` on begins."""
    for k in range(LANES):
        place[0, k] = (first + min(k, count - 1)) * of_each + row


@inline_kernel
def add_push(room, push, n, first, count):
    """Add what ``count`` parameters do to the residual of step n to r; lanes that are not open are zero."""
    r, size, open = room.r, push.shape[2], load(room.open, 0)
    rows = push.reshape(-1)
    lanes_at(room.place, first, count, push.shape[1] * size, n * size)
    whole = size - size % LANES
    for i in range(0, whole, LANES):
        x = gather_lanes(rows[i:], room.place, 0)
        for c in range(LANES):
            store(open * (load(r, i + c) + x[c]), r, i + c)
    for i in range(whole, size):
        for k in range(LANES):
            own = push[first + k, n, i] if k < count else 0.0
            r[i, k] = room.open[k] * (r[i, k] + own)


@inline_kernel
def turned_out(room, k, rows, whole):
    """Write the first ``whole`` rows of the k-th sensitivity to the eight places of ``rows``."""
    d = room.d
    for i in range(0, whole, LANES):
        x0, x1, x2, x3 = load(d, k, i), load(d, k, i + 1), load(d, k, i + 2), load(d, k, i + 3)
        x4, x5, x6, x7 = load(d, k, i + 4), load(d, k, i + 5), load(d, k, i + 6), load(d, k, i + 7)
        put_lanes(x0, x1, x2, x3, x4, x5, x6, x7, rows[i:], room.place, 0)


@inline_kernel
def kept(room, s, scheme, out, row, first):
    """Write s_v, s_q and s_v or all three, as there is room, to a row of what is kept.

    The next step starts with them.
    """
    am, af = scheme.alpha_m, scheme.alpha_f
    c1, c2, c3 = (1.0 - af) / (1.0 - am), af / (1.0 - am), -am / (1.0 - am)
    for i in range(s.shape[1]):
        q, v, a = load(room.d, 0, i), load(room.d, 1, i), load(room.d, 2, i)
        store(c1 * a + c2 * load(s, A, i) + c3 * load(s, ABAR, i), s, ABAR, i)
        store(q, s, Q, i)
        store(v, s, V, i)
        store(a, s, A, i)
    size, count, whole = s.shape[1], min(LANES, out.shape[0] - first), 0
    for k in range(out.shape[2]):
        own = k if out.shape[2] > 1 else 1
        if count == LANES:
            whole, each = size - size % LANES, out.shape[1] * out.shape[2] * size
            lanes_at(room.place, first, count, each, (row * out.shape[2] + k) * size)
            turned_out(room, own, out.reshape(-1), whole)
        for p in range(first, first + count):
            for i in range(whole, size):
                out[p, row, k, i] = room.d[own, i, p - first]
