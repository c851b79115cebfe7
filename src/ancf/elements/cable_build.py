"""From beams of the model to the flat arrays of a CableBatch."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import FloatArray, IntArray
from ..model.bodies.beam import Beam
from ..simd import LANES
from .cable import CableBatch
from .cable_columns import (
    AXIAL,
    AXIALLY,
    BEGIN,
    BENDING,
    CURVED,
    DA_L,
    DAMPED,
    DB_L,
    EA_L,
    EI_L,
    END,
    IN_BENDING,
    IN_SLOPE,
    INV_L,
    LENGTH,
    MASS,
    PAPER,
    VISCOUS,
    VISCOUSLY,
)
from .cable_slack import slack
from .cable_strain import gauss_table
from .chunks import elements_in, in_lanes
from .measures import axial_strain, curvature
from .shapes import gauss, hermite

__all__ = ["BATCH", "build", "initial_vectors", "reference_strains", "renumbered", "shape", "slack"]

BATCH = CableBatch
#: Constants of an element that stay in lanes without one, where all others are zero.
LENGTHS = 2
#: Angle by which the natural shape bends an element, rad, below which it is straight: less is round-off of
#: the curvature where the strain changes along the element, with which that bend would turn at random.
STRAIGHT = 1e-9


def build(beams: Sequence[Beam], slots: Sequence[IntArray]) -> CableBatch:
    """Batch of all cable elements of ``beams``.

    Parameters
    ----------
    beams : sequence of Beam
    slots : sequence of ndarray, shape (nodes, 2)
        First unknown of r and of r_x of each node.
    """
    parts = sorted((_part(beam, slot) for beam, slot in zip(beams, slots, strict=True)), key=lambda p: p[0])
    groups: list[list[int]] = []
    tables = [np.zeros((0, 20))]
    first = [np.zeros(1, dtype=np.int64)]
    start = chunk = first_gp = 0
    for key, members in groupby(parts, key=lambda part: part[0]):
        paper, axial, bending, damped, curved = key
        count = sum(len(member[1]) for member in members)
        ends = start + np.append(np.arange(LANES, count, LANES), count)
        first.append(ends)
        tables.append(gauss_table(axial, bending))
        groups.append([chunk, chunk + len(ends), paper, first_gp, axial, bending, damped, curved])
        start, chunk, first_gp = start + count, chunk + len(ends), first_gp + axial + bending
    base, data, slope, reference = (np.concatenate([part[k] for part in parts]) for k in range(1, 5))
    bounds = np.concatenate(first)
    return CableBatch(
        base=np.ascontiguousarray(base, dtype=np.int64),
        dest=np.full((start, 16), -1, dtype=np.int64),
        first=bounds,
        lane_base=in_lanes(base, bounds).astype(np.int64),
        nodal=np.zeros(len(bounds) - 1, dtype=np.bool_),
        lane_data=in_lanes(data, bounds, empty=LENGTHS),
        lane_slope=in_lanes(slope, bounds, empty=0),
        lane_reference=in_lanes(reference, bounds),
        groups=np.array(groups, dtype=np.int64).reshape(-1, 8),
        gp=np.ascontiguousarray(np.concatenate(tables)),
        lane_block=np.zeros((len(bounds) - 1, 3, LANES), dtype=np.int64),
        order=np.zeros(len(bounds) - 1, dtype=np.int64),
    )


def renumbered(batch: CableBatch, beam: Beam, slot: IntArray) -> CableBatch | None:
    """The batch of a System with other constants of one of its beams; None where that lies among others.

    Parameters
    ----------
    batch : CableBatch
    beam : Beam
        With the constants, as many elements and Gauss points.
    slot : ndarray, shape (nodes, 2)
        Its slots there.
    """
    straight = beam.natural is None or not beam.natural.bends
    if len(batch.base) == beam.elements and straight and not batch.groups[0, CURVED]:
        return _all_renumbered(batch, beam)
    key, base, *constants = _part(beam, slot)
    found = np.flatnonzero((batch.base[:, 0] == base[0, 0]) & (batch.base[:, 2] == base[0, 2]))
    if len(found) != 1:
        return None
    first, last = int(found[0]), int(found[0]) + len(base)
    begin, end = np.searchsorted(batch.first, (first, last - 1), side="right") - (1, 0)
    [group] = np.flatnonzero((batch.groups[:, BEGIN] <= begin) & (begin < batch.groups[:, END]))
    if batch.groups[group, [PAPER, AXIAL, BENDING, CURVED]].tolist() != [*key[:3], key[4]]:
        return None
    groups = batch.groups.copy()
    groups[group, DAMPED] |= key[3]  # of others in it that is a number, which is zero
    element, without = elements_in(batch.first[begin : end + 1])
    chunk, lanes = np.nonzero((element >= first) & (element < last))
    there, empty = element[chunk, lanes] - first, without[chunk, lanes]
    made = [array.copy() for array in (batch.lane_data, batch.lane_slope, batch.lane_reference)]
    for array, values, kept in zip(made, constants, (LENGTHS, 0, None), strict=True):
        rows = values[there]
        if kept is not None:
            rows[empty, kept:] = 0.0
        array[begin + chunk, :, lanes] = rows
    return batch._replace(groups=groups, lane_data=made[0], lane_slope=made[1], lane_reference=made[2])


def _all_renumbered(batch: CableBatch, beam: Beam) -> CableBatch | None:
    """The same where the beam is the only one, without natural strains."""
    if batch.groups[0, [PAPER, AXIAL, BENDING]].tolist() != [beam.strain == "paper", *beam.gauss]:
        return None
    values, slope, damped = _constants(beam)
    element, without = elements_in(batch.first)
    rows, slopes = values[:, element].transpose(1, 0, 2), slope[element]  # (chunks, constants, lanes)
    if without[-1, -1]:
        rows[:, LENGTHS:][np.broadcast_to(without[:, None], rows[:, LENGTHS:].shape)] = 0.0
        slopes[without] = 0.0
    groups = batch.groups.copy()
    groups[0, DAMPED] |= damped
    data = np.ascontiguousarray(rows)
    return batch._replace(groups=groups, lane_data=data, lane_slope=slopes[:, None])


def shape(
    element: str, xi: ArrayLike, length: float, y: float = 0.0, z: float = 0.0, derivative: int | str = 0
) -> FloatArray:
    """Factors of r, r_x of both nodes in r, "r_x" or "r_xx", (..., 4); there are no points off the axis."""
    order = derivative if isinstance(derivative, int) else ("r", "r_x", "r_xx").index(derivative)
    return hermite(xi, length, order)


def initial_vectors(beam: Beam) -> FloatArray:
    """r (m) and r_x of the nodes in the initial shape, (nodes, 2, 3)."""
    return np.stack([beam.node_position, beam.stretch * beam.node_tangent], axis=1)


def reference_strains(beam: Beam) -> tuple[FloatArray, FloatArray]:
    """Strains of the interpolated natural shape.

    The natural axial strain is what interpolation alone causes (the true initial stretch stays); the
    natural curvature is that of the natural shape, zero of a straight one, and where it is round-off: a
    spline through points of a straight piece beside a bend never becomes quite straight.

    Returns
    -------
    eps0 : ndarray, shape (elements, 10)
        At the axial Gauss points, zero beyond them.
    kappa0 : ndarray, shape (elements, 10)
        At the bending Gauss points, 1/m.
    """
    n = beam.elements
    eps0, kappa0 = np.zeros((n, 10)), np.zeros((n, 10))
    natural = beam.natural
    if natural is None or not natural.bends:
        return eps0, kappa0
    h, nodes = np.diff(beam.node_x)[:, None], [natural.node_position, natural.stretch * natural.node_tangent]
    values = np.stack([*(x[:-1] for x in nodes), *(x[1:] for x in nodes)], axis=1)
    xa, xb = gauss(beam.gauss[0])[0], gauss(beam.gauss[1])[0]
    r_s = _slopes(xa, h, 1) @ values / natural.stretch
    eps0[:, : len(xa)] = axial_strain(r_s, beam.strain)
    kappa = curvature(_slopes(xb, h, 1) @ values, _slopes(xb, h, 2) @ values, beam.strain)
    kappa0[:, : len(xb)] = np.where(kappa * h < STRAIGHT, 0.0, kappa)
    return eps0, kappa0


def _slopes(xi: FloatArray, h: FloatArray, derivative: int) -> FloatArray:
    """Derivatives of the shape functions at places in elements of lengths h (n, 1), (n, places, 4)."""
    return hermite(np.broadcast_to(xi, (len(h), len(xi))), np.repeat(h, len(xi), axis=1), derivative)


def _part(beam: Beam, slot: IntArray) -> tuple[tuple[int, ...], IntArray, FloatArray, FloatArray, FloatArray]:
    """Key of the group, base, constants, slope damping and reference strains of one beam."""
    data, slope, damped = _constants(beam)
    eps0, kappa0 = reference_strains(beam)
    curved = bool(np.any(eps0) or np.any(kappa0))
    key = (int(beam.strain == "paper"), *beam.gauss, damped, int(curved))
    base, reference = np.hstack([slot[:-1], slot[1:]]), np.hstack([eps0, kappa0])
    return key, base, np.ascontiguousarray(data.T), slope[:, None], reference


def _constants(beam: Beam) -> tuple[FloatArray, FloatArray, int]:
    """Constants of a beam's elements, (8, n), their slope damping, (n,), and which damping there is."""
    s, h = beam.section, np.diff(beam.node_x)
    data = np.empty((8, len(h)))
    data[LENGTH], data[INV_L], data[EA_L], data[EI_L] = h, 1 / h, s.EA * h, s.EI * h
    data[DA_L], data[DB_L] = s.axial_damping * h, s.bending_damping * h
    data[MASS], data[VISCOUS] = s.rhoA * h / 420, s.damping / s.rhoA
    kinds = (VISCOUSLY, s.damping), (AXIALLY, s.axial_damping), (IN_BENDING, s.bending_damping)
    damped = sum(bit for bit, value in (*kinds, (IN_SLOPE, s.slope_damping)) if value)
    return data, s.slope_damping * h / 30, damped
