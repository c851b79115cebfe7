"""What a converged step may not have done: gone too far, or turned a cross-section inside out."""

from __future__ import annotations

from ...compiled import formula
from ...system.core import inverted_section
from ..status import FAR, INVERTED, OK
from .memory import WORST


@formula
def check_way(core, s, furthest):
    """Status after a converged step: no unknown may have gone further than a step can tell.

    Where tangents turn by more than about half a radian in a step, the equations have several solutions, and
    those that swing to and fro from step to step gain energy.
    """
    for i in range(core.weight.shape[0]):
        if abs(s.q[i] - s.q0[i]) * core.weight[i] > furthest:
            s.memo[WORST] = i
            return FAR
    return OK


@formula
def check_sections(core, s):
    """Status after a converged step: no cross-section may have collapsed or turned inside out."""
    slot = inverted_section(core.batches, core.ws, s.q)
    if slot < 0:
        return OK
    s.memo[WORST] = slot
    return INVERTED
