"""What loads along bodies have in common: points of quadrature, their place and tangent, forces on them.

A batch of such a load has a row for each element that it acts on, and in each row the same number of points.
A point p of a row e stands for the piece of reference length ``weight[e, p]`` around it:

    r = sum_k shape[e, p, k] q[base[e, k]],      r_x = sum_k slope[e, p, k] q[base[e, k]].

The piece reaches from the sum of the weights before it to that with its own, so that the pieces of an element
cover it; ``shift[e, p]`` is the way from the point to the middle of its piece.

A point mass or the centre of a rigid body is a row with one point of weight 1 and without a slope.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..compiled import inline_kernel
from ..elements.registry import ELEMENTS
from ..elements.shapes import gauss
from ..model.beam import Beam
from ..model.bodies import Body, PointMass, RigidBody
from ..model.points import Point


def along(
    bodies: Iterable[Body], locate: Callable[[Any], Any], points: int
) -> tuple[dict[str, NDArray[Any]], list[Body]]:
    """Fields ``base``, ``dest``, ``shape``, ``slope``, ``weight``, ``shift`` of a batch; bodies of its rows.

    Parameters
    ----------
    bodies : iterable of Beam, PointMass or RigidBody
    locate : function
        Finds the probe of a point.
    points : int
        Gauss points of an element.
    """
    xi, w = gauss(points)
    rows: list[tuple[Any, ...]] = []
    owners: list[Body] = []
    for body in bodies:
        found = _of_beam(body, locate, xi, w) if isinstance(body, Beam) else [_of_point(body, locate, points)]
        rows += found
        owners += [body] * len(found)
    n, k = len(rows), max((len(row[0]) for row in rows), default=1)
    fields: dict[str, NDArray[Any]] = {
        "base": np.full((n, k), -1, dtype=np.int64),
        "dest": np.full((n, k * k), -1, dtype=np.int64),
        "shape": np.zeros((n, points, k)),
        "slope": np.zeros((n, points, k)),
        "weight": np.zeros((n, points)),
        "shift": np.zeros((n, points)),
    }
    for e, (slots, shape, slope, weight, shift) in enumerate(rows):
        used = slice(0, len(slots))
        fields["base"][e, used] = slots
        fields["shape"][e, :, used], fields["slope"][e, :, used] = shape, slope
        fields["weight"][e], fields["shift"][e] = weight, shift
    return fields, owners


def _of_beam(beam: Beam, locate: Callable[[Any], Any], xi: Any, w: Any) -> list[tuple[Any, ...]]:
    """Slots, factors and weights of each element."""
    shape, made = ELEMENTS[beam.element].shape, {}
    rows = []
    for a, b in zip(beam.node_x[:-1].tolist(), beam.node_x[1:].tolist(), strict=True):
        h = b - a
        if h not in made:
            made[h] = (
                shape(beam.element, xi, h),
                shape(beam.element, xi, h, derivative="r_x"),
            )
        S, dS = made[h]
        slots = locate(Point(beam, 0.5 * (a + b), "")).slots
        used = np.flatnonzero(np.any(S != 0.0, axis=0) | np.any(dS != 0.0, axis=0))
        rows.append((slots[used], S[:, used], dS[:, used], w * h, (np.cumsum(w) - 0.5 * w - xi) * h))
    return rows


def _of_point(body: PointMass | RigidBody, locate: Callable[[Any], Any], points: int) -> tuple[Any, ...]:
    """One point of weight 1, and others without weight in the same place."""
    slots = locate(body.point if isinstance(body, PointMass) else body.centre).slots[:1]
    return slots, np.ones((points, 1)), np.zeros((points, 1)), np.eye(points)[0], np.zeros(points)


@inline_kernel
def place_at(batch, e, p, q):
    """Position of point p of row e, or its velocity or acceleration from v or a."""
    x, y, z = 0.0, 0.0, 0.0
    for k in range(batch.base.shape[1]):
        i, w = batch.base[e, k], batch.shape[e, p, k]
        if i >= 0:
            x += w * q[i]
            y += w * q[i + 1]
            z += w * q[i + 2]
    return x, y, z


@inline_kernel
def tangent_at(batch, e, p, q):
    """Unit tangent t and the length of r_x; zeros for a point without a slope."""
    x, y, z = 0.0, 0.0, 0.0
    for k in range(batch.base.shape[1]):
        i, w = batch.base[e, k], batch.slope[e, p, k]
        if i >= 0:
            x += w * q[i]
            y += w * q[i + 1]
            z += w * q[i + 2]
    size = math.sqrt(x * x + y * y + z * z)
    inverse = 1.0 / size if size > 0.0 else 0.0
    return (x * inverse, y * inverse, z * inverse), size


@inline_kernel
def add_along(batch, e, p, fx, fy, fz, r):
    """Subtract a force on point p of row e, per reference length, from the residual r."""
    for k in range(batch.base.shape[1]):
        i = batch.base[e, k]
        if i >= 0:
            w = batch.weight[e, p] * batch.shape[e, p, k]
            r[i] -= w * fx
            r[i + 1] -= w * fy
            r[i + 2] -= w * fz


@inline_kernel
def add_block_along(batch, e, p, rows, A):
    """Add a symmetric 3x3 matrix per reference length, minus the derivative of the force by r, to A."""
    size = batch.base.shape[1]
    for k in range(size):
        wk = batch.weight[e, p] * batch.shape[e, p, k]
        for m in range(size):
            place = batch.dest[e, size * k + m]
            if place < 0:
                continue
            w = wk * batch.shape[e, p, m]
            for i in range(3):
                for j in range(3):
                    A[place + 6 * i + j] += w * rows[i][j]


@inline_kernel
def add_slope_block_along(batch, e, p, rows, A):
    """Add the symmetric part of what a 3x3 matrix, minus the derivative of the force by r_x, gives to A."""
    size = batch.base.shape[1]
    for k in range(size):
        for m in range(size):
            place = batch.dest[e, size * k + m]
            if place < 0:
                continue
            ahead = 0.5 * batch.weight[e, p] * batch.shape[e, p, k] * batch.slope[e, p, m]
            back = 0.5 * batch.weight[e, p] * batch.slope[e, p, k] * batch.shape[e, p, m]
            for i in range(3):
                for j in range(3):
                    A[place + 6 * i + j] += ahead * rows[i][j] + back * rows[j][i]
