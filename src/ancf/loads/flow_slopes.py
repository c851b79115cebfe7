"""How the motion of a fluid changes with the place, for derivatives of its forces in a step of time.

Profiles, gusts and waves are known; of laws that users give, and of their rates, differences of order four
are taken.  All of it is kept for the corrections of one step, where the place is the same to the last bit.
"""

from __future__ import annotations

import math

from ..compiled import formula, inline_kernel
from . import gusts
from .flow import ACCELERATION, CLOCK, VELOCITY, by_profile, carried
from .waves import ALONG_X, ALONG_Y, PLACE, RATE, RISE, SPEED, TIME, sea_at, sea_slopes

# columns of ``felt``: those of what waves keep, then derivatives of velocity and acceleration by the place,
# row by row, of the elevation by x and y, and room; velocity and acceleration of the point for which the
# derivatives of the three components of the force by place, slope and these two stand behind them
BY_PLACE, RATE_BY_PLACE, RISE_BY_X, RISE_BY_Y, ROOM = 11, 20, 29, 30, 31
MOVING, FORCES = 40, 46
FELT = 82
#: Step of the differences of laws, m, and their weights.
NEAR, ONE, TWO = 1e-3, 8.0 / 12.0, -1.0 / 12.0


@inline_kernel
def add_law(batch, e, p, k, at, v, felt):
    """Add what profile and law of fluid k do; both by differences, as one carries the other."""
    speed, rate = carried(batch, e, p, k, at, v)
    for i in range(3):
        felt[SPEED + i] += speed[i]
        felt[RATE + i] += rate[i]
    for j in range(3):
        for m in range(4):
            side = m - 2.0 if m < 2 else m - 1.0
            weight = (TWO if m == 0 or m == 3 else ONE) * (1.0 if m > 1 else -1.0) / NEAR
            d = side * NEAR
            x, y, z = at[0] + (d if j == 0 else 0.0), at[1] + (d if j == 1 else 0.0), at[2]
            speed, rate = carried(batch, e, p, k, (x, y, z + (d if j == 2 else 0.0)), v)
            for i in range(3):
                felt[BY_PLACE + 3 * i + j] += weight * speed[i]
                felt[RATE_BY_PLACE + 3 * i + j] += weight * rate[i]


@formula
def add_profile(batch, k, z, felt):
    """Add what is the same everywhere, and the profile of fluid k."""
    now, speed, shear = batch.value[k], (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    if batch.first[k + 1] > batch.first[k]:
        speed, shear = by_profile(batch, k, z)
    up = now[VELOCITY, 2] + speed[2]
    for i in range(3):
        felt[SPEED + i] += now[VELOCITY, i] + speed[i]
        felt[RATE + i] += now[ACCELERATION, i] + up * shear[i]
        felt[BY_PLACE + 3 * i + 2] += shear[i]
        felt[RATE_BY_PLACE + 3 * i + 2] += shear[2] * shear[i]


@inline_kernel
def add_gusts(batch, k, t, at, felt):
    """Add gusts: they change along their line, from one station to the next alike."""
    squall, gale = batch.squall[k], batch.gale[k]
    speed, rate = gusts.gust_at(squall, gale, batch.gust, t, at[0], at[1], at[2])
    more, faster = gusts.gust_along(squall, gale, batch.gust, t, at[0], at[1], at[2])
    for i in range(2):
        to = squall[gusts.TO_X + i]
        felt[SPEED + i] += speed * to
        felt[RATE + i] += rate * to
        for j in range(3):
            felt[BY_PLACE + 3 * i + j] += more * to * squall[gusts.LINE + j]
            felt[RATE_BY_PLACE + 3 * i + j] += faster * to * squall[gusts.LINE + j]


@inline_kernel
def put_waves(batch, k, own, t, at, felt):
    """Begin with the waves of fluid k, or with the elevation alone if they are those of another one."""
    sea, room = batch.sea[k], felt[ROOM:]
    first, last = batch.waves[k], batch.waves[k + 1]
    sea_at(sea, batch.wave, first, last, batch.angle, t, at[0], at[1], at[2], felt)
    sea_slopes(sea, batch.wave, first, last, batch.angle, felt, room)
    felt[RISE_BY_X], felt[RISE_BY_Y] = room[8] * sea[ALONG_X], room[8] * sea[ALONG_Y]
    if not own:
        for i in range(SPEED, RISE):
            felt[i] = 0.0
        return
    for n in range(2):
        of = BY_PLACE if n == 0 else RATE_BY_PLACE
        u, w, u_up, w_up = room[4 * n], room[4 * n + 1], room[4 * n + 2], room[4 * n + 3]
        for i in range(2):
            to = sea[ALONG_X + i]
            felt[of + 3 * i], felt[of + 3 * i + 1] = u * to * sea[ALONG_X], u * to * sea[ALONG_Y]
            felt[of + 3 * i + 2], felt[of + 6 + i] = u_up * to, w * to
        felt[of + 8] = w_up


@inline_kernel
def feel(batch, e, p, k, at, v):
    """Let ``felt`` hold what fluid k does at point p of row e, in a step of time, and its slopes.

    Whether it did not before: then ``angle`` is that of the point.
    """
    felt, t = batch.felt[e, p], batch.value[k, CLOCK, 0]
    same = felt[PLACE] == at[0] and felt[PLACE + 1] == at[1] and felt[PLACE + 2] == at[2]
    if same and felt[TIME] == t:
        return False
    for i in range(FELT):
        felt[i] = 0.0
    felt[MOVING] = math.inf
    own = batch.waves[k + 1] > batch.waves[k]
    if own or batch.under[k] >= 0:
        put_waves(batch, k if own else batch.under[k], own, t, at, felt)
    felt[TIME], felt[PLACE], felt[PLACE + 1], felt[PLACE + 2] = t, at[0], at[1], at[2]
    if batch.law[k] != 0:
        add_law(batch, e, p, k, at, v, felt)
    else:
        add_profile(batch, k, at[2], felt)
    if batch.gale[k, gusts.STATIONS] > 0:
        add_gusts(batch, k, t, at, felt)
    return True
