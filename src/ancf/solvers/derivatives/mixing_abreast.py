"""Corrections of eight sensitivities that do not shrink, mixed lane by lane, see ``mixing``.

A round of corrections, with a shift onto the constraints if there is one, is an affine map of s_q and s_a;
s_v goes with s_a.  Contacts between cables or bodies are in no factors, and beside joints there is no one
ratio by which corrections shrink: of changes of them and of what they lead to, those are taken of which the
next one would be the smallest.
"""

from __future__ import annotations

from ...compiled import formula, inline_kernel
from ...simd import LANES, every, load, store
from .mixing import KEPT, UNSEEN

#: Vectors: s_q and s_a before, their correction, those of the round before and what it led to, the changes.
X, C, C_BEFORE, G_BEFORE, FIRST = 0, 2, 4, 6, 8
ROOM = FIRST + 4 * KEPT


@formula
def weighed(weight, B, mix, a, b):
    """Scalar products of the corrections at two places, of places and what accelerations do to them."""
    total = every(0.0)
    for i in range(weight.shape[0]):
        rates = (B * B) * (load(mix, a + 1, i) * load(mix, b + 1, i))
        total = total + (weight[i] * weight[i]) * (load(mix, a, i) * load(mix, b, i) + rates)
    return total


@formula
def add(n, f, mix, a, b):
    """Add f times the two vectors at place a to those at b."""
    for i in range(n):
        store(load(mix, b, i) + f * load(mix, a, i), mix, b, i)
        store(load(mix, b + 1, i) + f * load(mix, a + 1, i), mix, b + 1, i)


@formula
def differ(n, mix, a, b, out):
    """Fill the two vectors at ``out`` with those at a less those at b."""
    for i in range(n):
        store(load(mix, a, i) - load(mix, b, i), mix, out, i)
        store(load(mix, a + 1, i) - load(mix, b + 1, i), mix, out + 1, i)


@formula
def copied(n, mix, a, b):
    """Copy the two vectors at place a to b."""
    for i in range(n):
        store(load(mix, a, i), mix, b, i)
        store(load(mix, a + 1, i), mix, b + 1, i)


@formula
def taken(n, d, mix, place):
    """Copy s_q and s_a to a place."""
    for i in range(n):
        store(load(d, 0, i), mix, place, i)
        store(load(d, 2, i), mix, place + 1, i)


@inline_kernel
def remembered(core, room, B, last, count):
    """Keep the change of the correction, and of what it leads to, less its parts along the others; of size 1.

    Multipliers are in neither: what joints alone bear may be round-off of any size.
    """
    weight, mix, own = core.weight, room.mix, FIRST + 4 * last
    n = weight.shape[0]
    differ(n, mix, C, C_BEFORE, own)
    taken(n, room.d, mix, own + 2)
    for i in range(n):
        for k in range(2):
            store(load(mix, own + 2 + k, i) - load(mix, G_BEFORE + k, i), mix, own + 2 + k, i)
    for _ in range(2):
        for k in range(count):
            other = FIRST + 4 * k
            if k != last:
                f = -1.0 * weighed(weight, B, mix, own, other)
                add(n, f, mix, other, own)
                add(n, f, mix, other + 2, own + 2)
    store(weighed(weight, B, mix, own, own), room.size, 0)
    for k in range(LANES):
        size = room.size[k]
        room.norm[k] = 1.0 / size**0.5 - 1.0 if size > (UNSEEN * UNSEEN) * room.first[k] else -1.0
    add(n, load(room.norm, 0), mix, own, own)
    add(n, load(room.norm, 0), mix, own + 2, own + 2)


@inline_kernel
def mixed(core, room, B, G, round):
    """Lead the sensitivities d, corrected from those in ``mix``, to where the next one is the smallest."""
    n, d, mix = core.weight.shape[0], room.d, room.mix
    for i in range(n):
        store(load(d, 0, i) - load(mix, X, i), mix, C, i)
        store(load(d, 2, i) - load(mix, X + 1, i), mix, C + 1, i)
    if round == 0:
        store(weighed(core.weight, B, mix, C, C), room.first, 0)
    else:
        remembered(core, room, B, (round - 1) % KEPT, min(round, KEPT))
    copied(n, mix, C, C_BEFORE)
    taken(n, d, mix, G_BEFORE)
    for k in range(min(round, KEPT)):
        own = FIRST + 4 * k
        f = -1.0 * weighed(core.weight, B, mix, C, own)
        add(n, f, mix, own, C)
        for i in range(n):
            rate = f * load(mix, own + 3, i)
            store(load(d, 0, i) + f * load(mix, own + 2, i), d, 0, i)
            store(load(d, 1, i) + G * rate, d, 1, i)
            store(load(d, 2, i) + rate, d, 2, i)
