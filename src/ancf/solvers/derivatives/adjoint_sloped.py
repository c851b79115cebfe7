"""The adjoint of the steps of models with forces that know the slopes of their work, see ``adjoint``.

With T_q, T_v and T_a the derivatives of R by q, v and a, a step solves T^T lambda = goal for

    T = w_q T_q + w_v T_v + w_a T_a,      (w_q, w_v, w_a) = (1, G/B, 1/B),

where the matrix A in the factors lacks of T what tangents leave out, as the turning of drag or a contact.
T^T d is the product of the exact matrices and the slopes of the work d . force of the others.  Corrections
are A^-1 times what is left, as long as each is small beside the one before it.  Others are conjugate
residuals: less their parts along those before them, they take from what is left all that they can.  So what
is lacking of few rows, however stiff, ends after as many.
"""

from __future__ import annotations

import numpy as np

from ...batches import add_tangents
from ...compiled import inline_kernel, kernel
from ...linalg.eight import factor_itself, factor_of
from ...simd import LANES
from ...system.core import drive, onto_shadows, solve_matrix, to_local
from ..rare import add_all_slopes, add_rate_works, add_tangent_works
from ..status import OK, SINGULAR, SLOW
from ..step.scheme import coefficients
from .adjoint import SURE, add_turns, folded, hold, take_wanted, to_start
from .ahead import look_ahead, look_at, looks_ahead
from .friction import bring
from .friction_back import is_there, through_force, through_memory
from .sensitivity import LEAST, MOST, NOISY, product, stiffnesses
from .strips import give_way, meet

#: Directions that are kept, vectors of each: it, A and T^T times it, and that by q, v and a.
KEPT, OF_EACH = 10, 6
#: Corrections after which those that do not shrink may be round-off.
MANY = 5
#: As ``SURE``, by the last two corrections, where contacts of strips are in the solutions: the next one is a
#: thousandth of what those say.
OF_STRIPS = 1e-12
#: Part of lambda that a plain correction may be, and part of the one before it; steps without such
#: corrections after one that was more.
MILD, MILDER, PAUSE = 1e-2, 5e-2, 64
#: Vectors of room: T_q^T, T_v^T, T_a^T lambda; the same of a correction; what A lacks, twice; what is left, a
#: correction, what is solved for, room of products, how many steps have no plain corrections yet.
SUMS, OWN, LACKS, LEFT, CHANGE, GOAL, WORK, HARD, FIRST = 0, 3, 6, 8, 9, 10, 11, 13, 14
ROOM = FIRST + OF_EACH * KEPT


@inline_kernel
def add_exact(core, m, matrices, y, d, sums, w):
    """Add the products of the exact matrices at y with d, which has its shadows filled, to the sums."""
    add_tangent_works(m.worked, y[0], y[1], d, sums[0], sums[1], sums[2], core.ws)
    if m.exact.table.shape[0] == 0:
        return
    product(core, matrices[0], d, sums[0], w)
    if m.damped:
        product(core, matrices[1], d, sums[1], w)
    product(core, m.M, d, sums[2], w)


@inline_kernel
def add_slopes(core, m, y, d, sums):
    """Add what else the forces do to d in the state y."""
    add_rate_works(m.stirred, y[0], y[1], d, sums[0], core.ws)
    add_all_slopes(m.joined, y[0], y[1], y[2], d, sums[0], sums[1], sums[2], core.ws)


@inline_kernel
def whole(core, weights, sums, r):
    """r = T^T times what the sums are of, as the solve wants it."""
    for i in range(r.shape[0]):
        r[i] = weights[0] * sums[0, i] + weights[1] * sums[1, i] + weights[2] * sums[2, i]
    to_local(core.supports, r)
    for i in range(core.weight.shape[0], r.shape[0]):
        r[i] = 0.0
    hold(core.supports, r)


