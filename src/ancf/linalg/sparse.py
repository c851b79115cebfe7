"""Block values as a sparse matrix of scipy."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..later import coo_array, csc_array


class Pattern(Protocol):
    """Which blocks are stored; see :class:`ancf.system.matrix.Places`."""

    n: int
    rows: NDArray[np.int64]
    column: NDArray[np.int64]


def to_sparse(A: FloatArray, places: Pattern) -> csc_array:
    """Whole symmetric matrix of block values."""
    n = places.n
    rows = np.concatenate([np.arange(n), places.rows])
    cols = np.concatenate([np.arange(n), places.column])
    i = 6 * rows[:, None] + np.repeat(np.arange(6), 6)
    j = 6 * cols[:, None] + np.tile(np.arange(6), 6)
    values = A.reshape(-1, 36)
    below = slice(n, None)
    ij = (
        np.concatenate([i.ravel(), j[below].ravel()]),
        np.concatenate([j.ravel(), i[below].ravel()]),
    )
    return csc_array(
        coo_array((np.concatenate([values.ravel(), values[below].ravel()]), ij), shape=(6 * n, 6 * n))
    )
