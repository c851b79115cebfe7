"""From beams of the model to the flat arrays of a SolidBatch."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..model.bodies.beam import Beam
from ..model.sections.inertia import of_beam
from ..model.sections.section import Rectangle
from ..simd import LANES
from .chunks import elements_in, in_lanes
from .shapes import gauss
from .solid import SolidBatch
from .solid_force import gauss_table
from .solid_shapes import INTERNAL, initial_vectors, shape
from .solid_strains import quadratic_strains

__all__ = ["BATCH", "build", "initial_vectors", "quadratic_strains", "renumbered", "shape"]

BATCH = SolidBatch


def build(beams: Sequence[Beam], slots: Sequence[IntArray]) -> SolidBatch:
    """Batch of all elements of ``beams``, which have the same kind of element.

    Parameters
    ----------
    beams : sequence of Beam
        At least one.
    slots : sequence of ndarray, shape (nodes, vectors + internal)
        First unknown of each vector of each node; the internal vectors of element e are in row e.
    """
    internal = INTERNAL[beams[0].element] > 0
    parts = sorted((_part(beam, slot) for beam, slot in zip(beams, slots, strict=True)), key=lambda p: p[0])
    groups: list[list[int]] = []
    tables, first = [], [np.zeros(1, dtype=np.int64)]
    start = chunk = first_gp = 0
    for key, members in groupby(parts, key=lambda part: part[0]):
        points, damping, viscous, curved = key
        count = sum(len(member[1]) for member in members)
        ends = start + np.append(np.arange(LANES, count, LANES), count)
        first.append(ends)
        tables.append(gauss_table(points, internal))
        groups.append([chunk, chunk + len(ends), first_gp, points, damping, viscous, curved])
        start, chunk, first_gp = start + count, chunk + len(ends), first_gp + points
    bounds = np.concatenate(first)
    widest = max((part[3].shape[1] for part in parts), default=0)
    base, data = (np.concatenate([part[k] for part in parts]) for k in (1, 2))
    natural = np.concatenate([np.pad(p[3], ((0, 0), (0, widest - p[3].shape[1]))) for p in parts])
    return SolidBatch(
        base=np.ascontiguousarray(base, dtype=np.int64),
        dest=np.full((start, base.shape[1] ** 2), -1, dtype=np.int64),
        first=bounds,
        lane_base=in_lanes(base, bounds),
        lane_data=in_lanes(data, bounds, empty=2),
        lane_reference=in_lanes(natural, bounds),
        groups=np.array(groups, dtype=np.int64),
        gp=np.concatenate(tables),
        mass=mass_factors(internal),
        lane_scale=in_lanes(np.concatenate([part[4] for part in parts]), bounds),
    )


def renumbered(batch: SolidBatch, beam: Beam, slot: IntArray) -> SolidBatch | None:
    """The batch of a System with other constants of one of its beams; None where that lies among others.

    Parameters
    ----------
    batch : SolidBatch
    beam : Beam
        With the constants, as many elements and Gauss points.
    slot : ndarray, shape (nodes, vectors + internal)
        Its slots there.
    """
    (points, damping, viscous, curved), base, data, natural, scales = _part(beam, slot)
    found = np.flatnonzero((batch.base[:, 0] == base[0, 0]) & (batch.base[:, 4] == base[0, 4]))
    if len(found) != 1:
        return None
    first, last = int(found[0]), int(found[0]) + len(base)
    begin, end = np.searchsorted(batch.first, (first, last - 1), side="right") - (1, 0)
    [group] = np.flatnonzero((batch.groups[:, 0] <= begin) & (begin < batch.groups[:, 1]))
    if batch.groups[group, [3, 6]].tolist() != [points, curved]:
        return None
    groups = batch.groups.copy()
    groups[group, 4:6] |= (damping, viscous)  # of others in it that is a number, which is zero
    element, without = elements_in(batch.first[begin : end + 1])
    chunk, lanes = np.nonzero((element >= first) & (element < last))
    there, empty = element[chunk, lanes] - first, without[chunk, lanes]
    rows = data[there]
    rows[empty, 2:] = 0.0
    made = [array.copy() for array in (batch.lane_data, batch.lane_scale, batch.lane_reference)]
    width = natural.shape[1]
    made[0][begin + chunk, :, lanes] = rows
    made[1][begin + chunk, :, lanes] = scales[there]
    made[2][begin + chunk, :width, lanes] = natural[there]
    return batch._replace(groups=groups, lane_data=made[0], lane_scale=made[1], lane_reference=made[2])


def mass_factors(internal: bool) -> FloatArray:
    """Integrals over xi of the products of the shape functions, by columns of base, shape (10, 10).

    Times 420 for the columns of r (paper, eq. 23), times 60 for those of r_y and of r_z, without the powers
    of the element's length.
    """
    axis = [[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]]
    section = [[32, 8, 7], [8, 12, 3], [7, 3, 2]] if internal else [[20, 10, 0], [10, 20, 0], [0, 0, 0]]
    mass = np.zeros((10, 10))
    for columns, factors in (([0, 1, 4, 5], axis), ([2, 6, 8], section), ([3, 7, 9], section)):
        mass[np.ix_(columns, columns)] = factors
    return mass


def _scales(h: FloatArray, mass: FloatArray) -> FloatArray:
    """By columns of base: derivative of the element's vector, then the root of the mass, shape (n, 20).

    ``mass``: rhoA L/420, rho I_z L/60 and rho I_y L/60, shape (n, 3).
    """
    one = np.ones_like(h)
    vector = np.hstack([-1 / h, one, one, one, 1 / h, one, one, one, h, h])
    length = np.hstack([one, h, one, one, one, h, one, one, h, h])
    return np.hstack([vector, length * np.sqrt(mass)[:, [0, 0, 1, 2, 0, 0, 1, 2, 1, 2]]])


def natural_scalars(beam: Beam, xi: FloatArray) -> FloatArray:
    """Scalars of the natural shape at xi of every element, shape (elements, points, 15).

    The natural shape is interpolated, without its stretch; a straight one has no strain.  B and C are
    L r_yx and L r_zx as in the kernels.
    """
    out = np.zeros((beam.elements, len(xi), 15))
    natural = beam.natural
    if natural is None or _is_straight(natural):
        return out
    values = initial_vectors(natural)
    values[:, :2] /= natural.stretch
    for e in range(beam.elements):
        h = float(beam.node_x[e + 1] - beam.node_x[e])
        nodal = np.concatenate([values[e, :4], values[e + 1, :4], values[e, 4:]])
        a, b, c, B, C = (
            shape(beam.element, xi, h, derivative=k) @ nodal for k in ("r_x", "r_y", "r_z", "r_yx", "r_zx")
        )
        out[e] = _scalars(a, b, h * B, c, h * C)
    return out


def _scalars(a: FloatArray, b: FloatArray, B: FloatArray, c: FloatArray, C: FloatArray) -> FloatArray:
    """The scalars of :func:`ancf.elements.solid_force.strains`, shape (points, 15)."""
    squares = [(v, v) for v in (a, b, c)]
    products = [(B, B), (C, C), (B, C), (a, B), (a, C), (a, b), (a, c), (b, c)]
    mixed = [(b, B), (c, C), (b, C), (c, B)]
    out = np.stack([np.einsum("gk,gk->g", u, v) for u, v in squares + products + mixed], axis=1)
    out[:, :3] = 0.5 * (out[:, :3] - 1.0)
    return out


def _is_straight(beam: Beam) -> bool:
    turns = (np.abs(v - v[0]) for v in (beam.node_tangent, beam.node_y))
    return all(bool(np.all(turn < 1e-12)) for turn in turns)


def moments(section: Any, points: int) -> tuple[float, float, float, float, float]:
    """Integrals of y^2, z^2, y^4, z^4, y^2 z^2 over the section.

    Those of a rectangle with ``points`` Gauss points in each direction, exact from three points on.
    """
    if not isinstance(section.shape, Rectangle):
        return section.I_z, section.I_y, section.I_yyyy, section.I_zzzz, section.I_yyzz
    x, w = gauss(points)
    second, fourth = w @ (x - 0.5) ** 2, w @ (x - 0.5) ** 4
    y, z, A = section.shape.width, section.shape.height, section.A
    values = (second * y**2, second * z**2, fourth * y**4, fourth * z**4, (second * y * z) ** 2)
    return tuple(float(A * value) for value in values)  # type: ignore[return-value]


def stiffnesses(beam: Beam) -> tuple[float, ...]:
    """D A, lambda A, then M, lambda and G with the section's moments, in the order of the kernels' rows.

    ``poisson="full"`` is the material of the whole volume (the paper's); ``"centreline"`` couples the normal
    strains on the centreline alone, which frees bending of Poisson locking, and corrects shear and torsion.
    """
    s: Any = beam.section  # which has a material: the model sees to that
    full = beam.poisson == "full"
    Y, Z, YY, ZZ, YZ = moments(s, beam.gauss[1])
    G, lam = s.G, s.E * s.nu / ((1 + s.nu) * (1 - 2 * s.nu))
    D = lam + 2 * G
    M, coupling = (D, lam) if full else (s.E, 0.0)
    k_y, k_z = (1.0, 1.0) if full else s.shear_factors
    k_t = 1.0 if full else s.J / (s.I_y + s.I_z)
    return (
        *(D * s.A, lam * s.A),
        *(M * Y, M * Z, M * YY, M * ZZ, M * YZ, coupling * Y, coupling * Z),
        *(k_y * G * s.A, k_z * G * s.A, G * s.A, G * Y, G * Z, k_t * G * Z, k_t * G * Y),
    )


#: Powers of the element's length in the rows of :func:`stiffnesses`: B and C are L r_yx and L r_zx.
_POWERS = np.array([1, 1, -1, -1, -3, -3, -3, -1, -1, 1, 1, 1, -1, -1, -1, -1])


def _part(beam: Beam, slot: IntArray) -> tuple[tuple[int, ...], IntArray, FloatArray, FloatArray, FloatArray]:
    """Key of the group, base, constants, natural scalars and scales of one beam."""
    s: Any = beam.section  # as above
    h = np.diff(beam.node_x)[:, None]
    stiff = np.array(stiffnesses(beam)) * h ** _POWERS.astype(float)
    damp = np.hstack([s.axial_damping * h, s.bending_damping / h])
    about_y, about_z = of_beam(s)
    mass = np.hstack([s.rho * s.A * h / 420, about_z * h / 60, about_y * h / 60])
    viscous = np.full_like(h, s.damping / s.rhoA)
    data = np.hstack([h, 1 / h, stiff, damp, mass, viscous])
    points = beam.gauss[0]
    natural = natural_scalars(beam, gauss(points)[0])
    curved = bool(np.any(natural))
    table = natural.reshape(beam.elements, -1) if curved else np.zeros((beam.elements, 0))
    damping = bool(s.axial_damping or s.bending_damping)
    key = (points, int(damping), int(bool(s.damping)), int(curved))
    base = np.hstack([slot[:-1, :4], slot[1:, :4], slot[:-1, 4:]])
    return key, base, data, table, _scales(h, mass)
