"""Strains of the two beams as scalar products of vectors, and their part that is quadratic in a change."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..arrays import FloatArray
from ..simd import LANES
from .chunks import in_lanes
from .shapes import gauss
from .solid import SolidBatch
from .solid_shapes import shape

#: Columns of the groups of a batch.
BEGIN, END, FIRST_GP, POINTS, DAMPING, VISCOUS, CURVED = range(7)
#: Scalar products at a Gauss point.
PRODUCTS = 15


class Vectors(NamedTuple):
    """The five vectors of a section, each of shape (..., 3)."""

    a: FloatArray
    b: FloatArray
    c: FloatArray
    B: FloatArray
    C: FloatArray


def dot(u: FloatArray, v: FloatArray) -> FloatArray:
    """Scalar products of vectors (..., 3)."""
    product: FloatArray = np.einsum("...k,...k->...", u, v)
    return product


def scalar_products(s: Vectors) -> list[FloatArray]:
    """The fifteen scalar products on which the energy depends, in the order of the element's kernels."""
    a, b, c, B, C = s
    pairs = ((B, B), (C, C), (B, C), (a, B), (a, C), (a, b), (a, c), (b, c), (b, B), (c, C), (b, C), (c, B))
    return [dot(u, w) for u, w in (*((x, x) for x in (a, b, c)), *pairs)]


class QuadraticStrains:
    """A batch whose stresses may leave out what is quadratic in the last change of the state.

    The kernels subtract the scalars of the natural shape from those of the state: what is left out is added
    to the former.

    Parameters
    ----------
    batch : SolidBatch
        Stays as it is.
    """

    def __init__(self, batch: SolidBatch) -> None:
        rows = PRODUCTS * int(np.max(batch.groups[:, POINTS]))
        self._natural = np.zeros((len(batch.first) - 1, rows, LANES))
        self._natural[:, : batch.lane_reference.shape[1]] = batch.lane_reference
        groups = batch.groups.copy()
        groups[:, CURVED] = 1  # the kernels look at the scalars
        self.batch = batch._replace(lane_reference=self._natural.copy(), groups=groups)

    def leave_out(self, change: FloatArray) -> None:
        """Leave out what is quadratic in this change of the state vector; zero: nothing."""
        self.batch.lane_reference[:] = self._natural + quadratic_part(self.batch, change)


def quadratic_strains(batch: SolidBatch) -> QuadraticStrains:
    """See :class:`ancf.elements.registry.Element`."""
    return QuadraticStrains(batch)


def quadratic_part(batch: SolidBatch, dq: FloatArray) -> FloatArray:
    """Part e2 of the scalars that is quadratic in a change of the state vector, in the lanes of the batch."""
    n = len(batch.base)
    counts = np.diff(batch.first)
    lane = np.arange(n) - np.repeat(batch.first[:-1], counts)
    h = batch.lane_data[np.repeat(np.arange(len(counts)), counts), 0, lane][:, None, None]
    element = "original" if batch.base.shape[1] == 8 else "nonlocking"
    vectors = dq[batch.base[:, :, None] + np.arange(3)]  # as for an element of the length 1
    vectors[:, [0, 4]] /= h
    vectors[:, 8:] *= h
    out = np.zeros((n, batch.lane_reference.shape[1]))
    for group in batch.groups.tolist():
        rows, points = slice(int(batch.first[group[BEGIN]]), int(batch.first[group[END]])), group[POINTS]
        factors = (
            shape(element, gauss(points)[0], 1.0, derivative=name)
            for name in ("r_x", "r_y", "r_z", "r_yx", "r_zx")
        )
        at = Vectors(*(np.einsum("gk,nki->ngi", f, vectors[rows]) for f in factors))
        products = np.stack(scalar_products(at), axis=-1)
        products[..., :3] *= 0.5
        out[rows, : PRODUCTS * points] = products.reshape(rows.stop - rows.start, -1)
    return in_lanes(out, batch.first)
