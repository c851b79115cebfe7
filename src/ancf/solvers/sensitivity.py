"""Sensitivities of the steps of the Newmark family: the derivative of the numbers that a run gives.

A step has solved R(q, v, a; p) = 0 with q = q~ + B a, v = v~ + G a (:mod:`ancf.solvers.newmark`).  Its
derivative by a parameter p is linear,

    M s_a + C s_v + K s_q + R_p = 0,      s_q = s_q~ + B s_a,      s_v = s_v~ + G s_a,

with the exact mass M, damping C and stiffness K of the step.  Batches that say so (``Traits.exact``) have
them in the matrix.  Of those that are exact at rest alone, as damped elements are, the change of the damping
forces with q is missing there: it is taken by differences along s, and so is all of other batches.  Each
parameter takes back-substitutions with one factorisation a step.

All vectors are derivatives at the free unknowns, zero at held ones; what a parameter does to these is in R_p.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..arrays import FloatArray
from ..batches import Batches, add_forces, add_tangents
from ..compiled import formula, inline_kernel, kernel
from ..system.core import (
    constraint_rows,
    drive,
    factorise_matrix,
    follow,
    restrict,
    solve_matrix,
    solve_sparse,
    to_local,
)
from .scheme import coefficients
from .status import OK, SINGULAR, SLOW

#: Change of a state, in sizes of the model, and of its velocities, in these per second, of the differences;
#: and its most in m: a contact is pressed by a millimetre, whatever the length of its line.
MOVED, FURTHEST = 3e-6, 2e-5
#: The same of damping forces, which are smooth, by differences of order four, and their weights.
LOSSY, NEAR, FAR = 3e-4, 8.0 / 12.0, -1.0 / 12.0
#: Corrections of a sensitivity: how many at most, the part of it below which they end, and the one below
#: which they end when the next one is not smaller, which is round-off; of long lines, whose places have more
#: of it, when it is as large.
MOST, ENOUGH, NOISY, ROUGH = 60, 1e-13, 1e-8, 1e-6
#: A correction that is none, whatever its units.
LEAST = 1e-200
#: Places of the vectors of a sensitivity.
Q, V, A, ABAR = range(4)


class Matrices(NamedTuple):
    """What sensitivities have of the matrix."""

    exact: Batches  # whose matrices are derivatives, at least at rest
    lossy: Batches  # of them, those with damping forces that change with q
    rough: Batches  # all others
    K: FloatArray  # values of the blocks of the exact ones
    C: FloatArray
    M: FloatArray
    damped: bool  # C is not zero
    moved: float  # change of a state, in sizes of the model, of differences
    work: FloatArray  # (9, size)


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
        for r in range(6):
            total = 0.0
            for c in range(6):
                total += values[36 * i + 6 * r + c] * x[6 * i + c]
            y[6 * i + r] += total
        for k in range(factor.row_start[i], factor.row_start[i + 1]):
            j, o = factor.column[k], 36 * (n + k)
            for r in range(6):
                total = 0.0
                for c in range(6):
                    total += values[o + 6 * r + c] * x[6 * j + c]
                    y[6 * j + c] += values[o + 6 * r + c] * x[6 * i + r]
                y[6 * i + r] += total


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
    """Add a matrix times x to r, both in physical components."""
    supports = core.supports
    seen(supports, x, w[0])
    for i in range(r.shape[0]):
        w[1][i] = 0.0
    multiply(core.factor, values, w[0], w[1])
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
    if most > 0.0:
        e = m.moved / size if size > 0.0 else m.moved / most
        along(batches, ws, x, d, (e, 0.0), r, w)
    size = extent(d[1], core.weight)
    size = size if size > 0.0 else extent(d[2], core.weight)
    if size > 0.0:
        along(batches, ws, x, d, (0.0, m.moved / size), r, w)


@inline_kernel
def add_rough(core, m, x, d, r):
    """Add the derivative of the forces of rough batches along d to r.

    Without the rows of the constraints first: what they add to the forces of joints with the large factor
    alpha is zero in the end, but not with the error of a difference.
    """
    joints, rows = core.joints, m.work[8]
    w0, w1, w2 = joints.level[0], joints.level[1], joints.level[2]
    joints.level[0], joints.level[1], joints.level[2] = 0.0, 0.0, 0.0
    both_along(m.rough, core, m, x, d, r)
    joints.level[0], joints.level[1], joints.level[2] = w0, w1, w2
    if joints.multipliers.shape[0] == 0:
        return
    for i in range(r.shape[0]):
        rows[i] = 0.0
    both_along(joints.batches, core, m, x, d, rows)
    for k in range(joints.multipliers.shape[0]):
        i = joints.multipliers[k]
        r[i] = rows[i]


@inline_kernel
def add_lossy(core, m, x, d, r):
    """Add the derivative along s_q of what forces of lossy batches do because of velocities."""
    w, size = m.work[4:8], extent(d[0], core.weight)
    if not size > 0.0:
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


@inline_kernel
def out_of_balance(core, m, x, d, push, r):
    """r = M s_a + C s_v + K s_q + R_p as the solve wants it."""
    follow(core.supports, d[0], d[1], d[2])
    for i in range(r.shape[0]):
        r[i] = 0.0
    product(core, m.K, d[0], r, m.work[4:6])
    product(core, m.M, d[2], r, m.work[4:6])
    if m.damped:
        product(core, m.C, d[1], r, m.work[4:6])
    if m.lossy.table.shape[0] > 0:
        add_lossy(core, m, x, d, r)
    if m.rough.table.shape[0] > 0:
        add_rough(core, m, x, d, r)
    to_local(core.supports, r)
    for i in range(r.shape[0]):
        r[i] += push[i]
    for k in range(core.supports.held.shape[0]):
        r[core.supports.held[k]] = 0.0


@inline_kernel
def shifted(core, m, x, d, gap, joined, r):
    """Shift s_q onto the derivative of C = 0; the size of the shift."""
    joints, w = core.joints, m.work
    joints.level[0], joints.level[1], joints.level[2] = 1.0, 0.0, 0.0
    size = extent(d[0], core.weight)
    e = m.moved / size if size > 0.0 else 1.0
    for i in range(r.shape[0]):
        r[i] = gap[i]
    for side in (1.0, -1.0):
        for i in range(r.shape[0]):
            w[4][i] = x[0][i] + side * e * d[0][i]
        constraint_rows(joints, w[4], x[1], x[2], w[5], core.ws)
        for i in range(r.shape[0]):
            r[i] += side * w[5][i] / (2.0 * e)
    joints.level[0], joints.level[1], joints.level[2] = joined.w0, joined.w1, joined.w2
    to_local(core.supports, r)
    solve_sparse(core.factor, r, joints.lowest)
    norm = 0.0
    for i in range(core.weight.shape[0]):
        c = r[i] * (1.0 - joints.mask[i])
        d[0][i] -= c
        norm = max(norm, abs(c) * core.weight[i])
    return norm


@inline_kernel
def matrices_at(core, m, q, v, B, G):
    """Exact parts of the matrix and the factors of all of it; whether that is possible.

    K is that at rest: a damped spring has the tension of its damping in it otherwise, see :func:`add_lossy`.
    """
    still = m.work[4]
    for i in range(still.shape[0]):
        still[i] = 0.0
    for i in range(m.K.shape[0]):
        m.K[i] = 0.0
    add_tangents(m.exact, q, still, m.K, 0.0, 0.0, 1.0, core.ws)
    if m.damped:
        for i in range(m.C.shape[0]):
            m.C[i] = 0.0
        add_tangents(m.exact, q, v, m.C, 0.0, 1.0, 0.0, core.ws)
    for i in range(m.K.shape[0]):
        core.A[i] = m.K[i] + m.M[i] / B
    if m.damped:
        for i in range(m.K.shape[0]):
            core.A[i] += m.C[i] * (G / B)
    add_tangents(m.rough, q, v, core.A, 1.0 / B, G / B, 1.0, core.ws)
    restrict(core.supports, core.A)
    return factorise_matrix(core.A, core.factor) >= 0


@inline_kernel
def solved(core, m, x, d, push, gap, joined, B, G):
    """Corrections of a predicted sensitivity d = (s_q, s_v, s_a); a status."""
    joints, r = core.joints, m.work[0]
    rough, before = m.rough.table.shape[0] + m.lossy.table.shape[0] > 0, np.inf
    for _ in range(MOST):
        out_of_balance(core, m, x, d, push, r)
        solve_matrix(core.factor, r)
        norm = 0.0
        for i in range(core.weight.shape[0]):
            c = r[i]
            d[0][i] -= c
            d[1][i] -= G / B * c
            d[2][i] -= c / B
            norm = max(norm, abs(c) * core.weight[i])
        for k in range(joints.multipliers.shape[0]):
            d[1][joints.multipliers[k]] = 0.0
            d[2][joints.multipliers[k]] = 0.0
        if joined.projects and joints.multipliers.shape[0] > 0:
            norm = max(norm, shifted(core, m, x, d, gap, joined, r))
        if not rough:
            return OK
        size = extent(d[0], core.weight)
        if norm <= ENOUGH * size or norm < LEAST or (norm <= NOISY * size and norm >= 0.5 * before):
            return OK
        if norm <= ROUGH * size and norm >= 0.9 * before:
            return OK
        before = norm
    return SLOW


@inline_kernel
def predicted(s, d, h, scheme):
    """d = (s_q, s_v, s_a) at the end of a step from the sensitivity s at its start, with the same s_a."""
    am, af = scheme.alpha_m, scheme.alpha_f
    c1, c2, c3 = (1.0 - af) / (1.0 - am), af / (1.0 - am), -am / (1.0 - am)
    for i in range(s.shape[1]):
        q, v, a, bar = s[Q, i], s[V, i], s[A, i], s[ABAR, i]
        new = c1 * a + c2 * a + c3 * bar
        d[0][i] = q + h * v + h * h * ((0.5 - scheme.beta) * bar + scheme.beta * new)
        d[1][i] = v + h * ((1.0 - scheme.gamma) * bar + scheme.gamma * new)
        d[2][i] = a


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


@kernel
def follow_steps(core, m, tables, way, push, gap, h, scheme, joined, s, out):
    """Carry sensitivities through the steps of a block.

    Parameters
    ----------
    core, m : Core, Matrices
    tables : Tables
        At the ends of the steps.
    way : Way
    push, gap : (p, steps, size)
        Derivatives of the residual and of the constraints' positions, at fixed free unknowns.
    h, scheme, joined : float, Scheme, Constraining
    s : (p, 4, size)
        At the start; changed to the end.
    out : (p, steps, 3, size)
        s_q, s_v, s_a at the ends of the steps.

    Returns
    -------
    Steps done and the status of the last one.
    """
    B, G = coefficients(h, scheme)
    level = core.joints.level
    level[0], level[1], level[2] = joined.w0, joined.w1, joined.w2
    am, af = scheme.alpha_m, scheme.alpha_f
    c1, c2, c3 = (1.0 - af) / (1.0 - am), af / (1.0 - am), -am / (1.0 - am)
    d = m.work[1:4]
    for n in range(way.q.shape[0]):
        x = (way.q[n], way.v[n], way.a[n])
        drive(core.supports, core.loads.value, tables, n, x[0], x[1], x[2])
        if not matrices_at(core, m, x[0], x[1], B, G):
            return n, SINGULAR
        for p in range(s.shape[0]):
            predicted(s[p], d, h, scheme)
            status = solved(core, m, x, d, push[p, n], gap[p, n], joined, B, G)
            if status != OK:
                return n, status
            follow(core.supports, d[0], d[1], d[2])
            for i in range(d.shape[1]):
                bar = c1 * d[2, i] + c2 * s[p, A, i] + c3 * s[p, ABAR, i]
                s[p, Q, i], s[p, V, i], s[p, A, i], s[p, ABAR, i] = d[0, i], d[1, i], d[2, i], bar
                for k in range(3):
                    out[p, n, k, i] = d[k, i]
    return way.q.shape[0], OK
