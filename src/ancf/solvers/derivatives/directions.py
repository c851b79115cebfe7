"""Derivatives of the equations along a direction in one state, for equilibria and starts."""

from __future__ import annotations

import numpy as np

from ...batches import add_tangents
from ...compiled import inline_kernel, kernel
from ...system.core import follow, solve_matrix
from .sensitivity import ENOUGH, MOST, NOISY, add_joined, out_of_balance, stiffnesses, turn_along


@inline_kernel
def make_matrices(core, m, q, v, still):
    """Make the exact stiffness and damping anew; ``still`` is a vector of zeros."""
    for i in range(m.K.shape[0]):
        m.C[i] = 0.0
    stiffnesses(core, m, m.K, m.W, q, v, still)
    add_tangents(m.exact, q, v, m.C, 0.0, 1.0, 0.0, core.ws)


@kernel
def products_along(core, m, q, v, a, d, turn, still, r):
    """r = M s_a + C s_v + K s_q along d, (3, size), as the solve wants it; the exact matrices are made anew.

    The shadows of d are filled; ``turn``: how their local axes turn, (k, 3, 3) or none.  ``still`` is a
    vector of zeros.
    """
    make_matrices(core, m, q, v, still)
    out_of_balance(core, m, (q, v, a), d, turn, still, r)


@inline_kernel
def accelerate(core, m, x, d, turn, push, r):
    """Bring s_a, and s_q at the multipliers, in balance at the state x = (q, v, a)."""
    n, multipliers, before = core.weight.shape[0], core.joints.multipliers, np.inf
    for _ in range(MOST):
        out_of_balance(core, m, x, d, turn, push, r)
        solve_matrix(core.factor, r)
        for k in range(multipliers.shape[0]):
            d[0, multipliers[k]] -= r[multipliers[k]]
            r[multipliers[k]] = 0.0
        norm, size = 0.0, 0.0
        for i in range(n):
            d[2, i] -= r[i]
            norm = max(norm, abs(r[i]))
        for i in range(d.shape[1]):
            size = max(size, abs(d[2, i]))
        if norm <= ENOUGH * size or (norm <= NOISY * size and norm >= 0.5 * before):
            break
        before = norm


@kernel
def accelerate_along(core, m, q, v, a, d, turn, push, still, r):
    """Fill s_a, s_q at the multipliers, and the shadows of sensitivities, so that these are in balance.

    Parameters
    ----------
    core, m : Core, Matrices
        The factors of the core are those of the masses.
    q, v, a : (size,)
    d : (p, 3, size)
        s_q and s_v are given.
    turn : (p, k, 3, 3)
        Derivatives of the local axes, or k = 0.
    push : (p, size)
        Derivatives of the residual at fixed free unknowns.
    still, r : (size,)
        Zeros, and room.
    """
    make_matrices(core, m, q, v, still)
    for p in range(d.shape[0]):
        accelerate(core, m, (q, v, a), d[p], turn[p], push[p], r)
        follow(core.supports, d[p, 0], d[p, 1], d[p, 2])
        turn_along(core.supports, turn[p], (q, v, a), d[p])


@kernel
def rows_along(core, m, q, v, a, d, r):
    """r = the derivative of the weighted constraints along d, (3, size), in the rows of the multipliers."""
    follow(core.supports, d[0], d[1], d[2])
    for i in range(r.shape[0]):
        r[i] = 0.0
    add_joined(core, m, (q, v, a), d, r)
    for i in range(r.shape[0]):
        r[i] *= core.joints.mask[i]


@kernel
def exact_masses(m, ws, q, v):
    """Fill M of the exact batches."""
    for i in range(m.M.shape[0]):
        m.M[i] = 0.0
    add_tangents(m.exact, q, v, m.M, 1.0, 0.0, 0.0, ws)
