"""From beams of the model to the flat arrays of a CableBatch."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from ..model.beam import Beam
from .cable import CableBatch
from .lanes import gauss_table
from .measures import axial_strain, curvature
from .shapes import FloatArray, gauss, hermite

IntArray = NDArray[np.int64]


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
    tables = []
    start = first_gp = 0
    for key, members in groupby(parts, key=lambda part: part[0]):
        paper, axial, bending, damped, curved = key
        stop = start + sum(len(member[1]) for member in members)
        tables.append(gauss_table(axial, bending))
        groups.append([start, stop, paper, first_gp, axial, bending, damped, curved])
        start, first_gp = stop, first_gp + axial + bending
    base, data, eps0, kappa0 = ([part[k] for part in parts] for k in range(1, 5))
    return CableBatch(
        base=_stack(base, 4, np.int64),
        dest=np.full((start, 16), -1, dtype=np.int64),
        data=_stack(data, 8, np.float64),
        eps0=_stack(eps0, 10, np.float64),
        kappa0=_stack(kappa0, 10, np.float64),
        groups=np.array(groups, dtype=np.int64).reshape(-1, 8),
        gp=np.ascontiguousarray(np.concatenate(tables)) if tables else np.zeros((0, 7)),
    )


def reference_strains(beam: Beam) -> tuple[FloatArray, FloatArray]:
    """Strains of the interpolated initial shape that the natural shape has too.

    The natural axial strain is what interpolation alone causes (the true initial stretch stays); the
    natural curvature is that of the initial shape, or zero for ``natural_shape="straight"``.

    Returns
    -------
    eps0 : ndarray, shape (elements, 10)
        At the axial Gauss points, zero beyond them.
    kappa0 : ndarray, shape (elements, 10)
        At the bending Gauss points, 1/m.
    """
    n = beam.elements
    eps0, kappa0 = np.zeros((n, 10)), np.zeros((n, 10))
    if beam.natural_shape == "straight" or _is_straight(beam):
        return eps0, kappa0
    for e in range(n):
        h = beam.node_x[e + 1] - beam.node_x[e]
        values = np.stack([beam.node_position[e], beam.stretch * beam.node_tangent[e],
                           beam.node_position[e + 1], beam.stretch * beam.node_tangent[e + 1]])
        xa, xb = gauss(beam.gauss[0])[0], gauss(beam.gauss[1])[0]
        r_s = hermite(xa, h, 1) @ values / beam.stretch
        eps0[e, : len(xa)] = axial_strain(r_s, beam.strain)
        kappa0[e, : len(xb)] = curvature(hermite(xb, h, 1) @ values, hermite(xb, h, 2) @ values, beam.strain)
    return eps0, kappa0


def _is_straight(beam: Beam) -> bool:
    return bool(np.all(np.abs(beam.node_tangent - beam.node_tangent[0]) < 1e-12))


def _part(beam: Beam, slot: IntArray) -> tuple[tuple[int, ...], IntArray, FloatArray, FloatArray, FloatArray]:
    """Key of the group, base, data, eps0 and kappa0 of one beam."""
    data = _data(beam, np.diff(beam.node_x))
    eps0, kappa0 = reference_strains(beam)
    damped, curved = bool(np.any(data[:, 4:7])), bool(np.any(eps0) or np.any(kappa0))
    key = (int(beam.strain == "paper"), *beam.gauss, int(damped), int(curved))
    return key, np.hstack([slot[:-1], slot[1:]]), data, eps0, kappa0


def _data(beam: Beam, h: FloatArray) -> FloatArray:
    s = beam.section
    row = [0.0, s.EA, s.EI, s.rhoA, s.damping, s.axial_damping, s.bending_damping, 0.0]
    data = np.tile(row, (len(h), 1))
    data[:, 0] = h
    return data


def _stack(parts: list[NDArray], columns: int, dtype: type) -> NDArray:  # type: ignore[type-arg]
    return np.ascontiguousarray(np.concatenate([np.zeros((0, columns)), *parts]), dtype=dtype)
