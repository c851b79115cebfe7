"""Pressure along beams and cables: f = p r_x x b per reference length, normal to the tangent and to b.

So it is p per present length, and turns with the beam in the plane normal to the fixed unit vector b.  On a
closed ring, or between ends that are held, it has a potential, the area; the matrix has the symmetric part of
its derivative, which is then all of it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import Role, implements, inline_kernel
from ..model.loads.followers import Pressure
from ..vectors import cross
from .along import (
    add_along,
    add_lanes_along,
    add_slope_block_along,
    along,
    in_lanes,
    place_at,
    tangent_at,
)

#: Gauss points of an element: exact for a cubic.
POINTS = 4


class PressureBatch(NamedTuple):
    """All pressures."""

    base: NDArray[np.int64]  # (n, k)
    dest: NDArray[np.int64]  # (n, k*k)
    shape: FloatArray  # (n, points, k)
    slope: FloatArray  # (n, points, k)
    weight: FloatArray  # (n, points) m
    shift: FloatArray  # (n, points) m
    axis: FloatArray  # (n, 3) b
    item: NDArray[np.int64]  # (n,) row of `value`
    value: FloatArray  # (items, 1, 3) p now, N/m, at [k, 0, 0]


def build(items, locate, value):
    """Batch of these loads."""
    fields, _owners = along([item.body for item in items], locate, POINTS)
    counts = [item.body.elements for item in items]
    rows = np.repeat(np.arange(len(items)), counts)
    return PressureBatch(**fields, axis=np.array([items[k].axis for k in rows]), item=rows, value=value)


def renumbered(batch: Any, model: Any, locate: Any) -> Any:
    """The batch of a model with beams of other lengths; ``locate`` finds the probe of a point."""
    bodies = [load.body for load in model.loads if isinstance(load, Pressure)]
    found = along(bodies, locate, POINTS)[0]
    return batch._replace(**{key: found[key] for key in ("weight", "shift", "shape", "slope")})


@inline_kernel
def pressure_force(batch, q, v, a, r, ws):
    """Subtract the forces from r."""
    for e in range(batch.base.shape[0]):
        b, pressure = batch.axis[e], batch.value[batch.item[e], 0, 0]
        for g in range(batch.weight.shape[1]):
            t, size = tangent_at(batch, e, g, q)
            p = pressure * size
            fx, fy = p * (t[1] * b[2] - t[2] * b[1]), p * (t[2] * b[0] - t[0] * b[2])
            add_along(batch, e, g, fx, fy, p * (t[0] * b[1] - t[1] * b[0]), r)


@inline_kernel
def pressure_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add the symmetric part of minus the derivatives."""
    for e in range(batch.base.shape[0]):
        p = c_stiffness * batch.value[batch.item[e], 0, 0]
        x, y, z = p * batch.axis[e, 0], p * batch.axis[e, 1], p * batch.axis[e, 2]
        rows = ((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0))
        for g in range(batch.weight.shape[1]):
            add_slope_block_along(batch, e, g, rows, A)


@inline_kernel
def pressure_work_slopes(batch, q, v, a, x, by_q, by_v, by_a, ws):
    """See :func:`ancf.compiled.add_work_slopes`: the work of a point is -p r_x.(b x X)."""
    for e in range(batch.base.shape[0]):
        p, b = batch.value[batch.item[e], 0, 0], (batch.axis[e, 0], batch.axis[e, 1], batch.axis[e, 2])
        for g in range(batch.weight.shape[1]):
            by, w = cross(b, place_at(batch, e, g, x)), -p * batch.weight[e, g]
            for k in range(batch.base.shape[1]):
                i = batch.base[e, k]
                if i >= 0:
                    for c in range(3):
                        by_q[i + c] += w * batch.slope[e, g, k] * by[c]


@inline_kernel
def pressure_slopes_along(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_force_slopes`."""
    for e in range(batch.base.shape[0]):
        p, b = batch.value[batch.item[e], 0, 0], (batch.axis[e, 0], batch.axis[e, 1], batch.axis[e, 2])
        for g in range(batch.weight.shape[1]):
            turned = cross(in_lanes(batch, e, g, batch.slope, d, 0), b)
            add_lanes_along(batch, e, g, batch.shape, p, turned, r)


@inline_kernel
def pressure_slopes_beside(batch, q, v, a, d, r, ws):
    """See :func:`ancf.compiled.add_slopes_beside`: the antisymmetric part."""
    for e in range(batch.base.shape[0]):
        p, b = 0.5 * batch.value[batch.item[e], 0, 0], (batch.axis[e, 0], batch.axis[e, 1], batch.axis[e, 2])
        for g in range(batch.weight.shape[1]):
            turned = cross(in_lanes(batch, e, g, batch.slope, d, 0), b)
            add_lanes_along(batch, e, g, batch.shape, p, turned, r)
            moved = cross(b, in_lanes(batch, e, g, batch.shape, d, 0))
            add_lanes_along(batch, e, g, batch.slope, -p, moved, r)


implements(
    PressureBatch,
    force=pressure_force,
    tangent=pressure_tangent,
    work_slopes=pressure_work_slopes,
    force_slopes=pressure_slopes_along,
    slopes_beside=pressure_slopes_beside,
    role=Role.EXTERNAL,
)
