"""Sensitivities of the steps of the Newmark family: the derivative of the numbers that a run gives.

A step has solved R(q, v, a; p) = 0 with q = q~ + B a, v = v~ + G a (:mod:`ancf.solvers.newmark`).  Its
derivative by a parameter p is linear,

    M s_a + C s_v + K s_q + R_p = 0,      s_q = s_q~ + B s_a,      s_v = s_v~ + G s_a,

with the exact mass M, damping C and stiffness K of the step.  Batches that say so (``Traits.exact``) have
them in the matrix.  Of those that are exact at rest alone, as damped elements are, the change of the damping
forces with q is missing there: kinds that know it (``add_rate_stiffness``) give it as a symmetric and an
antisymmetric matrix, of others it is taken by differences along s.  Joints know the derivatives of their
forces and rows along s (``add_force_slopes``); all of other batches is taken by differences.  All parameters
share the factors of a step, see :mod:`ancf.solvers.derivatives.abreast`.

All vectors are derivatives at the free unknowns, zero at held ones; what a parameter does to these is in R_p.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray, IntArray
from ...batches import Batches, add_forces, add_tangents
from ...compiled import formula, inline_kernel, kernel
from ...linalg.block import times
from ...records import recorded
from ...simd import load_six, store_six, total
from ...system.core import follow, to_local
from ..rare import add_rate_stiffnesses, add_slopes_along

#: Change of a state, in sizes of the model, and of its velocities, in these per second, of the differences;
#: and its most in m: a contact is pressed by a millimetre, whatever the length of its line.
MOVED, FURTHEST = 3e-6, 2e-5
#: The same of damping forces, which are smooth, by differences of order four, and their weights.
LOSSY, NEAR, FAR = 3e-4, 8.0 / 12.0, -1.0 / 12.0
#: Corrections of a sensitivity: how many at most; the part of it below which they end when the next one would
#: be smaller, and the same where central differences have more round-off; the part below which they end when
#: the next one is not smaller; of long lines, whose places have more round-off, when it is as large.
MOST, ENOUGH, DIFFERENCED, NOISY, ROUGH = 60, 1e-13, 1e-10, 1e-8, 1e-6
#: A correction, or a sensitivity, that is none, whatever its units: what has decayed so far is round-off of
#: forces that are not small.
LEAST = 1e-60
#: Places of the vectors of a sensitivity.
Q, V, A, ABAR = range(4)


@recorded
class Matrices(NamedTuple):
    """What sensitivities have of the matrix."""

    exact: Batches  # whose matrices are derivatives, at least at rest
    resting: Batches  # of them, those whose stiffness is taken at rest
    stirring: Batches  # of them, those that know what velocities add to it
    stirred: Batches  # these, and those of the worked ones that do
    worked: Batches  # whose matrices are derivatives as well, and that know their products with vectors
    lossy: Batches  # of them, those with damping forces that change with q in another way
    joined: Batches  # joints, which know the derivatives of their forces
    rough: Batches  # all others
    K: FloatArray  # values of the blocks of the exact ones
    C: FloatArray
    M: FloatArray
    W: FloatArray  # what is antisymmetric of the stiffness; no values if there is none
    outside: bool  # contacts are not in the matrix of a step
    turning: bool  # axes of supports turn, which the factors of a step do not know
    damped: bool  # C is not zero
    moved: float  # change of a state, in sizes of the model, of differences
    work: FloatArray  # (10, size)
    along: FloatArray  # (3, size, 8) and (size, 8) directions of joints, and what comes of them; of no joint
    found: FloatArray  # (0, 0, 8) and (0, 8)
    alpha: FloatArray  # of rows of joints with such, see joint, (k,)
    row: IntArray  # their multipliers, (k,)
    edge: IntArray  # all multipliers, then places of sliding joints, (k,): rows of joints
    touching: bool  # there are others than joints among the joined, of which matrices have nothing or not all


@recorded
class Way(NamedTuple):
    """The states at the ends of the steps of a block."""

    q: FloatArray  # (steps, size)
    v: FloatArray
    a: FloatArray


class Constraining(NamedTuple):
    """How joints are kept, see :class:`ancf.solvers.newmark.Rule`."""

    w0: float
    w1: float
    w2: float
    projects: bool


@inline_kernel
def multiply(factor, values, x, y):
    """Add the product of the symmetric matrix of these block values and x to y."""
    n = factor.row_start.shape[0] - 1
    for i in range(n):
        store_six(load_six(y, 6 * i) + times(values, 36 * i, x, 6 * i), y, 6 * i)
        for k in range(factor.row_start[i], factor.row_start[i + 1]):
            j, o = 6 * factor.column[k], 36 * (n + k)
            other = load_six(x, j)
            for r in range(6):
                y[6 * i + r] += total(load_six(values, o + 6 * r) * other)
            store_six(load_six(y, j) + times(values, o, x, 6 * i), y, j)


@inline_kernel
def multiply_twisted(factor, values, sign, x, y):
    """Add the product of the antisymmetric matrix of these block values, times a sign, and x to y."""
    n = factor.row_start.shape[0] - 1
    for i in range(n):
        for r in range(6):
            y[6 * i + r] += sign * total(load_six(values, 36 * i + 6 * r) * load_six(x, 6 * i))
        for k in range(factor.row_start[i], factor.row_start[i + 1]):
            j, o = 6 * factor.column[k], 36 * (n + k)
            other = load_six(x, j)
            for r in range(6):
                y[6 * i + r] += sign * total(load_six(values, o + 6 * r) * other)
            store_six(load_six(y, j) - sign * times(values, o, x, 6 * i), y, j)


@formula
def seen(supports, x, y):
    """y = x with the values of the shadows at the unknowns where the matrix has their rows."""
    for i in range(x.shape[0]):
        y[i] = x[i]
    for k in range(supports.rot_slot.shape[0]):
        for c in range(3):
            y[supports.rot_slot[k] + c] = x[supports.rot_shadow[k] + c]


@inline_kernel
def product(core, values, x, r, w):
    """Add a symmetric matrix times x to r, both in physical components."""
    seen(core.supports, x, w[0])
    for i in range(r.shape[0]):
        w[1][i] = 0.0
    multiply(core.factor, values, w[0], w[1])
    to_shadows(core.supports, r, w)


@inline_kernel
def twisted_product(core, values, sign, x, r, w):
    """The same of an antisymmetric matrix, times a sign; one without values is none."""
    if values.shape[0] == 0:
        return
    seen(core.supports, x, w[0])
    for i in range(r.shape[0]):
        w[1][i] = 0.0
    multiply_twisted(core.factor, values, sign, w[0], w[1])
    to_shadows(core.supports, r, w)


@formula
def to_shadows(supports, r, w):
    """Add the product w[1] to r, the rows of shadows where these are."""
    for k in range(supports.rot_slot.shape[0]):
        for c in range(3):
            i = supports.rot_slot[k] + c
            r[supports.rot_shadow[k] + c] += w[1][i]
            w[1][i] = 0.0
    for i in range(r.shape[0]):
        r[i] += w[1][i]


@inline_kernel
def along(batches, ws, x, d, e, r, w):
    """Add the derivative of the forces at the states x = (q, v, a) along d, which moves by e, to r."""
    for side in (1.0, -1.0):
        for i in range(r.shape[0]):
            w[0][i] = x[0][i] + side * e[0] * d[0][i]
            w[1][i] = x[1][i] + side * e[1] * d[1][i]
            w[2][i] = x[2][i] + side * e[1] * d[2][i]
            w[3][i] = 0.0
        add_forces(batches, w[0], w[1], w[2], w[3], ws)
        for i in range(r.shape[0]):
            r[i] += side * w[3][i] / (2.0 * (e[0] + e[1]))


@inline_kernel
def extent(x, weight):
    """Largest entry by size, weighted."""
    size = 0.0
    for i in range(weight.shape[0]):
        size = max(size, abs(x[i]) * weight[i])
    return size


@inline_kernel
def both_along(batches, core, m, x, d, r):
    """Add the derivative of the forces of batches along s_q, and that along s_v and s_a, to r."""
    w, ws = m.work[4:8], core.ws
    size, most = extent(d[0], core.weight), 0.0
    for i in range(r.shape[0]):
        most = max(most, abs(d[0][i]))
    if most > LEAST:
        e = m.moved / size if size > LEAST else m.moved / most
        along(batches, ws, x, d, (e, 0.0), r, w)
    size = extent(d[1], core.weight)
    size = size if size > LEAST else extent(d[2], core.weight)
    if size > LEAST:
        along(batches, ws, x, d, (0.0, m.moved / size), r, w)


@inline_kernel
def add_joined(core, m, x, d, r):
    """Add the derivative of the forces and rows of joints along d to r."""
    lanes, found = m.along, m.found
    for i in range(r.shape[0]):
        for k in range(3):
            lanes[k, i, 0] = d[k, i]
        found[i, 0] = 0.0
    add_slopes_along(m.joined, x[0], x[1], x[2], lanes, found, core.ws)
    for i in range(r.shape[0]):
        r[i] += found[i, 0]


@inline_kernel
def add_lossy(core, m, x, d, r):
    """Add the derivative along s_q of what forces of lossy batches do because of velocities."""
    w, size = m.work[4:8], extent(d[0], core.weight)
    if not size > LEAST:
        return
    e = LOSSY / size
    for i in range(r.shape[0]):
        w[1][i] = 0.0
        w[2][i] = 0.0
        w[3][i] = 0.0
    for k in range(4):
        side = (k - 2.0) if k < 2 else (k - 1.0)
        weight = (NEAR if abs(side) < 1.5 else FAR) * (1.0 if side > 0.0 else -1.0) / e
        for i in range(r.shape[0]):
            w[0][i] = x[0][i] + side * e * d[0][i]
            w[2][i] = 0.0
        add_forces(m.lossy, w[0], x[1], w[1], w[2], core.ws)
        for i in range(r.shape[0]):
            r[i] += weight * w[2][i]
            w[2][i] = 0.0
        add_forces(m.lossy, w[0], w[1], w[1], w[2], core.ws)
        for i in range(r.shape[0]):
            r[i] -= weight * w[2][i]


@formula
def turn_along(supports, turn, x, d):
    """Add to the shadows of d that their local axes turn by R', (k, 3, 3) or none: R' y of x = (q, v, a)."""
    for k in range(turn.shape[0]):
        i, j = supports.rot_slot[k], supports.rot_shadow[k]
        for c in range(3):
            for m in range(3):
                for n in range(3):
                    d[n, j + c] += turn[k, c, m] * x[n][i + m]


@inline_kernel
def out_of_balance(core, m, x, d, turn, push, r):
    """r = M s_a + C s_v + K s_q + R_p as the solve wants it; see :func:`turn_along`."""
    follow(core.supports, d[0], d[1], d[2])
    turn_along(core.supports, turn, x, d)
    for i in range(r.shape[0]):
        r[i] = 0.0
    product(core, m.K, d[0], r, m.work[4:6])
    twisted_product(core, m.W, 1.0, d[0], r, m.work[4:6])
    product(core, m.M, d[2], r, m.work[4:6])
    if m.damped:
        product(core, m.C, d[1], r, m.work[4:6])
    if m.lossy.table.shape[0] > 0:
        add_lossy(core, m, x, d, r)
    if m.joined.table.shape[0] > 0:
        add_joined(core, m, x, d, r)
    if m.rough.table.shape[0] > 0:
        both_along(m.rough, core, m, x, d, r)
    to_local(core.supports, r)
    for i in range(r.shape[0]):
        r[i] += push[i]
    for k in range(core.supports.held.shape[0]):
        r[core.supports.held[k]] = 0.0


@inline_kernel
def is_done(norm, size, before, enough):
    """Whether corrections of a sensitivity may end with one of this size."""
    rate = min(norm / before, 1.0) if before < np.inf else 1.0
    if rate * norm <= enough * size or norm < LEAST or (norm <= NOISY * size and norm >= 0.5 * before):
        return True
    return norm <= ROUGH * size and norm >= 0.9 * before


@inline_kernel
def stiffnesses(core, m, K, W, q, v, still):
    """Fill K and W of the exact batches; ``still`` is a vector of zeros."""
    for i in range(K.shape[0]):
        K[i] = 0.0
    for i in range(W.shape[0]):
        W[i] = 0.0
    add_tangents(m.resting, q, still, K, 0.0, 0.0, 1.0, core.ws)
    add_tangents(m.stirring, q, v, K, 0.0, 0.0, 1.0, core.ws)
    add_rate_stiffnesses(m.stirred, q, v, K, W, core.ws)


@kernel
def places(v, h, rest, full, scheme, bar, made):
    """Positions at the ends of steps from the velocities there, as the steps have them.

    Parameters
    ----------
    v : (steps + 1, size)
    h, rest : float
        Lengths of the first ``full`` steps and of those behind them.
    full : int
    scheme : Scheme
    bar : (size,)
        The algorithmic acceleration at the start; changed to that at the end.
    made : (steps + 1, size)
        Filled from the second row on.
    """
    beta, gamma = scheme.beta, scheme.gamma
    for n in range(1, v.shape[0]):
        step = h if n <= full else rest
        for i in range(v.shape[1]):
            new = ((v[n, i] - v[n - 1, i]) / step - (1.0 - gamma) * bar[i]) / gamma
            moved = step * v[n - 1, i] + step * step * ((0.5 - beta) * bar[i] + beta * new)
            made[n, i] = made[n - 1, i] + moved
            bar[i] = new


@kernel
def accelerations(v, h, scheme, before, made):
    """Accelerations at the ends of steps from the velocities there.

    Parameters
    ----------
    v, made : (steps, size)
    h, scheme : float, Scheme
    before : (3, size)
        v, a and the algorithmic acceleration at the start; changed to those at the end.
    """
    am, af, gamma = scheme.alpha_m, scheme.alpha_f, scheme.gamma
    c1, c2, c3 = (1.0 - af) / (1.0 - am), af / (1.0 - am), -am / (1.0 - am)
    for n in range(v.shape[0]):
        for i in range(v.shape[1]):
            bar = ((v[n, i] - before[0, i]) / h - (1.0 - gamma) * before[2, i]) / gamma
            a = (bar - c2 * before[1, i] - c3 * before[2, i]) / c1
            made[n, i] = a
            before[0, i], before[1, i], before[2, i] = v[n, i], a, bar
