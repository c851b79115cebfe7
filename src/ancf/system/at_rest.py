"""Matrices at rest: those of a time step, and what their tangents leave to the inertia there."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..compiled import traits
from .core import assemble


def assemble_at_rest(
    batches: Any, ws: FloatArray, q: FloatArray, A: FloatArray, mass: float, damping: float, stiffness: float
) -> None:
    """A = mass M + damping C + stiffness K of batches in the state q without velocities.

    Parameters
    ----------
    batches : Batches
    ws : ndarray
        Workspace of the kernels.
    q : ndarray, shape (size,)
    A : ndarray
        Values of the matrix, which are replaced.
    """
    assemble(batches, ws, q, np.zeros_like(q), A, mass, damping, stiffness)
    if stiffness:
        for batch, own in _still(batches):
            own(batch, q, A, stiffness)


def _still(batches: Iterable[Any]) -> list[tuple[Any, Any]]:
    return [(batch, own) for batch in batches if (own := traits(batch).still) is not None]
