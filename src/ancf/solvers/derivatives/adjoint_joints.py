"""The adjoint of the steps of models whose joints have multipliers, see ``adjoint``.

The rows of the joints are rows of R, and their multipliers unknowns without rates.  With T_q, T_v and T_a the
derivatives of R by q, v and a, a step of a sensitivity solves

    T_a s_a + T_v s_v + T_q s_q + R_p = 0,      s_q = q~ + B s_a + W gamma,      s_v = v~ + G s_a,

where gamma is there if the formulation shifts positions: W holds the columns of the inverse of the step's
matrix A for the multipliers, and gamma is such that C_q s_q + C_p = 0.  Transposed, with rho for the latter,

    (T_q + (G/B) T_v + T_a/B)^T lambda = mu_q + (G mu_v + c_1 mu_b + mu_a)/B - C_q^T rho,
    W^T (mu_q - T_q^T lambda - C_q^T rho) = 0.

The number changes by -lambda . R_p - rho . C_p, and mu_q - T_q^T lambda - C_q^T rho and mu_v - T_v^T lambda
go to the start of the step.  A is symmetric and lacks of the transposed matrix what velocities add to the
rows: corrections make up for it.  A^-1 C_q^T rho is (0, rho): so lambda follows a change of rho at once.
"""

from __future__ import annotations

import numpy as np

from ...compiled import formula, inline_kernel, kernel
from ...linalg.block import times
from ...linalg.eight import factor_of
from ...simd import LANES, load_six, store_six, total
from ...system.core import drive, onto_shadows, solve_matrix, to_local
from ..rare import add_all_slopes, add_rate_works, add_tangent_works
from ..status import OK, SINGULAR, SLOW
from ..step.scheme import coefficients
from .adjoint import folded, hold, take_wanted, to_start
from .ahead import look_ahead
from .friction import bring
from .friction_back import is_there, through_force, through_memory
from .mixing import NOTHING, ends_mixed, lead_on
from .sensitivity import LEAST, MOST, NOISY, ROUGH, seen, to_shadows

#: Vectors of room: T_q^T, T_v^T, T_a^T lambda and C_q^T rho, what is to be solved for, corrections, products.
ROOM = 11
#: Part of lambda below which corrections end when the next one would be smaller.
LEFT = 1e-10
#: In the first step of a block, which begins with nothing, corrections shrink faster than in later ones by at
#: most so much.
WARY = 2.0
#: Steps that lead to the first guess of rho.
PAST = 5


@formula
def at_level(core, w0, w1, w2):
    """Let these be the weights of the rows."""
    level = core.joints.level
    level[0], level[1], level[2] = w0, w1, w2


@formula
def clear(x):
    """Set vectors to zero."""
    for k in range(x.shape[0]):
        for i in range(x.shape[1]):
            x[k, i] = 0.0


@inline_kernel
def add_product(core, values, x, r, w):
    """Add a symmetric matrix without rows of sliding joints times x to r, both in physical components."""
    factor, n, y = core.factor, core.factor.row_start.shape[0] - 1, w[1]
    seen(core.supports, x, w[0])
    for i in range(r.shape[0]):
        y[i] = 0.0
    for i in range(core.joints.first):
        store_six(load_six(y, 6 * i) + times(values, 36 * i, w[0], 6 * i), y, 6 * i)
        for k in range(factor.row_start[i], factor.row_start[i + 1]):
            j, o = 6 * factor.column[k], 36 * (n + k)
            other = load_six(w[0], j)
            for c in range(6):
                y[6 * i + c] += total(load_six(values, o + 6 * c) * other)
            store_six(load_six(y, j) + times(values, o, w[0], 6 * i), y, j)
    to_shadows(core.supports, r, w)


@inline_kernel
def add_products(core, m, matrices, y, d, sums, w):
    """Add T_q^T d, T_v^T d and T_a^T d in the state y to the sums; d has its shadows filled."""
    K, C = matrices
    if m.exact.table.shape[0] > 0:
        add_product(core, K, d, sums[0], w)
        if m.damped:
            add_product(core, C, d, sums[1], w)
        add_product(core, m.M, d, sums[2], w)
    add_tangent_works(m.worked, y[0], y[1], d, sums[0], sums[1], sums[2], core.ws)
    add_rate_works(m.stirred, y[0], y[1], d, sums[0], core.ws)
    add_all_slopes(m.joined, y[0], y[1], y[2], d, sums[0], sums[1], sums[2], core.ws)


@formula
def change_of(joints, d, x, multipliers):
    """Size of the change d in x, relative: of its multipliers, or of all others."""
    change, size = 0.0, 0.0
    for i in range(joints.mask.shape[0]):
        if (joints.mask[i] > 0.0) == multipliers:
            change, size = max(change, abs(d[i])), max(size, abs(x[i]))
    return change / size if size > LEAST else 0.0


