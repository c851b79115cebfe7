"""Energy that leaves and enters a System: every force is booked once.

The work of loads is supplied: of those that depend on time alone, of batches with the role EXTERNAL whatever
they depend on, and of the reactions of moving supports.  Gravity has a potential instead.  What all other
forces do because of velocities is dissipated: what they lose when the velocities are set to zero.  All that
batches with the role RUBS do is dissipated: friction needs no velocity to hold.  What forces of inertia lose
that depend on velocities, as those of a cable that a winch pays out, is not dissipated.
"""

from __future__ import annotations

from ..batches import add_forces
from ..compiled import inline_kernel
from .core import residual


@inline_kernel
def powers(core, q, v, a, f, push, loss, r):
    """Fill ``push`` with the forces that supply energy, ``loss`` with those that dissipate it, opposed.

    Returns the power that is dissipated, W. ``f`` are gravity and dead loads; ``r`` is scratch memory.
    """
    n, dissipated = f.shape[0], 0.0
    for i in range(n):
        push[i] = 0.0
    if core.damped:  # without velocities first: what batches measure is left from the state as it is
        residual(core.batches, core.ws, q, push, a, f, r)
        for i in range(n):
            r[i] = -r[i]
        add_forces(core.external, q, push, a, r, core.ws)
        add_forces(core.rubbing, q, push, a, r, core.ws)
        add_forces(core.inertial, q, push, a, r, core.ws)
        for i in range(n):
            loss[i] = r[i]
            r[i] = 0.0
        add_forces(core.inertial, q, v, a, r, core.ws)
        for i in range(n):
            loss[i] -= r[i]
    if core.damped or core.supports.driven.shape[0] > 0:
        residual(core.batches, core.ws, q, v, a, f, r)
    add_forces(core.external, q, v, a, push, core.ws)
    if core.damped:
        for i in range(n):
            loss[i] += r[i] - push[i]
        for k in range(core.joints.multipliers.shape[0]):  # they are no places
            loss[core.joints.multipliers[k]] = 0.0
        for i in range(n):
            dissipated += v[i] * loss[i]
    for i in range(n):
        push[i] = f[i] - core.loads.gravity[i] - push[i]
    for k in range(core.supports.driven.shape[0]):
        for c in range(3):
            push[core.supports.driven[k] + c] += r[core.supports.driven[k] + c]
    return dissipated
