"""Co-rotation of an old factorisation: each node turned by what its tangent has turned since.

The elastic energy does not change under a rotation, so the iteration matrix of a cable that has
turned is about Q S Q^T with S the matrix as it was and Q the rotations of the nodes; the error is the
change of curvature within an element, not the rotation itself.  A correction costs two small
rotations per node more and one factorisation then serves far longer; the idea of a co-rotated
Jacobian is that of Gerstmayr (reference [5] of the paper).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..compiled import inline_kernel

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class Frames(NamedTuple):
    """Nodes that turn."""

    position: IntArray  # (m,) slot of r
    slope: IntArray  # (m,) slot of r_x
    tangent: FloatArray  # (m, 3) unit tangent when the matrix was made
    Q: FloatArray  # (m, 9) rotation since then, row by row


def allocate(slots: list[IntArray], held: IntArray) -> Frames:
    """Frames of all nodes with these slots, (nodes, >= 2) each.

    A vector that is held as a whole turns like a free one: its correction is zero.  Nodes that hold
    single components, or share their position with others, are left out.
    """
    pairs = np.concatenate([np.zeros((0, 2), dtype=np.int64), *[s[:, :2] for s in slots]])
    count_held = np.isin(pairs[:, :, None] + np.arange(3), held).sum(axis=2)
    fixed = ((count_held == 1) | (count_held == 2)).any(axis=1)
    first, count = np.unique(pairs[:, 0], return_counts=True)
    shared = np.isin(pairs[:, 0], first[count > 1])
    pairs = pairs[~fixed & ~shared]
    m = len(pairs)
    return Frames(
        np.ascontiguousarray(pairs[:, 0]),
        np.ascontiguousarray(pairs[:, 1]),
        np.zeros((m, 3)),
        np.zeros((m, 9)),
    )


@inline_kernel
def remember(frames, q):
    """The matrix is being made now: no rotation yet."""
    for k in range(frames.slope.shape[0]):
        i = frames.slope[k]
        length = math.sqrt(q[i] * q[i] + q[i + 1] * q[i + 1] + q[i + 2] * q[i + 2])
        for c in range(3):
            frames.tangent[k, c] = q[i + c] / length
        for c in range(9):
            frames.Q[k, c] = 1.0 if c % 4 == 0 else 0.0


@inline_kernel
def turn(frames, q):
    """Smallest rotations from the remembered tangents to the present ones."""
    for k in range(frames.slope.shape[0]):
        i = frames.slope[k]
        x, y, z = q[i], q[i + 1], q[i + 2]
        il = 1.0 / math.sqrt(x * x + y * y + z * z)
        x, y, z = x * il, y * il, z * il
        a, b, c = frames.tangent[k, 0], frames.tangent[k, 1], frames.tangent[k, 2]
        u, v, w = b * z - c * y, c * x - a * z, a * y - b * x
        # 1 + cos, away from zero: near a half turn the rotation is poor, not wrong: Newton renews
        f = 1.0 / max(1.0 + a * x + b * y + c * z, 1e-3)
        co = 1.0 - f * (u * u + v * v + w * w)
        frames.Q[k, 0] = co + f * u * u
        frames.Q[k, 1] = f * u * v - w
        frames.Q[k, 2] = f * u * w + v
        frames.Q[k, 3] = f * u * v + w
        frames.Q[k, 4] = co + f * v * v
        frames.Q[k, 5] = f * v * w - u
        frames.Q[k, 6] = f * u * w - v
        frames.Q[k, 7] = f * v * w + u
        frames.Q[k, 8] = co + f * w * w


@inline_kernel
def turn_back(frames, r):
    """r -> Q^T r."""
    for k in range(frames.slope.shape[0]):
        for i in (frames.position[k], frames.slope[k]):
            x, y, z = r[i], r[i + 1], r[i + 2]
            r[i] = frames.Q[k, 0] * x + frames.Q[k, 3] * y + frames.Q[k, 6] * z
            r[i + 1] = frames.Q[k, 1] * x + frames.Q[k, 4] * y + frames.Q[k, 7] * z
            r[i + 2] = frames.Q[k, 2] * x + frames.Q[k, 5] * y + frames.Q[k, 8] * z


@inline_kernel
def turn_forth(frames, r):
    """r -> Q r."""
    for k in range(frames.slope.shape[0]):
        for i in (frames.position[k], frames.slope[k]):
            x, y, z = r[i], r[i + 1], r[i + 2]
            r[i] = frames.Q[k, 0] * x + frames.Q[k, 1] * y + frames.Q[k, 2] * z
            r[i + 1] = frames.Q[k, 3] * x + frames.Q[k, 4] * y + frames.Q[k, 5] * z
            r[i + 2] = frames.Q[k, 6] * x + frames.Q[k, 7] * y + frames.Q[k, 8] * z
