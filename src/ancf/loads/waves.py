"""Velocity and acceleration of waves at a point, by linear theory; see :class:`ancf.model.waves.Waves`.

What a wave gives at a point is kept for the corrections of one step: the point moves between them by so
little that the wave is the same.  A point at rest, as in an equilibrium, is asked anew each time.
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import formula, inline_kernel, kernel
from ..errors import ModelError
from ..simd import LANES, cos_and_sin, decay, every, load, store, total

# columns of ``sea``: mean level, depth, ramp, direction, stretched or not, largest wave number
LEVEL, DEPTH, RAMP, ALONG_X, ALONG_Y, STRETCHED, SHORTEST = range(7)
# rows of ``wave``: amplitude, angular frequency, wave number k, phase; exp(-2 k h) and 1/(1 - exp(-2 k h))
AMPLITUDE, OMEGA, NUMBER, PHASE, MIRROR, WHOLE = range(6)
# columns of ``kept``: time, place, velocity, acceleration, elevation
TIME, PLACE, SPEED, RATE, RISE = 0, 1, 4, 7, 10
KEPT = 11
#: Way of a point, in 1/k of the shortest wave, up to which what was kept counts.
NEAR = 1e-3


def tables(items, gravity):
    """Fields ``sea``, ``waves``, ``wave`` of the batch of these fluids."""
    sea, wave = np.zeros((len(items), 7)), [np.zeros((0, 6, LANES))]
    for row, item in zip(sea, items, strict=True):
        found = item.waves
        if found is not None:
            k = found.numbers(-gravity[2])
            stretched = float(found.stretching == "wheeler")
            direction = math.cos(found.direction), math.sin(found.direction)
            row[:] = item.heights[1], found.depth, found.ramp, *direction, stretched, k.max()
            wave.append(_components(found, k))
    return {
        "sea": sea,
        "waves": np.cumsum([0, *_chunks(items)]).astype(np.int64),
        "wave": np.concatenate(wave),
        "angle": np.zeros((2, max(_chunks(items)), LANES)),
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
    """Share of the waves at a time and its derivative, see :func:`ancf.model.waves.grown`."""
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
        store(cos, angle, 0, i - first)
        store(sin, angle, 1, i - first)
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
        up = load(wave, i, MIRROR) / down
        speed = load(wave, i, AMPLITUDE) * omega * load(wave, i, WHOLE)
        level, lift = speed * (down + up), speed * (down - up)  # over cosine and sine
        cos, sin = load(angle, 0, i - first), load(angle, 1, i - first)
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
    at, (by_z, by_eta) = stretched(sea, z, eta), stretching(sea, z, eta)
    rise, cosine, sine, rate_cosine, rate_sine = every(0.0), every(0.0), every(0.0), every(0.0), every(0.0)
    for i in range(first, last):
        omega, number = load(wave, i, OMEGA), load(wave, i, NUMBER)
        down = decay(number * at)
        up = load(wave, i, MIRROR) / down
        speed = number * (load(wave, i, AMPLITUDE) * omega * load(wave, i, WHOLE))
        level, lift = speed * (down + up), speed * (down - up)
        cos, sin = load(angle, 0, i - first), load(angle, 1, i - first)
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
    kept, sea = batch.kept[e, p], batch.sea[k]
    dx, dy, dz = at[0] - kept[PLACE], at[1] - kept[PLACE + 1], at[2] - kept[PLACE + 2]
    near = NEAR / sea[SHORTEST]
    moves = v[0] != 0.0 or v[1] != 0.0 or v[2] != 0.0
    if not (kept[TIME] == t and moves and dx * dx + dy * dy + dz * dz < near * near):
        first, last = batch.waves[k], batch.waves[k + 1]
        sea_at(sea, batch.wave, first, last, batch.angle, t, at[0], at[1], at[2], kept)
