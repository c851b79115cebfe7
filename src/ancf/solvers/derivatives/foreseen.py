"""Corrections of sensitivities with all that would follow them, where these shrink by one ratio.

What the factors of a step do not have is a contact, as a rule: a matrix of rank one, k b b^T.  Corrections
c, M c, M M c, ... with M = -A^-1 k b b^T are then multiples of one vector from the second on, with the ratio
mu = -k b.A^-1 b, and their sum is c + M c/(1 - mu) (Aitken).  From step to step the ratio hardly changes, so
that of the step before serves first; the next correction, of what it has left, tells a better one.  Of more
contacts the ratio is a mean, and what is left shrinks by how much the others differ from it.
"""

from __future__ import annotations

from ...compiled import inline_kernel
from ...simd import LANES, every, load, store

#: Ratios from which on nothing is foreseen: the corrections would not come to an end.
MOST_RATIO = 0.9


@inline_kernel
def foresee(room, weight, round):
    """Let r, the corrections that follow the last ones, be those with what would follow."""
    r, last = room.r, room.last
    if round == 0:
        store(every(0.0), room.used, 0)
        for i in range(r.shape[0]):
            store(load(r, i), last, i)
        return
    if round > 1:
        measured(room, weight)
    used, share = load(room.used, 0), load(room.open, 0) / (1.0 - load(room.ratio, 0))
    for i in range(r.shape[0]):
        c = share * (load(r, i) - used * load(last, i))
        store(c, r, i)
        store(c, last, i)
    store(load(room.ratio, 0), room.used, 0)


@inline_kernel
def measured(room, weight):
    """The ratio of the corrections r to those before, of each lane that goes on."""
    along, whole = every(0.0), every(0.0)
    for i in range(weight.shape[0]):
        c = (weight[i] * weight[i]) * load(room.last, i)
        along, whole = along + c * load(room.r, i), whole + c * load(room.last, i)
    store(along, room.norm, 0)
    store(whole, room.size, 0)
    for k in range(LANES):
        if room.open[k] > 0.0 and room.size[k] > 0.0:
            ratio = room.norm[k] / room.size[k]
            room.ratio[k] = ratio if ratio < MOST_RATIO else 0.0
