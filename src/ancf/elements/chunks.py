"""From arrays by element to arrays by chunk of LANES elements, as the kernels read them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..simd import LANES


def in_lanes(values: NDArray[Any], bounds: NDArray[np.int64], empty: int | None = None) -> NDArray[Any]:
    """Rows of values by element, (n, k), as (chunks, k, LANES): component by component, lane by lane.

    Chunk c has the elements from bounds[c] to bounds[c + 1].  Lanes without an element repeat the last one,
    with zeros from component ``empty`` on.
    """
    counts = np.diff(bounds)
    lane = np.arange(LANES)
    out = values[bounds[:-1, None] + np.minimum(lane, counts[:, None] - 1)]  # (chunks, LANES, k)
    if empty is not None:
        out[lane >= counts[:, None], empty:] = 0.0
    return np.ascontiguousarray(out.transpose(0, 2, 1))
