"""What Newton's method leaves of the forces in a step, carried over to the next step.

The iteration stops with a residual d_n of the equations of motion, M a + ... = d_n: a force from nowhere.
Where the motion is smooth it has one sign, and over a run its impulses h d_n add up, the more the finer the
steps.  So the next step is solved with what was left, M a + ... = -(d_1 + ... + d_n): all steps together then
miss no more than the last one, whatever the tolerance.

That costs one more residual in a step.  It is done where rows of joints are kept with the matrix: a kept row
that has turned contracts slowly, and what is left changes the energy and the angular momentum.
"""

from __future__ import annotations

from ...compiled import formula
from ...system.core import residual, to_local
from .memory import H_PREV


@formula
def keeps_rows(joints):
    """Whether joints have rows that are kept with the matrix; those of sliding joints are not."""
    return joints.lowest < joints.first


@formula
def unbalanced(core, s, h):
    """s.r = the residual as the solve wants it, with what was left in earlier steps of the length h."""
    residual(core.batches, core.ws, s.q, s.v, s.a, s.f, s.r)
    to_local(core.supports, s.r)
    if keeps_rows(core.joints) and s.memo[H_PREV] == h:
        for i in range(s.r.shape[0]):
            s.r[i] += s.left[i]


@formula
def carry(core, s, h):
    """Keep what all steps so far have left of the forces; constraints have no share in it."""
    if keeps_rows(core.joints):
        unbalanced(core, s, h)
        for i in range(s.r.shape[0]):
            s.left[i] = s.r[i] * (1.0 - core.joints.mask[i])
