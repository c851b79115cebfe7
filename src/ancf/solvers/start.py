"""Consistent start of a simulation: the constraints hold and M a + C_q^T lambda = forces."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import types

from .. import addresses
from ..addresses import caller, pointer
from ..arrays import FloatArray
from ..compiled import formula, kernel, separate_kernel
from ..errors import SolveError
from ..records import place, recorded, type_of
from ..system.core import (
    Tables,
    assemble,
    constraint_rows,
    drive,
    external_force,
    factorise_matrix,
    follow,
    residual,
    restrict,
    solve_sparse,
    to_local,
)
from ..system.system import System
from .status import NOT_FINITE, OK

#: Sweeps of refinement: the rows of joints have small pivots, friction depends on the normal force.
SWEEPS = 4


@recorded
class Start(NamedTuple):
    """What the start takes besides the core; vectors have the length of the state vectors."""

    tables: Tables  # whose first row is the start
    q: FloatArray
    v: FloatArray
    a: FloatArray
    r: FloatArray  # workspace, as f
    f: FloatArray


def consistent_start(
    system: System, q: FloatArray, v: FloatArray, tables: Tables, load: FloatArray | None = None
) -> FloatArray:
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
    load : ndarray, shape (size,), optional
        Takes the load vector of the start.

    Raises
    ------
    SolveError
        The mass matrix is singular, or a force is not finite.
    """
    a, r, f = np.zeros((3, system.size))
    given = Start(tables, q, v, a, r, f if load is None else load)
    status = _number_at(_address(type_of(system.core), given), place(system.core), place(given))
    if status == NOT_FINITE:
        raise SolveError("start", "the initial state has no finite accelerations", "check shapes and loads")
    if status != OK:
        where = f"start, {system.numbering.describe(6 * (-status - 1))}"
        raise SolveError(where, "the mass matrix is singular", "check masses, inertias and joints")
    return a


_found: dict[Any, int] = {}


def _address(core: Any, given: Start) -> int:
    """Of the kernel for a type of core: to ask for all types takes longer than the start."""
    if core not in _found:
        _found[core] = addresses.address_of(start_at, (core, type_of(given)), types.int64)
    return _found[core]


@separate_kernel
def start_at(core, given):
    """See :func:`consistent_start`; OK, NOT_FINITE or -(block + 1)."""
    q, v, a, r = given.q, given.v, given.a, given.r
    if not (finite(q) and finite(v)):
        return NOT_FINITE
    drive(core.supports, core.loads.value, given.tables, 0, q, v, a)
    if core.joints.multipliers.shape[0] > 0:
        bad = shift(core, q, v, a, r)
        if bad < 0:
            return bad
    external_force(core.loads, given.tables.value[0], given.f)
    return accelerate(core, q, v, a, r, given.f)


@formula
def finite(x):
    """Whether all entries are."""
    none = 0.0
    for i in range(x.shape[0]):
        none += 0.0 * x[i]
    return none == 0.0


@formula
def mass_factors(core, q, v):
    """Factorise the mass matrix with the constraints for accelerations; negative if it is singular."""
    level = core.joints.level
    level[0], level[1], level[2] = 0.0, 0.0, 1.0
    assemble(core.batches, core.ws, q, v, core.A, 1.0, 0.0, 0.0)
    restrict(core.supports, core.A)
    return min(factorise_matrix(core.A, core.factor), 0)


@formula
def shift(core, q, v, a, r):
    """Correct q such that C = 0, then v such that dC/dt = 0."""
    level, n, mask = core.joints.level, core.weight.shape[0], core.joints.mask
    for k in range(2 * SWEEPS):
        of_velocity = k >= SWEEPS
        bad = mass_factors(core, q, v)
        if bad < 0:
            return bad
        level[0], level[1], level[2] = (0.0, 1.0, 0.0) if of_velocity else (1.0, 0.0, 0.0)
        constraint_rows(core.joints, q, v, a, r, core.ws)
        to_local(core.supports, r)
        solve_sparse(core.factor, r, np.int64(0))
        x = v if of_velocity else q
        for i in range(n):
            x[i] -= r[i] * (1.0 - mask[i])
        follow(core.supports, q, v, a)
    return OK


@formula
def accelerate(core, q, v, a, r, f):
    """Accelerations and multipliers from M a + C_q^T lambda = f - internal forces."""
    joints = core.joints
    for k in range(joints.multipliers.shape[0]):
        q[joints.multipliers[k]] = v[joints.multipliers[k]] = 0.0
    bad = mass_factors(core, q, v)
    if bad < 0:
        return bad
    for _ in range(SWEEPS if joints.multipliers.shape[0] > 0 else 1):
        residual(core.batches, core.ws, q, v, a, f, r)
        to_local(core.supports, r)
        if not finite(r):
            return NOT_FINITE
        solve_sparse(core.factor, r, np.int64(0))
        for i in range(core.weight.shape[0]):
            q[i] -= r[i] * joints.mask[i]
            a[i] -= r[i] * (1.0 - joints.mask[i])
        follow(core.supports, q, v, a)
    return OK


_number = caller(types.int64, (types.voidptr, types.voidptr))


@kernel
def _number_at(function, core, given):
    return _number(function, (pointer(core), pointer(given)))
