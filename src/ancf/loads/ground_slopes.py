"""Derivatives of x . force of grounds by the state and by numbers, and what friction remembers, backwards.

These are the transposed ones of :mod:`ancf.loads.ground_along` and :mod:`ancf.loads.ground_numbers`.  With
derivatives y_T, y_N and y_n of a number by the friction T, the normal force N and the normal n of a point,

    y_w = -d y_T  of what sticks,    -L/|w| (y_T - w (w.y_T)/w^2),  y_L = -(w.y_T)/|w|  of what slips,
    y_x = P y_w,    y_n += -(n.y_w) x - (x.n) y_w,

it has k_t y_x + ... by the place, c_t y_x + ... by the velocity and -k_t y_x by the anchor; by depth and its
rate N_g y_N and N_g' y_N.  On a table of heights the normal n = (-z_x, -z_y, 1) b, b = (1 + z_x^2 +
z_y^2)^-1/2, changes with the place: z_x with y and z_y with x.
"""

from __future__ import annotations

import math

from ..compiled import formula, inline_kernel
from ..vectors import both, dot
from .along import place_at
from .ground_along import places_of
from .ground_numbers import left_of, pull_at
from .ground_points import pressed_at
from .relief import DAMPING, DRAG, FRICTION, NORMAL, PLACE, SOFT, STICK, STIFFNESS, twist_at

ZERO = (0.0, 0.0, 0.0)


@formula
def pulled_back(pull, n, by_T):
    """Derivatives by x, n, the limit and the diameter from those by the friction -f w."""
    x, w, size, f, slips, _ = pull
    along = dot(w, by_T)
    by_w, by_L, by_d = both(-f, by_T, 0.0, w), 0.0, -along
    if slips:
        by_w, by_L, by_d = both(1.0, by_w, f * along / (size * size), w), -along / size, 0.0
    by_x = both(1.0, by_w, -dot(n, by_w), n)
    return by_x, both(-dot(n, by_w), x, -dot(x, n), by_w), by_L, by_d


@formula
def pressed_back(batch, e, here, by_N, by_n):
    """Derivatives by place and velocity, and by n, from those by N and by n."""
    at, u, g, n, _, by_depth, by_speed = here
    by_g, by_rate = by_N * by_depth, by_N * by_speed
    by_n = both(1.0, by_n, -by_rate, u)
    fx, fy, fz = -by_g * n[0], -by_g * n[1], -by_g * n[2]
    zx, zy, twist = twist_at(batch, batch.ground[e], at[0], at[1])
    if twist != 0.0:
        b = 1.0 / math.sqrt(1.0 + zx * zx + zy * zy)
        by_b = by_n[2] - zx * by_n[0] - zy * by_n[1] + by_g * g / b
        by_zx, by_zy = -b * by_n[0] - b * b * b * zx * by_b, -b * by_n[1] - b * b * b * zy * by_b
        fx, fy = fx + twist * by_zy, fy + twist * by_zx
    return (fx, fy, fz), both(-by_rate, n, 0.0, n), by_n


@formula
def back_at(batch, e, here, pull, rubs, damps, by_T, by_N, by_n):
    """Derivatives at a point by r, u, x and n, and by the limit and, through friction, the diameter.

    ``damps``: 1, or 0 of the spring alone.
    """
    by_x, by_L, by_d = ZERO, 0.0, 0.0
    if rubs:
        by_x, more, by_L, by_d = pulled_back(pull, here[3], by_T)
        by_n = both(1.0, by_n, 1.0, more)
    by_r, by_u, by_n = pressed_back(batch, e, here, by_N, by_n)
    if rubs:
        ground = batch.grounds[batch.ground[e]]
        by_r, by_u = both(1.0, by_r, ground[STICK], by_x), both(1.0, by_u, damps * ground[DRAG], by_x)
    return by_r, by_u, by_x, by_n, by_L, by_d


@formula
def worked_at(batch, e, p, q, here, X):
    """The same of the work that the force of a point does on X."""
    n, N, rubs, w = here[3], here[4], batch.limit[e, p] != 0.0, -batch.weight[e, p]
    by_f = both(w, X, 0.0, X)
    pull = pull_at(batch, e, p, q, here)
    return pull, back_at(batch, e, here, pull, rubs, 1.0, by_f, dot(n, by_f), both(N, by_f, 0.0, by_f))


@formula
def add_at(batch, e, p, factor, by_r, by_u, by_q, by_v):
    """Add derivatives by place and velocity of a point, times a factor, to those by the unknowns."""
    for m in range(batch.base.shape[1]):
        i, s = batch.base[e, m], factor * batch.shape[e, p, m]
        if i >= 0:
            for c in range(3):
                by_q[i + c] += s * by_r[c]
                by_v[i + c] += s * by_u[c]


@inline_kernel
def ground_work_slopes(batch, q, v, a, x, by_q, by_v, by_a, ws):
    """See :func:`ancf.compiled.add_work_slopes`."""
    for e in range(batch.base.shape[0]):
        for p in range(batch.weight.shape[1]):
            here = pressed_at(batch, e, p, q, v)
            if here[4] == 0.0 and batch.limit[e, p] == 0.0:
                continue
            _, (by_r, by_u, _, _, _, _) = worked_at(batch, e, p, q, here, place_at(batch, e, p, x))
            add_at(batch, e, p, 1.0, by_r, by_u, by_q, by_v)


