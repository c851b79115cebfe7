"""Depth below a ground, a plane or a table of heights, and how it presses; see :mod:`ancf.loads.ground`."""

from __future__ import annotations

import math

from ..compiled import formula, inline_kernel

# columns of ``grounds``: a point of the plane, its normal, k, c, mu, k_t, c_t
PLACE, NORMAL, STIFFNESS, DAMPING, FRICTION, STICK, DRAG = 0, 3, 6, 7, 8, 9, 10
#: Height in diameters over which damping comes on.
SOFT = 0.01


@inline_kernel
def interval(table, first, count, x):
    """The place k of x between the numbers ``table[first:first + count]``, and its share of the way on."""
    if x <= table[first]:
        return 0, 0.0, 0.0
    if x >= table[first + count - 1]:
        return count - 2, 1.0, 0.0
    a, b = first, first + count - 1
    while b - a > 1:
        middle = (a + b) // 2
        if table[middle] <= x:
            a = middle
        else:
            b = middle
    length = table[a + 1] - table[a]
    return a - first, (x - table[a]) / length, 1.0 / length


@formula
def depth_at(batch, k, x, y, z):
    """Depth of a place below ground k and its normal there."""
    ground = batch.grounds[k]
    nx, ny, first = batch.size[k, 0], batch.size[k, 1], batch.size[k, 2]
    if nx == 0:
        n = ground[NORMAL], ground[NORMAL + 1], ground[NORMAL + 2]
        return (ground[PLACE] - x) * n[0] + (ground[PLACE + 1] - y) * n[1] + (ground[PLACE + 2] - z) * n[2], n
    i, s, ds = interval(batch.table, first, nx, x)
    j, t, dt = interval(batch.table, first + nx, ny, y)
    at = first + nx + ny + i * ny + j
    z00, z01, z10, z11 = batch.table[at], batch.table[at + 1], batch.table[at + ny], batch.table[at + ny + 1]
    low, high = z00 + t * (z01 - z00), z10 + t * (z11 - z10)
    zx, zy = (high - low) * ds, ((1.0 - s) * (z01 - z00) + s * (z11 - z10)) * dt
    c = 1.0 / math.sqrt(1.0 + zx * zx + zy * zy)
    return (low + s * (high - low) - z) * c, (-zx * c, -zy * c, c)


@formula
def pressure(ground, d, g, rate):
    """Normal force N per length and its derivatives by g and by the rate of g."""
    soft = SOFT * d
    on = min(1.0, 1.0 + g / soft)
    if on <= 0.0:
        return 0.0, 0.0, 0.0
    N = ground[STIFFNESS] * g + ground[DAMPING] * on * rate
    if N <= 0.0:
        return 0.0, 0.0, 0.0
    slope = ground[STIFFNESS] + (max(ground[DAMPING] * rate, 0.0) / soft if on < 1.0 else 0.0)
    return d * N, d * slope, d * ground[DAMPING] * on


@formula
def twist_at(batch, k, x, y):
    """Slopes of a table of heights along x and y, and the derivative of each by the other; of a plane 0."""
    nx, ny, first = batch.size[k, 0], batch.size[k, 1], batch.size[k, 2]
    if nx == 0:
        return 0.0, 0.0, 0.0
    i, s, ds = interval(batch.table, first, nx, x)
    j, t, dt = interval(batch.table, first + nx, ny, y)
    at = first + nx + ny + i * ny + j
    z00, z01, z10, z11 = batch.table[at], batch.table[at + 1], batch.table[at + ny], batch.table[at + ny + 1]
    low, high = z00 + t * (z01 - z00), z10 + t * (z11 - z10)
    zx, zy = (high - low) * ds, ((1.0 - s) * (z01 - z00) + s * (z11 - z10)) * dt
    return zx, zy, (z11 - z10 - z01 + z00) * ds * dt
