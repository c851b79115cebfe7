"""Forces on points and along beams by laws that users give: F(t, r, v), compiled for the kernels to call.

A law is a C function of a time and of nine numbers: position, velocity, and the force that it leaves.  The
kernels know its address, so that a new law compiles nothing but itself.  The matrix takes the symmetric
part of its derivatives, by central differences.

A law that stays in Python is called once a step, where the step first looks for its end, and its force is
then kept: that place is off by the third power of the step, the velocity by the second.  A point at rest, as
in an equilibrium, is asked anew each time.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import Role, formula, implements, inline_kernel
from ..elements.shapes import gauss
from ..model.loads.load import DistributedLoad
from ..simd import every, load, store
from ..vectors import dot
from .at_points import add_force_at, add_tangent_at, at_point, at_points
from .law_functions import address_of

#: Step of the differences, of the size of the model, and of a velocity plus that size per second.
STEP = 1e-6
#: The same of order four, and its weights.
WIDE, NEAR, FAR = 1e-4, 8.0 / 12.0, -1.0 / 12.0
FORCE = 6  # where the force stands in the nine numbers
#: Gauss points of an element for a load along it: exact where the law is linear in place and velocity.
POINTS = 4


class StateForceBatch(NamedTuple):
    """All forces that depend on the state."""

    base: NDArray[np.int64]  # (n, k)
    dest: NDArray[np.int64]  # (n, k*k)
    factor: FloatArray  # (n, k)
    winch: NDArray[np.int64]  # (n,) of places along a cable with a winch the unknown of the length, -1: none
    unwound: FloatArray  # (n,) of them 1/L0, 1/m
    passing: FloatArray  # (n, k) of them factors of D r, see loads/along.py
    law: NDArray[np.int64]  # (n,) addresses
    weight: FloatArray  # (n,) length for which a point of a distributed load stands, m; 1 at a point
    item: NDArray[np.int64]  # (n,) row of `value`
    size: FloatArray  # (n,) of the model, m
    data: FloatArray  # (n, 9) scratch memory of the calls
    rows: FloatArray  # (n, 3, 3) of the differences
    once: NDArray[np.bool_]  # (n,) is called once a step
    kept: FloatArray  # (n, 4) of such a law: the time when it was called, and the force
    value: FloatArray  # (items, 1, 3) inputs now: t at [k, 0, 0]


def build(items, locate, value):
    """Batch of forces at points, and of loads along beams, which act at Gauss points of the elements."""
    points, weights, laws, rows, spread = [], [], [], [], []
    for k, item in enumerate(items):
        law = law_of(item)
        for point, weight in places_of(item):
            points.append(point)
            weights.append(weight)
            laws.append(law)
            rows.append(k)
            spread.append(isinstance(item, DistributedLoad))
    n = len(points)
    fields = at_points(points, locate)
    kept = np.zeros((n, 4))
    kept[:, 0] = np.inf
    return StateForceBatch(
        **fields,
        **_wound(points, spread, locate, fields["factor"].shape),
        law=np.array([address_of(law) for law in laws], dtype=np.int64),
        once=np.array([bool(law.once) for law in laws]),
        kept=kept,
        weight=np.array(weights),
        item=np.array(rows, dtype=np.int64),
        size=np.array([law.size for law in laws]),
        data=np.zeros((n, 9)),
        rows=np.zeros((n, 3, 3)),
        value=value,
    )


def _wound(points, spread, locate, shape):
    """Fields ``winch``, ``unwound`` and ``passing``; ``spread``: which points are of loads along a beam."""
    winch, unwound = np.full(len(points), -1, dtype=np.int64), np.zeros(len(points))
    passing = np.zeros(shape)
    for e in np.flatnonzero(spread):
        probe = locate(points[e])
        if probe.unknown >= 0:
            winch[e], unwound[e] = probe.unknown, 1.0 / probe.beam.length
            used = np.flatnonzero(probe.S[0])
            passing[e, : len(used)] = (probe.x - probe.far) * probe.S[1][used]
    return {"winch": winch, "unwound": unwound, "passing": passing}


def law_of(item):
    """The law of a force at a point or of a distributed load."""
    return item.load if isinstance(item, DistributedLoad) else item.force


def places_of(item):
    """Points where an item acts, and the lengths for which they stand."""
    if not isinstance(item, DistributedLoad):
        return [(item.point, 1.0)]
    beam, (x0, x1) = item.body, item.between
    xi, share = gauss(POINTS)
    found = []
    for a, b in zip(beam.node_x[:-1], beam.node_x[1:], strict=True):
        low, high = max(float(a), x0), min(float(b), x1)
        if high > low:
            found += [
                (beam.at(low + (high - low) * float(x)), (high - low) * float(w))
                for x, w in zip(xi, share, strict=True)
            ]
    return found


@intrinsic
def call(typing_context, address, time, data):
    """Call the function at an address with a time and the address of the numbers."""

    def code(context, builder, signature, arguments):
        double, pointer = ir.DoubleType(), ir.IntType(8).as_pointer()
        function = ir.FunctionType(double, [double, pointer]).as_pointer()
        where = builder.inttoptr(arguments[0], function)
        return builder.call(where, [arguments[1], builder.inttoptr(arguments[2], pointer)])

    return types.float64(types.int64, types.float64, types.uintp), code


@formula
def passing_at(batch, e, q):
    """D r at point e of a cable with a winch, of material that passes."""
    x, y, z = 0.0, 0.0, 0.0
    for k in range(batch.base.shape[1]):
        i, w = batch.base[e, k], batch.passing[e, k]
        if i >= 0:
            x += w * q[i]
            y += w * q[i + 1]
            z += w * q[i + 2]
    return x, y, z


@formula
def put_state(batch, e, q, v):
    """Position and velocity of the material at point e to where its law looks for them; the length there."""
    batch.data[e, 0], batch.data[e, 1], batch.data[e, 2] = at_point(batch, e, q)
    x, y, z = at_point(batch, e, v)
    i, size = batch.winch[e], batch.weight[e]
    if i >= 0:
        mu, d = v[i] / q[i], passing_at(batch, e, q)
        x, y, z = x - mu * d[0], y - mu * d[1], z - mu * d[2]
        size *= q[i] * batch.unwound[e]
    batch.data[e, 3], batch.data[e, 4], batch.data[e, 5] = x, y, z
    return size


@formula
def law_force(batch, e, w):
    """Force of law e in the state that has been put, on the length w."""
    call(batch.law[e], batch.value[batch.item[e], 0, 0], batch.data[e].ctypes.data)
    return w * batch.data[e, FORCE], w * batch.data[e, FORCE + 1], w * batch.data[e, FORCE + 2]


@formula
def force_now(batch, e, w):
    """The same, of a law that is called once a step what it gave first."""
    if not batch.once[e]:
        return law_force(batch, e, w)
    kept, t = batch.kept[e], batch.value[batch.item[e], 0, 0]
    moves = batch.data[e, 3] != 0.0 or batch.data[e, 4] != 0.0 or batch.data[e, 5] != 0.0
    if not (moves and kept[0] == t):
        kept[1], kept[2], kept[3] = law_force(batch, e, w)
        kept[0] = t
    return kept[1], kept[2], kept[3]


@inline_kernel
def state_force(batch, q, v, a, r, ws):
    """Subtract the forces from r."""
    for e in range(batch.base.shape[0]):
        force = force_now(batch, e, put_state(batch, e, q, v))
        add_force_at(batch, e, force, r)
        i = batch.winch[e]
        if i >= 0:
            d = passing_at(batch, e, q)
            r[i] += (force[0] * d[0] + force[1] * d[1] + force[2] * d[2]) / q[i]


@formula
def add_differences(batch, e, size, first, step, weight):
    """Subtract ``weight`` times the derivatives by the numbers from ``first`` on from the rows."""
    for j in range(3):
        here = batch.data[e, first + j]
        batch.data[e, first + j] = here + step
        fx, fy, fz = law_force(batch, e, size)
        batch.data[e, first + j] = here - step
        gx, gy, gz = law_force(batch, e, size)
        batch.data[e, first + j] = here
        w = weight / (2.0 * step)
        batch.rows[e, 0, j] -= w * (fx - gx)
        batch.rows[e, 1, j] -= w * (fy - gy)
        batch.rows[e, 2, j] -= w * (fz - gz)


@formula
def steps_of(batch, e):
    """Steps of the differences by place and by velocity."""
    speed = abs(batch.data[e, 3]) + abs(batch.data[e, 4]) + abs(batch.data[e, 5])
    return batch.size[e], batch.size[e] + speed


@inline_kernel
def state_force_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add the symmetric part of minus the derivatives by position and velocity."""
    for e in range(batch.base.shape[0]):
        if batch.once[e] and (c_mass != 0.0 or c_damping != 0.0):
            continue  # in a step its force does not change
        size = put_state(batch, e, q, v)
        for i in range(3):
            for j in range(3):
                batch.rows[e, i, j] = 0.0
        if c_stiffness != 0.0:
            add_differences(batch, e, size, 0, STEP * batch.size[e], c_stiffness)
        if c_damping != 0.0:
            add_differences(batch, e, size, 3, STEP * steps_of(batch, e)[1], c_damping)
        m = batch.rows[e]
        xy, xz, yz = 0.5 * (m[0, 1] + m[1, 0]), 0.5 * (m[0, 2] + m[2, 0]), 0.5 * (m[1, 2] + m[2, 1])
        rows = ((m[0, 0], xy, xz), (xy, m[1, 1], yz), (xz, yz, m[2, 2]))
        add_tangent_at(batch, e, rows, A)


