"""Stresses that fit the correction, for the matrix of an equilibrium iteration with thin beams.

The strains of the two beams are quadratic in the unknowns, e(q + dq) = e(q) + De dq + e2(dq).  After a large
correction of a thin beam, e2 times the stiffness against stretch or thickness is a stress that the next
correction takes away again, but until then it stands in the geometric part of the matrix and spoils it.
There the stress of the linear part, e(q + dq) - e2(dq), is taken instead: it is what Newton's method finds
if the stresses are unknowns of their own, and converges in far fewer and longer steps.  Where the iteration
settles both are the same.  Source: Magisano, Leonetti & Garcea (2017), "mixed integration point" strategy.

The kernels subtract the scalars of the natural shape from those of the state; e2(dq) is added to the former.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..batches import Batches
from ..elements.chunks import in_lanes
from ..elements.lanes import LANES
from ..elements.shapes import gauss
from ..elements.solid import SolidBatch
from ..elements.solid_shapes import shape
from ..system.sections import Vectors, scalar_products

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class Mixed:
    """Batches of a System for the matrix; the residual takes those of the System."""

    def __init__(self, batches: tuple[Any, ...]) -> None:
        self._natural: list[FloatArray] = []
        self._solids: list[SolidBatch] = []
        self.batches = Batches(self._copy(b) if isinstance(b, SolidBatch) else b for b in batches)

    def _copy(self, batch: SolidBatch) -> SolidBatch:
        """The batch with room for scalars of its own."""
        width = 15 * LANES * int(np.max(batch.groups[:, 3]))
        natural = np.zeros((len(batch.first) - 1, width))
        natural[:, : batch.lane_reference.shape[1]] = batch.lane_reference
        groups = batch.groups.copy()
        groups[:, 6] = 1  # the kernels look at the scalars
        self._natural.append(natural)
        self._solids.append(batch._replace(lane_reference=natural.copy(), groups=groups))
        return self._solids[-1]

    def correct(self, change: FloatArray) -> None:
        """Take the stresses that are linear in the last change of the state vector; zero: the true ones."""
        for batch, natural in zip(self._solids, self._natural, strict=True):
            batch.lane_reference[:] = natural + quadratic_strains(batch, change)


def quadratic_strains(batch: SolidBatch, dq: FloatArray) -> FloatArray:
    """Part e2 of the scalars that is quadratic in a change of the state vector, in the lanes of the batch."""
    n = len(batch.base)
    counts = np.diff(batch.first)
    lane = np.arange(n) - np.repeat(batch.first[:-1], counts)
    h = batch.lane_data[np.repeat(np.arange(len(counts)), counts), lane][:, None, None]
    element = "original" if batch.base.shape[1] == 8 else "nonlocking"
    vectors = dq[batch.base[:, :, None] + np.arange(3)]  # as for an element of the length 1
    vectors[:, [0, 4]] /= h
    vectors[:, 8:] *= h
    out = np.zeros((n, batch.lane_reference.shape[1] // LANES))
    for first, end, _, points, *_ in batch.groups.tolist():
        rows = slice(int(batch.first[first]), int(batch.first[end]))
        factors = (
            shape(element, gauss(points)[0], 1.0, derivative=name)
            for name in ("r_x", "r_y", "r_z", "r_yx", "r_zx")
        )
        at = Vectors(*(np.einsum("gk,nki->ngi", f, vectors[rows]) for f in factors))
        products = np.stack(scalar_products(at), axis=-1)
        products[..., :3] *= 0.5
        out[rows, : 15 * points] = products.reshape(rows.stop - rows.start, -1)
    return in_lanes(out, batch.first)
