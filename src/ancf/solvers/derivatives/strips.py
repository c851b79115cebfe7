"""Contacts of strips in the solutions of an adjoint: Woodbury's formula, as in the steps of the run.

The factors of a step know nothing of them (:mod:`ancf.connections.contact`), while their stiffness is by far
the largest of what is missing there.  With the gradient b of an overlap and c = k + (G/B) d, see
:mod:`ancf.solvers.step.low_rank`, c b b^T is all of it but for how the force turns.
"""

from __future__ import annotations

from ...choices import optional
from ...connections.contact_touch import DAMPING, STIFFNESS
from ..step.low_rank import fill_small, renew_contacts, take_out


def _meet(patches, core, factor, q, v):
    renew_contacts(core, factor, patches[0], q, v, 6 * core.joints.first)


def _give_way(patches, gb, x):
    p, m = patches[0], 0
    for j in range(p.contacts.slot.shape[0]):
        if p.spring[j] != 0:
            p.active[m] = j
            p.small[m, m] = 1.0 / (p.contacts.data[j, STIFFNESS] + gb * p.contacts.data[j, DAMPING])
            m += 1
    if m > 0:
        fill_small(p, m)
        take_out(p, m, x)


#: ``meet(patches, core, factor, q, v)``: rows of the contacts in a state, with the factors of its step.
meet = optional(_meet)
#: ``give_way(patches, gb, x)``: the solution x of the factorised matrix, corrected by them.
give_way = optional(_give_way)
