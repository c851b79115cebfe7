"""Spring and damper between two points, or a point and the ground; optionally slack in compression.

Tension F = k (l - l0) + c dl/dt along the line between the points.  A slack spring (a dropper, a rope)
carries nothing while l <= l0 and never pushes: F = max(F, 0).  Others may have curves beside it and friction,

    F = k e + c de/dt + f(e) + g(de/dt) + R tanh((de/dt)/w),        e = l - l0.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import Role, formula, implements, inline_kernel
from .curves import looked_up

#: Columns of SpringBatch.data.
STIFFNESS, DAMPING, LENGTH, SLACK, FRICTION, CREEP, IDLE = range(7)
#: Columns of SpringBatch.found.
FORCE, DISTANCE = range(2)


class SpringBatch(NamedTuple):
    """All springs; the vector between the ends is d = sum(factor_k q[base_k]) + offset."""

    base: NDArray[np.int64]  # (n, k) slots of the two elements, -1 unused; k = 8 for cables
    dest: NDArray[np.int64]  # (n, k*k) places of the 3x3 blocks in the matrix
    factor: FloatArray  # (n, k) shape functions, negative at the first end
    offset: FloatArray  # (n, 3) position of a fixed second end
    data: FloatArray  # (n, 7) stiffness, damping, length, 1 if slack, friction, its rate, 1 if left out now
    inside: NDArray[np.int64]  # (n,) 1: its stiffness is in the matrix that was assembled last
    begins: NDArray[np.int64]  # (2 n + 1,) curves of each: force over elongation, force over its rate
    place: FloatArray  # (m,) see connections/curves.py
    height: FloatArray  # (m,)
    area: FloatArray  # (m,)
    wanted: NDArray[np.int64]  # (k,) springs that sensors record; none in a System, see :func:`gauges`
    found: FloatArray  # (n, 2) FORCE, DISTANCE where those were measured last


@formula
def spring_vector(batch, e, q, fixed):
    """Vector from the first to the second end (fixed = 1) or its rate (fixed = 0)."""
    x, y, z = fixed * batch.offset[e, 0], fixed * batch.offset[e, 1], fixed * batch.offset[e, 2]
    for k in range(batch.base.shape[1]):
        i = batch.base[e, k]
        if i >= 0:
            w = batch.factor[e, k]
            x += w * q[i]
            y += w * q[i + 1]
            z += w * q[i + 2]
    return x, y, z


@formula
def spring_state(batch, e, q, v):
    """Direction, length, rate, tension and whether the spring carries."""
    x, y, z = spring_vector(batch, e, q, 1.0)
    length = max(math.sqrt(x * x + y * y + z * z), 1e-100)
    n = (x / length, y / length, z / length)
    dx, dy, dz = spring_vector(batch, e, v, 0.0)
    rate = n[0] * dx + n[1] * dy + n[2] * dz
    extension = length - batch.data[e, LENGTH]
    tension = batch.data[e, STIFFNESS] * extension + batch.data[e, DAMPING] * rate
    if batch.data[e, SLACK] != 0.0:
        slack = extension <= 0.0 or tension <= 0.0
        return n, length, rate, 0.0 if slack else tension, not slack
    tension += looked_up(batch, 2 * e, extension)[0] + looked_up(batch, 2 * e + 1, rate)[0]
    if batch.data[e, FRICTION] != 0.0:
        tension += batch.data[e, FRICTION] * math.tanh(rate / batch.data[e, CREEP])
    return n, length, rate, tension, True


@formula
def spring_slopes(batch, e, length, rate):
    """Derivatives of the tension of a spring that carries by its length and by its rate."""
    k = batch.data[e, STIFFNESS] + looked_up(batch, 2 * e, length - batch.data[e, LENGTH])[1]
    c = batch.data[e, DAMPING] + looked_up(batch, 2 * e + 1, rate)[1]
    if batch.data[e, FRICTION] != 0.0:
        share = math.tanh(rate / batch.data[e, CREEP])
        c += batch.data[e, FRICTION] / batch.data[e, CREEP] * (1.0 - share * share)
    return k, c


@formula
def spring_gradient(batch, e, q, b):
    """Add the gradient of the length of spring e to b."""
    x, y, z = spring_vector(batch, e, q, 1.0)
    il = 1.0 / max(math.sqrt(x * x + y * y + z * z), 1e-100)
    n = (x * il, y * il, z * il)
    for k in range(batch.base.shape[1]):
        i = batch.base[e, k]
        if i >= 0:
            for c in range(3):
                b[i + c] += batch.factor[e, k] * n[c]


@inline_kernel
def spring_force(batch, q, v, a, r, ws):
    """Add the spring forces to r."""
    for e in range(batch.base.shape[0]):
        if batch.data[e, IDLE] != 0.0:
            continue
        n, _, _, tension, carries = spring_state(batch, e, q, v)
        if carries:
            for k in range(batch.base.shape[1]):
                i = batch.base[e, k]
                if i >= 0:
                    f = batch.factor[e, k] * tension
                    for c in range(3):
                        r[i + c] += f * n[c]


@inline_kernel
def spring_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add stiffness and damping of the springs that carry to A."""
    for e in range(batch.base.shape[0]):
        if batch.data[e, IDLE] != 0.0:
            continue
        n, length, rate, tension, carries = spring_state(batch, e, q, v)
        batch.inside[e] = carries
        if not carries:
            continue
        k_slope, c_slope = spring_slopes(batch, e, length, rate)
        across = c_stiffness * tension / length
        along = c_stiffness * k_slope + c_damping * c_slope - across
        size = batch.base.shape[1]
        for k in range(size):
            for m in range(size):
                place = batch.dest[e, size * k + m]
                if place < 0:
                    continue
                w = batch.factor[e, k] * batch.factor[e, m]
                for i in range(3):
                    A[place + 7 * i] += w * across
                    for j in range(3):
                        A[place + 6 * i + j] += w * along * n[i] * n[j]