@inline_kernel
def solved(core, patches, factor, weights, x):
    """A^-1 x, the shadows filled; A with the contacts of strips."""
    n = core.weight.shape[0]
    solve_matrix(factor, x)
    give_way(patches, weights[1], x)
    for i in range(n, x.shape[0]):
        x[i] = 0.0
    onto_shadows(core.supports, x)


@inline_kernel
def product_of(x, y):
    """Sum of the products of the entries."""
    s = 0.0
    for i in range(x.shape[0]):
        s += x[i] * y[i]
    return s


@inline_kernel
def add_times(f, x, y):
    """y += f x."""
    for k in range(x.shape[0]):
        for i in range(x.shape[1]):
            y[k, i] += f * x[k, i]


@inline_kernel
def begun(core, m, patches, factor, matrices, weights, y, known, lam, room):
    """Solve with what A lacked in the later steps, ``known`` of them, led on; that is left in room[LACKS]."""
    goal, one, two, sums = room[GOAL], room[LACKS], room[LACKS + 1], room[SUMS:OWN]
    for i in range(lam.shape[0]):
        guess = 0.0 if known == 0 else (one[i] if known == 1 else 2.0 * one[i] - two[i])
        two[i], one[i] = one[i], guess
        lam[i] = goal[i] - guess
        sums[0, i] = sums[1, i] = sums[2, i] = 0.0
    meet(patches, core, factor, y[0], y[1])
    solved(core, patches, factor, weights, lam)
    add_exact(core, m, matrices, y, lam, sums, room[WORK:HARD])
    add_slopes(core, m, y, lam, sums)
    leave(core, weights, room)


@inline_kernel
def leave(core, weights, room):
    """What is left of the goal, without the product that the sums are of."""
    goal, left = room[GOAL], room[LEFT]
    whole(core, weights, room[SUMS:OWN], left)
    for i in range(left.shape[0]):
        left[i] = goal[i] - left[i]


@inline_kernel
def correction(core, patches, factor, weights, lam, room):
    """A^-1 times what is left; the sizes of it and of lambda."""
    left, change, norm, size = room[LEFT], room[CHANGE], 0.0, 0.0
    for i in range(left.shape[0]):
        change[i] = left[i]
    solved(core, patches, factor, weights, change)
    for i in range(core.weight.shape[0]):
        norm, size = max(norm, abs(change[i])), max(size, abs(lam[i]))
    return norm, size


@inline_kernel
def plainly(core, m, patches, factor, matrices, weights, y, lam, count, room):
    """Corrections as they are, while they shrink; whether they ended, and the size of the last one.

    The last one is still to be added if they did not.
    """
    sums, change, lacks, left, before = room[SUMS:OWN], room[CHANGE], room[LACKS], room[LEFT], 0.0
    for round in range(MOST):
        count[0] += 1.0
        norm, size = correction(core, patches, factor, weights, lam, room)
        ends = may_end(norm, size, before, round, OF_STRIPS if len(patches) > 0 else SURE)
        if not ends and not norm <= (MILD * size if round == 0 else MILDER * before):
            return False, norm
        before = norm
        for i in range(lam.shape[0]):
            lam[i] += change[i]
            lacks[i] -= left[i]
        add_exact(core, m, matrices, y, change, sums, room[WORK:HARD])
        if ends:
            return True, norm
        add_slopes(core, m, y, change, sums)
        leave(core, weights, room)
    return False, before


@inline_kernel
def direction(core, weights, round, room):
    """Keep the correction as a direction, less its parts along those before it; where it is."""
    own = FIRST + OF_EACH * (round % KEPT)
    for i in range(room.shape[1]):
        room[own, i], room[own + 1, i] = room[CHANGE, i], room[LEFT, i]
        room[own + 3, i], room[own + 4, i], room[own + 5, i] = (
            room[OWN, i],
            room[OWN + 1, i],
            room[OWN + 2, i],
        )
    whole(core, weights, room[OWN:LACKS], room[own + 2])
    for k in range(min(round, KEPT)):
        other = FIRST + OF_EACH * k
        size = product_of(room[other + 2], room[other + 2])
        if other != own and size > 0.0:
            f = -product_of(room[own + 2], room[other + 2]) / size
            add_times(f, room[other : other + OF_EACH], room[own : own + OF_EACH])
    return own


