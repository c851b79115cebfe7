"""What contacts add to a matrix where there is no inertia: equilibria and modes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..compiled import traits
from ..later import csc_array
from .core import Core, apply_supports


@dataclass(frozen=True)
class Touching:
    """Contacts that push in a state: rows b_j with the stiffness k_j, which add k_j b_j b_j^T to the matrix.

    Attributes
    ----------
    rows : ndarray, shape (m, n)
        Gradients of the overlaps, zero for held unknowns.
    stiffness : ndarray, shape (m,)
    """

    rows: FloatArray
    stiffness: FloatArray

    def matrix(self) -> csc_array:
        """Sum of k_j b_j b_j^T, shape (n, n)."""
        B = csc_array(self.rows)
        return csc_array(B.T @ (self.stiffness[:, None] * B))


def touching(core: Core, q: FloatArray, n: int) -> Touching:
    """Contacts that push in the state q; n unknowns."""
    rows, stiffness = [], []
    still = np.zeros_like(q)
    for batch in core.batches:
        if (rows_of := traits(batch).rows) is not None:
            for found, k in zip(*rows_of(batch, q), strict=True):
                apply_supports(core.supports, found)
                rows.append(found[:n])
                stiffness.append(k)
        row_of = traits(batch).row
        if row_of is None:
            continue
        for j in range(len(batch.slot)):
            row = np.zeros_like(q)
            k = float(row_of(batch, j, q, still, row))
            if k > 0.0:
                apply_supports(core.supports, row)
                rows.append(row[:n])
                stiffness.append(k)
    return Touching(np.array(rows).reshape(len(rows), n), np.array(stiffness))


def strips_touch(core: Core, q: FloatArray) -> BoolArray:
    """Which contacts with a row each, those of strips, push in the state q; (m,)."""
    still = np.zeros_like(q)
    batches = [(batch, row_of) for batch in core.batches if (row_of := traits(batch).row) is not None]
    found = [
        float(row_of(batch, j, q, still, np.zeros_like(q))) > 0.0
        for batch, row_of in batches
        for j in range(len(batch.slot))
    ]
    return np.array(found, dtype=bool)
