"""Contacts along cables that a winch pays out or hauls in: the material passes the points of their rows.

With lam = L/L0, mu = (dL/dt)/L and D = X d/dX, see :mod:`ancf.elements.winched`, a piece of the mesh holds
lam times its length of the material, which has the velocity v - mu D r.  D of a cubic is a cubic: the
velocity of the material in a row has four vectors as its place has.  A force f per length of the material,
sums S_k on the four vectors r_k, leaves lam S_k there and -(1/L0) sum S_k.(D r)_k on L, so that its power is
that on the material.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..compiled import formula, inline_kernel
from ..model.bodies.beam import Beam
from ..records import beginning
from ..vectors import dot
from .touching import Touching

#: Columns of ``mesh``: X of both nodes of a row and 1/h; of cables with a winch.
X1, X2, INV_H = range(3)


def winched(bodies: Sequence[Beam], locate: Callable[[Any], Any]) -> dict[str, NDArray[Any]]:
    """Fields ``winch``, ``unwound`` and ``mesh`` of the rows of these bodies, one for each element.

    The unknown of the length, -1: there is no winch; 1/L0; and X1, X2 and INV_H.
    """
    winch, unwound, mesh = [], [], [np.zeros((0, 3))]
    for body in bodies:
        end = locate(body.start)
        winch += [end.unknown] * body.elements
        unwound += [1.0 / body.length] * body.elements
        x = body.node_x - end.far
        mesh.append(np.stack([x[:-1], x[1:], 1.0 / np.diff(x)], axis=1))
    return {
        "winch": np.array(winch, dtype=np.int64),
        "unwound": np.array(unwound, dtype=np.float64),
        "mesh": np.concatenate(mesh),
    }


@inline_kernel
def minus(a, s, b):
    """a - s b."""
    return a[0] - s * b[0], a[1] - s * b[1], a[2] - s * b[2]


@formula
def times(s, a):
    """s a."""
    return s * a[0], s * a[1], s * a[2]


@beginning(Touching)
def swept(batch, e, nodes):
    """D r of a row, as vectors of its nodes."""
    f1, s1, f2, s2 = nodes
    x1, x2, inv = batch.mesh[e, X1], batch.mesh[e, X2], batch.mesh[e, INV_H]
    chord = times(inv, minus(f2, 1.0, f1))
    c1 = times(inv, minus(minus(times(6.0, chord), 4.0, s1), 2.0, s2))
    c2 = times(inv, minus(minus(times(-6.0, chord), -4.0, s2), -2.0, s1))
    return times(x1, s1), minus(s1, -x1, c1), times(x2, s2), minus(s2, -x2, c2)


@beginning(Touching)
def rates_of_material(batch, e, nodes, rates, q, v):
    """Velocity of the material of a row, from that of its four vectors."""
    i = batch.winch[e]
    if i < 0:
        return rates
    mu, d = v[i] / q[i], swept(batch, e, nodes)
    a, b, c, f = rates
    return minus(a, mu, d[0]), minus(b, mu, d[1]), minus(c, mu, d[2]), minus(f, mu, d[3])


@beginning(Touching)
def stretched(batch, e, q):
    """lam of a row."""
    i = batch.winch[e]
    return q[i] * batch.unwound[e] if i >= 0 else 1.0


@beginning(Touching)
def add_on_length(batch, e, nodes, sums, more, r):
    """Add to the residual of L what forces with these sums, and stored energy of ``more`` N, leave there."""
    i = batch.winch[e]
    if i >= 0:
        d = swept(batch, e, nodes)
        work = dot(sums[0], d[0]) + dot(sums[1], d[1]) + dot(sums[2], d[2]) + dot(sums[3], d[3])
        r[i] += batch.unwound[e] * (work + more)


@formula
def grown(batch, e, q):
    """By which share the length has grown since the last accepted step."""
    i = batch.winch[e]
    if i < 0 or batch.since[e] == 0.0:
        return 0.0
    return q[i] / batch.since[e] - 1.0
