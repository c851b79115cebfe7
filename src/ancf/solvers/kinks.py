"""Derivatives of what friction does and leaves by differences, taken more closely where these reach a kink.

A batch remembers numbers, which are parts of one array here, and counts; a difference moves the numbers, the
state or both, asks for forces or lets the batch remember, and brings back what it has changed.
"""

from __future__ import annotations

from typing import NamedTuple

from ..arrays import FloatArray, IntArray
from ..batches import Batches, add_forces, remember_all
from ..compiled import inline_kernel, kernel
from ..records import recorded
from .sensitivity import extent

#: Part of a derivative by which differences of order two that reach over no kink agree, part of the largest
#: one below which that does not matter; how much closer others are taken, and how often.
BENT, SMALL, CLOSE, CLOSER = 1e-3, 1e-6, 32.0, 2
#: Places of the differences; kinds of numbers that depend smoothly on the state.
PLACES = (2.0, -2.0, 1.0, -1.0)
LENGTH, LIMIT, FORCE = range(3)
#: Changes of places, m, of velocities, m/s, and of limits in their size, of the differences.
FAR, FAST, STRONG = 1e-6, 1e-6, 1e-5


@recorded
class Remembering(NamedTuple):
    """Batches with friction and their memory, of which a difference begins."""

    batches: Batches
    numbers: FloatArray  # (m,) what they remember now
    counts: IntArray  # (k,)
    kept: FloatArray  # (m,) the same at the start
    kept_counts: IntArray  # (k,)
    smooth: IntArray  # (n,) which numbers depend smoothly on the state
    kinds: IntArray  # (n,) LENGTH, LIMIT or FORCE
    move: FloatArray  # (m,) room for their changes
    work: FloatArray  # (6, size) and (6, n) room for differences
    own: FloatArray
    state: FloatArray  # (2, size) room
    limit: float  # the size of limits, N/m


@inline_kernel
def bring_moved(memory, move, x):
    """Let batches remember what they did at the start, and x times a move."""
    for i in range(memory.numbers.shape[0]):
        memory.numbers[i] = memory.kept[i] + x * move[i]
    for i in range(memory.counts.shape[0]):
        memory.counts[i] = memory.kept_counts[i]


@inline_kernel
def settled(work, e):
    """Take the derivatives from values at the places into row 4 of ``work``; whether none of them is bent.

    Row 5 has those that were so far.
    """
    most, bent = 0.0, 0
    for i in range(work.shape[1]):
        far, near = (work[0, i] - work[1, i]) / (4.0 * e), (work[2, i] - work[3, i]) / (2.0 * e)
        if work[5, i] != 0.0:
            work[4, i] = (4.0 * near - far) / 3.0
        work[0, i], work[1, i] = abs(near - far), max(abs(near), abs(far))
        if work[1, i] < 1e300:
            most = max(most, work[1, i])
    for i in range(work.shape[1]):
        if not work[0, i] > max(BENT * work[1, i], SMALL * most):
            work[5, i] = 0.0
        bent += 1 if work[5, i] != 0.0 else 0
    return bent == 0


@inline_kernel
def begin(work):
    """Nothing is known."""
    for i in range(work.shape[1]):
        work[4, i], work[5, i] = 0.0, 1.0


@inline_kernel
def part_of(memory, d, of_lengths):
    """Let ``move`` be the changes d of lengths, or of the others; their size.

    Limits are negative by their size.
    """
    size, move = 0.0, memory.move
    for i in range(move.shape[0]):
        move[i] = 0.0
    for k in range(d.shape[0]):
        i, kind = memory.smooth[k], memory.kinds[k]
        if (kind == LENGTH) == of_lengths:
            size = max(size, abs(d[k]))
            move[i] = -d[k] if kind == LIMIT and memory.kept[i] < 0.0 else d[k]
    return size


@inline_kernel
def force_along(memory, ws, q, v, a, e, r):
    """Add the derivative of the force in a state along the move of the memory to r."""
    work = memory.work
    begin(work)
    for _ in range(CLOSER + 1):
        for k in range(4):
            bring_moved(memory, memory.move, PLACES[k] * e)
            for i in range(r.shape[0]):
                work[k, i] = 0.0
            add_forces(memory.batches, q, v, a, work[k], ws)
        if settled(work, e):
            break
        e /= CLOSE
    for i in range(r.shape[0]):
        r[i] += work[4, i]


@inline_kernel
def left_along(memory, q, v, dq, dv, by_q, by_v, e, out):
    """Add the derivative of what a step leaves along the move of the memory, dq and dv to out.

    ``by_q``, ``by_v``: 1 where these move, else 0.
    """
    begin(memory.own)
    work, state = memory.own, memory.state
    for _ in range(CLOSER + 1):
        for k in range(4):
            x = PLACES[k] * e
            bring_moved(memory, memory.move, x)
            for i in range(q.shape[0]):
                state[0, i], state[1, i] = q[i] + x * by_q * dq[i], v[i] + x * by_v * dv[i]
            remember_all(memory.batches, state[0], state[1])
            for i in range(out.shape[0]):
                work[k, i] = memory.numbers[memory.smooth[i]]
        if settled(work, e):
            break
        e /= CLOSE
    for i in range(out.shape[0]):
        out[i] += work[4, i]


@kernel
def add_forces_along(memory, ws, d, q, v, a, r):
    """Add the derivatives of the forces in a state along changes d of memories, (p, n), to r, (p, size)."""
    for p in range(d.shape[0]):
        for k in range(2):
            size = part_of(memory, d[p], k == 0)
            if size > 0.0:
                far = FAR if k == 0 else STRONG * memory.limit
                force_along(memory, ws, q, v, a, 0.5 * far / size, r[p])


@kernel
def leave_along(memory, d, q, v, s, weight, out):
    """Add the derivatives of what a step leaves to out, (p, n).

    Along changes d of the memories in which it began and those s, (p, 2, size), of the state at its end.
    """
    for p in range(d.shape[0]):
        dq, dv = s[p, 0], s[p, 1]
        size = max(extent(dq, weight), part_of(memory, d[p], True))
        if size > 0.0:
            left_along(memory, q, v, dq, dv, 1.0, 0.0, 0.5 * FAR / size, out[p])
        for i in range(memory.move.shape[0]):
            memory.move[i] = 0.0
        size = extent(dv, weight)
        if size > 0.0:
            left_along(memory, q, v, dq, dv, 0.0, 1.0, 0.5 * FAST / size, out[p])
        size = part_of(memory, d[p], False)
        if size > 0.0:
            left_along(memory, q, v, dq, dv, 0.0, 0.0, 0.5 * STRONG * memory.limit / size, out[p])
