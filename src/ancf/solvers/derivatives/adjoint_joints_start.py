"""The adjoint of a consistent start of a model whose joints have multipliers, see adjoint_joints.py."""

from __future__ import annotations

import numpy as np

from ...batches import add_tangents
from ...compiled import inline_kernel, kernel
from ...system.core import onto_shadows, to_local
from ..rare import add_all_slopes
from ..status import OK, SLOW
from .adjoint import take_wanted
from .adjoint_joints import add_products, at_level, clear, corrected, may_end, take, take_memory
from .friction import bring
from .friction_back import through_force
from .sensitivity import ENOUGH, MOST, stiffnesses


@inline_kernel
def start_back(core, m, y, goal, lam, room):
    """Fill lambda of accelerations and multipliers, with the rows for these, and the sums; a status.

    ``goal``: what is to be solved for, of multipliers by T_q^T, of all others by T_a^T.
    """
    sums, d, r, w, mask = room[0:3], room[5], room[6], room[7:9], core.joints.mask
    n, before = core.weight.shape[0], np.inf
    clear(sums)
    for i in range(lam.shape[0]):
        lam[i] = 0.0
    at_level(core, 0.0, 0.0, 1.0)
    for _ in range(MOST):
        for i in range(r.shape[0]):
            r[i] = sums[2, i]
        to_local(core.supports, r)
        for i in range(n):
            d[i] = goal[i] - (r[i] if mask[i] == 0.0 else sums[0, i])
        change, left = corrected(core, core.factor, goal, d, lam)
        add_products(core, m, (m.K, m.C), y, d, sums, w)
        if may_end(change, before, min(change / before, 1.0) if before < np.inf else 1.0, ENOUGH, left):
            return OK
        before = change
    return SLOW


@inline_kernel
def shift_back(core, m, y, mu, k, rho, room):
    """Fill rho of the shift of mu[k], positions (0) or velocities (1), onto their rows, and the sums.

    A shift goes through the factors of the masses: rho has the multipliers of accelerations due to mu[k].
    """
    goal, mask = room[4], core.joints.mask
    for i in range(core.weight.shape[0]):
        goal[i] = mu[k, i] * (1.0 - mask[i])
    status = start_back(core, m, y, goal, rho, room)
    for i in range(rho.shape[0]):
        rho[i] *= mask[i]
    clear(room[0:3])
    at_level(core, 1.0 - k, 1.0 * k, 0.0)
    add_all_slopes(m.joined, y[0], y[1], y[2], rho, room[0], room[1], room[2], core.ws)
    return status


@kernel
def back_joined_start(core, m, friction, back, y, wanted, unknowns, mu, lam, still, room):
    """Carry the adjoint through a consistent start: accelerations, shifts of velocities and of positions.

    Parameters
    ----------
    core, m : Core, Matrices
        The factors of the core are those of the masses, with the rows for accelerations.
    friction : Friction
        With what it remembers at the start, and what the first memory is made of.
    back : Forgetting
    y : (q, v, a)
        The state.
    wanted, unknowns, mu, still, room
        As of :func:`back_joined_steps`, of one state; mu_a and mu_b are used up.
    lam : (3, size)
        lambda, and rho of positions and of velocities.

    Returns
    -------
    A status.
    """
    none = room[9]
    clear(room[9:10])
    bring(friction, 0)
    take_wanted(core.supports, wanted, unknowns, mu, m.work[5:8], m.work[1:3])
    stiffnesses(core, m, m.K, m.W, y[0], y[1], none)
    for i in range(m.C.shape[0]):
        m.C[i] = 0.0
    add_tangents(m.exact, y[0], y[1], m.C, 0.0, 1.0, 0.0, core.ws)
    for i in range(core.weight.shape[0]):
        room[4, i] = mu[2, i] + mu[3, i] if core.joints.mask[i] == 0.0 else mu[0, i]
    status = start_back(core, m, y, room[4], lam[0], room)
    if status != OK:
        return status
    take(core, room[0:3], mu, m.work[1:3], still)
    onto_shadows(core.supports, lam[0])
    through_force(back, y[0], y[1], lam[0], core.ws)
    if back.anew:
        bring(friction, 1)
        take_memory(core, m, back, y, mu, room, still)
        bring(friction, 0)
    for k in (1, 0):
        status = shift_back(core, m, y, mu, k, lam[1 + k], room)
        if status != OK:
            return status
        take(core, room[0:3], mu, m.work[1:3], still)
    for i in range(mu.shape[1]):
        mu[2, i] = mu[3, i] = 0.0
    for i in range(core.weight.shape[0], mu.shape[1]):
        mu[0, i] = mu[1, i] = lam[0, i] = 0.0
    return OK
