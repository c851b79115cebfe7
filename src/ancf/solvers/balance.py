"""Energy dissipated and supplied in a step of any method but Radau's, by the trapezoidal rule."""

from __future__ import annotations

from ..compiled import kernel
from ..system.powers import powers
from .memory import POWER


@kernel
def balance(core, s, h):
    """Add a step's share to the energies dissipated and supplied (trapezoidal rule); h = 0 at the start."""
    push = s.push_new
    power = powers(core, s.q, s.v, s.a, s.f, push, s.r)
    s.work[0] += 0.5 * h * (s.memo[POWER] + power)
    s.memo[POWER] = power
    if not core.loaded:
        return
    for i in range(push.shape[0]):
        if h > 0.0:
            s.work[1] += 0.5 * (s.push[i] + push[i]) * (s.q[i] - s.q0[i])
        s.push[i] = push[i]
