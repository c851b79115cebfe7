"""What a fluid does at a place: its velocity and acceleration by all that moves it, and its surface."""

from __future__ import annotations

import math

from ..compiled import formula, inline_kernel
from ..model.surroundings.velocity_field import STEP
from . import gusts
from .state_force import call
from .waves import RATE, RISE, SPEED, renew_waves

# columns of ``fluids``: density, heights between which it is, gravity
DENSITY, LOW, HIGH, GRAVITY = 0, 1, 2, 3
# columns of ``data``: area, diameter, factors of the drag without the density, coefficients of added mass
AREA, DIAMETER, DRAG_N, DRAG_T, MASS_N, MASS_T = range(6)
# columns of ``said``: time, velocity, acceleration
SAID_TIME, SAID_SPEED, SAID_RATE = 0, 1, 4
SAID = 7
# rows of ``value``: velocity and acceleration of what is the same everywhere, and the clock (t, share, 0)
VELOCITY, ACCELERATION, CLOCK = range(3)
#: Speed below which drag is taken as smooth by matrices, m/s.
STILL = 1e-12


@formula
def below(z, rise, height):
    """Share of a piece around z with this rise that is below a height, and minus its derivative by z."""
    if z + 0.5 * rise <= height:
        return 1.0, 0.0
    if z - 0.5 * rise >= height:
        return 0.0, 0.0
    return 0.5 + (height - z) / rise, 1.0 / rise


@formula
def wetted(batch, e, p, z, t, size, rise):
    """Share of the piece of point p inside its fluid, whose waves rise that high; the derivative by z."""
    k = batch.fluid[e]
    low, high = batch.fluids[k, LOW], batch.fluids[k, HIGH]
    if low == -math.inf and high == math.inf:
        return 1.0, 0.0
    if batch.under[k] >= 0:
        low += rise
    else:
        high += rise
    level = math.sqrt(max(1.0 - t[2] * t[2], 0.0))
    tall = batch.weight[e, p] * size * abs(t[2]) + batch.data[e, DIAMETER] * level
    middle = z + batch.shift[e, p] * size * t[2]
    top, dtop = below(middle, tall, high)
    bottom, dbottom = below(middle, tall, low)
    return top - bottom, dbottom - dtop


@inline_kernel
def by_law(batch, k, time, x, y, z):
    """Velocity of fluid k by its law."""
    batch.numbers[0], batch.numbers[1], batch.numbers[2] = x, y, z
    call(batch.law[k], time, batch.numbers.ctypes.data)
    return batch.numbers[6], batch.numbers[7], batch.numbers[8]


@formula
def by_profile(batch, k, z):
    """Velocity of fluid k by its profile, and how it changes with the height."""
    a, b = batch.first[k], batch.first[k + 1] - 1
    while b - a > 1:
        middle = (a + b) // 2
        if batch.heights[middle] <= z:
            a = middle
        else:
            b = middle
    c = 1.0 / (batch.heights[b] - batch.heights[a])
    s = (z - batch.heights[a]) * c
    c = c if 0.0 < s < 1.0 else 0.0
    s = min(max(s, 0.0), 1.0)
    low, high = batch.profile[a], batch.profile[b]
    x, y, z = high[0] - low[0], high[1] - low[1], high[2] - low[2]
    return (low[0] + s * x, low[1] + s * y, low[2] + s * z), (c * x, c * y, c * z)


@inline_kernel
def along_law(batch, k, time, at, u):
    """Velocity by the law of fluid k, and its rate for a particle that moves with it and with u."""
    x, y, z = at
    lx, ly, lz = by_law(batch, k, time, x, y, z)
    dx, dy, dz = STEP * (u[0] + lx), STEP * (u[1] + ly), STEP * (u[2] + lz)
    bx, by, bz = by_law(batch, k, time - STEP, x - dx, y - dy, z - dz)
    fx, fy, fz = by_law(batch, k, time + STEP, x + dx, y + dy, z + dz)
    c = 1.0 / (2.0 * STEP)
    return (lx, ly, lz), (c * (fx - bx), c * (fy - by), c * (fz - bz))


