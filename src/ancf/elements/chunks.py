"""From arrays by element to arrays by chunk of LANES elements, as the kernels read them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..simd import LANES


def elements_in(bounds: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """Which element each lane of each chunk has, (chunks, LANES), and whether it but repeats the last one."""
    counts, lane = np.diff(bounds)[:, None], np.arange(LANES)
    return bounds[:-1, None] + np.minimum(lane, counts - 1), lane >= counts


def in_lanes(values: NDArray[Any], bounds: NDArray[np.int64], empty: int | None = None) -> NDArray[Any]:
    """Rows of values by element, (n, k), as (chunks, k, LANES): component by component, lane by lane.

    Chunk c has the elements from bounds[c] to bounds[c + 1].  Lanes without an element repeat the last one,
    with zeros from component ``empty`` on.
    """
    element, without = elements_in(bounds)
    out = values[element]  # (chunks, LANES, k)
    if empty is not None:
        out[without, empty:] = 0.0
    return np.ascontiguousarray(out.transpose(0, 2, 1))
