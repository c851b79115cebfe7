"""The adjoint of the steps of the Newmark family: the derivative of one number by everything, backwards.

With mu_q, mu_v, mu_a, mu_b the derivatives of the number by q, v, a and the algorithmic acceleration at the
end of a step, by what comes later, and J = M/B + (G/B) C + K,

    J^T lambda = mu_q + (G mu_v + c_1 mu_b + mu_a)/B

at the free unknowns; the number changes by -lambda . R_p, and mu_q - K^T lambda and mu_v - C^T lambda go back
through q~ and v~ to the start of the step.  For models whose matrices are all exact: they are symmetric but
for what velocities add to K, which is not in the factors; its products with lambda are made up for by
iteration.
"""

from __future__ import annotations

from ...batches import add_tangents
from ...compiled import formula, inline_kernel, kernel
from ...linalg.eight import factor_of
from ...simd import LANES
from ...system.core import drive, onto_shadows, solve_matrix, to_local
from ..rare import add_rate_works, add_tangent_works
from ..status import OK, SINGULAR, SLOW
from ..step.scheme import coefficients
from .ahead import look_ahead
from .sensitivity import LEAST, MOST, is_done, product, stiffnesses

#: Part of lambda below which its corrections end when the next one would be smaller: what is left out of a
#: step goes on to all before it.
SURE = 1e-15


@formula
def folded(supports, x, moved):
    """Derivatives x by q, v and a at the shadows as those by their unknowns, R^T x; what turns counts too."""
    for k in range(supports.rot_slot.shape[0]):
        i, j = supports.rot_slot[k], supports.rot_shadow[k]
        for c in range(3):
            f, g = 0.0, 0.0
            for n in range(3):
                R, dR = supports.rot_R[k, 0, n, c], supports.rot_R[k, 1, n, c]
                f += R * x[0][j + n] + dR * x[1][j + n] + supports.rot_R[k, 2, n, c] * x[2][j + n]
                g += R * x[1][j + n] + 2.0 * dR * x[2][j + n]
            moved[0][i + c], moved[1][i + c] = f, g
    for k in range(supports.held.shape[0]):
        moved[0][supports.held[k]], moved[1][supports.held[k]] = 0.0, 0.0


@formula
def take_wanted(supports, wanted, unknowns, mu, x, moved):
    """Add the derivatives of the number by entries of the state at the end of a step, (2, k), to mu."""
    for k in range(supports.rot_slot.shape[0]):
        for c in range(3):
            j = supports.rot_shadow[k] + c
            x[0, j] = x[1, j] = x[2, j] = 0.0
    for k in range(unknowns.shape[0]):
        i = unknowns[k]
        if supports.rot_slot.shape[0] > 0 and i >= supports.rot_shadow[0]:
            x[0, i], x[1, i] = wanted[0, k], wanted[1, k]
        else:
            mu[0, i] += wanted[0, k]
            mu[1, i] += wanted[1, k]
    folded(supports, x, moved)
    for k in range(supports.rot_slot.shape[0]):
        for c in range(3):
            i = supports.rot_slot[k] + c
            mu[0, i] += moved[0, i]
            mu[1, i] += moved[1, i]
    for k in range(supports.held.shape[0]):
        mu[0, supports.held[k]] = mu[1, supports.held[k]] = 0.0


@formula
def hold(supports, x):
    """Set x to zero where it is held."""
    for k in range(supports.held.shape[0]):
        x[supports.held[k]] = 0.0


@formula
def foreseen(last, known, sums):
    """What velocities will add to K^T lambda, on a line through what they did in the steps before."""
    for i in range(sums.shape[0]):
        sums[i] = 0.0 if known == 0 else (last[0, i] if known == 1 else 2.0 * last[0, i] - last[1, i])


