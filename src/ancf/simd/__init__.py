"""Eight elements at a time: values that kernels calculate with, see :mod:`ancf.simd.values`."""

from __future__ import annotations

from .memory import gather, gather_nodes, load, scatter, scatter_nodes, store
from .values import LANES, absolute, every, sqrt, total, vector, zero

__all__ = [
    "LANES",
    "absolute",
    "every",
    "gather",
    "gather_nodes",
    "load",
    "scatter",
    "scatter_nodes",
    "sqrt",
    "store",
    "total",
    "vector",
    "zero",
]