@formula
def law_by(batch, e, size, j, step):
    """Derivative of the force by number j of the state that has been put, of order four."""
    here, x, y, z = batch.data[e, j], 0.0, 0.0, 0.0
    for m in range(4):
        batch.data[e, j] = here + step * (m - 2.0 if m < 2 else m - 1.0)
        w = (FAR if m == 0 or m == 3 else NEAR) * (1.0 if m > 1 else -1.0) / step
        f = law_force(batch, e, size)
        x, y, z = x + w * f[0], y + w * f[1], z + w * f[2]
    batch.data[e, j] = here
    return x, y, z


@inline_kernel
def state_force_slopes(batch, q, v, a, x, by_q, by_v, by_a, ws):
    """See :func:`ancf.compiled.add_work_slopes`: of laws by differences of order four."""
    for e in range(batch.base.shape[0]):
        size, X = put_state(batch, e, q, v), at_point(batch, e, x)
        by_place, by_speed = steps_of(batch, e)
        for c in range(3):
            along = dot(law_by(batch, e, size, c, WIDE * by_place), X)
            faster = dot(law_by(batch, e, size, 3 + c, WIDE * by_speed), X)
            for k in range(batch.base.shape[1]):
                i = batch.base[e, k]
                if i >= 0:
                    by_q[i + c] -= batch.factor[e, k] * along
                    by_v[i + c] -= batch.factor[e, k] * faster


