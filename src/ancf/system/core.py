"""The compiled heart of a System: residual, iteration matrix and solve on flat arrays."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..arrays import FloatArray, IntArray
from ..batches import (
    Batches,
    add_forces,
    add_inertias,
    add_tangents,
    find_events,
    last_inverted,
    remember_all,
    strain_energies,
)
from ..compiled import formula, inline_kernel, inlined_kernel, kernel
from ..linalg.block_ldl import Factor, fill, solve_rows
from ..linalg.border import Border, apply_border
from ..records import recorded

#: Entries of a vector that are summed up by themselves.
PIECE = 64


@recorded
class Supports(NamedTuple):
    """Held unknowns, local axes and given motions."""

    held: IntArray  # unknowns that the solve leaves alone
    held_zero: IntArray  # places in A of their rows and columns, if anything is added there
    held_one: IntArray  # places in A of their diagonal entries
    rot_slot: IntArray  # (k,) slots with local axes
    rot_shadow: IntArray  # (k,) their shadows
    rot_R: FloatArray  # (k, 3, 3, 3) R, dR/dt, d2R/dt2 now
    rot_moving: IntArray  # (k,) row of Tables.rotation, -1 where R is constant
    rot_rows: IntArray  # places in A of 3x6 pieces to be multiplied from the left by R^T
    rot_rows_of: IntArray  # their index in rot_slot
    rot_cols: IntArray  # places in A of 6x3 pieces to be multiplied from the right by R
    rot_cols_of: IntArray
    prescribed: IntArray  # unknowns with a given motion
    driven: IntArray  # slots that a support moves: their reactions do work


@recorded
class Loads(NamedTuple):
    """Dead loads as patterns of nodal forces, and the moments now."""

    gravity: FloatArray  # weight now, on the whole state vector
    still: FloatArray  # of it what does not change
    hung: FloatArray  # (m, 3) of it what bodies with a winch weigh per metre of their length
    hung_slot: IntArray  # (m,)
    hung_row: IntArray  # (m,) rows of `value` with these lengths
    hung_from: IntArray  # (m,) their unknowns
    start: IntArray  # (k + 1,) pattern of load k: slots and factors
    slot: IntArray
    factor: FloatArray
    grows: IntArray  # (k,) row of `value` with a length that the factors are multiplied with, -1: none
    value: FloatArray  # (m, 3) inputs now: those of the k patterns, slices that batches share, lengths


@recorded
class Joints(NamedTuple):
    """Constraints with multipliers.

    The multipliers are unknowns of the state vector without rates.  The blocks of the sliding joints,
    whose rows of the matrix change as they slide, come last: their rows alone are renewed in every step, as a
    border of the kept factors of the others.
    """

    multipliers: IntArray  # unknowns
    weight: FloatArray  # of their rows: of places one over the size of the model or a metre, of directions 1
    mask: FloatArray  # (size,) 1 for multipliers, else 0
    level: FloatArray  # (3,) weights of C, dC/dt, d2C/dt2 in their rows now
    batches: Batches  # with constraints
    tail: Batches  # of them those whose rows come last
    first: int  # first block of these rows, the number of blocks if there are none
    lowest: int  # first block with a multiplier, the number of blocks if there are none
    supports: Supports  # the part of the supports that concerns these rows
    border: Border  # these rows, beside the factors of those before


@recorded
class Core(NamedTuple):
    """All arrays that the kernels need.

    A state vector has ``n`` unknowns in blocks of six (two slots of three), followed by one *shadow*
    slot for each slot whose unknowns are components along local axes R.  Elements, loads and results
    see the shadow, r_x = R y; the solve sees y.
    """

    batches: Batches  # everything that has forces
    external: Batches  # of them the loads that depend on the state
    rubbing: Batches  # of them those with friction
    losing: Batches  # of them those without friction that dissipate
    inertial: Batches  # of these those with forces of inertia by velocities, with their mass alone
    remembering: Batches  # of them those with a memory
    entwined: Batches  # of them contacts between cables, which are not in the matrix: one or none
    near: tuple[Any, ...]  # of a line what evaluates a part of them, see near: one or none
    far: tuple[Any, ...]  # of a line what of it may be reduced, see far: one or none
    ws: FloatArray  # workspace of the element kernels
    A: FloatArray  # values of the iteration matrix in 6x6 blocks
    factor: Factor
    weight: FloatArray  # (n,) 1/size for positions, 1 for slopes, element length for r_yx, r_zx: the norm
    supports: Supports
    joints: Joints
    loads: Loads
    sticks: bool  # friction sticks or slips: forces have kinks
    damped: bool  # something dissipates
    loses: bool  # something without friction does
    loaded: bool  # something but gravity does work
    accounted: bool  # a run is to integrate what is dissipated and supplied


class Tables(NamedTuple):
    """Everything that is a function of time, at the ends of the steps of one block."""

    value: FloatArray  # (steps, inputs, 3) of loads
    motion: FloatArray  # (steps, prescribed, 3) value, rate, second rate
    rotation: FloatArray  # (steps, moving, 3, 3, 3) R, dR/dt, d2R/dt2


@inline_kernel
def weigh(loads, load):
    """The weight now, with the lengths in ``load``."""
    for i in range(loads.gravity.shape[0]):
        loads.gravity[i] = loads.still[i]
    for m in range(loads.hung_slot.shape[0]):
        for c in range(3):
            loads.gravity[loads.hung_slot[m] + c] += load[loads.hung_row[m], 0] * loads.hung[m, c]


@formula
def external_force(loads, load, f):
    """Load vector f from gravity and the inputs, shape (inputs, 3), of which the patterns have the first."""
    if loads.hung_slot.shape[0] > 0:
        weigh(loads, load)
    for i in range(f.shape[0]):
        f[i] = loads.gravity[i]
    add_patterns(loads, load, f)


@formula
def add_patterns(loads, load, f):
    """Add the inputs of the patterns to f, which holds the weight where these act."""
    for k in range(loads.start.shape[0] - 1):
        size = load[loads.grows[k], 0] if loads.grows[k] >= 0 else 1.0
        for m in range(loads.start[k], loads.start[k + 1]):
            i, w = loads.slot[m], size * loads.factor[m]
            for c in range(3):
                f[i + c] += w * load[k, c]


@inlined_kernel
def residual(batches, ws, q, v, a, f, r):
    """r = M a + internal forces - f, in the physical components; supports not yet applied."""
    for i in range(r.shape[0]):
        r[i] = -f[i]
    add_forces(batches, q, v, a, r, ws)


@kernel
def assemble(batches, ws, q, v, A, c_mass, c_damping, c_stiffness):
    """A = c_mass M + c_damping C + c_stiffness K, supports not yet applied."""
    for i in range(A.shape[0]):
        A[i] = 0.0
    add_tangents(batches, q, v, A, c_mass, c_damping, c_stiffness, ws)


@formula
def onto_shadows(supports, x):
    """Vectors at the unknowns of local axes as those of the shadows."""
    for k in range(supports.rot_slot.shape[0]):
        i, j = supports.rot_slot[k], supports.rot_shadow[k]
        for c in range(3):
            total = 0.0
            for m in range(3):
                total += supports.rot_R[k, 0, c, m] * x[i + m]
            x[j + c] = total


@formula
def to_local(supports, r):
    """Residual as the solve wants it: components along local axes, zero for held unknowns."""
    for k in range(supports.rot_slot.shape[0]):
        i, j = supports.rot_slot[k], supports.rot_shadow[k]
        for c in range(3):
            x = 0.0
            for m in range(3):
                x += supports.rot_R[k, 0, m, c] * r[j + m]
            r[i + c] = x
    for k in range(supports.held.shape[0]):
        r[supports.held[k]] = 0.0


@formula
def follow(supports, q, v, a):
    """Shadows from the unknowns: r_x = R y and its two time derivatives."""
    for k in range(supports.rot_slot.shape[0]):
        i, j = supports.rot_slot[k], supports.rot_shadow[k]
        for c in range(3):
            x, dx, ddx = 0.0, 0.0, 0.0
            for m in range(3):
                R, dR = supports.rot_R[k, 0, c, m], supports.rot_R[k, 1, c, m]
                x += R * q[i + m]
                dx += R * v[i + m] + dR * q[i + m]
                ddx += R * a[i + m] + 2.0 * dR * v[i + m] + supports.rot_R[k, 2, c, m] * q[i + m]
            q[j + c], v[j + c], a[j + c] = x, dx, ddx


@formula
def drive(supports, value, tables, n, q, v, a):
    """Inputs and given motions of the supports at the end of step n of the block; fills the shadows."""
    for k in range(value.shape[0]):
        for c in range(3):
            value[k, c] = tables.value[n, k, c]
    for k in range(supports.prescribed.shape[0]):
        i = supports.prescribed[k]
        q[i], v[i], a[i] = tables.motion[n, k, 0], tables.motion[n, k, 1], tables.motion[n, k, 2]
    for k in range(supports.rot_moving.shape[0]):
        if supports.rot_moving[k] >= 0:
            for d in range(3):
                for i in range(3):
                    for j in range(3):
                        R = tables.rotation[n, supports.rot_moving[k], d, i, j]
                        supports.rot_R[k, d, i, j] = R
    follow(supports, q, v, a)


@inline_kernel
def rotate_rows(A, o, step, R):
    """Replace three numbers, ``step`` apart from ``A[o]``, by R^T times them."""
    x, y, z = A[o], A[o + step], A[o + 2 * step]
    for i in range(3):
        A[o + i * step] = R[0, i] * x + R[1, i] * y + R[2, i] * z


@kernel
def restrict(supports, A):
    """Apply local axes to A and replace held unknowns by the identity."""
    for k in range(supports.rot_rows.shape[0]):
        for c in range(6):
            rotate_rows(A, supports.rot_rows[k] + c, 6, supports.rot_R[supports.rot_rows_of[k], 0])
    for k in range(supports.rot_cols.shape[0]):
        for c in range(6):
            rotate_rows(A, supports.rot_cols[k] + 6 * c, 1, supports.rot_R[supports.rot_cols_of[k], 0])
    for k in range(supports.held_zero.shape[0]):
        A[supports.held_zero[k]] = 0.0
    for k in range(supports.held_one.shape[0]):
        A[supports.held_one[k]] = 1.0


@kernel
def factorise_matrix(A, factor):
    """Factorise A; number of negative pivots, or -(block + 1) when singular there."""
    return fill(A, factor, factor.row_start.shape[0] - 1)


@kernel
def factorise_head(A, factor, last):
    """Factorise the rows before block ``last`` alone; see :func:`factorise_matrix`."""
    return fill(A, factor, last)


@inline_kernel
def constraint_rows(joints, q, v, a, r, ws):
    """r = the weighted constraints in the rows of the multipliers, zero elsewhere."""
    for i in range(r.shape[0]):
        r[i] = 0.0
    add_forces(joints.batches, q, v, a, r, ws)
    for i in range(r.shape[0]):
        r[i] *= joints.mask[i]


@kernel
def first_event(tail, q):
    """Code of the first event of the sliding joints in the state q, or -1."""
    return find_events(tail, q)


@kernel
def constraints(joints, q, v, a, r, ws):
    """See :func:`constraint_rows`."""
    constraint_rows(joints, q, v, a, r, ws)


@inlined_kernel
def solve_matrix(factor, x):
    """Replace a residual that :func:`to_local` has prepared by the correction."""
    solve_rows(factor, x, np.int64(0), factor.row_start.shape[0] - 1)  # a literal 0 is a type of its own


@kernel
def solve_sparse(factor, x, first):
    """The same for an x that is zero before block ``first``."""
    solve_rows(factor, x, first, factor.row_start.shape[0] - 1)


@formula
def has_rows(joints):
    """Whether there are rows that are renewed in every step."""
    return joints.border.number.shape[0] > 0


@formula
def solve_kept(core, x, first):
    """The same with the factors of a step, which have the rows of the sliding joints at their border."""
    if first < core.joints.first:
        solve_rows(core.factor, x, first, core.joints.first)
    if has_rows(core.joints):
        apply_border(core.joints.border, x)


@kernel
def inertia(batches, ws, a, r):
    """r = M a."""
    for i in range(r.shape[0]):
        r[i] = 0.0
    add_inertias(batches, a, r, ws)


@formula
def product(x, y):
    """x . y, summed up in pieces, so that round-off does not grow with all entries."""
    total, n = 0.0, x.shape[0]
    for first in range(0, n, PIECE):
        part = 0.0
        for i in range(first, min(first + PIECE, n)):
            part += x[i] * y[i]
        total += part
    return total


@kernel
def energies_of(batches, ws, still, q, v, momentum, out):
    """Kinetic, strain and potential energy of a state, J; ``momentum`` is workspace."""
    for i in range(momentum.shape[0]):
        momentum[i] = 0.0
    add_inertias(batches, v, momentum, ws)
    out[0], out[1], out[2] = 0.5 * product(momentum, v), strain_energies(batches, q, ws), -product(still, q)


@formula
def inverted_section(batches, ws, q):
    """Slot of r_y at the start of an element whose section has collapsed or turned inside out, or -1."""
    return last_inverted(batches, q, ws)


@kernel
def find_inverted(batches, ws, q):
    """See :func:`inverted_section`."""
    return inverted_section(batches, ws, q)


@kernel
def apply_load(loads, load, f):
    """Load vector f, see :func:`external_force`."""
    external_force(loads, load, f)


@kernel
def apply_supports(supports, r):
    """Residual as the solve wants it, see :func:`to_local`."""
    to_local(supports, r)


@kernel
def follow_supports(supports, q, v, a):
    """Shadows from the unknowns, see :func:`follow`."""
    follow(supports, q, v, a)


@kernel
def place_supports(supports, value, tables, n, q, v, a):
    """Inputs, given motions and shadows, see :func:`drive`."""
    drive(supports, value, tables, n, q, v, a)


@kernel
def keep_memory(remembering, q, v):
    """Bring the memory of batches up to a state, as each accepted step does."""
    remember_all(remembering, q, v)
