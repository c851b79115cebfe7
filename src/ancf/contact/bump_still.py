"""What tangents of bodies on bodies leave out at rest: places and normals move with the bodies.

A ball that rests on a plane under the force N turns without resistance: its lowest place stays below its
centre.  As if it were a place of the ball, and so the tangent has it, it would tip over it, with the
stiffness -N R.  On round bodies the normal turns as the ball moves aside: -N/(R + r) on a ball, N/(R - r) in
a bowl.  Steps of time do without, their masses outweigh it; equilibria and modes do not.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..compiled import kernel
from ..linalg.eight import lane_rows
from ..records import Located
from ..simd import LANES
from .bump_along import add_row_along

COLUMNS = 24  # unknowns of two bodies


@kernel
def add_still(batch, q, still, d, r, H, A, factor):
    """Add ``factor`` times the symmetric part of what the tangent leaves out to the matrix A.

    ``d`` (3, size, 8) and ``r`` (size, 8) are zero, before and after; H (24, 24) is room.
    """
    for e in range(batch.base.shape[0]):
        for first in range(0, COLUMNS, LANES):
            for lane in range(LANES):
                k, c = divmod(first + lane, 3)
                if batch.base[e, k] >= 0:
                    d[0, batch.base[e, k] + c, lane] = 1.0
            add_row_along(batch, e, q, still, d, r, 1.0)
            for k in range(8):
                i = batch.base[e, k]
                for c in range(3):
                    for lane in range(LANES):
                        H[3 * k + c, first + lane] = r[i + c, lane] if i >= 0 else 0.0
                        if i >= 0:
                            r[i + c, lane] = d[0, i + c, lane] = 0.0
        for k in range(8):
            for m in range(8):
                place = batch.dest[e, 8 * k + m]
                if place < 0:
                    continue
                for i in range(3):
                    for j in range(3):
                        x = H[3 * k + i, 3 * m + j] + H[3 * m + j, 3 * k + i]
                        A[place + 6 * i + j] += 0.5 * factor * x


def still_part(batch: Any, q: FloatArray, A: FloatArray, factor: float) -> None:
    """See :func:`add_still`."""
    size = len(q)
    d, r = lane_rows(3 * size).reshape(3, size, LANES), lane_rows(size)
    add_still(Located(batch), q, np.zeros_like(q), d, r, np.zeros((COLUMNS, COLUMNS)), A, factor)