@formula
def add_numbers(batch, e, factor, here, pull, damps, by_N, by_x, by_n, by_d, out):
    """Add derivatives by the numbers of a ground and the diameter, times a factor; see :func:`back_at`."""
    at, u, g, n, N, by_depth, _ = here
    k, d, rate = batch.ground[e], batch.diameter[e], -dot(here[1], here[3])
    ground, own = batch.grounds[k], out[batch.grounds.shape[1] * k :]
    own[STICK] += factor * dot(pull[5], by_x)
    own[DRAG] += damps * factor * dot(u, by_x)
    if N > 0.0:
        on = min(1.0, 1.0 + g / (SOFT * d))
        own[STIFFNESS] += factor * by_N * d * g
        own[DAMPING] += factor * by_N * d * on * rate
        by_d += by_N * N / d
        if g < 0.0:  # the height over which damping comes on goes with the diameter
            by_d -= by_N * ground[DAMPING] * rate * g / (SOFT * d)
    out[batch.grounds.size + e] += factor * by_d
    if batch.size[k, 0] == 0:
        by_g = factor * by_N * by_depth
        for c in range(3):
            own[PLACE + c] += by_g * n[c]
            own[NORMAL + c] += by_g * (ground[PLACE + c] - at[c]) + factor * by_n[c]


@formula
def add_factors(batch, e, p, factor, q, v, by_r, by_u, out):
    """Add derivatives by the factors of a point, times a factor, from those by its place and velocity."""
    first = batch.grounds.size + batch.diameter.size + batch.weight.size
    first += (e * batch.weight.shape[1] + p) * batch.base.shape[1]
    for m in range(batch.base.shape[1]):
        i = batch.base[e, m]
        if i >= 0:
            found = by_r[0] * q[i] + by_r[1] * q[i + 1] + by_r[2] * q[i + 2]
            found += by_u[0] * v[i] + by_u[1] * v[i + 1] + by_u[2] * v[i + 2]
            out[first + m] += factor * found


@inline_kernel
def ground_number_work(batch, q, v, a, x, out, ws):
    """See :func:`ancf.compiled.add_number_work`."""
    weights = batch.grounds.size + batch.diameter.size
    for e in range(batch.base.shape[0]):
        for p in range(batch.weight.shape[1]):
            here, rubs = pressed_at(batch, e, p, q, v), batch.limit[e, p] != 0.0
            n, N = here[3], here[4]
            if N == 0.0 and not rubs:
                continue
            X = place_at(batch, e, p, x)
            pull, (by_r, by_u, by_x, by_n, _, by_d) = worked_at(batch, e, p, q, here, X)
            by_N = -batch.weight[e, p] * dot(n, X)
            add_numbers(batch, e, 1.0, here, pull, 1.0, by_N, by_x, by_n, by_d, out)
            f = both(N, n, -pull[3] if rubs else 0.0, pull[1])
            out[weights + e * batch.weight.shape[1] + p] -= dot(f, X)
            add_factors(batch, e, p, 1.0, q, v, by_r, by_u, out)
            add_factors(batch, e, p, -batch.weight[e, p], x, v, f, ZERO, out)


@inline_kernel
def ground_memory_work(batch, q, v, x, z, ws):
    """See :func:`ancf.compiled.take_memory_work`."""
    for e in range(batch.base.shape[0]):
        stick = batch.grounds[batch.ground[e], STICK]
        for p in range(batch.weight.shape[1]):
            if batch.limit[e, p] == 0.0:
                continue
            anchor, limit = places_of(batch, e, p)
            here = pressed_at(batch, e, p, q, v)
            _, (_, _, by_x, _, by_L, _) = worked_at(batch, e, p, q, here, place_at(batch, e, p, x))
            for c in range(3):
                z[anchor + c] += stick * by_x[c]
            z[limit] -= by_L


@inline_kernel
def ground_memory_back(batch, q, v, z, by_q, by_v, numbers, ws):
    """See :func:`ancf.compiled.take_memory_back`."""
    for e in range(batch.base.shape[0]):
        ground, d = batch.grounds[batch.ground[e]], batch.diameter[e]
        own, stiff = numbers[batch.grounds.shape[1] * batch.ground[e] :], d * ground[STICK]
        for p in range(batch.weight.shape[1]):
            anchor, limit = places_of(batch, e, p)
            left, by_L = (z[anchor], z[anchor + 1], z[anchor + 2]), z[limit]
            if left == ZERO and by_L == 0.0:
                continue
            here = pressed_at(batch, e, p, q, v)
            N = here[4]
            if N == 0.0:
                add_at(batch, e, p, -1.0, left, ZERO, by_q, by_v)
                add_factors(batch, e, p, -1.0, q, v, left, ZERO, numbers)
                for c in range(3):
                    z[anchor + c] = 0.0
                z[limit] = 0.0
                continue
            (_, pull), by_N = left_of(batch, e, p, q, here), ground[FRICTION] * by_L
            own[FRICTION] -= N * by_L
            yields = pull[4]
            by_T = both(1.0 / stiff, left, 0.0, left) if yields else ZERO
            found = back_at(batch, e, here, pull, yields, 0.0, by_T, by_N, ZERO)
            by_r, by_u, by_x, by_n, by_L, by_d = found
            if yields:
                by_r = both(1.0, by_r, 1.0, left)
                shorter = pull[3] * dot(pull[1], left) / stiff
                by_d += shorter / d
                own[STICK] -= shorter / ground[STICK]
            add_at(batch, e, p, -1.0, by_r, by_u, by_q, by_v)
            add_numbers(batch, e, -1.0, here, pull, 0.0, by_N, by_x, by_n, by_d, numbers)
            add_factors(batch, e, p, -1.0, q, v, by_r, by_u, numbers)
            for c in range(3):
                z[anchor + c] = -ground[STICK] * by_x[c] + (0.0 if yields else left[c])
            z[limit] = by_L