@inline_kernel
def may_end(norm, size, before, round, sure):
    """Whether corrections may end with one of this size: the next would be too small, or it is round-off.

    Those of a few rows shrink when there have been as many, and not before.
    """
    rate = min(norm / before, 1.0) if round > 0 else 1.0  # nothing is known of a contact that has begun
    if rate * norm <= sure * size or norm < LEAST:
        return True
    return round >= MANY and norm <= NOISY * size and norm >= 0.5 * before


@inline_kernel
def solve(core, m, patches, factor, matrices, weights, y, known, lam, count, room):
    """Fill lambda for room[GOAL], and room[SUMS] of it; a status.

    ``known``: how many steps have been solved before; ``count``: of all corrections, is added to.
    """
    given = (core, m, patches, factor, matrices, weights, y)
    begun(*given, known, lam, room)
    if room[HARD, 0] > 0.0:
        room[HARD, 0] -= 1.0
        return entangled(*given, lam, count, room, np.inf, 0)
    ended, norm = plainly(*given, lam, count, room)
    if ended:
        return OK
    room[HARD, 0] = PAUSE
    return entangled(*given, lam, count, room, norm, 1)


@inline_kernel
def entangled(core, m, patches, factor, matrices, weights, y, lam, count, room, norm, known):
    """Corrections as conjugate residuals; a status.  ``known``: the first one is there, of size ``norm``."""
    sums, own, before = room[SUMS:OWN], room[OWN:LACKS], 0.0
    left, change, w, lacks = room[LEFT], room[CHANGE], room[WORK:HARD], room[LACKS]
    for round in range(MOST):
        if round >= known:
            count[0] += 1.0
            norm, size = correction(core, patches, factor, weights, lam, room)
        else:
            size = np.inf
        for k in range(OWN, LACKS):
            for i in range(lam.shape[0]):
                room[k, i] = 0.0
        add_exact(core, m, matrices, y, change, own, w)
        if round >= known and may_end(norm, size, before, round, SURE):
            for i in range(lam.shape[0]):
                lam[i] += change[i]
                lacks[i] -= left[i]
            add_times(1.0, own, sums)
            return OK
        before = norm
        add_slopes(core, m, y, change, own)
        of = direction(core, weights, round, room)
        size = product_of(room[of + 2], room[of + 2])
        if not size > 0.0:
            return SLOW
        f = product_of(room[of + 2], left) / size
        for i in range(lam.shape[0]):
            lam[i] += f * room[of, i]
            lacks[i] -= f * room[of + 1, i]
            left[i] -= f * room[of + 2, i]
        add_times(f, room[of + 3 : of + OF_EACH], sums)
    return SLOW


@inline_kernel
def take(core, y, mu, room, still, turned):
    """Take the sums from mu_q and mu_v; they are added to ``still`` and ``turned``, and used up."""
    sums = room[SUMS:OWN]
    add_turns(core.supports, sums, y, turned)
    for i in range(still.shape[0]):
        still[i] += sums[0, i]
    folded(core.supports, sums, sums)  # what is at shadows goes to their unknowns
    for i in range(core.weight.shape[0]):
        mu[0, i] -= sums[0, i]
        mu[1, i] -= sums[1, i]


@inline_kernel
def take_memory(core, back, y, mu, room, still, turned):
    """Add to mu_q and mu_v what a step leaves in memories of friction does."""
    for k in range(SUMS, OWN):
        for i in range(room.shape[1]):
            room[k, i] = 0.0
    through_memory(back, y[0], y[1], room[SUMS], room[SUMS + 1], core.ws)
    take(core, y, mu, room, still, turned)


