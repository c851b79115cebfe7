"""Consistent start of a simulation: the constraints hold and M a + C_q^T lambda = forces."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..errors import SolveError
from ..system.core import (
    Tables,
    apply_load,
    apply_supports,
    assemble,
    constraints,
    factorise_matrix,
    follow_supports,
    place_supports,
    residual,
    restrict,
    solve_matrix,
)
from ..system.system import System

#: Sweeps of refinement: the rows of joints have small pivots, friction depends on the normal force.
SWEEPS = 4


NO_START = "the initial state has no finite accelerations"


def consistent_start(system: System, q: FloatArray, v: FloatArray, tables: Tables) -> FloatArray:
    """Accelerations that fulfil the equations of motion; also places the supports.

    With joints, q is shifted onto C = 0 and v onto dC/dt = 0, both as little as possible in the sense of
    the mass, and the multipliers in q are computed.

    Parameters
    ----------
    system : System
    q, v : ndarray, shape (size,)
        State vectors, changed in place.
    tables : Tables
        Functions of time whose first row is the start.
    """
    core = system.core
    if not (np.all(np.isfinite(q)) and np.all(np.isfinite(v))):
        raise SolveError("start", NO_START, "check shapes and loads")
    a = np.zeros(system.size)
    place_supports(core.supports, core.loads.value, tables, 0, q, v, a)
    if len(system.multipliers):
        _shift(system, q, v, a, (1.0, 0.0, 0.0), q)
        _shift(system, q, v, a, (0.0, 1.0, 0.0), v)
    return _accelerate(system, q, v, a, tables)


def _mass_factors(system: System, q: FloatArray, v: FloatArray) -> None:
    """Factorise the mass matrix with the constraints for accelerations."""
    core = system.core
    system.level[:] = 0.0, 0.0, 1.0
    assemble(core.batches, core.ws, q, v, core.A, 1.0, 0.0, 0.0)
    restrict(core.supports, core.A)
    bad = factorise_matrix(core.A, core.factor)
    if bad < 0:
        where = f"start, {system.numbering.describe(6 * (-bad - 1))}"
        raise SolveError(where, "the mass matrix is singular", "check masses, inertias and joints")


def _shift(
    system: System,
    q: FloatArray,
    v: FloatArray,
    a: FloatArray,
    level: tuple[float, float, float],
    x: FloatArray,
) -> None:
    """Correct x, which is q or v, such that the constraints of this level hold."""
    core, r = system.core, np.zeros(system.size)
    for _ in range(SWEEPS):
        _mass_factors(system, q, v)
        system.level[:] = level
        constraints(core.joints, q, v, a, r, core.ws)
        apply_supports(core.supports, r)
        solve_matrix(core.factor, r)
        r[system.multipliers] = 0.0
        x[: system.n] -= r[: system.n]
        follow_supports(core.supports, q, v, a)


def _accelerate(system: System, q: FloatArray, v: FloatArray, a: FloatArray, tables: Tables) -> FloatArray:
    core, r, f = system.core, np.zeros(system.size), np.zeros(system.size)
    lam = system.multipliers
    apply_load(core.loads, tables.value[0], f)
    q[lam] = v[lam] = 0.0
    _mass_factors(system, q, v)
    for _ in range(SWEEPS if len(lam) else 1):
        residual(core.batches, core.ws, q, v, a, f, r)
        apply_supports(core.supports, r)
        if not np.all(np.isfinite(r)):
            raise SolveError("start", NO_START, "check shapes and loads")
        solve_matrix(core.factor, r)
        q[lam] -= r[lam]
        r[lam] = 0.0
        a[: system.n] -= r[: system.n]
        follow_supports(core.supports, q, v, a)
    return a