@inline_kernel
def solve_stirred(core, m, ahead, factor, y, lam, known):
    """Solve with the transposed matrix, in whose factors what velocities do to K at y is not; a status.

    What they add to K^T lambda is left in ``m.work[9]``, as a guess for the next steps, of which ``known``
    have been solved.  A guess leaves little to correct, and no ratio of corrections: the largest so far
    tells what one more would be.
    """
    if m.stirred.table.shape[0] == 0:
        solve_matrix(factor, lam)
        return OK
    n, d, r, sums, last, before = core.weight.shape[0], m.work[0], m.work[8], m.work[9], ahead.last, 0.0
    foreseen(last, known, sums)
    for i in range(r.shape[0]):
        r[i] = sums[i]
    to_local(core.supports, r)
    hold(core.supports, r)
    for i in range(n):
        lam[i] -= r[i]
    solve_matrix(factor, lam)
    for i in range(n):
        d[i] = lam[i]
        before = max(before, abs(lam[i]))  # without a guess the first of the corrections
    for i in range(r.shape[0]):
        r[i] = -sums[i]
    for round in range(MOST):
        onto_shadows(core.supports, d)
        add_rate_works(m.stirred, y[0], y[1], d, r, core.ws)
        for i in range(r.shape[0]):
            sums[i] += r[i]
        to_local(core.supports, r)
        hold(core.supports, r)
        solve_matrix(factor, r)
        norm, size = 0.0, 0.0
        for i in range(n):
            lam[i] -= r[i]
            d[i] = -r[i]
            norm, size = max(norm, abs(r[i])), max(size, abs(lam[i]))
        if round > 0 and norm > 0.0:
            ahead.rate[0] = max(ahead.rate[0], norm / before)
        elif known > 0:
            before = norm / max(ahead.rate[0], LEAST)
        if is_done(norm, size, before, SURE):
            for i in range(r.shape[0]):
                last[1, i] = last[0, i]
                last[0, i] = sums[i]
            return OK
        before = norm
        for i in range(r.shape[0]):
            r[i] = 0.0
    return SLOW


@formula
def factors(core, m, ahead, factor, y, mu, c1, B, G, lam, known):
    """Fill lambda at the unknowns and, as forces of the residual, at the shadows; a status."""
    supports, n = core.supports, core.weight.shape[0]
    for i in range(n):
        lam[i] = mu[0, i] + (G * mu[1, i] + c1 * mu[3, i] + mu[2, i]) / B
    hold(supports, lam)
    status = solve_stirred(core, m, ahead, factor, y, lam, known)
    for i in range(n, lam.shape[0]):
        lam[i] = 0.0
    onto_shadows(supports, lam)
    return status


@formula
def add_turns(supports, x, y, turned):
    """Add derivatives x by q, v and a at the shadows times the state y there: those by the local axes."""
    for k in range(turned.shape[0]):
        i, j = supports.rot_slot[k], supports.rot_shadow[k]
        for n in range(x.shape[0]):
            for m in range(3):
                for c in range(3):
                    turned[k, m, c] += x[n, j + m] * y[n][i + c]


@formula
def taken_back(core, m, matrices, y, lam, still, turned):
    """Fill ``m.work[1:3]`` with what lambda takes from mu_q and mu_v: K^T lambda and C^T lambda.

    ``matrices``: K and C, without what velocities add to K^T lambda: that is ``m.work[9]``; ``y``: the state.
    Sums are added to ``still`` and ``turned``.
    """
    (K, C), back, w, x = matrices, m.work[1:3], m.work[3:5], m.work[5:8]
    for i in range(lam.shape[0]):
        x[0, i] = x[1, i] = x[2, i] = 0.0
    add_tangent_works(m.worked, y[0], y[1], lam, x[0], x[1], x[2], core.ws)
    if m.stirred.table.shape[0] > 0:
        for i in range(lam.shape[0]):
            x[0, i] += m.work[9, i]
    if m.exact.table.shape[0] > 0:
        product(core, K, lam, x[0], w)
        if m.damped:
            product(core, C, lam, x[1], w)
        if core.supports.rot_slot.shape[0] > 0:
            product(core, m.M, lam, x[2], w)
    if core.supports.rot_slot.shape[0] > 0:
        add_turns(core.supports, x, y, turned)
    for i in range(lam.shape[0]):
        back[0, i], back[1, i] = x[0, i], x[1, i]
        still[i] += x[0, i]
    folded(core.supports, x, back)


@formula
def to_start(n, h, scheme, mu, lam):
    """Carry mu, less what lambda takes from it, through q~ and v~ to the start of a step; none at shadows."""
    am, af, beta, gamma = scheme.alpha_m, scheme.alpha_f, scheme.beta, scheme.gamma
    c2, c3 = af / (1.0 - am), -am / (1.0 - am)
    for i in range(n):
        eq, ev = mu[0, i], mu[1, i]
        eb = mu[3, i] + h * h * beta * eq + h * gamma * ev
        mu[0, i], mu[1, i], mu[2, i] = eq, h * eq + ev, c2 * eb
        mu[3, i] = c3 * eb + h * h * (0.5 - beta) * eq + h * (1.0 - gamma) * ev
    for i in range(n, lam.shape[0]):
        mu[0, i] = mu[1, i] = mu[2, i] = mu[3, i] = lam[i] = 0.0


