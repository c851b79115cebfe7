"""What loads at points have in common: the place of the point, its force on the unknowns, its tangent."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..compiled import formula


def at_points(points: Sequence[Any], locate: Callable[[Any], Any]) -> dict[str, NDArray[Any]]:
    """Fields ``base``, ``dest`` and ``factor`` of a batch: each point is sum(factor_k q[base_k]).

    Parameters
    ----------
    points : sequence of Point
    locate : function
        Finds the probe of a point.

    Returns
    -------
    dict
        base (n, k), the slots, -1 where there is none; dest (n, k*k), their places in the matrix, which
        follow later; factor (n, k), shape functions.
    """
    probes = [locate(point) for point in points]
    used = [np.flatnonzero(probe.S[0]) for probe in probes]
    n, width = len(probes), max(map(len, used), default=1)
    base, factor = np.full((n, width), -1, dtype=np.int64), np.zeros((n, width))
    for e, (probe, columns) in enumerate(zip(probes, used, strict=True)):
        base[e, : len(columns)], factor[e, : len(columns)] = probe.slots[columns], probe.S[0][columns]
    return {"base": base, "dest": np.full((n, width**2), -1, dtype=np.int64), "factor": factor}


@formula
def at_point(batch, e, q):
    """Position of point e from the state vector, its velocity from the rates."""
    x, y, z = 0.0, 0.0, 0.0
    for k in range(batch.base.shape[1]):
        i, w = batch.base[e, k], batch.factor[e, k]
        if i >= 0:
            x += w * q[i]
            y += w * q[i + 1]
            z += w * q[i + 2]
    return x, y, z


@formula
def add_force_at(batch, e, force, r):
    """Subtract the force on point e from the residual r."""
    for k in range(batch.base.shape[1]):
        i, w = batch.base[e, k], batch.factor[e, k]
        if i >= 0:
            for c in range(3):
                r[i + c] -= w * force[c]


@formula
def add_tangent_at(batch, e, rows, A):
    """Add a symmetric 3x3 matrix, minus the derivative of the force on point e, three tuples, to A."""
    size = batch.base.shape[1]
    for k in range(size):
        for m in range(size):
            place = batch.dest[e, size * k + m]
            if place < 0:
                continue
            w = batch.factor[e, k] * batch.factor[e, m]
            for i in range(3):
                for j in range(3):
                    A[place + 6 * i + j] += w * rows[i][j]
