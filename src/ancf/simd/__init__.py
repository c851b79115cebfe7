"""Eight elements at a time: values that kernels calculate with, see :mod:`ancf.simd.values`."""

from __future__ import annotations

from .functions import cos_and_sin, decay
from .memory import (
    gather,
    gather_lanes,
    gather_nodes,
    load,
    load_six,
    put,
    put_lanes,
    put_nodes,
    scatter,
    scatter_nodes,
    store,
    store_columns,
    store_six,
)
from .sums import lanes_plus
from .values import LANES, absolute, every, greatest, replaced, sqrt, total, vector, zero

__all__ = [
    "LANES",
    "absolute",
    "cos_and_sin",
    "decay",
    "every",
    "gather",
    "gather_lanes",
    "gather_nodes",
    "greatest",
    "lanes_plus",
    "load",
    "load_six",
    "put",
    "put_lanes",
    "put_nodes",
    "replaced",
    "scatter",
    "scatter_nodes",
    "sqrt",
    "store",
    "store_columns",
    "store_six",
    "total",
    "vector",
    "zero",
]
