"""What loads along bodies have in common: points of quadrature, their place and tangent, forces on them.

A batch of such a load has a row for each element that it acts on, and in each row the same number of points.
A point p of a row e stands for the piece of reference length ``weight[e, p]`` around it:

    r = sum_k shape[e, p, k] q[base[e, k]],      r_x = sum_k slope[e, p, k] q[base[e, k]].

The piece reaches from the sum of the weights before it to that with its own, so that the pieces of an element
cover it; ``shift[e, p]`` is the way from the point to the middle of its piece.

A point mass or the centre of a rigid body is a row with one point of weight 1 and without a slope.

Of a cable with a winch (:mod:`ancf.elements.winched`) the piece holds lam times that length of the material,
which passes the point: with D = X d/dX and mu = (dL/dt)/L its velocity is w = v - mu D r, its acceleration
a - (dmu/dt) D r - mu (2 D v - mu D D r), and a force f on it does the work f.w, so that -f.D r/L acts on L.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..compiled import formula, inline_kernel
from ..elements.registry import ELEMENTS
from ..elements.shapes import gauss
from ..model.bodies.beam import Beam
from ..model.bodies.rigid import Body, PointMass, RigidBody
from ..model.points import Point
from ..simd import every, load, store


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


def joined(parts: list[dict[str, NDArray[Any]]]) -> dict[str, NDArray[Any]]:
    """Rows of many :func:`along`, of one width."""
    k = max(part["base"].shape[1] for part in parts)
    found: dict[str, NDArray[Any]] = {}
    empties: dict[str, Any] = {"base": -1, "shape": 0.0, "slope": 0.0}
    for key, empty in empties.items():
        found[key] = np.concatenate([_widened(part[key], k, empty) for part in parts])
    for key in ("weight", "shift"):
        found[key] = np.concatenate([part[key] for part in parts])
    found["dest"] = np.full((len(found["base"]), k * k), -1, dtype=np.int64)
    return found


def _widened(x: NDArray[Any], k: int, empty: Any) -> NDArray[Any]:
    wide = np.full((*x.shape[:-1], k), empty, dtype=x.dtype)
    wide[..., : x.shape[-1]] = x
    return wide


def wound(bodies: Iterable[Body], locate: Callable[[Any], Any], points: int) -> dict[str, NDArray[Any]]:
    """Fields ``winch``, ``unwound``, ``passing``, ``twice`` for the rows that :func:`along` gives.

    The unknown of the length, -1 for none, and 1/L0; factors of D r and D D r at the points, which have no
    rows where there is no winch.
    """
    unknowns: list[int] = []
    lengths: list[float] = []
    rows: list[Any] = []
    xi, _ = gauss(points)
    for body in bodies:
        end = locate(body.start) if isinstance(body, Beam) else None
        unknown = getattr(end, "unknown", -1)
        count = body.elements if isinstance(body, Beam) else 1
        unknowns += [unknown] * count
        lengths += [1.0 / body.length if unknown >= 0 else 0.0] * count  # type: ignore[union-attr]
        rows += _passing(body, end, xi) if unknown >= 0 else [None] * count
    n, k = len(rows), max((len(row[0][0]) for row in rows if row), default=0)
    factors = np.zeros((2, n if k else 0, points, k))
    for e, row in enumerate(rows):
        if row:
            factors[:, e] = row
    return {
        "winch": np.array(unknowns, dtype=np.int64),
        "unwound": np.array(lengths),
        "passing": factors[0],
        "twice": factors[1],
    }


def ordered(bodies: Iterable[Body], locate: Callable[[Any], Any], points: int) -> dict[str, NDArray[Any]]:
    """Fields ``label`` and ``beside`` for the rows that :func:`along` gives, of beams.

    The X of the points of cables with a winch, m, and the rows that go on towards the far end and towards
    the winch, -1 for none.
    """
    xi, _ = gauss(points)
    label, beside = [np.zeros((0, points))], [np.zeros((0, 2), dtype=np.int64)]
    first = 0
    for body in bodies:
        assert isinstance(body, Beam)
        far, rows = locate(body.start).far, np.arange(first, first + body.elements)
        ends = body.node_x
        label.append(ends[:-1, None] + xi * np.diff(ends)[:, None] - far)
        before, after = np.where(rows > first, rows - 1, -1), np.where(rows < rows[-1], rows + 1, -1)
        beside.append(np.stack([after, before] if far > 0.0 else [before, after], axis=1))
        first += body.elements
    return {"label": np.concatenate(label), "beside": np.concatenate(beside)}


def _passing(beam: Any, end: Any, xi: Any) -> list[Any]:
    """Factors of D r and D D r at the points of each element."""
    shape, rows = ELEMENTS[beam.element].shape, []
    for a, b in zip(beam.node_x[:-1].tolist(), beam.node_x[1:].tolist(), strict=True):
        h = b - a
        X = (a + xi * h - end.far)[:, None]
        slope, bend = (shape(beam.element, xi, h, derivative=name) for name in ("r_x", "r_xx"))
        rows.append((X * slope, X * (slope + X * bend)))
    return rows


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


@formula
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


@formula
def stretch_at(batch, e, q):
    """Length of the material in row e as a multiple of that of the mesh."""
    i = batch.winch[e]
    return q[i] * batch.unwound[e] if i >= 0 else 1.0


@inline_kernel
def passed(base, factors, e, p, q):
    """Sum of factors of point p of row e times q."""
    x, y, z = 0.0, 0.0, 0.0
    for k in range(factors.shape[2]):
        i, w = base[e, k], factors[e, p, k]
        if i >= 0:
            x += w * q[i]
            y += w * q[i + 1]
            z += w * q[i + 2]
    return x, y, z


@formula
def velocity_at(batch, e, p, q, v):
    """Velocity of the material at point p of row e."""
    u, i = place_at(batch, e, p, v), batch.winch[e]
    if i < 0:
        return u
    mu, d = v[i] / q[i], passed(batch.base, batch.passing, e, p, q)
    return u[0] - mu * d[0], u[1] - mu * d[1], u[2] - mu * d[2]


@formula
def acceleration_at(batch, e, p, q, v, a):
    """Acceleration of the material at point p of row e."""
    b, i = place_at(batch, e, p, a), batch.winch[e]
    if i < 0:
        return b
    mu = v[i] / q[i]
    dmu = a[i] / q[i] - mu * mu
    d, dv = passed(batch.base, batch.passing, e, p, q), passed(batch.base, batch.passing, e, p, v)
    dd = passed(batch.base, batch.twice, e, p, q)
    return (
        b[0] - dmu * d[0] - mu * (2.0 * dv[0] - mu * dd[0]),
        b[1] - dmu * d[1] - mu * (2.0 * dv[1] - mu * dd[1]),
        b[2] - dmu * d[2] - mu * (2.0 * dv[2] - mu * dd[2]),
    )


@formula
def upstream(batch, e, p, comes):
    """Row and point next to point p of row e from which the material comes; row -1: there is none.

    It comes from the winch if ``comes`` is 1, from the far end if it is 0.
    """
    last = batch.label.shape[1] - 1
    up = (batch.label[e, last] < 0.0) != (comes == 1)  # whether that is towards higher numbers
    m = p + 1 if up else p - 1
    if 0 <= m <= last:
        return e, m
    return batch.beside[e, comes], 0 if up else last


@formula
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


@formula
def add_along(batch, e, p, fx, fy, fz, r):
    """Subtract a force on point p of row e, per reference length, from the residual r."""
    for k in range(batch.base.shape[1]):
        i = batch.base[e, k]
        if i >= 0:
            w = batch.weight[e, p] * batch.shape[e, p, k]
            r[i] -= w * fx
            r[i + 1] -= w * fy
            r[i + 2] -= w * fz


@formula
def add_material(batch, e, p, fx, fy, fz, q, r):
    """Subtract a force on point p of row e, per length of the material; also what acts on its length."""
    lam, i = stretch_at(batch, e, q), batch.winch[e]
    add_along(batch, e, p, lam * fx, lam * fy, lam * fz, r)
    if i >= 0:
        d = passed(batch.base, batch.passing, e, p, q)
        r[i] += batch.weight[e, p] * batch.unwound[e] * (fx * d[0] + fy * d[1] + fz * d[2])


@formula
def scaled(factor, rows):
    """A factor times a 3x3 matrix, of three tuples."""
    a, b, c = rows
    return (
        (factor * a[0], factor * a[1], factor * a[2]),
        (factor * b[0], factor * b[1], factor * b[2]),
        (factor * c[0], factor * c[1], factor * c[2]),
    )


@formula
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


@formula
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


@formula
def in_lanes(batch, e, p, factors, d, n):
    """Sum of the factors of point p times eight directions."""
    x, y, z = every(0.0), every(0.0), every(0.0)
    for k in range(batch.base.shape[1]):
        i, w = batch.base[e, k], factors[e, p, k]
        if i >= 0:
            x = x + w * load(d, n, i)
            y = y + w * load(d, n, i + 1)
            z = z + w * load(d, n, i + 2)
    return x, y, z


@formula
def add_lanes_along(batch, e, p, factors, w, f, r):
    """Subtract w times forces f in eight lanes on what the factors of point p of row e make from r."""
    for k in range(batch.base.shape[1]):
        i = batch.base[e, k]
        if i >= 0:
            s = w * batch.weight[e, p] * factors[e, p, k]
            for c in range(3):
                store(load(r, i + c) - s * f[c], r, i + c)


def let_stick(batch: Any) -> None:
    """Let the friction of a batch hold what it acts on, whatever that takes."""
    batch.limit[batch.limit > 0.0] = np.inf
