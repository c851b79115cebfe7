"""Energy dissipated and supplied in a step of any method but Radau's, by the trapezoidal rule.

The work of a force is its mean at both ends times the way: as much as the trapezoidal rule itself gives to
the kinetic energy, so that the account misses nothing but what potentials do within a step.
"""

from __future__ import annotations

from typing import Any

from ...compiled import kernel
from ...system.powers import powers


@kernel
def balance(core, s, h):
    """Add a step's share to the energies dissipated and supplied; h = 0 at the start."""
    push, loss = s.push_new, s.loss_new
    powers(core, s.q, s.v, s.a, s.f, push, loss, s.r)
    for i in range(push.shape[0]):
        if h > 0.0:
            way = 0.5 * (s.q[i] - s.q0[i])
            s.work[0] += (s.loss[i] + loss[i]) * way
            s.work[1] += (s.push[i] + push[i]) * way
        s.push[i], s.loss[i] = push[i], loss[i]


def begin_account(core: Any, memory: Any) -> None:
    """At the start of an account, of the forces as they are now."""
    if core.damped or core.loaded:
        balance(core, memory, 0.0)
