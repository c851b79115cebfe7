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
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import Role, formula, implements, inline_kernel
from ..model.bodies.beam import Beam
from ..model.surroundings.fluids import require_section
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
from .flow import (
    AREA,
    CLOCK,
    DENSITY,
    DRAG_N,
    DRAG_T,
    GRAVITY,
    MASS_N,
    MASS_T,
    SAID,
    STILL,
    apart,
    flow,
    wetted,
)
from .flow_slopes import FELT
from .fluid_numbers import NUMBERED, SHAPES, fluid_changes, fluid_number_work, kinds_of, numbers
from .fluid_numbers import joined as joined_numbers
from .fluid_slopes import fluid_force_slopes, fluid_work_slopes
from .law_functions import address_of
from .waves import KEPT, TIME, tables, under

#: Gauss points of an element.
POINTS = 5


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
    sea: FloatArray  # (m, 6) see loads/waves.py
    shortest: FloatArray  # (m,) largest wave numbers, 1/m
    waves: NDArray[np.int64]  # (m + 1,) first chunk of components
    wave: FloatArray  # (chunks, 6, LANES) components
    angle: FloatArray  # (3, most chunks, LANES) scratch memory
    kept: FloatArray  # (n, points, KEPT) what waves gave last
    felt: FloatArray  # (n, points, FELT) see loads/flow_slopes.py
    asked: NDArray[np.bool_]  # (2,) see loads/fluid_numbers.py
    squall: FloatArray  # (m, 9) see loads/gusts.py
    gale: NDArray[np.int64]  # (m, 3) places and sizes of the tables of gusts
    gust: FloatArray  # (j,) tables of gusts, one after the other
    numbers: FloatArray  # (9,) scratch memory of the laws
    value: FloatArray  # (m, 3, 3) inputs now


def build(items, locate, value, model):
    """Batch of these fluids; ModelError if a section lacks what they need."""
    parts, rows, which, everybody = [], [], [], []
    for k, item in enumerate(items):
        bodies = _bodies(item, model)
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
    kept, felt = _nothing_kept(fields["weight"])
    law = np.array([_law(item.velocity) for item in items], dtype=np.int64)
    once = np.array([bool(item.velocity.once) for item in items])
    said = np.full((len(kept) if np.any(once) else 0, POINTS, SAID), np.inf)
    return FluidBatch(
        **fields,
        **wound(everybody, locate, POINTS),
        **tables(items, model.gravity),
        **gusts.tables(items),
        kept=kept,
        felt=felt,
        asked=np.zeros(2, dtype=bool),
        fluid=np.array(which, dtype=np.int64),
        data=np.array(rows, dtype=np.float64).reshape(-1, 6),
        fluids=_fluids(items, model),
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


def _nothing_kept(weight):
    """Fields ``kept`` and ``felt`` of points with these weights that have not been asked yet."""
    kept = np.zeros((*weight.shape, KEPT))
    kept[..., TIME] = np.inf
    return kept, np.full((*weight.shape, FELT), np.inf)


def _takes_part(body):
    return isinstance(body, Beam) or bool(body.volume or body.drag_area)


def _law(velocity):
    by_law = velocity.parts or velocity.law is not None
    return address_of(velocity, of_place=True) if by_law else 0


def renumbered(batch: FluidBatch, model: Any, locate: Any = None) -> FluidBatch:
    """The batch of a model that differs in densities, gravity, drag and added mass alone.

    ``locate``: finds the probe of a point where lengths of beams differ as well.
    """
    owners = [body for item in model.fluids for body in _bodies(item, model)]
    each = [[_data(body)] * (body.elements if isinstance(body, Beam) else 1) for body in owners]
    made = batch._replace(
        data=np.array([row for rows in each for row in rows], dtype=np.float64).reshape(-1, 6),
        fluids=_fluids(model.fluids, model),
    )
    fields: dict[str, Any] = {}
    if not np.array_equal(made.fluids[:, GRAVITY:], batch.fluids[:, GRAVITY:]):  # waves go with it
        fields |= tables(model.fluids, model.gravity)
    if locate is not None:
        found = joined([along(_bodies(item, model), locate, POINTS)[0] for item in model.fluids])
        fields |= {key: found[key] for key in SHAPES}
    if fields:
        fields["kept"], fields["felt"] = _nothing_kept(batch.weight)
    return made._replace(**fields)


def _bodies(item, model):
    """Those that a fluid acts on."""
    return [body for name, body in model.bodies.items() if item.acts_on(name) and _takes_part(body)]


def _fluids(items, model):
    """Numbers of fluids, a row for each."""
    return np.array([[item.density, *item.heights, *model.gravity] for item in items])


def _data(body):
    if not isinstance(body, Beam):
        diameter = (6.0 * body.volume / math.pi) ** (1.0 / 3.0)
        return body.volume, diameter, 0.5 * body.drag_area, 0.0, body.added_mass, 0.0
    s = body.section
    d, (normal, tangential) = s.diameter, s.drag
    mass = s.added_mass or (0.0, 0.0)
    return 0.25 * math.pi * d * d, d, 0.5 * d * normal, 0.5 * math.pi * d * tangential, *mass


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
    work_slopes=fluid_work_slopes,
    force_slopes=fluid_force_slopes,
    number_work=fluid_number_work,
    sloped=lambda batch: not (np.any(batch.once) or np.any(batch.winch >= 0)),
    changes=fluid_changes,
    numbers=numbers,
    numbered=(*NUMBERED, "shortest"),
    joined=joined_numbers,
    kinds=kinds_of,
)
