"""Co-rotation of an old factorisation: each node turned by what it has turned since.

The elastic energy does not change under a rotation, so the iteration matrix of a cable that has
turned is about Q S Q^T with S the matrix as it was and Q the rotations of the nodes; the error is the
change of curvature within an element, not the rotation itself.  A correction costs two small
rotations per vector more and one factorisation then serves far longer; the idea of a co-rotated
Jacobian is that of Gerstmayr (reference [5] of the paper).

A node of a cable turns by the smallest rotation that takes its tangent to the present one, a node of
a beam with r_y by that of the right angle of r_x and r_y, so that it follows the twist as well.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ...arrays import BoolArray, FloatArray, IntArray
from ...compiled import formula, inline_kernel
from ...records import recorded
from ...simd import LANES, gather, gather_nodes, greatest, put, put_nodes, sqrt, vector
from ...system.system import System
from ...vectors import dot
from .corotation_along import (
    Along,
    along_of,
    bend,
    cross,
    none_along,
    remember_along,
    rows_of,
    set_rows_of,
    turn_back_along,
    turn_forth_along,
)


@recorded
class Frames(NamedTuple):
    """Nodes that turn, in chunks of LANES with as many vectors; a chunk that is not full repeats its last."""

    first: IntArray  # (chunks + 1,) first row in slot of each chunk
    slot: IntArray  # (rows, LANES) slots of all vectors of the nodes: r, r_x, and perhaps r_y, ...
    nodes: IntArray  # (chunks,) nodes of each chunk
    paired: BoolArray  # (chunks,) whether r_x follows r in the state vector, r_z follows r_y, ...
    under: IntArray  # (blocks, 2) nodes over the halves of blocks in the rows that are renewed in every step
    begin: int  # number of the first of these blocks in the matrix
    axes: FloatArray  # (chunks, 6, LANES) unit tangent and unit normal towards r_y when the matrix was made
    Q: FloatArray  # (chunks, 9, LANES) rotation since then, row by row
    along: Along  # how it changes between short elements


def allocate(
    slots: list[IntArray],
    held: IntArray,
    attached: IntArray | None = None,
    tail: Callable[[IntArray], IntArray] | None = None,
) -> Frames:
    """Frames of all nodes with these slots, (nodes, vectors) each.

    A vector that is held as a whole turns like a free one: its correction is zero.  Nodes that hold
    single components, share their position with others or have one of the slots ``attached``, to which
    joints are attached whose rows are kept with the matrix, are left out.  ``tail`` finds the
    places of the 6x3 pieces that stand under slots in the rows that are not kept, -1: none.
    """
    attached = np.zeros(0, dtype=np.int64) if attached is None else attached
    slots = [s for s in slots if s.shape[1] > 1]
    size = 3 + max((int(s.max()) for s in slots if s.size), default=0)
    still = np.zeros(max(size, 1 + int(np.max(held, initial=0))), dtype=np.bool_)
    still[held] = True
    joined = np.zeros(max(size, 1 + int(np.max(attached, initial=0))), dtype=np.bool_)
    joined[attached[attached >= 0]] = True
    ends = np.bincount(np.concatenate([np.zeros(0, dtype=np.int64), *[s[:, 0] for s in slots]]))
    nodes: dict[int, list[IntArray]] = {}
    for s in slots:
        count_held = still[s] + 0 + still[s + 1] + still[s + 2]
        turns = ((count_held == 0) | (count_held == 3)) & ~joined[s]
        nodes.setdefault(s.shape[1], []).append(s[turns.all(axis=1) & (ends[s[:, 0]] < 2)])
    chunks = _chunks({vectors: np.concatenate(found) for vectors, found in nodes.items()})
    every = np.concatenate([np.zeros((0, LANES), dtype=np.int64), *[c for c, _ in chunks]])
    first = np.cumsum([0, *[len(c) for c, _ in chunks]]).astype(np.int64)
    places = np.zeros((every.size, 0), dtype=np.int64) if tail is None else tail(every.ravel())
    under, begin = _under(places, first)
    return Frames(
        first=first,
        slot=np.ascontiguousarray(every),
        nodes=np.array([count for _, count in chunks], dtype=np.int64),
        paired=np.array([_paired(c) for c, _ in chunks], dtype=np.bool_),
        under=under,
        begin=begin,
        axes=np.zeros((len(chunks), 6, LANES)),
        Q=np.zeros((len(chunks), 9, LANES)),
        along=none_along(len(chunks)),
    )


def _under(places: IntArray, first: IntArray) -> tuple[IntArray, int]:
    """See :class:`Frames`, from the places of pieces under all slots of all lanes, (rows LANES, k)."""
    chunk = np.repeat(np.arange(len(first) - 1), np.diff(first))
    node = np.broadcast_to((LANES * chunk[:, None] + np.arange(LANES)).reshape(-1, 1), places.shape)
    there = places >= 0
    if not there.any():
        return np.zeros((0, 2), dtype=np.int64), 0
    block, half = places[there] // 36, places[there] % 36 // 3
    begin = int(block.min())
    under = np.full((int(block.max()) - begin + 1, 2), -1, dtype=np.int64)
    under[block - begin, half] = node[there]
    return under, begin


def _chunks(nodes: dict[int, IntArray]) -> list[tuple[IntArray, int]]:
    """Slots of LANES nodes at a time, (vectors, LANES), and how many nodes there are.

    Those of the nodes are (nodes, vectors), by their vectors.
    """
    found = []
    for _, alike in sorted(nodes.items()):
        for start in range(0, len(alike), LANES):
            part = alike[start : start + LANES]
            repeated = np.minimum(np.arange(LANES), len(part) - 1)
            found.append((np.ascontiguousarray(part[repeated].T), len(part)))
    return found


def _paired(slots: IntArray) -> bool:
    """Whether the vectors of all nodes stand in pairs in the state vector."""
    return len(slots) % 2 == 0 and bool(np.all(slots[1::2] == slots[::2] + 3))


def turning_nodes(system: System, step: float) -> Frames:
    """Frames of a system in steps of a length, s."""
    joints = system.parts.get("joints")
    attached = np.zeros(0, dtype=np.int64) if joints is None else joints.slot

    renewed = 6 * np.arange(system.core.joints.first, system.numbering.blocks)

    def tail(slots: IntArray) -> IntArray:
        return system.places.of(renewed[None, :], slots[:, None])

    slots = [system.numbering.each(name) for name in system.numbering.slots]
    frames = allocate(slots, system.core.supports.held, attached, tail if len(renewed) else None)
    return frames._replace(along=along_of(system, step, frames.first, frames.slot))


def flies(system: System) -> bool:
    """Whether nothing ties a system to the ground.

    A kept matrix that turns with the nodes mixes their motions: the momentum is then lost by what Newton's
    method leaves, where the plain one keeps it to the last digit.
    """
    model = system.model
    ends = [getattr(c, name, None) for c in model.connections for name in ("a", "b", "point")]
    held = any(support.held for support in model.supports)
    return not held and not any(isinstance(end, np.ndarray) for end in ends)


@formula
def tangent_at(frames, q, k):
    """Unit tangents of chunk k."""
    t = gather(q, frames.slot, frames.first[k] + 1)
    return 1.0 / sqrt(dot(t, t)) * t


@formula
def normal_at(frames, q, k, t):
    """Unit vectors normal to the tangents t, towards r_y."""
    n = gather(q, frames.slot, frames.first[k] + 2)
    n = n - dot(n, t) * t
    return 1.0 / sqrt(dot(n, n)) * n


@formula
def across(frames, k):
    """Whether the nodes of chunk k have r_y."""
    return frames.first[k + 1] - frames.first[k] > 2


@inline_kernel
def remember(frames, q):
    """The matrix is being made now: no rotation yet."""
    for k in range(frames.nodes.shape[0]):
        t = tangent_at(frames, q, k)
        set_rows_of(frames.axes, k, 0, t)
        if across(frames, k):
            set_rows_of(frames.axes, k, 3, normal_at(frames, q, k, t))
        for c in range(9):
            for m in range(LANES):
                frames.Q[k, c, m] = 1.0 if c % 4 == 0 else 0.0
        if frames.along.row[k] >= 0:
            remember_along(frames.along, q, frames.along.row[k], t)


@formula
def turn(frames, q):
    """Rotations from the remembered axes to the present ones."""
    for k in range(frames.nodes.shape[0]):
        t, old = tangent_at(frames, q, k), rows_of(frames.axes, k, 0)
        if across(frames, k):
            turn_axes(frames.Q, k, old, rows_of(frames.axes, k, 3), t, normal_at(frames, q, k, t))
        else:
            turn_tangent(frames.Q, k, old, t)
            if frames.along.row[k] >= 0:
                a, b, c = rows_of(frames.Q, k, 0), rows_of(frames.Q, k, 3), rows_of(frames.Q, k, 6)
                bend(frames.along, q, frames.along.row[k], old, a, b, c)


@formula
def turn_tangent(Q, k, old, t):
    """Chunk k of Q: the smallest rotation that takes the tangents `old` to t."""
    w = cross(old, t)
    # 1 + cos, away from zero: near a half turn the rotation is poor, not wrong: Newton renews
    f = 1.0 / greatest(1.0 + dot(old, t), 1e-3)
    co, x, y, z = 1.0 - f * dot(w, w), f * w[0], f * w[1], f * w[2]
    set_rows_of(Q, k, 0, vector(co + x * w[0], x * w[1] - w[2], x * w[2] + w[1]))
    set_rows_of(Q, k, 3, vector(y * w[0] + w[2], co + y * w[1], y * w[2] - w[0]))
    set_rows_of(Q, k, 6, vector(z * w[0] - w[1], z * w[1] + w[0], co + z * w[2]))


@formula
def turn_axes(Q, k, old, old_normal, t, n):
    """Chunk k of Q: the rotation to the tangents t and the normals n."""
    third, b = cross(old, old_normal), cross(t, n)
    set_rows_of(Q, k, 0, t[0] * old + n[0] * old_normal + b[0] * third)
    set_rows_of(Q, k, 3, t[1] * old + n[1] * old_normal + b[1] * third)
    set_rows_of(Q, k, 6, t[2] * old + n[2] * old_normal + b[2] * third)


@formula
def turn_back(frames, r):
    """r -> Q^T r."""
    for k in range(frames.nodes.shape[0]):
        a, b, c = rows_of(frames.Q, k, 0), rows_of(frames.Q, k, 3), rows_of(frames.Q, k, 6)
        if frames.along.row[k] >= 0:
            turn_back_along(frames.along, frames.along.row[k], r, frames.slot, frames.first[k], a, b, c)
        elif frames.paired[k]:
            for m in range(frames.first[k], frames.first[k + 1], 2):
                x, y = gather_nodes(r, frames.slot, m)
                x, y = x[0] * a + x[1] * b + x[2] * c, y[0] * a + y[1] * b + y[2] * c
                put_nodes(x, y, r, frames.slot, m)
        else:
            for m in range(frames.first[k], frames.first[k + 1]):
                x = gather(r, frames.slot, m)
                put(x[0] * a + x[1] * b + x[2] * c, r, frames.slot, m)


@formula
def turn_forth(frames, r):
    """r -> Q r."""
    for k in range(frames.nodes.shape[0]):
        a, b, c = rows_of(frames.Q, k, 0), rows_of(frames.Q, k, 3), rows_of(frames.Q, k, 6)
        if frames.along.row[k] >= 0:
            turn_forth_along(frames.along, frames.along.row[k], r, frames.slot, frames.first[k], a, b, c)
        elif frames.paired[k]:
            for m in range(frames.first[k], frames.first[k + 1], 2):
                x, y = gather_nodes(r, frames.slot, m)
                x, y = vector(dot(a, x), dot(b, x), dot(c, x)), vector(dot(a, y), dot(b, y), dot(c, y))
                put_nodes(x, y, r, frames.slot, m)
        else:
            for m in range(frames.first[k], frames.first[k + 1]):
                x = gather(r, frames.slot, m)
                put(vector(dot(a, x), dot(b, x), dot(c, x)), r, frames.slot, m)


@inline_kernel
def turn_rows(frames, border, A):
    """C -> C Q for the rows that are not kept: a joint's row then fits the matrix that is."""
    for t in range(border.number.shape[0]):
        for u in range(border.number[t]):
            place = border.place[t, u]
            k = place // 36 - frames.begin
            if 0 <= k < frames.under.shape[0]:  # beside these blocks no node turns
                for half in range(2):
                    node = frames.under[k, half]
                    if node >= 0:
                        turn_piece(frames.Q, node // LANES, node % LANES, A, place + 3 * half)


@inline_kernel
def turn_piece(Q, k, lane, A, place):
    """C -> C Q for six rows of three numbers."""
    if min(place, k, lane) < 0:
        return  # never: but now the compiler knows that no index counts from the end
    for o in range(place, place + 36, 6):
        x, y, z = A[o], A[o + 1], A[o + 2]
        for c in range(3):
            A[o + c] = x * Q[k, c, lane] + y * Q[k, 3 + c, lane] + z * Q[k, 6 + c, lane]
