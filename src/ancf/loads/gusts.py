"""Speed of gusts at a place and a time from their table, see :class:`ancf.model.gusts.Gusts`."""

from __future__ import annotations

import math

import numpy as np

from ..compiled import inline_kernel
from .waves import share_of

# columns of ``squall``: step, first station, distance of stations, ramp, where the wind blows, the line
STEP, BEGIN, APART, RAMP, TO_X, TO_Y, LINE = 0, 1, 2, 3, 4, 5, 6
# columns of ``gale``: first number of the table, times, stations (0: none)
FIRST, TIMES, STATIONS = range(3)


def tables(items):
    """Fields ``squall``, ``gale``, ``gust`` of the batch of these fluids."""
    squall, gale, found = np.zeros((len(items), 9)), np.zeros((len(items), 3), dtype=np.int64), [np.zeros(0)]
    for row, size, item in zip(squall, gale, items, strict=True):
        gusts = item.gusts
        if gusts is not None:
            v, s = gusts.values, gusts.stations
            to = math.cos(v["direction"]), math.sin(v["direction"])
            row[:] = v["step"], s[0], s[1] - s[0], v["ramp"], *to, *v["line"]
            size[:] = sum(map(len, found)), *gusts.table.shape
            found.append(gusts.table.ravel())
    return {"squall": squall, "gale": gale, "gust": np.concatenate(found)}


@inline_kernel
def cubic(a, b, c, d, s):
    """Value and slope at s of the way from b to c, with the slopes of neighbours (Catmull and Rom)."""
    c1, c2, c3 = 0.5 * (c - a), a - 2.5 * b + 2.0 * c - 0.5 * d, 0.5 * (d - a) + 1.5 * (b - c)
    return b + s * (c1 + s * (c2 + s * c3)), c1 + s * (2.0 * c2 + 3.0 * c3 * s)


@inline_kernel
def gust_at(squall, gale, gust, t, x, y, z):
    """Speed over the mean and its rate at a time and a place."""
    along = squall[LINE] * x + squall[LINE + 1] * y + squall[LINE + 2] * z
    s = (along - squall[BEGIN]) / squall[APART]
    times, stations = gale[TIMES], gale[STATIONS]
    s = min(max(s, 0.0), stations - 1.0)
    k = min(int(s), stations - 2)
    s -= k
    steps = t / squall[STEP]
    j = math.floor(steps)
    into = steps - j
    j0, j1, j2, j3 = (int(j) - 1) % times, int(j) % times, (int(j) + 1) % times, (int(j) + 2) % times
    first = gale[FIRST] + k
    value, rate = 0.0, 0.0
    for m in range(2):
        w = s if m == 1 else 1.0 - s
        at = first + m
        u, du = cubic(
            gust[at + j0 * stations],
            gust[at + j1 * stations],
            gust[at + j2 * stations],
            gust[at + j3 * stations],
            into,
        )
        value += w * u
        rate += w * du / squall[STEP]
    share, growth = share_of(t, squall[RAMP])
    return share * value, share * rate + growth * value
