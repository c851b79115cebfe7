"""Corrections that do not shrink: what a few of them have done tells what all that follow would do.

A correction c(x) of x is affine in x.  Of changes of corrections and of what they lead to, g = x + c, those
are taken of which the next correction would be the smallest (Anderson's mixing; of affine corrections it is
GMRES).  So what is lacking in few rows, however stiff, ends after as many corrections.
"""

from __future__ import annotations

from ...compiled import formula, inline_kernel
from .adjoint import SURE
from .sensitivity import LEAST, NOISY

#: Changes that are kept; vectors of x with all that is summed up of it, of which corrections are the first.
KEPT, OF_X, OF_C = 10, 6, 2
#: Where in the room there are: x before, its correction, and those of the round before, the changes.
X, C, C_BEFORE, G_BEFORE, FIRST = 0, 2, 4, 6, 12
MIXED = FIRST + KEPT * (OF_X + OF_C)
ROOM = MIXED + OF_X
#: Corrections after which those that do not shrink may be round-off; part of what is solved for below which
#: what is left of it is that.
MANY, NOTHING = 5, 1e-13
#: Changes of corrections, in what they are measured in, that are round-off of x and lead nowhere.
UNSEEN = 1e-15


@formula
def weighed(mask, scale, a, b):
    """Scalar product of two corrections, of lambda, its multipliers and rho in sizes of their own."""
    total = 0.0
    for i in range(mask.shape[0]):
        w = scale[1] if mask[i] > 0.0 else scale[0]
        total += w * a[0, i] * b[0, i] + scale[2] * a[1, i] * b[1, i]
    return total


@formula
def add(f, x, y):
    """y += f x of vectors."""
    for k in range(x.shape[0]):
        for i in range(x.shape[1]):
            y[k, i] += f * x[k, i]


@formula
def copied(x, y):
    """y = x of vectors."""
    for k in range(x.shape[0]):
        for i in range(x.shape[1]):
            y[k, i] = x[k, i]


@formula
def scales(mask, g, scale):
    """Squares of what lambda, its multipliers and rho are measured in."""
    scale[0] = scale[1] = scale[2] = 0.0
    for i in range(mask.shape[0]):
        k = 1 if mask[i] > 0.0 else 0
        scale[k] = max(scale[k], abs(g[0, i]))
        scale[2] = max(scale[2], abs(g[1, i]))
    for k in range(3):
        scale[k] = 1.0 / (scale[k] * scale[k]) if scale[k] > 1e-150 else 0.0


@inline_kernel
def mixed(mask, g, room, scale, round):
    """Lead g, what x has become by a correction, to where the next correction is the smallest.

    Parameters
    ----------
    mask : (n,)
        Which unknowns are multipliers.
    g : (OF_X, size)
        lambda, rho and what is summed up of them; changed.
    room : (ROOM, size)
        In its first two rows lambda and rho before the correction.
    scale : (3,)
        Filled in round 0.
    round : int
    """
    c, last, c_last, g_last = (
        room[C : C + 2],
        (round - 1) % KEPT,
        room[C_BEFORE:G_BEFORE],
        room[G_BEFORE:FIRST],
    )
    copied(g[:OF_C], c)
    add(-1.0, room[X : X + 2], c)
    if round == 0:
        scales(mask, g, scale)
    else:
        own = FIRST + last * (OF_X + OF_C)
        dc, dg = room[own : own + OF_C], room[own + OF_C : own + OF_C + OF_X]
        copied(c, dc)
        add(-1.0, c_last, dc)
        copied(g, dg)
        add(-1.0, g_last, dg)
        for _ in range(2):
            for k in range(min(round - 1, KEPT)):
                o = FIRST + k * (OF_X + OF_C)
                if k != last:
                    f = -weighed(mask, scale, dc, room[o : o + OF_C])
                    add(f, room[o : o + OF_C], dc)
                    add(f, room[o + OF_C : o + OF_C + OF_X], dg)
        size = weighed(mask, scale, dc, dc)
        f = 1.0 / size**0.5 if size > UNSEEN * UNSEEN else 0.0
        for i in range(dc.shape[1]):
            for k in range(OF_C):
                dc[k, i] *= f
            for k in range(OF_X):
                dg[k, i] *= f
    copied(c, c_last)
    copied(g, g_last)
    for k in range(min(round, KEPT)):
        o = FIRST + k * (OF_X + OF_C)
        f = -weighed(mask, scale, c, room[o : o + OF_C])
        add(f, room[o : o + OF_C], c)
        add(f, room[o + OF_C : o + OF_C + OF_X], g)


@formula
def ends_mixed(change, before, round, left):
    """Whether corrections may end with one of this relative size, and what was ``left``."""
    if change <= SURE or change < LEAST:
        return True
    return round >= MANY and change >= 0.5 * before and (change <= NOISY or left <= NOTHING)


@inline_kernel
def lead_on(mask, lam, rho, sums, mix, scale, round):
    """Mix corrections of lambda, rho and what they take."""
    g = mix[MIXED:ROOM]
    for i in range(lam.shape[0]):
        g[0, i], g[1, i] = lam[i], rho[i]
    for k in range(4):
        for i in range(lam.shape[0]):
            g[2 + k, i] = sums[k, i]
    mixed(mask, g, mix, scale, round)
    for i in range(lam.shape[0]):
        lam[i], rho[i] = g[0, i], g[1, i]
    for k in range(4):
        for i in range(lam.shape[0]):
            sums[k, i] = g[2 + k, i]