@formula
def corrected(core, factor, goal, d, x):
    """Replace d, what of the goal is left, by the correction, and add it to x.

    Returns
    -------
    The size of the correction, and that of what was left, relative.
    """
    n, left, whole = core.weight.shape[0], 0.0, 0.0
    hold(core.supports, d)
    for i in range(n):
        left, whole = max(left, abs(d[i])), max(whole, abs(goal[i]))
    solve_matrix(factor, d)
    for i in range(n):
        x[i] += d[i]
    for i in range(n, d.shape[0]):
        d[i] = 0.0
    onto_shadows(core.supports, d)
    change = max(change_of(core.joints, d, x, True), change_of(core.joints, d, x, False))
    return change, left / whole if whole > LEAST else 0.0


@formula
def lifted(core, factor, goal, taken, rho, d):
    """d = the multipliers of A^-1 (goal - taken) without its rows, and add them to rho; their size, relative.

    ``taken``: in physical components; changed to those of the solve.
    """
    joints, n = core.joints, core.weight.shape[0]
    to_local(core.supports, taken)
    for i in range(n):
        d[i] = (goal[i] - taken[i]) * (1.0 - joints.mask[i])
    hold(core.supports, d)
    solve_matrix(factor, d)
    for i in range(n):
        d[i] *= joints.mask[i]
        rho[i] += d[i]
    for i in range(n, d.shape[0]):
        d[i] = 0.0
    return change_of(joints, d, rho, True)


@formula
def shifted_back(core, m, factor, y, goal, joined, lam, rho, room):
    """Correct rho, and lambda with it, for the shift of the positions; the size of the change, relative."""
    sums, z, d, r, none = room[0:3], room[3], room[5], room[6], room[9:11]
    for i in range(r.shape[0]):
        r[i] = sums[0, i] + z[i]
    change = lifted(core, factor, goal, r, rho, d)
    at_level(core, 1.0, 0.0, 0.0)
    add_all_slopes(m.joined, y[0], y[1], y[2], d, z, none[0], none[1], core.ws)
    at_level(core, joined.w0, joined.w1, joined.w2)
    for i in range(core.weight.shape[0]):
        d[i] = -d[i]
        lam[i] += d[i]
    add_all_slopes(m.joined, y[0], y[1], y[2], d, sums[0], sums[1], sums[2], core.ws)
    return change


@formula
def may_end(change, before, rate, enough, left):
    """Whether corrections may end with one of this size, relative, that are thought to shrink by a rate.

    Those that do not shrink are round-off, if they are small or what was ``left`` is.
    """
    if rate * change <= enough or change < LEAST:
        return True
    if change >= 0.5 * before and (change <= NOISY or left <= NOTHING):
        return True
    return change <= ROUGH and change >= 0.9 * before


@formula
def led_to(later, order, i):
    """Where entry i of so many later steps leads by a polynomial."""
    value, weight = 0.0, 1.0 * order
    for n in range(order):
        value += weight * later[n, i]
        weight *= -(order - 1.0 - n) / (n + 2.0)
    return value


@formula
def begun(core, m, y, joined, known, later, rho_later, lam, rho, room):
    """Begin with the multipliers that those of ``known`` later steps lead to, and what they take."""
    sums, z, d, none, joints = room[0:3], room[3], room[5], room[9:11], core.joints
    clear(room[0:4])
    for i in range(lam.shape[0]):
        lam[i] = rho[i] = d[i] = 0.0
    if known == 0:
        return
    for k in range(joints.multipliers.shape[0]):
        i = joints.multipliers[k]
        lam[i] = led_to(later, min(known, 2), i)  # it swings from step to step
        rho[i], d[i] = led_to(rho_later, known, i), lam[i]
    add_all_slopes(m.joined, y[0], y[1], y[2], d, sums[0], sums[1], sums[2], core.ws)
    if joined.projects:
        at_level(core, 1.0, 0.0, 0.0)
        add_all_slopes(m.joined, y[0], y[1], y[2], rho, z, none[0], none[1], core.ws)
        at_level(core, joined.w0, joined.w1, joined.w2)