@inline_kernel
def spring_tangent_work(batch, q, v, x, by_q, by_v, by_a, ws):
    """See :func:`ancf.compiled.add_tangent_work`."""
    for e in range(batch.base.shape[0]):
        n, length, rate, tension, carries = spring_state(batch, e, q, v)
        if batch.data[e, IDLE] != 0.0 or not carries:
            continue
        k_slope, c_slope = spring_slopes(batch, e, length, rate)
        across, d = tension / length, spring_vector(batch, e, x, 0.0)
        moved = n[0] * d[0] + n[1] * d[1] + n[2] * d[2]
        along, lost = (k_slope - across) * moved, c_slope * moved
        for k in range(batch.base.shape[1]):
            i = batch.base[e, k]
            if i >= 0:
                w = batch.factor[e, k]
                for c in range(3):
                    by_q[i + c] += w * (along * n[c] + across * d[c])
                    by_v[i + c] += w * lost * n[c]


@inline_kernel
def spring_rate_stiffness(batch, q, v, S, W, ws):
    """See :func:`ancf.compiled.add_rate_stiffness`: where a spring turns, its rate changes.

    With the velocity d' of one end against the other, (d' - (n.d') n)/length is the derivative of the rate.
    """
    size = batch.base.shape[1]
    for e in range(batch.base.shape[0]):
        n, length, rate, _, carries = spring_state(batch, e, q, v)
        if not carries:
            continue
        c = spring_slopes(batch, e, length, rate)[1]
        if c == 0.0:
            continue
        x, y, z = spring_vector(batch, e, v, 0.0)
        c *= 0.5 / length
        t = (c * (x - rate * n[0]), c * (y - rate * n[1]), c * (z - rate * n[2]))
        for k in range(size):
            for m in range(size):
                place = batch.dest[e, size * k + m]
                if place < 0:
                    continue
                w = batch.factor[e, k] * batch.factor[e, m]
                for i in range(3):
                    for j in range(3):
                        S[place + 6 * i + j] += w * (n[i] * t[j] + t[i] * n[j])
                        W[place + 6 * i + j] += w * (n[i] * t[j] - t[i] * n[j])


@inline_kernel
def spring_rate_work(batch, q, v, x, out, ws):
    """See :func:`ancf.compiled.add_rate_work`."""
    for e in range(batch.base.shape[0]):
        n, length, rate, _, carries = spring_state(batch, e, q, v)
        if not carries:
            continue
        c = spring_slopes(batch, e, length, rate)[1]
        if c == 0.0:
            continue
        dx, dy, dz = spring_vector(batch, e, x, 0.0)
        f = c * (n[0] * dx + n[1] * dy + n[2] * dz) / length
        vx, vy, vz = spring_vector(batch, e, v, 0.0)
        y = (f * (vx - rate * n[0]), f * (vy - rate * n[1]), f * (vz - rate * n[2]))
        for k in range(batch.base.shape[1]):
            i = batch.base[e, k]
            if i >= 0:
                for m in range(3):
                    out[i + m] += batch.factor[e, k] * y[m]


@formula
def spring_by_numbers(batch, e, length, rate):
    """Derivatives of the tension of a spring that carries, by its numbers but the two flags."""
    extension = length - batch.data[e, LENGTH]
    by_length = -(batch.data[e, STIFFNESS] + looked_up(batch, 2 * e, extension)[1])
    share, by_creep = 0.0, 0.0
    if batch.data[e, SLACK] == 0.0:
        creep = batch.data[e, CREEP]
        share = math.tanh(rate / creep)
        by_creep = -batch.data[e, FRICTION] * (1.0 - share * share) * rate / creep**2
    return extension, rate, by_length, share, by_creep


