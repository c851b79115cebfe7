"""Contact of a wire with a straight strip by a penalty: it pushes, never pulls, and knows no friction.

The strip runs along u through the point p, the wire receives a force near n.  It crosses the plane through
p across e = u x n at the arc length s, which follows from the positions alone:

    e . (p - r(s)) = 0,      overlap g = n . (p - r(s)),      F = max(k g + c dg/dt, 0) where g > 0.

A wire may have a profile h(s), by which its surface stands out towards the strip: g = n . (p - r(s)) + h(s).
With ds = e . (dp - dr)/(e . r_x) the variation of g is m . (dp - dr(s)),

    m = n - (n . r_x - h')/(e . r_x) e,

so that the force on the wire is F m, normal to the wire and to the strip, and on the point -F m: the part
along e is what drives the strip uphill.  Nothing is added to the iteration matrix: in a time step the
stiffness is small against the inertia of what touches, and Newton's iteration makes up for it.
:func:`contact_row` gives m S(s) where there is no inertia (equilibria and modes), :func:`contact_turn` how
the force turns as the wire moves along and turns: with a = ds/dq and c = -m S'(s), the Hessian of g is
c a^T + a c^T - (m . r_xx) a a^T.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..arrays import FloatArray, IntArray
from ..compiled import Role, implements, inline_kernel, kernel
from ..vectors import dot
from .carrier import COLUMNS, line, shape
from .contact_along import contact_slopes_along
from .contact_slopes import (
    contact_measured_slopes,
    contact_measured_work,
    contact_number_work,
    contact_work_slopes,
)
from .contact_touch import ARC, ASIDE, DAMPING, FORCE, OVERLAP, STIFFNESS, add_row, touch
from .in_matrix import no_pairs, no_places


class ContactBatch(NamedTuple):
    """All contacts of a System; n contacts, m elements of their wires."""

    slot: IntArray  # (n, COLUMNS) slots of the point, -1: none
    factor: FloatArray  # (n, COLUMNS)
    offset: FloatArray  # (n, 3) constant part of the point's position
    first: IntArray  # (n + 1,) elements of the wire of each contact
    x: FloatArray  # (m, 2) start and length of the element, m
    line_slot: IntArray  # (m, COLUMNS)
    line_poly: FloatArray  # (m, COLUMNS, 4) factors as powers of xi = (s - start)/length
    data: FloatArray  # (n, 2) STIFFNESS, DAMPING
    travel: FloatArray  # (n, 3) e
    normal: FloatArray  # (n, 3) n
    begins: IntArray  # (n + 1,) profiles over s, see connections/curves.py
    place: FloatArray  # (k,)
    height: FloatArray  # (k,)
    area: FloatArray  # (k,)
    found: FloatArray  # (n, 4) FORCE ... ASIDE where it was evaluated last; the next search starts at ARC


@inline_kernel
def contact_force(batch, q, v, a, r, ws):
    """Add the contact forces to r."""
    for j in range(batch.slot.shape[0]):
        pushes, e, xi, m, force = touch(batch, j, q, v)
        if pushes:
            add_row(batch, j, e, xi, m, force, r)


@inline_kernel
def contact_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Nothing, see the text above."""


@inline_kernel
def contact_energy(batch, q, ws):
    """Energy of the overlaps, J.

    It is asked for of any state at any time: ``found`` stays as it is, and the search begins in the middle
    of the wire, so that the energy of a state is the same whenever it is computed.
    """
    energy = 0.0
    for j in range(batch.slot.shape[0]):
        force, overlap = batch.found[j, FORCE], batch.found[j, OVERLAP]
        arc, aside = batch.found[j, ARC], batch.found[j, ASIDE]
        batch.found[j, ARC] = np.nan
        touch(batch, j, q, q)
        if batch.found[j, OVERLAP] == -np.inf:  # from there nothing was found
            batch.found[j, ARC] = arc
            touch(batch, j, q, q)
        energy += 0.5 * batch.data[j, STIFFNESS] * max(batch.found[j, OVERLAP], 0.0) ** 2
        batch.found[j, FORCE], batch.found[j, OVERLAP] = force, overlap
        batch.found[j, ARC], batch.found[j, ASIDE] = arc, aside
    return energy


@inline_kernel
def contact_measure(batch, q, v):
    """Fill ``found`` for the state (q, v)."""
    for j in range(batch.slot.shape[0]):
        touch(batch, j, q, v)


@kernel
def contact_row(batch, j, q, v, row):
    """Gradient of the overlap of contact j in ``row``; stiffness and damping, 0 while it does not touch."""
    pushes, e, xi, m, _ = touch(batch, j, q, v)
    if not pushes:
        return 0.0, 0.0
    add_row(batch, j, e, xi, m, 1.0, row)
    return batch.data[j, STIFFNESS], batch.data[j, DAMPING]


@kernel
def contact_turn(batch, j, q, v, a, c):
    """Rows a and c of contact j, see the text above; its force, 0 while it does not touch, and -m . r_xx."""
    pushes, e, xi, m, force = touch(batch, j, q, v)
    if not pushes:
        return 0.0, 0.0
    tau = (batch.travel[j, 0], batch.travel[j, 1], batch.travel[j, 2])
    rise = dot(tau, line(batch, e, xi, q, 1))
    add_row(batch, j, e, xi, (tau[0] / rise, tau[1] / rise, tau[2] / rise), 1.0, a)
    for k in range(COLUMNS):
        o = batch.line_slot[e, k]
        if o < 0:
            break
        w = shape(batch, e, k, xi, 1)
        for i in range(3):
            c[o + i] -= w * m[i]
    return force, -dot(m, line(batch, e, xi, q, 2))


implements(
    ContactBatch,
    force=contact_force,
    tangent=contact_tangent,
    energy=contact_energy,
    force_slopes=contact_slopes_along,
    slopes_beside=contact_slopes_along,
    work_slopes=contact_work_slopes,
    measured_slopes=contact_measured_slopes,
    measured_work=contact_measured_work,
    number_work=contact_number_work,
    numbers=lambda batch: batch.data.ravel(),
    numbered=("data",),
    measure=contact_measure,
    role=Role.DISSIPATES | Role.MEASURES,
    slots=("slot", "line_slot"),
    couples=no_pairs,
    bind=no_places,
    damped=lambda batch: bool(np.any(batch.data[:, DAMPING])),
    row=contact_row,
    turn=contact_turn,
)


@kernel
def contact_values(batch, j, q, v, out):
    """What ``found`` says of contact j in each state, rows of ``out``, shape (n, 4)."""
    for n in range(q.shape[0]):
        touch(batch, j, q[n], v[n])
        for c in range(4):
            out[n, c] = batch.found[j, c]