@formula
def factors(core, m, factor, matrices, y, mu, c1, B, G, joined, known, lam, rho, rate, room, mix):
    """Correct lambda and rho, and the sums in ``room`` of what they take; a status.

    ``known``: later steps whose multipliers they began with.  ``rate``: by what the corrections of a step
    that began with none shrink.  ``mix``: room of corrections that do not shrink, or none.
    """
    sums, z, goal, d, r, w = room[0:3], room[3], room[4], room[5], room[6], room[7:9]
    n, before = core.weight.shape[0], np.inf
    for i in range(n):
        goal[i] = mu[0, i] + (G * mu[1, i] + c1 * mu[3, i] + mu[2, i]) / B
    sudden = mix.shape[0] > 0
    for round in range(MOST):
        if sudden:
            for i in range(lam.shape[0]):
                mix[0, i], mix[1, i] = lam[i], rho[i]
        for i in range(r.shape[0]):
            r[i] = sums[0, i] + z[i] + (G / B) * sums[1, i] + sums[2, i] / B
        to_local(core.supports, r)
        for i in range(n):
            d[i] = goal[i] - r[i]
        change, left = corrected(core, factor, goal, d, lam)
        add_products(core, m, matrices, y, d, sums, w)
        if joined.projects:
            change = max(change, shifted_back(core, m, factor, y, mu[0], joined, lam, rho, room))
        if round == 1 and known == 0:
            rate[0] = min(WARY * change / before, 1.0)
        shrinks = min(change / before, 1.0) if round > 0 else 1.0
        if sudden:
            if ends_mixed(change, before, round, left):
                return OK
            lead_on(core.joints.mask, lam, rho, room[0:4], mix, room[9], round)
        elif may_end(change, before, rate[0] if known > 0 and round < 2 else shrinks, LEFT, left):
            return OK
        before = change
    return SLOW


@formula
def take(core, sums, mu, back, still):
    """Take the sums, derivatives by q, v and a in physical components, from mu; add to ``still``."""
    joints = core.joints
    for i in range(still.shape[0]):
        back[0, i], back[1, i] = sums[0, i], sums[1, i]
        still[i] += sums[0, i]
    folded(core.supports, sums, back)
    for i in range(core.weight.shape[0]):
        mu[0, i] -= back[0, i]
        mu[1, i] -= back[1, i]
    hold(core.supports, mu[0])
    hold(core.supports, mu[1])
    for k in range(joints.multipliers.shape[0]):
        mu[0, joints.multipliers[k]] = mu[1, joints.multipliers[k]] = 0.0


@inline_kernel
def take_memory(core, m, back, y, mu, room, still):
    """Add to mu_q and mu_v what a step leaves in memories of friction does."""
    clear(room[0:3])
    through_memory(back, y[0], y[1], room[0], room[1], core.ws)
    take(core, room[0:3], mu, m.work[1:3], still)


@kernel
def back_joined_steps(
    core, m, ahead, back, tables, way, wanted, unknowns, h, scheme, joined, mu, out, shifts, still, rooms
):
    """Carry the adjoint back through the steps of a block.

    Parameters
    ----------
    core, m, ahead, tables, way, wanted, unknowns, h, scheme, mu, out, still
        See :func:`ancf.solvers.derivatives.adjoint.back_steps`.
    back : Forgetting
    joined : Constraining
    shifts : (steps, size)
        rho, zero unless the formulation shifts positions.
    rooms : tuple
        (1,) by what corrections shrink, see :func:`factors`; (ROOM, size); (ROOM, size) of
        ``mixing``, or (0, size): room for forces that begin from one step to the next, or none.

    Returns
    -------
    Steps done and the status of the last one.
    """
    (rate, room, mix), (B, G) = rooms, coefficients(h, scheme)
    c1 = (1.0 - scheme.alpha_f) / (1.0 - scheme.alpha_m)
    n, size = core.weight.shape[0], mu.shape[1]
    at_level(core, joined.w0, joined.w1, joined.w2)
    for step in range(way.q.shape[0]):
        at = way.q.shape[0] - 1 - step
        k = at % LANES
        fresh = step == 0 or k == LANES - 1
        if fresh and look_ahead(core, m, ahead, tables, way, at - k, B, G, True) >= 0:
            return step, SINGULAR
        drive(core.supports, core.loads.value, tables, at, way.q[at], way.v[at], way.a[at])
        bring(ahead.friction, at)
        lam, y = out[at], (way.q[at], way.v[at], way.a[at])
        if is_there(back):
            take_memory(core, m, back, y, mu, room, still)
        take_wanted(core.supports, wanted[at], unknowns, mu, m.work[5:8], m.work[1:3])
        factor, matrices = factor_of(core.factor, ahead.eight, k), (ahead.K[k], ahead.C[k])
        rho, known = shifts[at], min(step, PAST)
        begun(core, m, y, joined, known, out[at + 1 :], shifts[at + 1 :], lam, rho, room)
        own = (joined, known, lam, rho, rate, room, mix)
        status = factors(core, m, factor, matrices, y, mu, c1, B, G, *own)
        if status != OK:
            return step, status
        for i in range(size):
            room[0, i] += room[3, i]
        take(core, room[0:3], mu, m.work[1:3], still)
        if is_there(back):
            onto_shadows(core.supports, lam)
            through_force(back, y[0], y[1], lam, core.ws)
        to_start(n, h, scheme, mu, lam)
    return way.q.shape[0], OK
