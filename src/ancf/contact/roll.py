"""Friction of rigid bodies on rigid bodies: elastic-plastic springs with memory in the places of contact.

The place of contact after the last step is a material place of both bodies, rho the way between them since
then, and e the stretch that was left, in the axes of the second body.  With P = 1 - n n^T,

    T = -f w,   w = P (k_t (rho + e) + c_t u),   |f w| <= mu N of the last step,

acts in the place of contact, the opposite force in the same place on the second body.  What slips keeps a
stretch of mu N/k_t at most: what the damper takes beyond the limit stretches nothing.  A body that rolls
without sliding brings ever new places together: rho grows with the third power of a step, and nothing is
stretched; where the two turn past each other about the normal as well, with the second one.
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import VECTOR, Role, formula, implements, inline_kernel, kernel
from ..records import Located
from ..vectors import dot
from .bump import add_bump, add_bump_block, bumped
from .meeting import BumpBatch, apart_at, both, both_rates, meet
from .rubbed import find, nothing_found, share_found
from .strand import less
from .touch import DRAG, FRICTION, STICK, carried, in_body

#: Columns of ``rough``: places in both bodies, the stretch in the axes of the second one, the limit.
ONE, TWO, HELD, LIMIT = 0, 3, 6, 9
#: Share of a change of the limits that a round of an equilibrium takes.
TAKEN = 0.4


class RollBatch(BumpBatch):
    """Friction of the places of a BumpBatch, whose arrays it shares."""

    __slots__ = ()


@inline_kernel
def turned(body, x):
    """A direction in body axes as a global one."""
    return less(carried(body, x[0], x[1], x[2]), body[0])


@formula
def dragged(batch, e, q, v):
    """Place of contact in the axes of both bodies, w, its size, f, whether it slips, normal, stretch."""
    one, two = both(batch, e, q)
    moving, other = both_rates(batch, e, v)
    _, n, c, _, _, _, _ = meet(batch, e, one, two)
    u, x, y = apart_at(one, two, moving, other, c)
    m, data = batch.rough[e], batch.data[batch.contact[e]]
    rho = less(carried(one, m[0], m[1], m[2]), carried(two, m[3], m[4], m[5]))
    held = turned(two, (m[6], m[7], m[8]))
    way = rho[0] + held[0], rho[1] + held[1], rho[2] + held[2]
    k, drag = data[STICK], data[DRAG]
    w = k * way[0] + drag * u[0], k * way[1] + drag * u[1], k * way[2] + drag * u[2]
    s, t = dot(w, n), dot(way, n)
    w = w[0] - s * n[0], w[1] - s * n[1], w[2] - s * n[2]
    way = way[0] - t * n[0], way[1] - t * n[1], way[2] - t * n[2]
    size = math.sqrt(dot(w, w))
    slips = size > m[LIMIT]
    return x, y, w, size, (m[LIMIT] / size if slips else 1.0), slips, n, way


@inline_kernel
def roll_force(batch, q, v, a, r, ws):
    """Subtract the friction from r."""
    for e in range(batch.base.shape[0]):
        if batch.rough[e, LIMIT] > 0.0:
            x, y, w, _, f, _, _, _ = dragged(batch, e, q, v)
            add_bump(batch, e, x, y, (-f * w[0], -f * w[1], -f * w[2]), r)


@inline_kernel
def roll_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add the stiffness of the springs, that of slipping ones as they turn."""
    for e in range(batch.base.shape[0]):
        if batch.rough[e, LIMIT] > 0.0:
            x, y, _, _, f, _, n, _ = dragged(batch, e, q, v)
            data = batch.data[batch.contact[e]]
            k = f * (c_stiffness * data[STICK] + c_damping * data[DRAG])
            add_bump_block(batch, e, x, y, n, 0.0, k, A)


@inline_kernel
def roll_remember(batch, q, v):
    """Bring places, stretches and limits up to the state of an accepted step; ``found`` keeps what acted."""
    roll_measure(batch, q, v)
    for e in range(batch.base.shape[0]):
        data, m = batch.data[batch.contact[e]], batch.rough[e]
        _, _, _, _, _, _, _, N = bumped(batch, e, q, v)
        one, two = both(batch, e, q)
        _, _, c, _, _, _, _ = meet(batch, e, one, two)
        keep = 0.0, 0.0, 0.0
        if m[LIMIT] > 0.0 and N > 0.0:
            _, _, _, _, _, slips, _, way = dragged(batch, e, q, v)
            size = data[STICK] * math.sqrt(dot(way, way))
            s = m[LIMIT] / size if slips and size > m[LIMIT] else 1.0
            keep = s * way[0], s * way[1], s * way[2]
        x, y = in_body(one, c), in_body(two, c)
        o = in_body(two, (two[0][0] + keep[0], two[0][1] + keep[1], two[0][2] + keep[2]))
        for i in range(3):
            m[ONE + i], m[TWO + i], m[HELD + i] = x[i], y[i], o[i]
        m[LIMIT] = data[FRICTION] * N


@inline_kernel
def roll_measure(batch, q, v):
    """Fill ``found`` for the state (q, v), with the limits that acted in it."""
    nothing_found(batch)
    for e in range(batch.base.shape[0]):
        if batch.rough[e, LIMIT] > 0.0:
            _, _, _, size, f, slips, _, _ = dragged(batch, e, q, v)
            find(batch, batch.contact[e], f * size, slips)
    share_found(batch)


@kernel
def roll_values(batch, q, v):
    """Fill ``found``."""
    roll_measure(batch, q, v)


@kernel
def roll_limits(batch, q, v):
    """Limits in an equilibrium; returns their largest change and the largest of them."""
    change, most = 0.0, 0.0
    for e in range(batch.base.shape[0]):
        _, _, _, _, _, _, _, N = bumped(batch, e, q, v)
        wanted, limit = batch.data[batch.contact[e], FRICTION] * N, batch.rough[e, LIMIT]
        change, most = max(change, abs(wanted - limit)), max(most, wanted)
        batch.rough[e, LIMIT] = limit + TAKEN * (wanted - limit)
    return change, most


def let_roll(batch, q):
    """Renew the limits in an equilibrium; returns their relative change."""
    change, most = roll_limits(Located(batch), q, np.zeros_like(q))
    return change / most if most > 0.0 else 0.0


def stick(batch):
    """Let friction hold what it acts on."""
    batch.rough[batch.rough[:, LIMIT] > 0.0, LIMIT] = np.inf


implements(
    RollBatch,
    force=roll_force,
    tangent=roll_tangent,
    remember=roll_remember,
    measure=roll_measure,
    role=Role.RUBS | Role.MEASURES,
    memory=("rough", "found"),
    late=lambda batch: let_roll,
    stick=stick,
    resting=((roll_limits, (VECTOR, VECTOR)),),
)