@kernel
def back_start(core, m, y, wanted, unknowns, mu, lam, still, turned):
    """Carry the adjoint through the accelerations of a consistent start, M s_a + C s_v + K s_q + R_p = 0.

    Parameters
    ----------
    core, m : Core, Matrices
        The factors of the core are those of the masses.
    y : (q, v, a)
        The state.
    wanted, unknowns, mu, lam, still, turned
        As of :func:`back_steps`, of one state; mu_a and mu_b are used up.
    """
    n, none = core.weight.shape[0], m.work[0]
    take_wanted(core.supports, wanted, unknowns, mu, m.work[5:8], m.work[1:3])
    for i in range(none.shape[0]):
        none[i] = 0.0
    stiffnesses(core, m, m.K, m.W, y[0], y[1], none)
    for i in range(m.C.shape[0]):
        m.C[i] = 0.0
    add_tangents(m.exact, y[0], y[1], m.C, 0.0, 1.0, 0.0, core.ws)
    for i in range(n):
        lam[i] = mu[2, i] + mu[3, i]
    hold(core.supports, lam)
    solve_matrix(core.factor, lam)
    for i in range(n, lam.shape[0]):
        lam[i] = 0.0
    onto_shadows(core.supports, lam)
    for i in range(lam.shape[0]):
        m.work[9, i] = 0.0
    add_rate_works(m.stirred, y[0], y[1], lam, m.work[9], core.ws)
    taken_back(core, m, (m.K, m.C), y, lam, still, turned)
    for i in range(n):
        mu[0, i], mu[1, i] = mu[0, i] - m.work[1, i], mu[1, i] - m.work[2, i]
        mu[2, i] = mu[3, i] = 0.0
    for i in range(n, lam.shape[0]):
        mu[0, i] = mu[1, i] = mu[2, i] = mu[3, i] = lam[i] = 0.0


@kernel
def back_steps(core, m, ahead, tables, way, wanted, unknowns, h, scheme, mu, out, still, turned):
    """Carry the adjoint back through the steps of a block.

    Parameters
    ----------
    core, m, ahead, tables, way : Core, Matrices, Ahead, Tables, Way
        See :func:`ancf.solvers.derivatives.abreast.follow_steps`.
    wanted : (steps, 2, k)
        Derivatives of the number by q and v at the ends of the steps.
    unknowns : (k,)
        The entries of these by which it has some, each once.
    mu : (4, size)
        mu_q, mu_v, mu_a, mu_b at the end of the block; changed to those at its start.
    out : (steps, size)
        lambda.
    still : (size,)
        What lambda does to derivatives of q that are the same at all times is added: K^T lambda.
    turned : (k, 3, 3)
        What it does through places and motion where local axes turn, by these, or k = 0: it is not asked for.

    Returns
    -------
    Steps done and the status of the last one.
    """
    B, G = coefficients(h, scheme)
    n, c1 = core.weight.shape[0], (1.0 - scheme.alpha_f) / (1.0 - scheme.alpha_m)
    back, x = m.work[1:3], m.work[5:8]
    ahead.rate[0] = 0.0
    for step in range(way.q.shape[0]):
        at = way.q.shape[0] - 1 - step
        k = at % LANES
        fresh = step == 0 or k == LANES - 1
        if fresh and look_ahead(core, m, ahead, tables, way, at - k, B, G, True) >= 0:
            return step, SINGULAR
        drive(core.supports, core.loads.value, tables, at, way.q[at], way.v[at], way.a[at])
        lam = out[at]
        take_wanted(core.supports, wanted[at], unknowns, mu, x, back)
        factor, y = factor_of(core.factor, ahead.eight, k), (way.q[at], way.v[at], way.a[at])
        status = factors(core, m, ahead, factor, y, mu, c1, B, G, lam, min(step, 2))
        if status != OK:
            return step, status
        taken_back(core, m, (ahead.K[k], ahead.C[k]), y, lam, still, turned)
        for i in range(n):
            mu[0, i] -= back[0, i]
            mu[1, i] -= back[1, i]
        to_start(n, h, scheme, mu, lam)
    return way.q.shape[0], OK
