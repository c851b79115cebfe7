"""What changes of numbers do to the forces of grounds, and to what friction remembers.

The numbers are those of the grounds, but for tables of heights, the diameters of sections and, as a length
changes them, weights of points and factors of their places.  At fixed unknowns a point then moves by dr; see
:mod:`ancf.loads.ground_along` for what that does, to which

    dN = N dd/d + d (g dk + on g' dc),    dx = dk_t (r - anchor) + dc_t v,    dL = dmu N

and, of what sticks, dT = -w dd are added.  What stays in the spring knows of no damping, c_t = 0.
"""

from __future__ import annotations

import numpy as np

from ..compiled import formula, inline_kernel
from ..simd import LANES
from ..vectors import both, dot
from .along import stretch_at
from .ground_along import ZERO, along_ground, both_forces, places_of, rubbed, turning
from .ground_points import anchor_at, drawn_at, left_at, pressed_at, pulled_at
from .relief import DAMPING, DRAG, FRICTION, NORMAL, PLACE, SOFT, STICK, STIFFNESS

#: Fields of which the numbers are made, one after the other, and those that change with these.
NUMBERS = ("grounds", "diameter", "weight", "shape")
NUMBERED = (*NUMBERS, "slope", "shift", "label")


def numbers(batch):
    """Those of the grounds, diameters, weights and factors of points."""
    return np.concatenate([getattr(batch, key).ravel() for key in NUMBERS])


def kinds_of(batch, rates):
    """Whether a change has some of weights and factors."""
    return [int(np.any(rates[batch.grounds.size + batch.diameter.size :]))]


@formula
def moved_by(batch, e, p, x, rates):
    """What a point p of row e, or its velocity, changes by with the factors."""
    count, moved = batch.base.shape[1], (0.0, 0.0, 0.0)
    first = batch.grounds.size + batch.diameter.size + batch.weight.size
    first += (e * batch.weight.shape[1] + p) * count
    for k in range(count):
        i, w = batch.base[e, k], rates[first + k]
        if i >= 0:
            moved = moved[0] + w * x[i], moved[1] + w * x[i + 1], moved[2] + w * x[i + 2]
    return moved


@formula
def normal_of(row):
    """The direction in the numbers of a ground."""
    return row[NORMAL], row[NORMAL + 1], row[NORMAL + 2]


@formula
def shifted(batch, e, at, g, n, dr, own):
    """What depth and normal at a place change by as it moves by dr and the ground by its numbers."""
    k = batch.ground[e]
    dg, dn = turning(batch, e, at, g, dr)
    dg -= dot(n, dr)
    if batch.size[k, 0] > 0:
        return dg, dn
    ground, turned = batch.grounds[k], normal_of(own)
    for c in range(3):
        dg += own[PLACE + c] * n[c] + (ground[PLACE + c] - at[c]) * turned[c]
    return dg, both(1.0, dn, 1.0, turned)


@formula
def pressed_along(batch, e, here, dg, drate, own, dd):
    """Change of N as the depth, its rate, numbers of the ground and the diameter do."""
    _, u, g, n, N, by_g, by_rate = here
    if N == 0.0:
        return 0.0
    ground, d, rate = batch.grounds[batch.ground[e]], batch.diameter[e], -dot(u, n)
    on = min(1.0, 1.0 + g / (SOFT * d))
    by_d = N / d
    if g < 0.0:  # the height over which damping comes on goes with the diameter
        by_d -= ground[DAMPING] * rate * g / (SOFT * d)
    of_own = d * (g * own[STIFFNESS] + on * rate * own[DAMPING])
    return by_g * dg + by_rate * drate + by_d * dd + of_own


@formula
def moved_at(batch, e, p, q, v, here, shaped, own, dd, rates):
    """What a change of numbers moves point p of row e by, and its velocity; what n and N change by."""
    at, u, g, n, _, _, _ = here
    dr, du = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    if shaped:
        dr, du = moved_by(batch, e, p, q, rates), moved_by(batch, e, p, v, rates)
    dg, dn = shifted(batch, e, at, g, n, dr, own)
    return dr, du, dn, pressed_along(batch, e, here, dg, -dot(n, du) - dot(u, dn), own, dd)


@formula
def pull_at(batch, e, p, q, here):
    """Of the friction at point p of row e: x, w, its size, the factor f, whether it slips; r - anchor."""
    at, u, n = here[0], here[1], here[3]
    anchor = anchor_at(batch, e, p, q)
    w, size, f, slips = drawn_at(batch, e, p, q, at, u, n)
    way = at[0] - anchor[0], at[1] - anchor[1], at[2] - anchor[2]
    return pulled_at(batch, e, p, q, at, u), w, size, f, slips, way


