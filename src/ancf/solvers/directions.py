"""Derivatives of the equations along a direction in one state, for equilibria and starts."""

from __future__ import annotations

from ..batches import add_tangents
from ..compiled import kernel
from ..system.core import constraint_rows, follow
from .sensitivity import LEAST, out_of_balance, stiffnesses


@kernel
def products_along(core, m, q, v, a, d, turn, still, r):
    """r = M s_a + C s_v + K s_q along d, (3, size), as the solve wants it; the exact matrices are made anew.

    The shadows of d are filled; ``turn``: how their local axes turn, (k, 3, 3) or none.  ``still`` is a
    vector of zeros.
    """
    for i in range(m.K.shape[0]):
        m.C[i] = 0.0
    stiffnesses(core, m, m.K, m.W, q, v, still)
    add_tangents(m.exact, q, v, m.C, 0.0, 1.0, 0.0, core.ws)
    out_of_balance(core, m, (q, v, a), d, turn, still, r)


@kernel
def rows_along(core, m, q, v, a, d, r):
    """r = the derivative of the weighted constraints along d, (3, size), in the rows of the multipliers."""
    w = m.work
    follow(core.supports, d[0], d[1], d[2])
    for i in range(r.shape[0]):
        r[i] = 0.0
    most = 0.0
    for k in range(3):
        for i in range(r.shape[0]):
            most = max(most, abs(d[k, i]))
    e = m.moved / most if most > LEAST else 1.0
    for side in (1.0, -1.0):
        for i in range(r.shape[0]):
            w[1, i] = q[i] + side * e * d[0, i]
            w[2, i] = v[i] + side * e * d[1, i]
            w[3, i] = a[i] + side * e * d[2, i]
        constraint_rows(core.joints, w[1], w[2], w[3], w[4], core.ws)
        for i in range(r.shape[0]):
            r[i] += side * w[4, i] / (2.0 * e)


@kernel
def exact_masses(m, ws, q, v):
    """Fill M of the exact batches."""
    for i in range(m.M.shape[0]):
        m.M[i] = 0.0
    add_tangents(m.exact, q, v, m.M, 1.0, 0.0, 0.0, ws)
