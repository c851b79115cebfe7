"""Derivatives of x . force of fluids by numbers of sections, fluids and waves, and by lengths of bodies.

The work is that of :mod:`ancf.loads.fluid_slopes`.  A length acts through the factors of places and slopes,
the weights of the points and the middles of their pieces: these are numbers, too.
"""

from __future__ import annotations

import numpy as np

from ..compiled import formula, inline_kernel
from ..vectors import both, dot
from .along import place_at
from .flow import AREA, CLOCK, DENSITY, DRAG_N, DRAG_T, GRAVITY, MASS_N, MASS_T, apart
from .flow_slopes import ROOM
from .fluid_slopes import acting, along_axis, found_at, slopes_at, three
from .waves import ALONG_X, ALONG_Y, PLACE, RATE, SPEED, TIME, sea_at, sea_changes, sea_numbers

#: Fields of which the numbers are made, one after the other, and those that lengths change.
SHAPES = ("weight", "shift", "shape", "slope")
NUMBERED = ("fluids", "data", *SHAPES, "wave")
#: Places in ``asked``: whether derivatives by numbers of shapes and of waves are wanted.
OF_SHAPES, OF_WAVES = range(2)
#: Bits of the kinds of a change.
IN_SHAPES, IN_WAVES = 1, 2


def numbers(batch):
    """Those of the fluids, 0 for a surface that there is not, of sections, of shapes and of waves."""
    fluids = np.where(np.isinf(batch.fluids), 0.0, batch.fluids)
    return np.concatenate([fluids.ravel(), *(getattr(batch, key).ravel() for key in NUMBERED[1:])])


def joined(batch, other):
    """The batch asked for what differs from another one, see :class:`ancf.compiled.Traits`."""
    found = [any(not np.array_equal(getattr(batch, x), getattr(other, x)) for x in SHAPES)]
    found.append(not np.array_equal(batch.wave, other.wave))
    return batch._replace(asked=batch.asked | np.array(found))


def kinds_of(batch, rates):
    """What a change has some of, as bits: numbers of shapes, of waves."""
    count, begin = batch.wave.size, batch.fluids.size + batch.data.size
    in_shapes, in_waves = np.any(rates[begin : len(rates) - count]), np.any(rates[len(rates) - count :])
    return [int(in_shapes) * IN_SHAPES | int(in_waves) * IN_WAVES]


@formula
def by_numbers(batch, e, p, t, size, own, b, X, wet, f, h, g):
    """Derivatives of X . force at point p by the fluid's numbers, the section's, weight and shift."""
    (part, by_z, by_low, by_high, _, _, by_width, by_tall), k = wet, batch.fluid[e]
    fluid, data, felt, weight = batch.fluids[k], batch.data[e], batch.felt[e, p], batch.weight[e, p]
    past, du, share = both(1.0, three(felt, SPEED), -1.0, own), three(felt, RATE), batch.value[k, CLOCK, 1]
    wt, n, speed = apart(past, t)
    area, tau, gain = data[AREA], dot(t, X), dot(du, t) - dot(b, t)
    gained, lift = dot(du, X) - dot(b, X) - gain * tau, -f * share * area
    by_area = dot(du, X) - share * dot(three(fluid, GRAVITY), X)
    by_area += data[MASS_N] * gained + data[MASS_T] * gain * tau
    of_fluid = -weight * part * g, h * by_low, h * by_high, lift * X[0], lift * X[1], lift * X[2]
    drag = f * speed * dot(n, X), f * abs(wt) * wt * tau
    of_section = f * by_area, h * by_width, drag[0], drag[1], f * area * gained, f * area * gain * tau
    by_weight = -fluid[DENSITY] * part * g + h * by_tall * size * abs(t[2])
    return of_fluid, of_section, by_weight, h * by_z * size * t[2]


@formula
def force_at(batch, e, p, t, own, b, f):
    """The force at point p: f times the derivative of g by X."""
    k, data, felt = batch.fluid[e], batch.data[e], batch.felt[e, p]
    past, du, area = both(1.0, three(felt, SPEED), -1.0, own), three(felt, RATE), data[AREA]
    wt, n, speed = apart(past, t)
    mn, gain = data[MASS_N], dot(du, t) - dot(b, t)
    x = both(f * data[DRAG_N] * speed, n, f * data[DRAG_T] * abs(wt) * wt, t)
    y = both(f * area * (1.0 + mn), du, -f * area * mn, b)
    along = f * area * (data[MASS_T] - mn) * gain
    z = both(along, t, -f * area * batch.value[k, CLOCK, 1], three(batch.fluids[k], GRAVITY))
    return x[0] + y[0] + z[0], x[1] + y[1] + z[1], x[2] + y[2] + z[2]