@formula
def left_of(batch, e, p, q, here):
    """A point as if it stood still, and :func:`pull_at` of what a step leaves in the spring there."""
    at, u, g, n, N, by_g, by_rate = here
    still = at, ZERO, g, n, N, by_g, by_rate
    x, _, _, _, _, way = pull_at(batch, e, p, q, still)
    w, size, f, yields = left_at(batch, e, p, q, at, u, n)
    return still, (x, w, size, f, yields, way)


@formula
def rubbed_by(ground, here, pull, dr, du, dn, own, dd):
    """What the friction at a point changes by as it moves and numbers change."""
    x, w, size, f, slips, way = pull
    dx = both(ground[STICK], dr, ground[DRAG], du)
    dx = both(1.0, dx, 1.0, both(own[STICK], way, own[DRAG], here[1]))
    dT = rubbed(w, size, f, slips, along_ground(here[3], x, dn, dx), 0.0)
    return both(1.0, dT, 0.0 if slips else -dd, w)


@formula
def add_change(batch, e, p, force, change, shaped, lam, rates, out):
    """Add a change of the force at point p of row e, and where the force itself acts otherwise."""
    count, weights = batch.base.shape[1], batch.grounds.size + batch.diameter.size
    point = e * batch.weight.shape[1] + p
    first, more = weights + batch.weight.size + point * count, rates[weights + point]
    for k in range(count):
        i, s, w = batch.base[e, k], batch.shape[e, p, k], batch.weight[e, p]
        if i >= 0:
            moved = more * s + w * rates[first + k] if shaped else 0.0
            for c in range(3):
                out[i + c] -= lam * (w * s * change[c] + moved * force[c])


@inline_kernel
def ground_changes(batch, q, v, a, rates, kinds, begin, out, ws):
    """See :func:`ancf.compiled.add_changes`."""
    of_each, columns = rates.shape[0] // begin.shape[0], batch.grounds.shape[1]
    for e in range(batch.base.shape[0]):
        lam, k = stretch_at(batch, e, q), batch.ground[e]
        for p in range(batch.weight.shape[1]):
            here = pressed_at(batch, e, p, q, v)
            n, N, rubs = here[3], here[4], batch.limit[e, p] != 0.0
            if N == 0.0 and not rubs:
                continue
            pull = pull_at(batch, e, p, q, here)
            force = both(N, n, -pull[3] if rubs else 0.0, pull[1])
            for m in range(begin.shape[0]):
                of, shaped, dT = rates[m * of_each : (m + 1) * of_each], kinds[m] != 0, (0.0, 0.0, 0.0)
                own, dd = of[columns * k : columns * (k + 1)], of[batch.grounds.size + e]
                dr, du, dn, dN = moved_at(batch, e, p, q, v, here, shaped, own, dd, of)
                if rubs:
                    dT = rubbed_by(batch.grounds[k], here, pull, dr, du, dn, own, dd)
                change = both_forces(n, N, dn, dN, dT)
                add_change(batch, e, p, force, change, shaped, lam, of, out[begin[m] :])


@inline_kernel
def ground_memory_changes(batch, q, v, rates, kinds, begin, out, ws):
    """See :func:`ancf.compiled.add_memory_changes`."""
    of_each, columns = rates.shape[0] // begin.shape[0], batch.grounds.shape[1]
    for e in range(batch.base.shape[0]):
        k, d = batch.ground[e], batch.diameter[e]
        ground = batch.grounds[k]
        for p in range(batch.weight.shape[1]):
            here, (anchor, limit) = pressed_at(batch, e, p, q, v), places_of(batch, e, p)
            N, (still, pull) = here[4], left_of(batch, e, p, q, here)
            goes_along = N == 0.0 or batch.limit[e, p] == 0.0
            for m in range(begin.shape[0]):
                of, shaped, z = rates[m * of_each : (m + 1) * of_each], kinds[m] != 0, out[begin[m] :]
                if goes_along and not shaped and N == 0.0:
                    continue
                own, dd = of[columns * k : columns * (k + 1)], of[batch.grounds.size + e]
                dr, _, dn, dN = moved_at(batch, e, p, q, v, here, shaped, own, dd, of)
                z[LANES * limit] += own[FRICTION] * N + ground[FRICTION] * dN
                if pull[4] and not goes_along:
                    dT = rubbed_by(ground, still, pull, dr, ZERO, dn, own, dd)
                    shorter = pull[3] * (dd / d + own[STICK] / ground[STICK])
                    dr = both(1.0, dr, 1.0 / (d * ground[STICK]), both(1.0, dT, shorter, pull[1]))
                if pull[4] or goes_along:
                    for c in range(3):
                        z[LANES * (anchor + c)] += dr[c]