@kernel
def back_sloped_start(core, m, friction, back, y, wanted, unknowns, mu, lam, still, turned, count, room):
    """Carry the adjoint through the accelerations of a consistent start, as ``back_start``; a status.

    ``friction``: with what it remembers at the start, and what the first memory is made of.
    """
    bring(friction, 0)
    n, none, K, C = core.weight.shape[0], room[WORK], m.K, m.C
    take_wanted(core.supports, wanted, unknowns, mu, m.work[5:8], m.work[1:3])
    for i in range(none.shape[0]):
        none[i] = 0.0
    stiffnesses(core, m, K, m.W, y[0], y[1], none)
    for i in range(C.shape[0]):
        C[i] = 0.0
    add_tangents(m.exact, y[0], y[1], C, 0.0, 1.0, 0.0, core.ws)
    for i in range(lam.shape[0]):
        room[GOAL, i] = mu[2, i] + mu[3, i] if i < n else 0.0
    hold(core.supports, room[GOAL])
    status = solve(core, m, (), core.factor, (K, C), (0.0, 0.0, 1.0), y, 0, lam, count, room)
    take(core, y, mu, room, still, turned)
    through_force(back, y[0], y[1], lam, core.ws)
    if back.anew:
        bring(friction, 1)
        take_memory(core, back, y, mu, room, still, turned)
        bring(friction, 0)
    for i in range(lam.shape[0]):
        mu[2, i] = mu[3, i] = 0.0
        if i >= n:
            mu[0, i] = mu[1, i] = lam[i] = 0.0
    return status


@kernel
def back_sloped_steps(
    core, m, given, tables, way, wanted, unknowns, h, scheme, mu, out, still, turned, count, room
):
    """Carry the adjoint back through the steps of a block.

    Parameters
    ----------
    core, m, tables, way, wanted, unknowns, h, scheme, mu, out, still, turned
        See :func:`ancf.solvers.derivatives.adjoint.back_steps`.
    given : (tuple of Patches, Ahead, Forgetting)
        Patches: one, for contacts of strips, or none.
    count : (1,)
        Corrections, added to.
    room : (ROOM, size)

    Returns
    -------
    Steps done and the status of the last one.
    """
    patches, ahead, back = given
    B, G = coefficients(h, scheme)
    c1 = (1.0 - scheme.alpha_f) / (1.0 - scheme.alpha_m)
    n, size, weights = core.weight.shape[0], mu.shape[1], (1.0, G / B, 1.0 / B)
    at_once = looks_ahead(ahead)
    for step in range(way.q.shape[0]):
        at = way.q.shape[0] - 1 - step
        k = at % LANES if at_once else 0
        fresh = at_once and (step == 0 or k == LANES - 1)
        if fresh and look_ahead(core, m, ahead, tables, way, at - k, B, G, True) >= 0:
            return step, SINGULAR
        drive(core.supports, core.loads.value, tables, at, way.q[at], way.v[at], way.a[at])
        bring(ahead.friction, at)
        if not at_once and not look_at(core, m, ahead, way, at, B, G):
            return step, SINGULAR
        lam, y = out[at], (way.q[at], way.v[at], way.a[at])
        if is_there(back):
            take_memory(core, back, y, mu, room, still, turned)
        take_wanted(core.supports, wanted[at], unknowns, mu, m.work[5:8], m.work[1:3])
        factor = factor_of(core.factor, ahead.eight, k) if at_once else factor_itself(core.factor)
        matrices = (ahead.K[k], ahead.C[k])
        for i in range(size):
            room[GOAL, i] = mu[0, i] + (G * mu[1, i] + c1 * mu[3, i] + mu[2, i]) / B if i < n else 0.0
        hold(core.supports, room[GOAL])
        status = solve(core, m, patches, factor, matrices, weights, y, min(step, 2), lam, count, room)
        if status != OK:
            return step, status
        take(core, y, mu, room, still, turned)
        through_force(back, y[0], y[1], lam, core.ws)
        to_start(n, h, scheme, mu, lam)
    return way.q.shape[0], OK
