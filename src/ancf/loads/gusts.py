"""Speed of gusts at a place and a time from their table, see :class:`ancf.model.surroundings.gusts.Gusts`."""

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
def between(squall, gale, t, x, y, z):
    """The station before a place, its share of the way to the next, and whether it is between the outer ones.

    Also times before and after, four of them, and the share of the way from the second to the third.
    """
    along = squall[LINE] * x + squall[LINE + 1] * y + squall[LINE + 2] * z
    s = (along - squall[BEGIN]) / squall[APART]
    times, stations = gale[TIMES], gale[STATIONS]
    inside = 0.0 < s < stations - 1.0
    s = min(max(s, 0.0), stations - 1.0)
    k = min(int(s), stations - 2)
    steps = t / squall[STEP]
    j = math.floor(steps)
    rows = (int(j) - 1) % times, int(j) % times, (int(j) + 1) % times, (int(j) + 2) % times
    return k, s - k, inside, rows, steps - j


@inline_kernel
def at_station(gale, gust, station, rows, into):
    """Speed and slope by time, in steps of the table, at a station."""
    at, n = gale[FIRST] + station, gale[STATIONS]
    i, j, k, m = rows
    return cubic(gust[at + i * n], gust[at + j * n], gust[at + k * n], gust[at + m * n], into)


@inline_kernel
def gust_at(squall, gale, gust, t, x, y, z):
    """Speed over the mean and its rate at a time and a place."""
    k, s, _, rows, into = between(squall, gale, t, x, y, z)
    value, rate = 0.0, 0.0
    for m in range(2):
        w = s if m == 1 else 1.0 - s
        u, du = at_station(gale, gust, k + m, rows, into)
        value += w * u
        rate += w * du / squall[STEP]
    share, growth = share_of(t, squall[RAMP])
    return share * value, share * rate + growth * value


@inline_kernel
def gust_along(squall, gale, gust, t, x, y, z):
    """Derivatives of both along the line of the stations."""
    k, _, inside, rows, into = between(squall, gale, t, x, y, z)
    if not inside:
        return 0.0, 0.0
    u, du = at_station(gale, gust, k, rows, into)
    v, dv = at_station(gale, gust, k + 1, rows, into)
    share, growth = share_of(t, squall[RAMP])
    value, rate = (v - u) / squall[APART], (dv - du) / (squall[APART] * squall[STEP])
    return share * value, share * rate + growth * value