@formula
def add_shapes(batch, e, p, states, by, force, out):
    """Add the derivatives by the factors of point p: of its place and of its slope."""
    count, (q, v, a, x) = batch.base.shape[1], states
    first = batch.fluids.size + batch.data.size + batch.weight.size + batch.shift.size
    own = first + (e * batch.weight.shape[1] + p) * count
    for k in range(count):
        i = batch.base[e, k]
        if i >= 0:
            by_shape = dot(by[0], three(q, i)) + dot(by[2], three(v, i)) + dot(by[3], three(a, i))
            out[own + k] += by_shape + dot(force, three(x, i))
            out[own + batch.shape.size + k] += dot(by[1], three(q, i))


@inline_kernel
def add_waves(batch, e, p, k, fresh, f, by_rise, by_past, by_du, out):
    """Add the derivatives at point p by the numbers of waves."""
    own = batch.waves[k + 1] > batch.waves[k]
    if not own and batch.under[k] < 0:
        return
    of = k if own else batch.under[k]
    sea, felt, first, last = batch.sea[of], batch.felt[e, p], batch.waves[of], batch.waves[of + 1]
    if not fresh:
        x, y, z = three(felt, PLACE)
        sea_at(sea, batch.wave, first, last, batch.angle, felt[TIME], x, y, z, batch.kept[e, p])
    c = f if own else 0.0
    by = (
        c * (by_past[0] * sea[ALONG_X] + by_past[1] * sea[ALONG_Y]),
        c * by_past[2],
        c * (by_du[0] * sea[ALONG_X] + by_du[1] * sea[ALONG_Y]),
        c * by_du[2],
        by_rise,
    )
    sea_numbers(sea, batch.wave, first, last, batch.angle, felt, by, out[out.shape[0] - batch.wave.size :])


@inline_kernel
def fluid_number_work(batch, q, v, a, x, out, ws):
    """See :func:`ancf.compiled.add_number_work`."""
    columns, begin = batch.data.shape[1], batch.fluids.size
    weights = begin + batch.data.size
    for e in range(batch.base.shape[0]):
        k = batch.fluid[e]
        for p in range(batch.weight.shape[1]):
            if batch.weight[e, p] == 0.0:
                continue
            own, b, t, size, fresh, wet = found_at(batch, e, p, q, v, a)
            if wet[0] == 0.0 and wet[1] == 0.0:
                continue
            X = place_at(batch, e, p, x)
            f, h, by_rise, (g, by_past, by_du, _, _) = acting(batch, e, p, t, own, b, X, wet)
            made = by_numbers(batch, e, p, t, size, own, b, X, wet, f, h, g)
            for i in range(columns):
                out[columns * k + i] += made[0][i]
                out[begin + columns * e + i] += made[1][i]
            if batch.asked[OF_SHAPES]:
                point = weights + e * batch.weight.shape[1] + p
                out[point] += made[2]
                out[point + batch.weight.size] += made[3]
                by = slopes_at(batch, e, p, t, size, own, b, X, wet)
                add_shapes(batch, e, p, (q, v, a, x), by, force_at(batch, e, p, t, own, b, f), out)
            if batch.asked[OF_WAVES]:
                add_waves(batch, e, p, k, fresh, f, by_rise, by_past, by_du, out)


@formula
def along_data(batch, e, p, made, rates):
    """Change of X . force at point p as numbers of the fluid, the section and the weights change."""
    columns, k = batch.data.shape[1], batch.fluid[e]
    begin, change = batch.fluids.size, 0.0
    for i in range(columns):
        change += made[0][i] * rates[columns * k + i] + made[1][i] * rates[begin + columns * e + i]
    point = begin + batch.data.size + e * batch.weight.shape[1] + p
    return change + made[2] * rates[point] + made[3] * rates[point + batch.weight.size]


@formula
def along_shapes(batch, e, p, q, v, a, by, rates):
    """The same as factors of places and slopes change, without what X changes by."""
    count = batch.base.shape[1]
    first = batch.fluids.size + batch.data.size + batch.weight.size + batch.shift.size
    own, change = first + (e * batch.weight.shape[1] + p) * count, 0.0
    for k in range(count):
        i = batch.base[e, k]
        if i >= 0:
            by_shape = dot(by[0], three(q, i)) + dot(by[2], three(v, i)) + dot(by[3], three(a, i))
            change += rates[own + k] * by_shape + rates[own + batch.shape.size + k] * dot(by[1], three(q, i))
    return change


