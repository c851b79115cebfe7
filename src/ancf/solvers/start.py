"""Consistent start of a simulation: M a = forces at the initial positions and velocities."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import SolveError
from ..system.core import (
    Tables,
    apply_load,
    apply_supports,
    assemble,
    factorise_matrix,
    follow_supports,
    place_supports,
    residual,
    restrict,
    solve_matrix,
)
from ..system.system import System

FloatArray = NDArray[np.float64]


def initial_acceleration(system: System, q: FloatArray, v: FloatArray, tables: Tables) -> FloatArray:
    """Accelerations that fulfil the equations of motion at the start; also places the supports.

    Parameters
    ----------
    system : System
    q, v : ndarray, shape (size,)
        State vectors; what supports prescribe is overwritten.
    tables : Tables
        Functions of time whose first row is the start.
    """
    core = system.core
    a, r, f = np.zeros(system.size), np.zeros(system.size), np.zeros(system.size)
    place_supports(core.supports, core.loads.moment, tables, 0, q, v, a)
    apply_load(core.loads, tables.load[0], f)
    residual(core.batches, core.ws, q, v, a, f, r)
    apply_supports(core.supports, r)
    assemble(core.batches, core.ws, q, v, core.A, 1.0, 0.0, 0.0)
    restrict(core.supports, core.A)
    if factorise_matrix(core.A, core.factor) < 0 or not np.all(np.isfinite(r)):
        raise SolveError("start", "the initial state has no finite accelerations", "check shapes and loads")
    solve_matrix(core.factor, r)
    a[: system.n] -= r[: system.n]
    follow_supports(core.supports, q, v, a)
    return a
