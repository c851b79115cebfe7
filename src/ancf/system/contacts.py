"""What contacts add to a matrix where there is no inertia: equilibria and modes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..compiled import traits
from ..later import csc_array
from .core import Core, apply_supports

Seen = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class Touching:
    """Contacts that push in a state: rows b_j with the stiffness k_j, which add k_j b_j b_j^T to the matrix.

    Attributes
    ----------
    rows : ndarray, shape (m, n)
        Gradients of the overlaps, zero for held unknowns.
    stiffness, damping : ndarray, shape (m,)
    turns : list of (ndarray, ndarray)
        Rows R (2, n) and symmetric S (2, 2) of forces that turn with the motion: R^T S R in the matrix.
    """

    rows: FloatArray
    stiffness: FloatArray
    damping: FloatArray
    turns: list[tuple[FloatArray, FloatArray]]

    def matrix(self) -> csc_array:
        """Stiffness, shape (n, n)."""
        B = csc_array(self.rows)
        found = B.T @ (self.stiffness[:, None] * B)
        for rows, small in self.turns:
            R = csc_array(rows)
            found = found + R.T @ csc_array(small) @ R
        return csc_array(found)

    def brakes(self) -> csc_array:
        """Damping, shape (n, n)."""
        B = csc_array(self.rows)
        return csc_array(B.T @ (self.damping[:, None] * B))


def touching(core: Core, q: FloatArray, n: int, seen: Seen | None = None) -> Touching:
    """Contacts that push in the state q; n unknowns.

    ``seen(row)``: components (n,) of a row of forces (size,); default those that the supports leave.
    """
    seen = (lambda row: _left(core, row)[:n]) if seen is None else seen
    rows, stiffness, damping, turns = [], [], [], []
    for batch in core.batches:
        if (rows_of := traits(batch).rows) is not None:
            for found, k, c in zip(*rows_of(batch, q), strict=True):
                rows.append(seen(found))
                stiffness.append(k)
                damping.append(c)
        row_of = traits(batch).row
        if row_of is None:
            continue
        for j in range(len(batch.slot)):
            row = np.zeros_like(q)
            k, c = row_of(batch, j, q, np.zeros_like(q), row)
            if k > 0.0:
                rows.append(seen(row))
                stiffness.append(k)
                damping.append(c)  # of a strip
                turns += _turns(batch, j, q, seen)
    return Touching(np.array(rows).reshape(len(rows), n), np.array(stiffness), np.array(damping), turns)


def _left(core: Core, row: FloatArray) -> FloatArray:
    """What the supports leave of a row."""
    apply_supports(core.supports, row)
    return row


def _turns(batch: Any, j: int, q: FloatArray, seen: Seen) -> list[tuple[FloatArray, FloatArray]]:
    """What part j of a batch adds to :attr:`Touching.turns`."""
    if (turn_of := traits(batch).turn) is None:
        return []
    a, c = np.zeros_like(q), np.zeros_like(q)
    force, bend = turn_of(batch, j, q, np.zeros_like(q), a, c)
    return [(np.array([seen(a), seen(c)]), float(force) * np.array([[float(bend), 1.0], [1.0, 0.0]]))]


def strips_touch(core: Core, q: FloatArray) -> BoolArray:
    """Which contacts with a row each, those of strips, push in the state q; (m,)."""
    still = np.zeros_like(q)
    batches = [(batch, row_of) for batch in core.batches if (row_of := traits(batch).row) is not None]
    found = [
        row_of(batch, j, q, still, np.zeros_like(q))[0] > 0.0
        for batch, row_of in batches
        for j in range(len(batch.slot))
    ]
    return np.array(found, dtype=bool)
