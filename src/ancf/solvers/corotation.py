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

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..arrays import FloatArray, IntArray
from ..compiled import formula, inline_kernel
from ..system.system import System


class Frames(NamedTuple):
    """Nodes that turn."""

    first: IntArray  # (m + 1,) where the slots of each node start
    slot: IntArray  # slots of all vectors of the nodes: r, r_x, ...
    slope: IntArray  # (m,) slot of r_x
    across: IntArray  # (m,) slot of r_y, -1: there is none
    tail: IntArray  # (slots, k) places of the 6x3 pieces in the rows that are renewed in every step, or -1
    axes: FloatArray  # (m, 6) unit tangent and unit normal towards r_y when the matrix was made
    Q: FloatArray  # (m, 9) rotation since then, row by row


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
    places of the pieces that stand under these slots in the rows that are not kept.
    """
    attached = np.zeros(0, dtype=np.int64) if attached is None else attached
    slots = [s for s in slots if s.shape[1] > 1]
    positions = np.concatenate([np.zeros(0, dtype=np.int64), *[s[:, 0] for s in slots]])
    places, count = np.unique(positions, return_counts=True)
    shared = places[count > 1]
    nodes: list[IntArray] = []
    for s in slots:
        count_held = np.isin(s[:, :, None] + np.arange(3), held).sum(axis=2)
        fixed = ((count_held == 1) | (count_held == 2)).any(axis=1)
        joined = np.isin(s, attached).any(axis=1)
        nodes += list(s[~fixed & ~joined & ~np.isin(s[:, 0], shared)])
    m = len(nodes)
    every = np.concatenate([np.zeros(0, dtype=np.int64), *nodes])
    return Frames(
        first=np.cumsum([0, *[len(n) for n in nodes]]).astype(np.int64),
        slot=every,
        tail=np.zeros((len(every), 0), dtype=np.int64) if tail is None else tail(every),
        slope=np.array([n[1] for n in nodes], dtype=np.int64),
        across=np.array([n[2] if len(n) > 2 else -1 for n in nodes], dtype=np.int64),
        axes=np.zeros((m, 6)),
        Q=np.zeros((m, 9)),
    )


def turning_nodes(system: System) -> Frames:
    """Frames of a system."""
    joints = system.parts.get("joints")
    attached = np.zeros(0, dtype=np.int64) if joints is None else joints.slot

    def tail(slots: IntArray) -> IntArray:
        first = 6 * np.arange(system.core.joints.first, system.numbering.blocks)
        return system.places.of(first[None, :], slots[:, None]).astype(np.int64)

    slots = list(system.numbering.slots.values())
    return allocate(slots, system.core.supports.held, attached, tail)


@formula
def tangent_at(q, i):
    """Unit vector along q[i : i + 3]."""
    x, y, z = q[i], q[i + 1], q[i + 2]
    il = 1.0 / math.sqrt(x * x + y * y + z * z)
    return x * il, y * il, z * il


@formula
def normal_at(q, j, x, y, z):
    """Unit vector normal to the tangent (x, y, z) towards q[j : j + 3]."""
    u, v, w = q[j], q[j + 1], q[j + 2]
    s = u * x + v * y + w * z
    u, v, w = u - s * x, v - s * y, w - s * z
    il = 1.0 / math.sqrt(u * u + v * v + w * w)
    return u * il, v * il, w * il


@inline_kernel
def remember(frames, q):
    """The matrix is being made now: no rotation yet."""
    for k in range(frames.slope.shape[0]):
        x, y, z = tangent_at(q, frames.slope[k])
        frames.axes[k, 0], frames.axes[k, 1], frames.axes[k, 2] = x, y, z
        if frames.across[k] >= 0:
            u, v, w = normal_at(q, frames.across[k], x, y, z)
            frames.axes[k, 3], frames.axes[k, 4], frames.axes[k, 5] = u, v, w
        for c in range(9):
            frames.Q[k, c] = 1.0 if c % 4 == 0 else 0.0


@formula
def turn(frames, q):
    """Rotations from the remembered axes to the present ones."""
    for k in range(frames.slope.shape[0]):
        x, y, z = tangent_at(q, frames.slope[k])
        if frames.across[k] >= 0:
            u, v, w = normal_at(q, frames.across[k], x, y, z)
            turn_axes(frames.axes, frames.Q, k, x, y, z, u, v, w)
        else:
            turn_tangent(frames.axes, frames.Q, k, x, y, z)


@formula
def turn_tangent(axes, Q, k, x, y, z):
    """Row k of Q: the smallest rotation to the tangent (x, y, z)."""
    a, b, c = axes[k, 0], axes[k, 1], axes[k, 2]
    u, v, w = b * z - c * y, c * x - a * z, a * y - b * x
    # 1 + cos, away from zero: near a half turn the rotation is poor, not wrong: Newton renews
    f = 1.0 / max(1.0 + a * x + b * y + c * z, 1e-3)
    co = 1.0 - f * (u * u + v * v + w * w)
    Q[k, 0] = co + f * u * u
    Q[k, 1] = f * u * v - w
    Q[k, 2] = f * u * w + v
    Q[k, 3] = f * u * v + w
    Q[k, 4] = co + f * v * v
    Q[k, 5] = f * v * w - u
    Q[k, 6] = f * u * w - v
    Q[k, 7] = f * v * w + u
    Q[k, 8] = co + f * w * w


@formula
def turn_axes(axes, Q, k, x, y, z, u, v, w):
    """Row k of Q: the rotation to the tangent (x, y, z) and the normal (u, v, w)."""
    a, b, c, d, e, f = axes[k, 0], axes[k, 1], axes[k, 2], axes[k, 3], axes[k, 4], axes[k, 5]
    g, h, i = b * f - c * e, c * d - a * f, a * e - b * d  # third axes: tangent x normal
    o, p, s = y * w - z * v, z * u - x * w, x * v - y * u
    Q[k, 0] = x * a + u * d + o * g
    Q[k, 1] = x * b + u * e + o * h
    Q[k, 2] = x * c + u * f + o * i
    Q[k, 3] = y * a + v * d + p * g
    Q[k, 4] = y * b + v * e + p * h
    Q[k, 5] = y * c + v * f + p * i
    Q[k, 6] = z * a + w * d + s * g
    Q[k, 7] = z * b + w * e + s * h
    Q[k, 8] = z * c + w * f + s * i


@formula
def turn_back(frames, r):
    """r -> Q^T r."""
    for k in range(frames.slope.shape[0]):
        for m in range(frames.first[k], frames.first[k + 1]):
            i = frames.slot[m]
            x, y, z = r[i], r[i + 1], r[i + 2]
            r[i] = frames.Q[k, 0] * x + frames.Q[k, 3] * y + frames.Q[k, 6] * z
            r[i + 1] = frames.Q[k, 1] * x + frames.Q[k, 4] * y + frames.Q[k, 7] * z
            r[i + 2] = frames.Q[k, 2] * x + frames.Q[k, 5] * y + frames.Q[k, 8] * z


@formula
def turn_forth(frames, r):
    """r -> Q r."""
    for k in range(frames.slope.shape[0]):
        for m in range(frames.first[k], frames.first[k + 1]):
            i = frames.slot[m]
            x, y, z = r[i], r[i + 1], r[i + 2]
            r[i] = frames.Q[k, 0] * x + frames.Q[k, 1] * y + frames.Q[k, 2] * z
            r[i + 1] = frames.Q[k, 3] * x + frames.Q[k, 4] * y + frames.Q[k, 5] * z
            r[i + 2] = frames.Q[k, 6] * x + frames.Q[k, 7] * y + frames.Q[k, 8] * z


@inline_kernel
def turn_rows(frames, A):
    """C -> C Q for the rows that are not kept: a joint's row then fits the matrix that is."""
    Q = frames.Q
    for k in range(frames.slope.shape[0]):
        for m in range(frames.first[k], frames.first[k + 1]):
            for t in range(frames.tail.shape[1]):
                place = frames.tail[m, t]
                if place < 0:
                    continue
                for o in range(place, place + 36, 6):
                    x, y, z = A[o], A[o + 1], A[o + 2]
                    if x != 0.0 or y != 0.0 or z != 0.0:
                        A[o] = x * Q[k, 0] + y * Q[k, 3] + z * Q[k, 6]
                        A[o + 1] = x * Q[k, 1] + y * Q[k, 4] + z * Q[k, 7]
                        A[o + 2] = x * Q[k, 2] + y * Q[k, 5] + z * Q[k, 8]
