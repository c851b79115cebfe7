"""Forces of fluids by Morison's formula, per reference length, on points along bodies.

With t the unit tangent, w = v_f - v the velocity of the fluid past the point, n the part normal to t,

    f = -rho A g                                       buoyancy: the displaced weight
      + rho d/2 C_Dn |w_n| w_n + rho pi d/2 C_Dt |w_t| w_t          drag; the tangential one on the surface
      + rho A (1 + C_An) a_f,n + rho A (1 + C_At) a_f,t              Froude-Krylov and inertia of the fluid
      - rho A C_An a_n - rho A C_At a_t                              added mass.

a_f is the rate of the velocity of a particle, dv_f/dt + (v_f . grad) v_f, of waves and gusts its first
part.  d and A = pi d^2/4 are those of the section whatever the stretch.  Of a piece that a surface cuts the
part that is inside counts: its height is the rise of its length and of its diameter, and it fills it evenly.

All of it is the work of a load, the kinetic energy of the water that is carried along included.  The matrix
leaves out how drag changes as the piece turns, but in an equilibrium, where nothing else may hold it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import Role, formula, implements, inline_kernel
from ..model.beam import Beam
from ..model.fluids import STEP, require_section
from . import gusts
from .along import (
    acceleration_at,
    add_block_along,
    add_material,
    add_slope_block_along,
    along,
    joined,
    place_at,
    stretch_at,
    tangent_at,
    velocity_at,
    wound,
)
from .law_functions import address_of
from .state_force import call
from .waves import KEPT, RATE, RISE, SPEED, TIME, renew_waves, tables, under

#: Gauss points of an element.
POINTS = 5
# columns of ``fluids``: density, heights between which it is, gravity
DENSITY, LOW, HIGH, GRAVITY = 0, 1, 2, 3
# columns of ``data``: area, diameter, factors of the drag without the density, coefficients of added mass
AREA, DIAMETER, DRAG_N, DRAG_T, MASS_N, MASS_T = range(6)
# columns of ``said``: time, velocity, acceleration
SAID_TIME, SAID_SPEED, SAID_RATE = 0, 1, 4
SAID = 7
# rows of ``value``: velocity and acceleration of what is the same everywhere, and the clock (t, share, 0)
VELOCITY, ACCELERATION, CLOCK = range(3)
#: Speed below which drag is taken as smooth by the matrix, m/s.
STILL = 1e-12


class FluidBatch(NamedTuple):
    """All elements in all fluids."""

    base: NDArray[np.int64]  # (n, k)
    dest: NDArray[np.int64]  # (n, k*k)
    shape: FloatArray  # (n, points, k)
    slope: FloatArray  # (n, points, k)
    weight: FloatArray  # (n, points) m
    shift: FloatArray  # (n, points) m
    winch: NDArray[np.int64]  # (n,) see loads/along.py
    unwound: FloatArray  # (n,) 1/m
    passing: FloatArray  # (n, points, k)
    twice: FloatArray  # (n, points, k)
    fluid: NDArray[np.int64]  # (n,) which fluid
    data: FloatArray  # (n, 6) columns AREA ... MASS_T
    fluids: FloatArray  # (m, 6) columns DENSITY ... GRAVITY
    law: NDArray[np.int64]  # (m,) address of the law of the velocity, 0: none
    once: NDArray[np.bool_]  # (m,) it is called once a step
    said: FloatArray  # (n, points, SAID) what such a law said last; no rows where there is none
    first: NDArray[np.int64]  # (m + 1,) first height of the profile
    heights: FloatArray  # (j,)
    profile: FloatArray  # (j, 3)
    moves: NDArray[np.bool_]  # (m,)
    under: NDArray[np.int64]  # (m,) the fluid whose waves are its lower surface, -1: none
    sea: FloatArray  # (m, 7) see loads/waves.py
    waves: NDArray[np.int64]  # (m + 1,) first chunk of components
    wave: FloatArray  # (chunks, 6, LANES) components
    angle: FloatArray  # (2, most chunks, LANES) scratch memory
    kept: FloatArray  # (n, points, KEPT) what waves gave last
    squall: FloatArray  # (m, 9) see loads/gusts.py
    gale: NDArray[np.int64]  # (m, 3) places and sizes of the tables of gusts
    gust: FloatArray  # (j,) tables of gusts, one after the other
    numbers: FloatArray  # (9,) scratch memory of the laws
    value: FloatArray  # (m, 3, 3) inputs now


def build(items, locate, value, model):
    """Batch of these fluids; ModelError if a section lacks what they need."""
    parts, rows, which, everybody = [], [], [], []
    for k, item in enumerate(items):
        bodies = [body for name, body in model.bodies.items() if item.acts_on(name) and _takes_part(body)]
        for body in bodies:
            if isinstance(body, Beam):
                require_section(item, body, ("diameter", "drag"))
        found, owners = along(bodies, locate, POINTS)
        parts.append(found)
        everybody += bodies
        rows += [_data(body) for body in owners]
        which += [k] * len(owners)
    heights = [item.velocity.heights for item in items]
    fields = joined(parts)
    kept = np.zeros((*fields["weight"].shape, KEPT))
    kept[..., TIME] = np.inf
    law = np.array([_law(item.velocity) for item in items], dtype=np.int64)
    once = np.array([bool(item.velocity.once) for item in items])
    said = np.full((len(kept) if np.any(once) else 0, POINTS, SAID), np.inf)
    return FluidBatch(
        **fields,
        **wound(everybody, locate, POINTS),
        **tables(items, model.gravity),
        **gusts.tables(items),
        kept=kept,
        fluid=np.array(which, dtype=np.int64),
        data=np.array(rows, dtype=np.float64).reshape(-1, 6),
        fluids=np.array([[item.density, *item.heights, *model.gravity] for item in items]),
        law=law,
        once=once,
        said=said,
        first=np.cumsum([0, *map(len, heights)]).astype(np.int64),
        heights=np.concatenate(heights),
        profile=np.concatenate([item.velocity.profile for item in items]),
        moves=np.array([item.moves for item in items]),
        under=under(items),
        numbers=np.zeros(9),
        value=value,
    )


def _takes_part(body):
    return isinstance(body, Beam) or bool(body.volume or body.drag_area)


def _law(velocity):
    by_law = velocity.parts or velocity.law is not None
    return address_of(velocity, of_place=True) if by_law else 0


def _data(body):
    if not isinstance(body, Beam):
        diameter = (6.0 * body.volume / math.pi) ** (1.0 / 3.0)
        return body.volume, diameter, 0.5 * body.drag_area, 0.0, body.added_mass, 0.0
    s = body.section
    d, (normal, tangential) = s.diameter, s.drag
    mass = s.added_mass or (0.0, 0.0)
    return 0.25 * math.pi * d * d, d, 0.5 * d * normal, 0.5 * math.pi * d * tangential, *mass


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
def flow(batch, e, p, k, at, v):
    """Velocity, acceleration and rise of the surface of fluid k at a point now; in load steps a share."""
    now, (x, y, z) = batch.value[k], at
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


@inline_kernel
def fluid_force(batch, q, v, a, r, ws):
    """Subtract the forces of the fluids from r."""
    for e in range(batch.base.shape[0]):
        k = batch.fluid[e]
        fluid, data = batch.fluids[k], batch.data[e]
        share = batch.value[k, CLOCK, 1]
        for p in range(batch.weight.shape[1]):
            if batch.weight[e, p] == 0.0:
                continue
            at, own = place_at(batch, e, p, q), velocity_at(batch, e, p, q, v)
            t, size = tangent_at(batch, e, p, q)
            u, du, rise = flow(batch, e, p, k, at, own)
            part, _ = wetted(batch, e, p, at[2], t, size, rise)
            if part == 0.0:
                continue
            wt, n, speed = apart((u[0] - own[0], u[1] - own[1], u[2] - own[2]), t)
            ft, fn, _ = apart(du, t)
            bt, bn, _ = apart(acceleration_at(batch, e, p, q, v, a), t)
            rho = part * fluid[DENSITY]
            m, mn, mt = rho * data[AREA], data[MASS_N], data[MASS_T]
            lift = -share * m
            dn = rho * data[DRAG_N] * speed
            along_t = rho * data[DRAG_T] * abs(wt) * wt + m * ((1.0 + mt) * ft - mt * bt)
            fx = dn * n[0] + along_t * t[0] + m * ((1.0 + mn) * fn[0] - mn * bn[0])
            fy = dn * n[1] + along_t * t[1] + m * ((1.0 + mn) * fn[1] - mn * bn[1])
            fz = dn * n[2] + along_t * t[2] + m * ((1.0 + mn) * fn[2] - mn * bn[2])
            g = fluid[GRAVITY], fluid[GRAVITY + 1], fluid[GRAVITY + 2]
            add_material(batch, e, p, fx + lift * g[0], fy + lift * g[1], fz + lift * g[2], q, r)


@formula
def dyadic(n, t, one, nn, tt, zz):
    """Rows of one 1 + nn n n^T + tt t t^T + zz e_z e_z^T."""
    xy, xz, yz = (
        nn * n[0] * n[1] + tt * t[0] * t[1],
        nn * n[0] * n[2] + tt * t[0] * t[2],
        nn * n[1] * n[2] + tt * t[1] * t[2],
    )
    return (
        (one + nn * n[0] * n[0] + tt * t[0] * t[0], xy, xz),
        (xy, one + nn * n[1] * n[1] + tt * t[1] * t[1], yz),
        (xz, yz, one + zz + nn * n[2] * n[2] + tt * t[2] * t[2]),
    )


@inline_kernel
def turning_row(i, wt, n, speed, t, size, dn, dt):
    """Row i of minus the derivative of the drag by r_x, with its factors dn and dt.

    As t turns by dt, w_t grows by n.dt and n by -w_t dt - (n.dt) t.
    """
    s = 1.0 / size
    here = s * (dn * speed - dt * abs(wt)) * wt
    c = s * ((dn * wt / speed if speed > STILL else 0.0) * n[i] + (dn * speed - 2.0 * dt * abs(wt)) * t[i])
    return (
        c * n[0] + here * ((1.0 if i == 0 else 0.0) - t[i] * t[0]),
        c * n[1] + here * ((1.0 if i == 1 else 0.0) - t[i] * t[1]),
        c * n[2] + here * ((1.0 if i == 2 else 0.0) - t[i] * t[2]),
    )


@inline_kernel
def fluid_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add added mass, the derivatives of drag by the velocity and of buoyancy at a surface to A.

    Without damping, in an equilibrium, also how drag changes as pieces turn.
    """
    for e in range(batch.base.shape[0]):
        k = batch.fluid[e]
        fluid, data = batch.fluids[k], batch.data[e]
        for p in range(batch.weight.shape[1]):
            if batch.weight[e, p] == 0.0:
                continue
            at, own = place_at(batch, e, p, q), velocity_at(batch, e, p, q, v)
            t, size = tangent_at(batch, e, p, q)
            u, _, rise = flow(batch, e, p, k, at, own)
            part, rising = wetted(batch, e, p, at[2], t, size, rise)
            if part == 0.0 and rising == 0.0:
                continue
            lam = stretch_at(batch, e, q)
            rho = lam * part * fluid[DENSITY]
            m = c_mass * rho * data[AREA]
            one, nn, tt = m * data[MASS_N], 0.0, m * (data[MASS_T] - data[MASS_N])
            lift = lam * batch.value[k, CLOCK, 1] * fluid[DENSITY] * data[AREA] * fluid[GRAVITY + 2]
            zz = c_stiffness * lift * rising
            n = 0.0, 0.0, 0.0
            if batch.moves[k] or c_damping != 0.0:
                wt, n, speed = apart((u[0] - own[0], u[1] - own[1], u[2] - own[2]), t)
                dn, dt = rho * data[DRAG_N], rho * data[DRAG_T]
                c = c_damping * dn
                one, tt = one + c * speed, tt + 2.0 * c_damping * dt * abs(wt) - c * speed
                nn = c / speed if speed > STILL else 0.0
                if c_damping == 0.0 and c_stiffness != 0.0 and size > 0.0:
                    rows = (
                        turning_row(0, wt, n, speed, t, size, dn, dt),
                        turning_row(1, wt, n, speed, t, size, dn, dt),
                        turning_row(2, wt, n, speed, t, size, dn, dt),
                    )
                    add_slope_block_along(batch, e, p, rows, A)
            add_block_along(batch, e, p, dyadic(n, t, one, nn, tt, zz), A)


implements(
    FluidBatch,
    force=fluid_force,
    tangent=fluid_tangent,
    role=Role.EXTERNAL,
    slots=("base", "winch"),
    follows=lambda batch: bool(np.any(batch.moves)),
    turning_mass=lambda batch: bool(np.any(batch.data[:, MASS_N] != batch.data[:, MASS_T])),
)
