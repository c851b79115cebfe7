"""Places and axes of the ends of joints, from state vectors of a state or a history."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..connections.joint_build import Vector


def values_of(vector: Vector, x: Any, *, rates: bool = False) -> FloatArray:
    """A vector in states x (..., size), shape (..., 3); of rates without its constant."""
    found = np.zeros((*np.shape(x)[:-1], 3)) if rates else np.zeros((*np.shape(x)[:-1], 3)) + vector.constant
    for slot, factor in zip(vector.slots, vector.factors, strict=True):
        found = found + factor * x[..., slot : slot + 3]
    return found


def dot(a: FloatArray, b: FloatArray) -> FloatArray:
    """Scalar products of vectors (..., 3)."""
    product: FloatArray = np.einsum("...k,...k->...", a, b)
    return product


def recorded(*vectors: Vector) -> bool:
    """Whether sensors have all that vectors follow from."""
    return all(slot >= 0 for vector in vectors for slot in vector.slots)
