"""The compiled heart of a System: residual, iteration matrix and solve on flat arrays."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import literal_unroll
from numpy.typing import NDArray

from ..compiled import add_force, add_inertia, add_tangent, dissipated_power, inline_kernel, kernel, strain_energy
from ..linalg.block_ldl import Factor, factorise, solve

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class Core(NamedTuple):
    """All arrays that the kernels need.

    A state vector has ``n`` unknowns in blocks of six (two slots of three), followed by one *shadow*
    slot for each slot whose unknowns are components along local axes R.  Elements, loads and results
    see the shadow, r_x = R y; the solve sees y.
    """

    batches: tuple[Any, ...]
    factor: Factor
    A: FloatArray  # values of the iteration matrix in 6x6 blocks
    ws: FloatArray  # workspace of the element kernels
    weight: FloatArray  # (n,) 1/size for positions, 1 for slopes: the norm of a correction
    held: IntArray  # unknowns that the solve leaves alone
    held_zero: IntArray  # places in A of their rows and columns
    held_one: IntArray  # places in A of their diagonal entries
    rot_slot: IntArray  # (k,) slots with local axes
    rot_shadow: IntArray  # (k,) their shadows
    rot_R: FloatArray  # (k, 3, 3, 3) R, dR/dt, d2R/dt2 now
    rot_moving: IntArray  # (k,) row of Tables.rotation, -1 where R is constant
    rot_rows: IntArray  # places in A of 3x6 pieces to be multiplied from the left by R^T
    rot_rows_of: IntArray  # their index in rot_slot
    rot_cols: IntArray  # places in A of 6x3 pieces to be multiplied from the right by R
    rot_cols_of: IntArray
    gravity: FloatArray  # weight, on the whole state vector
    load_start: IntArray  # (k + 1,) pattern of load k: slots and factors
    load_slot: IntArray
    load_factor: FloatArray
    moment: FloatArray  # (k, 3) moments now, shared with their batch
    prescribed: IntArray  # unknowns with a given motion
    driven: IntArray  # slots that a support moves: their reactions do work
    damped: bool  # something dissipates
    loaded: bool  # something but gravity does work


class Tables(NamedTuple):
    """Everything that is a function of time, at the ends of the steps of one block."""

    load: FloatArray  # (steps, loads, 3)
    moment: FloatArray  # (steps, moments, 3)
    motion: FloatArray  # (steps, prescribed, 3) value, rate, second rate
    rotation: FloatArray  # (steps, moving, 3, 3, 3) R, dR/dt, d2R/dt2


@inline_kernel
def external_force(core, load, f):  # type: ignore[no-untyped-def]
    """Load vector f from gravity and the loads' values, shape (loads, 3)."""
    for i in range(f.shape[0]):
        f[i] = core.gravity[i]
    for k in range(load.shape[0]):
        for m in range(core.load_start[k], core.load_start[k + 1]):
            i, w = core.load_slot[m], core.load_factor[m]
            for c in range(3):
                f[i + c] += w * load[k, c]


@kernel
def residual(core, q, v, a, f, r):  # type: ignore[no-untyped-def]
    """r = M a + internal forces - f, in the physical components; supports not yet applied."""
    for i in range(r.shape[0]):
        r[i] = -f[i]
    for batch in literal_unroll(core.batches):
        add_force(batch, q, v, a, r, core.ws)


@inline_kernel
def to_local(core, r):  # type: ignore[no-untyped-def]
    """Residual as the solve wants it: components along local axes, zero for held unknowns."""
    for k in range(core.rot_slot.shape[0]):
        i, j = core.rot_slot[k], core.rot_shadow[k]
        for c in range(3):
            r[i + c] = (
                core.rot_R[k, 0, 0, c] * r[j]
                + core.rot_R[k, 0, 1, c] * r[j + 1]
                + core.rot_R[k, 0, 2, c] * r[j + 2]
            )
    for k in range(core.held.shape[0]):
        r[core.held[k]] = 0.0


@inline_kernel
def follow(core, q, v, a):  # type: ignore[no-untyped-def]
    """Shadows from the unknowns: r_x = R y and its two time derivatives."""
    for k in range(core.rot_slot.shape[0]):
        i, j = core.rot_slot[k], core.rot_shadow[k]
        for c in range(3):
            x, dx, ddx = 0.0, 0.0, 0.0
            for m in range(3):
                R, dR, ddR = core.rot_R[k, 0, c, m], core.rot_R[k, 1, c, m], core.rot_R[k, 2, c, m]
                x += R * q[i + m]
                dx += R * v[i + m] + dR * q[i + m]
                ddx += R * a[i + m] + 2.0 * dR * v[i + m] + ddR * q[i + m]
            q[j + c], v[j + c], a[j + c] = x, dx, ddx