@formula
def add_change(batch, e, p, c, change, force, shaped, rates, out):
    """Add a change of component c of the force at point p, and where the force itself acts otherwise."""
    count = batch.base.shape[1]
    first = batch.fluids.size + batch.data.size + batch.weight.size + batch.shift.size
    own = first + (e * batch.weight.shape[1] + p) * count
    for k in range(count):
        i = batch.base[e, k]
        if i >= 0:
            more = rates[own + k] * force if shaped else 0.0
            out[i + c] += batch.shape[e, p, k] * change + more


@inline_kernel
def waves_change(batch, e, p, k, fresh, rates):
    """Fill the room of ``felt`` with what waves at point p change by; which fluid has them, -1: none."""
    own = batch.waves[k + 1] > batch.waves[k]
    of = k if own else batch.under[k]
    if of < 0:
        return -1
    sea, felt, first, last = batch.sea[of], batch.felt[e, p], batch.waves[of], batch.waves[of + 1]
    if not fresh:
        x, y, z = three(felt, PLACE)
        sea_at(sea, batch.wave, first, last, batch.angle, felt[TIME], x, y, z, batch.kept[e, p])
    changes = rates[rates.shape[0] - batch.wave.size :]
    sea_changes(sea, batch.wave, first, last, batch.angle, felt, changes, felt[ROOM:])
    return of


@formula
def along_waves(batch, e, p, k, of, f, by_rise, by_past, by_du):
    """Change of X . force at point p as waves do."""
    sea, room = batch.sea[of], batch.felt[e, p, ROOM:]
    change = by_rise * room[4]
    if of == k:
        x, y = sea[ALONG_X], sea[ALONG_Y]
        change += f * (room[0] * (by_past[0] * x + by_past[1] * y) + room[1] * by_past[2])
        change += f * (room[2] * (by_du[0] * x + by_du[1] * y) + room[3] * by_du[2])
    return change


@inline_kernel
def add_sea_change(batch, e, p, here, fresh, rates, out):
    """Add what a change of waves does at point p."""
    k, (t, own, b, wet) = batch.fluid[e], here
    of = waves_change(batch, e, p, k, fresh, rates)
    if of < 0:
        return
    for c in range(3):
        X = along_axis(c)
        f, _, by_rise, (_, by_past, by_du, _, _) = acting(batch, e, p, t, own, b, X, wet)
        change = along_waves(batch, e, p, k, of, f, by_rise, by_past, by_du)
        add_change(batch, e, p, c, change, 0.0, False, rates, out)


@inline_kernel
def add_changes_at(batch, e, p, states, size, here, rates, kinds, begin, out):
    """Add what other changes of numbers do at point p, of which r_x has this size."""
    (q, v, a), (t, own, b, wet), of_each = states, here, rates.shape[0] // begin.shape[0]
    for c in range(3):
        X = along_axis(c)
        f, h, _, (g, _, _, _, _) = acting(batch, e, p, t, own, b, X, wet)
        made = by_numbers(batch, e, p, t, size, own, b, X, wet, f, h, g)
        for m in range(begin.shape[0]):
            of, shaped = rates[m * of_each : (m + 1) * of_each], kinds[m] & IN_SHAPES != 0
            change = along_data(batch, e, p, made, of)
            if shaped:
                by = slopes_at(batch, e, p, t, size, own, b, X, wet)
                change += along_shapes(batch, e, p, q, v, a, by, of)
            add_change(batch, e, p, c, change, f * g, shaped, of, out[begin[m] :])


@inline_kernel
def fluid_changes(batch, q, v, a, rates, kinds, begin, out, ws):
    """See :func:`ancf.compiled.add_changes`."""
    count, of_each = begin.shape[0], rates.shape[0] // begin.shape[0]
    for e in range(batch.base.shape[0]):
        for p in range(batch.weight.shape[1]):
            if batch.weight[e, p] == 0.0:
                continue
            own, b, t, size, fresh, wet = found_at(batch, e, p, q, v, a)
            if wet[0] == 0.0 and wet[1] == 0.0:
                continue
            here = t, own, b, wet
            for m in range(count):
                if kinds[m] & IN_WAVES:
                    of = rates[m * of_each : (m + 1) * of_each]
                    add_sea_change(batch, e, p, here, fresh, of, out[begin[m] :])
            add_changes_at(batch, e, p, (q, v, a), size, here, rates, kinds, begin, out)