@formula
def at_point_in_lanes(batch, e, d, n, c):
    """Component c of what place, n = 0, or velocity of point e changes by along eight directions."""
    x = every(0.0)
    for k in range(batch.base.shape[1]):
        i = batch.base[e, k]
        if i >= 0:
            x = x + batch.factor[e, k] * load(d, n, i + c)
    return x


@formula
def add_law_along(batch, e, q, v, d, r, apart):
    """Subtract the change of force e along eight directions from r; ``apart``: what tangents lack of it."""
    size = put_state(batch, e, q, v)
    steps = steps_of(batch, e)
    x, y, z = every(0.0), every(0.0), every(0.0)
    for n in range(2):
        step, m = steps[0] if n == 0 else steps[1], batch.rows[e]
        for i in range(3):
            for j in range(3):
                m[i, j] = 0.0
        if apart:
            add_differences(batch, e, size, 3 * n, STEP * step, 1.0)
        for c in range(3):
            f, by = law_by(batch, e, size, 3 * n + c, WIDE * step), at_point_in_lanes(batch, e, d, n, c)
            x = x + (f[0] + 0.5 * (m[0, c] + m[c, 0])) * by
            y = y + (f[1] + 0.5 * (m[1, c] + m[c, 1])) * by
            z = z + (f[2] + 0.5 * (m[2, c] + m[c, 2])) * by
    for k in range(batch.base.shape[1]):
        i, w = batch.base[e, k], batch.factor[e, k]
        if i >= 0:
            store(load(r, i) - w * x, r, i)
            store(load(r, i + 1) - w * y, r, i + 1)
            store(load(r, i + 2) - w * z, r, i + 2)


@inline_kernel
def state_force_along(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_force_slopes`."""
    for e in range(batch.base.shape[0]):
        add_law_along(batch, e, q, v, d, r, False)


@inline_kernel
def state_force_beside(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_slopes_beside`: the antisymmetric part, and how differences differ."""
    for e in range(batch.base.shape[0]):
        add_law_along(batch, e, q, v, d, r, True)


implements(
    StateForceBatch,
    force=state_force,
    tangent=state_force_tangent,
    work_slopes=state_force_slopes,
    force_slopes=state_force_along,
    slopes_beside=state_force_beside,
    sloped=lambda batch: not (np.any(batch.once) or np.any(batch.winch >= 0)),
    role=Role.EXTERNAL,
    slots=("base", "winch"),
)