@inline_kernel
def spring_number_work(batch, q, v, a, x, out, ws):
    """See :func:`ancf.compiled.add_number_work`: the numbers of a spring act on its tension alone."""
    columns = batch.data.shape[1]
    for e in range(batch.base.shape[0]):
        n, length, rate, _, carries = spring_state(batch, e, q, v)
        if batch.data[e, IDLE] != 0.0 or not carries:
            continue
        dx, dy, dz = spring_vector(batch, e, x, 0.0)
        moved = n[0] * dx + n[1] * dy + n[2] * dz
        by, first = spring_by_numbers(batch, e, length, rate), columns * e
        out[first + STIFFNESS] += moved * by[0]
        out[first + DAMPING] += moved * by[1]
        out[first + LENGTH] += moved * by[2]
        out[first + FRICTION] += moved * by[3]
        out[first + CREEP] += moved * by[4]


@inline_kernel
def spring_changes(batch, q, v, a, rates, kinds, begin, out, ws):
    """See :func:`ancf.compiled.add_changes`; ``kinds``: the first and the last of the springs that change."""
    count, columns = batch.data.shape
    for m in range(begin.shape[0]):
        for e in range(kinds[2 * m], kinds[2 * m + 1]):
            n, length, rate, _, carries = spring_state(batch, e, q, v)
            if batch.data[e, IDLE] != 0.0 or not carries:
                continue
            by, first = spring_by_numbers(batch, e, length, rate), columns * (m * count + e)
            change = rates[first + STIFFNESS] * by[0] + rates[first + DAMPING] * by[1]
            change += rates[first + LENGTH] * by[2]
            change += rates[first + FRICTION] * by[3] + rates[first + CREEP] * by[4]
            for k in range(batch.base.shape[1]):
                i = batch.base[e, k]
                if i >= 0:
                    for c in range(3):
                        out[begin[m] + i + c] += batch.factor[e, k] * change * n[c]


def kinds_of(batch: SpringBatch, rates: FloatArray) -> list[int]:
    """The first of the springs whose numbers change, and the one behind the last."""
    rows = np.flatnonzero(np.any(rates.reshape(batch.data.shape) != 0.0, axis=1))
    return [int(rows[0]), int(rows[-1]) + 1] if len(rows) else [0, 0]


@inline_kernel
def spring_energy(batch, q, ws):
    """Elastic energy of the springs, J."""
    energy = 0.0
    for e in range(batch.base.shape[0]):
        x, y, z = spring_vector(batch, e, q, 1.0)
        extension = math.sqrt(x * x + y * y + z * z) - batch.data[e, LENGTH]
        if extension > 0.0 or batch.data[e, SLACK] == 0.0:
            energy += 0.5 * batch.data[e, STIFFNESS] * extension**2 + looked_up(batch, 2 * e, extension)[2]
    return energy


@inline_kernel
def spring_measure(batch, q, v):
    """Fill ``found`` of the springs that are wanted for the state (q, v)."""
    for k in range(batch.wanted.shape[0]):
        e = batch.wanted[k]
        _, length, _, tension, _ = spring_state(batch, e, q, v)
        batch.found[e, FORCE], batch.found[e, DISTANCE] = tension, length


def gauges(batch: SpringBatch, wanted: NDArray[np.int64], measured: FloatArray) -> SpringBatch:
    """The same springs, of which these are measured; they leave what they find in ``measured``, (n, 2)."""
    return batch._replace(wanted=wanted, found=measured)


def _damped(batch):
    """Whether a spring takes energy."""
    return bool(np.any(batch.data[:, (DAMPING, FRICTION)])) or bool(np.any(np.diff(batch.begins)[1::2]))


def _some(batch, rows):
    """Some of the springs, with their curves."""
    curves = [k for e in rows for k in (2 * e, 2 * e + 1)]
    points = [np.arange(batch.begins[k], batch.begins[k + 1]) for k in curves]
    own = np.concatenate([np.zeros(0, dtype=np.int64), *points])
    kept = {
        name: getattr(batch, name)[rows] for name in ("base", "dest", "factor", "offset", "data", "inside")
    }
    return batch._replace(
        **kept,
        begins=np.cumsum([0, *map(len, points)]).astype(np.int64),
        place=batch.place[own],
        height=batch.height[own],
        area=batch.area[own],
        wanted=np.zeros(0, dtype=np.int64),
        found=np.zeros((0, 2)),
    )


implements(
    SpringBatch,
    force=spring_force,
    tangent=spring_tangent,
    tangent_work=spring_tangent_work,
    energy=spring_energy,
    measure=spring_measure,
    rate_stiffness=spring_rate_stiffness,
    rate_work=spring_rate_work,
    number_work=spring_number_work,
    changes=spring_changes,
    kinds=kinds_of,
    numbers=lambda batch: batch.data.ravel(),
    numbered=("data",),
    role=Role.DISSIPATES | Role.MEASURES,
    damped=_damped,
    some=_some,
    exact=lambda batch, moving: not (moving and _damped(batch)),
)