@inline_kernel
def told(batch, e, p, k, time, at, u, v):
    """The same; of a law that is called once a step what it said first, unless the point is at rest."""
    if not batch.once[k]:
        return along_law(batch, k, time, at, u)
    said = batch.said[e, p]
    moves = v[0] != 0.0 or v[1] != 0.0 or v[2] != 0.0
    if not (moves and said[SAID_TIME] == time):
        speed, rate = along_law(batch, k, time, at, u)
        said[SAID_TIME] = time
        for i in range(3):
            said[SAID_SPEED + i], said[SAID_RATE + i] = speed[i], rate[i]
    return (
        (said[SAID_SPEED], said[SAID_SPEED + 1], said[SAID_SPEED + 2]),
        (said[SAID_RATE], said[SAID_RATE + 1], said[SAID_RATE + 2]),
    )


@formula
def carried(batch, e, p, k, at, v):
    """Velocity and acceleration of fluid k at a point now, without gusts and waves; in load steps a share."""
    now, z = batch.value[k], at[2]
    ux, uy, uz = now[VELOCITY, 0], now[VELOCITY, 1], now[VELOCITY, 2]
    ax, ay, az = now[ACCELERATION, 0], now[ACCELERATION, 1], now[ACCELERATION, 2]
    share = now[CLOCK, 1]
    if batch.first[k + 1] > batch.first[k] and share > 0.0:
        speed, shear = by_profile(batch, k, z)
        ux, uy, uz = ux + share * speed[0], uy + share * speed[1], uz + share * speed[2]
        ax, ay, az = ax + uz * shear[0], ay + uz * shear[1], az + uz * shear[2]
    if batch.law[k] != 0 and share > 0.0:
        u = ux / share, uy / share, uz / share
        speed, rate = told(batch, e, p, k, now[CLOCK, 0] / share, at, u, v)
        ux, uy, uz = ux + share * speed[0], uy + share * speed[1], uz + share * speed[2]
        ax, ay, az = ax + share * rate[0], ay + share * rate[1], az + share * rate[2]
    return (ux, uy, uz), (ax, ay, az)


@formula
def flow(batch, e, p, k, at, v):
    """Velocity, acceleration and rise of the surface of fluid k at a point now; in load steps a share."""
    now, (x, y, z) = batch.value[k], at
    (ux, uy, uz), (ax, ay, az) = carried(batch, e, p, k, at, v)
    share = now[CLOCK, 1]
    if batch.gale[k, gusts.STATIONS] > 0 and share > 0.0:
        squall = batch.squall[k]
        speed, rate = gusts.gust_at(squall, batch.gale[k], batch.gust, now[CLOCK, 0] / share, x, y, z)
        to_x, to_y = share * squall[gusts.TO_X], share * squall[gusts.TO_Y]
        ux, uy, ax, ay = ux + speed * to_x, uy + speed * to_y, ax + rate * to_x, ay + rate * to_y
    rise, own = 0.0, batch.waves[k + 1] > batch.waves[k]
    if (own or batch.under[k] >= 0) and share > 0.0:
        renew_waves(batch, e, p, k if own else batch.under[k], now[CLOCK, 0] / share, at, v)
        w = batch.kept[e, p]
        rise = share * w[RISE]
        if own:
            ux, uy, uz = ux + share * w[SPEED], uy + share * w[SPEED + 1], uz + share * w[SPEED + 2]
            ax, ay, az = ax + share * w[RATE], ay + share * w[RATE + 1], az + share * w[RATE + 2]
    return (ux, uy, uz), (ax, ay, az), rise


@formula
def apart(w, t):
    """Part of w along t, its normal part and the size of that."""
    wt = w[0] * t[0] + w[1] * t[1] + w[2] * t[2]
    n = w[0] - wt * t[0], w[1] - wt * t[1], w[2] - wt * t[2]
    return wt, n, math.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
