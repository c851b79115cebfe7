"""Velocity and acceleration of waves at a point, by linear theory; see ``model.surroundings.waves``.

What a wave gives at a point is kept for the corrections of one step: the point moves between them by so
little that the wave is the same.  A point at rest, as in an equilibrium, is asked anew each time.
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import formula, inline_kernel, kernel
from ..errors import ModelError
from ..simd import LANES, cos_and_sin, decay, every, load, store, total

# columns of ``sea``: mean level, depth, ramp, direction, stretched or not
LEVEL, DEPTH, RAMP, ALONG_X, ALONG_Y, STRETCHED = range(6)
# rows of ``wave``: amplitude, angular frequency, wave number k, phase; exp(-2 k h) and 1/(1 - exp(-2 k h))
AMPLITUDE, OMEGA, NUMBER, PHASE, MIRROR, WHOLE = range(6)
# columns of ``kept``: time, place, velocity, acceleration, elevation
TIME, PLACE, SPEED, RATE, RISE = 0, 1, 4, 7, 10
KEPT = 11
# rows of ``angle``, of a point that has just been asked: cosine and sine of each component, exp(k z)
COSINE, SINE, DOWN = range(3)
#: Way of a point, in 1/k of the shortest wave, up to which what was kept counts.
NEAR = 1e-3


def tables(items, gravity):
    """Fields ``sea``, ``shortest``, ``waves``, ``wave``, ``angle`` of the batch of these fluids."""
    sea, shortest, wave = np.zeros((len(items), 6)), np.ones(len(items)), [np.zeros((0, 6, LANES))]
    for n, (row, item) in enumerate(zip(sea, items, strict=True)):
        found = item.waves
        if found is not None:
            k = found.numbers(-gravity[2])
            stretched = float(found.stretching == "wheeler")
            direction = math.cos(found.direction), math.sin(found.direction)
            row[:] = item.heights[1], found.depth, found.ramp, *direction, stretched
            shortest[n] = k.max()
            wave.append(_components(found, k))
    return {
        "sea": sea,
        "shortest": shortest,
        "waves": np.cumsum([0, *_chunks(items)]).astype(np.int64),
        "wave": np.concatenate(wave),
        "angle": np.zeros((3, max(_chunks(items)), LANES)),
    }


def under(items):
    """Of each fluid the one whose waves are its lower surface, -1: none.

    Raises
    ------
    ModelError
        A fluid has waves on both surfaces.
    """
    found = np.full(len(items), -1, dtype=np.int64)
    for k, item in enumerate(items):
        for j, other in enumerate(items):
            if other.waves is not None and other.below == item.above and other.meets(item):
                if item.waves is not None:
                    what = f'has waves of its own and below it those of "{other.name}"'
                    raise ModelError(item.name, what, "leave out one of them")
                found[k] = j
    return found


def _chunks(items):
    """Numbers of chunks of the components of these fluids."""
    return [0 if item.waves is None else -(-len(item.waves.omega) // LANES) for item in items]


def _components(waves, k):
    """Rows of the components in chunks, filled up by waves of no height."""
    mirror = np.exp(-2.0 * k * waves.depth)
    given = (waves.amplitude, waves.omega, k, waves.phase, mirror, 1.0 / (1.0 - mirror))
    rest = -len(k) % LANES
    rows = [np.concatenate([x, np.full(rest, y)]) for x, y in zip(given, (0, 0, 0, 0, 0, 1), strict=True)]
    return np.ascontiguousarray(np.reshape(rows, (6, -1, LANES)).transpose(1, 0, 2))


@inline_kernel
def share_of(t, ramp):
    """Share of the waves at a time and its derivative, see :func:`ancf.model.surroundings.waves.grown`."""
    if t >= ramp:
        return 1.0, 0.0
    if t <= 0.0:
        return 0.0, 0.0
    s = t / ramp
    return s * s * (3.0 - 2.0 * s), 6.0 * s * (1.0 - s) / ramp


@inline_kernel
def surface(wave, first, last, angle, s, t):
    """Elevation of the surface at s before the ramp; leaves cosines and sines of the components."""
    eta = every(0.0)
    for i in range(first, last):
        psi = load(wave, i, NUMBER) * s - load(wave, i, OMEGA) * t + load(wave, i, PHASE)
        cos, sin = cos_and_sin(psi)
        store(cos, angle, COSINE, i - first)
        store(sin, angle, SINE, i - first)
        eta = eta + load(wave, i, AMPLITUDE) * cos
    return total(eta)


@inline_kernel
def stretched(sea, z, eta):
    """Height over the mean level at which the profile is read."""
    h = sea[DEPTH]
    if sea[STRETCHED] != 0.0:
        z = z - eta if h == math.inf else h * (z - eta) / (h + eta)
    return max(min(z, 0.0), -h)


@inline_kernel
def keep(sea, share, growth, velocity, rate, kept):
    """Write velocity and acceleration, level and up, of grown waves to ``kept``, with their direction."""
    u, w = share * velocity[0], share * velocity[1]
    du, dw = share * rate[0] + growth * velocity[0], share * rate[1] + growth * velocity[1]
    kept[SPEED], kept[SPEED + 1], kept[SPEED + 2] = u * sea[ALONG_X], u * sea[ALONG_Y], w
    kept[RATE], kept[RATE + 1], kept[RATE + 2] = du * sea[ALONG_X], du * sea[ALONG_Y], dw


@kernel
def sea_at(sea, wave, first, last, angle, t, x, y, z, kept):
    """Velocity, acceleration and elevation at a time and a place, to ``kept``."""
    share, growth = share_of(t, sea[RAMP])
    eta = surface(wave, first, last, angle, sea[ALONG_X] * x + sea[ALONG_Y] * y, t)
    at = stretched(sea, z - sea[LEVEL], share * eta)
    u, w, au, aw = every(0.0), every(0.0), every(0.0), every(0.0)
    for i in range(first, last):
        omega = load(wave, i, OMEGA)
        down = decay(load(wave, i, NUMBER) * at)
        store(down, angle, DOWN, i - first)
        up = load(wave, i, MIRROR) / down
        speed = load(wave, i, AMPLITUDE) * omega * load(wave, i, WHOLE)
        level, lift = speed * (down + up), speed * (down - up)  # over cosine and sine
        cos, sin = load(angle, COSINE, i - first), load(angle, SINE, i - first)
        u = u + level * cos
        w = w + lift * sin
        au = au + omega * (level * sin)
        aw = aw - omega * (lift * cos)
    keep(sea, share, growth, (total(u), total(w)), (total(au), total(aw)), kept)
    kept[TIME], kept[RISE] = t, share * eta
    kept[PLACE], kept[PLACE + 1], kept[PLACE + 2] = x, y, z


@inline_kernel
def stretching(sea, z, eta):
    """Derivatives of :func:`stretched` by z and by eta."""
    h = sea[DEPTH]
    if sea[STRETCHED] == 0.0:
        return (1.0, 0.0) if -h < z < 0.0 else (0.0, 0.0)
    if h == math.inf:
        return (1.0, -1.0) if z - eta < 0.0 else (0.0, 0.0)
    inverse = 1.0 / (h + eta)
    if not -1.0 < (z - eta) * inverse < 0.0:
        return 0.0, 0.0
    return h * inverse, -h * (h + z) * inverse * inverse


@kernel
def sea_slopes(sea, wave, first, last, angle, kept, slopes):
    """Derivatives by the way along the waves and by the height of what :func:`sea_at` has just kept.

    Filled are u and w by the way and by the height, their rates so, and the elevation by the way, (9,).
    """
    share, growth = share_of(kept[TIME], sea[RAMP])
    z, eta = kept[PLACE + 2] - sea[LEVEL], kept[RISE]
    by_z, by_eta = stretching(sea, z, eta)
    rise, cosine, sine, rate_cosine, rate_sine = every(0.0), every(0.0), every(0.0), every(0.0), every(0.0)
    for i in range(first, last):
        omega, number = load(wave, i, OMEGA), load(wave, i, NUMBER)
        down = load(angle, DOWN, i - first)
        up = load(wave, i, MIRROR) / down
        speed = number * (load(wave, i, AMPLITUDE) * omega * load(wave, i, WHOLE))
        level, lift = speed * (down + up), speed * (down - up)
        cos, sin = load(angle, COSINE, i - first), load(angle, SINE, i - first)
        rise = rise - number * (load(wave, i, AMPLITUDE) * sin)
        cosine, sine = cosine + lift * cos, sine + level * sin
        rate_cosine, rate_sine = rate_cosine + omega * (level * cos), rate_sine + omega * (lift * sin)
    slopes[8] = share * total(rise)
    along, c, s, rc, rs = by_eta * slopes[8], total(cosine), total(sine), total(rate_cosine), total(rate_sine)
    u, w, du, dw = along * c - s, c + along * s, rc + along * rs, rs - along * rc
    slopes[0], slopes[1], slopes[2], slopes[3] = share * u, share * w, share * by_z * c, share * by_z * s
    slopes[4], slopes[5] = share * du + growth * u, share * dw + growth * w
    slopes[6], slopes[7] = by_z * (share * rs + growth * c), by_z * (growth * s - share * rc)


@formula
def renew_waves(batch, e, p, k, t, at, v):
    """Let ``kept`` hold what the waves of fluid k do at point p of row e, at this place and velocity."""
    kept = batch.kept[e, p]
    dx, dy, dz = at[0] - kept[PLACE], at[1] - kept[PLACE + 1], at[2] - kept[PLACE + 2]
    near = NEAR / batch.shortest[k]
    moves = v[0] != 0.0 or v[1] != 0.0 or v[2] != 0.0
    if not (kept[TIME] == t and moves and dx * dx + dy * dy + dz * dz < near * near):
        first, last = batch.waves[k], batch.waves[k + 1]
        sea_at(batch.sea[k], batch.wave, first, last, batch.angle, t, at[0], at[1], at[2], kept)


@formula
def add_to(out, i, x):
    """Add lanes to the numbers from i on."""
    store(load(out, i) + x, out, i)


@kernel
def sea_numbers(sea, wave, first, last, angle, kept, by, out):
    """Add derivatives by the numbers of the components to out, chunk by chunk as ``wave`` is, in one row.

    ``by``: those by u and w, their rates, and the elevation, of what :func:`sea_at` has just kept.
    """
    share, growth = share_of(kept[TIME], sea[RAMP])
    way, z, eta = sea[ALONG_X] * kept[PLACE] + sea[ALONG_Y] * kept[PLACE + 1], kept[PLACE + 2], kept[RISE]
    at, (_, by_eta) = stretched(sea, z - sea[LEVEL], eta), stretching(sea, z - sea[LEVEL], eta)
    rs, rc, rise = share * by[2], share * by[3], share * by[4]
    c, s = share * by[0] + growth * by[2], share * by[1] + growth * by[3]
    for last_round in (False, True):
        lifted = every(0.0)
        for i in range(first, last):
            omega, number, down = load(wave, i, OMEGA), load(wave, i, NUMBER), load(angle, DOWN, i - first)
            cos, sin = load(angle, COSINE, i - first), load(angle, SINE, i - first)
            level, lift = c * cos + omega * (rs * sin), s * sin - omega * (rc * cos)
            up, height, whole = load(wave, i, MIRROR) / down, load(wave, i, AMPLITUDE), load(wave, i, WHOLE)
            more, less, unit = down + up, down - up, height * whole
            deeper = unit * omega * (less * level + more * lift)
            if not last_round:
                lifted = lifted + number * deeper
                continue
            size = more * level + less * lift
            turn = more * (omega * (rs * cos) - c * sin) + less * (s * cos + omega * (rc * sin))
            turn = unit * omega * turn - rise * (height * sin)
            own = 6 * LANES * i
            faster = unit * (size + omega * (more * (rs * sin) - less * (rc * cos))) - kept[TIME] * turn
            add_to(out, own + LANES * AMPLITUDE, omega * whole * size + rise * cos)
            add_to(out, own + LANES * OMEGA, faster)
            add_to(out, own + LANES * NUMBER, way * turn + at * deeper)
            add_to(out, own + LANES * PHASE, turn)
            add_to(out, own + LANES * MIRROR, unit * omega / down * (level - lift))
            add_to(out, own + LANES * WHOLE, height * omega * size)
        rise += share * by_eta * total(lifted)


@kernel
def sea_changes(sea, wave, first, last, angle, kept, rates, out):
    """Fill ``out`` with what u and w, their rates, and the elevation change by; see :func:`sea_numbers`.

    ``rates``: of the numbers of the components, in one row.
    """
    share, growth = share_of(kept[TIME], sea[RAMP])
    way, z, eta = sea[ALONG_X] * kept[PLACE] + sea[ALONG_Y] * kept[PLACE + 1], kept[PLACE + 2], kept[RISE]
    at, (_, by_eta) = stretched(sea, z - sea[LEVEL], eta), stretching(sea, z - sea[LEVEL], eta)
    rise, u, w, au, aw = every(0.0), every(0.0), every(0.0), every(0.0), every(0.0)
    for i in range(first, last):
        own, cos, sin = 6 * LANES * i, load(angle, COSINE, i - first), load(angle, SINE, i - first)
        turned = way * load(rates, own + LANES * NUMBER) - kept[TIME] * load(rates, own + LANES * OMEGA)
        turned = turned + load(rates, own + LANES * PHASE)
        rise = rise + load(rates, own) * cos - load(wave, i, AMPLITUDE) * (sin * turned)
    out[4] = share * total(rise)
    for i in range(first, last):
        own, cos, sin = 6 * LANES * i, load(angle, COSINE, i - first), load(angle, SINE, i - first)
        omega, number, down = load(wave, i, OMEGA), load(wave, i, NUMBER), load(angle, DOWN, i - first)
        faster, longer = load(rates, own + LANES * OMEGA), load(rates, own + LANES * NUMBER)
        turned = way * longer - kept[TIME] * faster + load(rates, own + LANES * PHASE)
        deeper, up = at * longer + (by_eta * out[4]) * number, load(wave, i, MIRROR) / down
        mirrored = load(rates, own + LANES * MIRROR) / down
        height, whole = load(wave, i, AMPLITUDE), load(wave, i, WHOLE)
        speed = height * omega * whole
        more = (load(rates, own) * omega + height * faster) * whole + height * omega * load(
            rates, own + LANES * WHOLE
        )
        level, lift = speed * (down + up), speed * (down - up)
        levelled = more * (down + up) + lift * deeper + speed * mirrored
        lifted = more * (down - up) + level * deeper - speed * mirrored
        x, y = levelled * cos - level * (sin * turned), lifted * sin + lift * (cos * turned)
        u, w = u + x, w + y
        au = au + faster * (level * sin) + omega * (levelled * sin + level * (cos * turned))
        aw = aw - faster * (lift * cos) - omega * (lifted * cos - lift * (sin * turned))
    out[0], out[1] = share * total(u), share * total(w)
    out[2], out[3] = share * total(au) + growth * total(u), share * total(aw) + growth * total(w)
