"""What the kernels of elements keep in memory while they work on a chunk: rows of LANES numbers by name."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..compiled import formula
from ..simd import LANES, load, store, vector

ROWS = 738  # what the greediest element needs


def workspace() -> FloatArray:
    """Workspace for the kernels of all elements; its rows do not cross cache lines."""
    spare = np.zeros((ROWS + 1) * LANES)
    start = -(spare.ctypes.data // 8) % LANES
    return spare[start : start + ROWS * LANES]


@formula
def clear(ws, first, rows):
    """Set rows to zero."""
    for i in range(first * LANES, (first + rows) * LANES):
        ws[i] = 0.0


@formula
def row(ws, k):
    """The numbers of row k."""
    return load(ws, k * LANES)


@formula
def add_row(ws, k, x):
    """Add numbers to row k."""
    store(load(ws, k * LANES) + x, ws, k * LANES)


@formula
def rows(ws, k):
    """The vector in the rows k, k + 1, k + 2."""
    return vector(row(ws, k), row(ws, k + 1), row(ws, k + 2))


@formula
def set_rows(ws, k, x):
    """Write a vector into the rows k, k + 1, k + 2."""
    store(x[0], ws, k * LANES)
    store(x[1], ws, (k + 1) * LANES)
    store(x[2], ws, (k + 2) * LANES)


@formula
def add_rows(ws, k, x):
    """Add a vector to the rows k, k + 1, k + 2."""
    add_row(ws, k, x[0])
    add_row(ws, k + 1, x[1])
    add_row(ws, k + 2, x[2])