@inline_kernel
def drive(core, tables, n, q, v, a):  # type: ignore[no-untyped-def]
    """Given motions of the supports, and moments, at the end of step n of the block."""
    for k in range(core.moment.shape[0]):
        for c in range(3):
            core.moment[k, c] = tables.moment[n, k, c]
    for k in range(core.prescribed.shape[0]):
        i = core.prescribed[k]
        q[i], v[i], a[i] = tables.motion[n, k, 0], tables.motion[n, k, 1], tables.motion[n, k, 2]
    for k in range(core.rot_moving.shape[0]):
        if core.rot_moving[k] >= 0:
            for d in range(3):
                for i in range(3):
                    for j in range(3):
                        core.rot_R[k, d, i, j] = tables.rotation[n, core.rot_moving[k], d, i, j]


@inline_kernel
def rotate_matrix(core):  # type: ignore[no-untyped-def]
    """Rows and columns of rotated slots along their local axes."""
    A = core.A
    for k in range(core.rot_rows.shape[0]):
        o, R = core.rot_rows[k], core.rot_R[core.rot_rows_of[k], 0]
        for c in range(6):
            x, y, z = A[o + c], A[o + 6 + c], A[o + 12 + c]
            for i in range(3):
                A[o + 6 * i + c] = R[0, i] * x + R[1, i] * y + R[2, i] * z
    for k in range(core.rot_cols.shape[0]):
        o, R = core.rot_cols[k], core.rot_R[core.rot_cols_of[k], 0]
        for c in range(6):
            x, y, z = A[o + 6 * c], A[o + 6 * c + 1], A[o + 6 * c + 2]
            for i in range(3):
                A[o + 6 * c + i] = x * R[0, i] + y * R[1, i] + z * R[2, i]


@kernel
def build_matrix(core, q, v, c_mass, c_damping, c_stiffness):  # type: ignore[no-untyped-def]
    """A = c_mass M + c_damping C + c_stiffness K, with held unknowns replaced by the identity."""
    for i in range(core.A.shape[0]):
        core.A[i] = 0.0
    for batch in literal_unroll(core.batches):
        add_tangent(batch, q, v, core.A, c_mass, c_damping, c_stiffness, core.ws)
    rotate_matrix(core)
    for k in range(core.held_zero.shape[0]):
        core.A[core.held_zero[k]] = 0.0
    for k in range(core.held_one.shape[0]):
        core.A[core.held_one[k]] = 1.0


@kernel
def factorise_matrix(core):  # type: ignore[no-untyped-def]
    """Factorise core.A; number of negative pivots, or -(block + 1) when singular there."""
    return factorise(core.A, core.factor)


@kernel
def solve_matrix(core, x):  # type: ignore[no-untyped-def]
    """Replace a residual that :func:`to_local` has prepared by the correction."""
    solve(core.factor, x)


@kernel
def inertia(core, a, r):  # type: ignore[no-untyped-def]
    """r = M a."""
    for i in range(r.shape[0]):
        r[i] = 0.0
    for batch in literal_unroll(core.batches):
        add_inertia(batch, a, r, core.ws)


@kernel
def total_strain_energy(core, q):  # type: ignore[no-untyped-def]
    """Strain energy of all batches, J."""
    energy = 0.0
    for batch in literal_unroll(core.batches):
        energy += strain_energy(batch, q, core.ws)
    return energy


@kernel
def powers(core, q, v):  # type: ignore[no-untyped-def]
    """Power that dampers take out and that moments put in, W."""
    out, into = 0.0, 0.0
    for batch in literal_unroll(core.batches):
        p = dissipated_power(batch, q, v, core.ws)
        out += p[0]
        into += p[1]
    return out, into


@kernel
def apply_load(core, load, f):  # type: ignore[no-untyped-def]
    """Load vector f, see :func:`external_force`."""
    external_force(core, load, f)


@kernel
def apply_supports(core, r):  # type: ignore[no-untyped-def]
    """Residual as the solve wants it, see :func:`to_local`."""
    to_local(core, r)


@kernel
def place_supports(core, tables, n, q, v, a):  # type: ignore[no-untyped-def]
    """Given motions and shadows, see :func:`drive` and :func:`follow`."""
    drive(core, tables, n, q, v, a)
    follow(core, q, v, a)
