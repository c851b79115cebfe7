"""The matrices of the steps of a block whose states are known: eight of them are factorised at once.

What eight factors of a long line need is more than fits near a processor; there they come one by one.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray
from ...batches import add_tangents
from ...compiled import inline_kernel
from ...linalg.eight import Eight, allocate_eight, factorise_eight
from ...linalg.eight_twisted import Twisted, allocate_twisted, factorise_twisted
from ...records import recorded
from ...simd import LANES
from ...system.core import Core, drive, factorise_matrix, restrict
from .friction import Friction, bring, no_friction
from .sensitivity import Matrices, stiffnesses

#: Values of a matrix, 100 kB, of which eight are too many at once.
LARGE = 12500


@recorded
class Ahead(NamedTuple):
    """Matrices and factors of eight steps."""

    K: FloatArray  # (8, values) of the exact batches, at rest
    C: FloatArray  # (8, values)
    W: FloatArray  # (8, values or none), see Matrices
    eight: Eight  # all of M/B + (G/B) C + K
    twisted: Twisted  # for W, if there is some
    turned: FloatArray  # (8, values or none) W along local axes, without held unknowns; perhaps W itself
    whole: FloatArray  # (2,) whether W is in the factors, else 0; whether ``turned`` is not W itself
    last: FloatArray  # (2, size) what velocities added to K^T lambda in the last steps of an adjoint
    rate: FloatArray  # (1,) by which corrections of lambda shrink, at most
    friction: Friction  # that remembers the way


def ahead_of(core: Core, m: Matrices, shifts: bool = False) -> Ahead:
    """Room for the matrices of a model; ``shifts``: sensitivities of what is held are not zero."""
    K, C = np.zeros((2, LANES, core.A.size))
    last = np.zeros((2, m.work.shape[1]))
    W, eight = np.zeros((LANES, m.W.size)), allocate_eight(core.factor)
    twisted = allocate_twisted(core.factor, bool(m.W.size))
    apart = shifts or len(core.supports.rot_slot) > 0
    turned, whole = W.copy() if apart else W, np.array([0.0, float(apart)])
    return Ahead(K, C, W, eight, twisted, turned, whole, last, np.zeros(1), no_friction())


@inline_kernel
def matrices_at(core, m, K, C, W, A, q, v, B, G):
    """Exact parts of the matrix of a step, and all of it that is symmetric."""
    c_mass, c_damping = 1.0 / B, G / B
    if m.exact.table.shape[0] == 0:
        for i in range(A.shape[0]):
            A[i] = 0.0
    else:
        exact_parts(core, m, K, C, W, A, q, v, c_mass, c_damping)
    add_tangents(m.worked, q, v, A, c_mass, c_damping, 1.0, core.ws)
    add_tangents(m.joined, q, v, A, c_mass, c_damping, 1.0, core.ws)
    add_tangents(m.rough, q, v, A, c_mass, c_damping, 1.0, core.ws)
    restrict(core.supports, A)


@inline_kernel
def exact_parts(core, m, K, C, W, A, q, v, c_mass, c_damping):
    """Matrices of the exact batches, and A of these."""
    still = m.work[4]
    for i in range(still.shape[0]):
        still[i] = 0.0
    stiffnesses(core, m, K, W, q, v, still)
    if m.damped:
        for i in range(K.shape[0]):
            C[i] = 0.0
        add_tangents(m.exact, q, v, C, 0.0, 1.0, 0.0, core.ws)
        for i in range(K.shape[0]):
            A[i] = K[i] + c_mass * m.M[i] + c_damping * C[i]
    else:
        for i in range(K.shape[0]):
            A[i] = K[i] + c_mass * m.M[i]


@inline_kernel
def turn_twists(core, ahead, count):
    """Fill ``turned`` with W along local axes and without held unknowns."""
    supports, turned = core.supports, ahead.turned
    for k in range(count):
        if ahead.whole[1] > 0.0:
            for i in range(turned.shape[1]):
                turned[k, i] = ahead.W[k, i]
        restrict(supports, turned[k])
        for i in range(supports.held_one.shape[0]):
            turned[k, supports.held_one[i]] = 0.0


@inline_kernel
def looks_ahead(ahead):
    """Whether the matrices of eight steps are to be factorised at once."""
    return ahead.eight.A.shape[1] < LARGE


@inline_kernel
def look_at(core, m, ahead, way, n, B, G):
    """Fill the matrices of step n, whose supports are driven, and the factors of the core; if these exist."""
    A, x = ahead.eight.A[0], (way.q[n], way.v[n])
    matrices_at(core, m, ahead.K[0], ahead.C[0], ahead.W[0], A, x[0], x[1], B, G)
    return factorise_matrix(A, core.factor) >= 0


@inline_kernel
def look_ahead(core, m, ahead, tables, way, first, B, G, both):
    """Fill the matrices of the steps from ``first`` on; the number of the first singular one, or -1.

    ``both``: vectors are to be solved for, not parameters abreast.  For these W is in the factors, where the
    matrices allow it.
    """
    count = min(LANES, way.q.shape[0] - first)
    for k in range(count):
        n = first + k
        drive(core.supports, core.loads.value, tables, n, way.q[n], way.v[n], way.a[n])
        bring(ahead.friction, n)
        x = (way.q[n], way.v[n])
        matrices_at(core, m, ahead.K[k], ahead.C[k], ahead.W[k], ahead.eight.A[k], x[0], x[1], B, G)
    definite, ahead.whole[0] = core.joints.multipliers.shape[0] == 0, 0.0
    if definite and not both and ahead.twisted.w.shape[0] > 0:
        turn_twists(core, ahead, count)
        if factorise_twisted(core.factor, ahead.eight, ahead.twisted, ahead.turned, count):
            ahead.whole[0] = 1.0
            return -1
    return factorise_eight(core.factor, ahead.eight, count, definite, both)
