"""Accelerations and reactions of a state in motion, by its equations of motion."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..system.core import residual
from ..system.system import System
from .start import consistent_start


def in_motion(system: System, q: FloatArray, v: FloatArray, time: float) -> tuple[FloatArray, FloatArray]:
    """Accelerations, and forces out of balance, which in the rows of held unknowns are reactions, N.

    Parameters
    ----------
    system : System
        None that a run is using: its arrays are written into.
    q, v : ndarray, shape (size,)
        State vectors.
    time : float
        s.

    Raises
    ------
    SolveError
        The mass matrix is singular, or a force is not finite.
    """
    tables = system.inputs.moment(time, (q, v))
    q, v = q.copy(), v.copy()
    f, r = np.zeros((2, system.size))
    a = consistent_start(system, q, v, tables, f)
    residual(system.core.batches, system.core.ws, q, v, a, f, r)
    return a, r
