"""The place of a line nearest to a point, in the initial shape."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import Polynomial

from ...arrays import FloatArray
from .beam import Beam

SAMPLES = 17  # per element, both ends included
CHUNK = 20_000  # elements sampled at once
POWERS = np.linspace(0.0, 1.0, SAMPLES)[:, None] ** np.arange(4)


def along_beam(beam: Beam, offset: tuple[float, float], position: FloatArray) -> tuple[float, float]:
    """Reference arc length of the nearest place, m, and its distance, m.

    In each element the line at the offset (y, z) is a cubic, its squared distance from the position a
    polynomial of degree 6. The element is found by sampling, the place from the roots of its derivative.
    """
    cubics = _cubics(beam, offset)
    cubics[:, 0] -= position
    size = float(np.max(np.abs(cubics)))
    cubics /= size
    best, found = 0, np.inf
    for first in range(0, beam.elements, CHUNK):
        squares = np.sum((POWERS @ cubics[first : first + CHUNK]) ** 2, axis=2).min(axis=1)
        if np.min(squares) < found:
            best, found = first + int(np.argmin(squares)), float(np.min(squares))
    near = range(max(best - 1, 0), min(best + 2, beam.elements))
    distance, s, e = min((*_in_element(cubics[e]), e) for e in near)
    x = float(beam.node_x[e] + s * (beam.node_x[e + 1] - beam.node_x[e]))
    node = beam.node_at(x)
    return x if node is None else float(beam.node_x[node]), size * distance


def along_line(start: FloatArray, end: FloatArray, position: FloatArray) -> tuple[float, float]:
    """Distance of the nearest place of a straight line from its start, m, and from the position, m."""
    length = float(np.linalg.norm(end - start))
    unit = (end - start) / length
    s = float(np.clip(unit @ (position - start), 0.0, length))
    return s, float(np.linalg.norm(start + s * unit - position))


def _cubics(beam: Beam, offset: tuple[float, float]) -> FloatArray:
    """Coefficients (n, 4, 3) of 1, s, s^2, s^3 in each element, s from 0 to 1."""
    p, h = beam.node_position, np.diff(beam.node_x)[:, None]
    m0, m1 = (h * beam.stretch * m for m in (beam.node_tangent[:-1], beam.node_tangent[1:]))
    d = p[1:] - p[:-1]
    coefficients: FloatArray = np.stack([p[:-1], m0, 3 * d - 2 * m0 - m1, m0 + m1 - 2 * d], axis=1)
    if any(offset):
        y, z = offset
        at_nodes = y * beam.node_y + z * beam.node_z
        first, last = at_nodes[:-1], at_nodes[1:]
        coefficients[:, 0] += first
        coefficients[:, 1] += last - first
        if beam.element == "nonlocking":
            middle = y * beam.middle_axes[:, 0] + z * beam.middle_axes[:, 1]
            bulge = 4 * middle - 2 * (first + last)
            coefficients[:, 1] += bulge
            coefficients[:, 2] -= bulge
    return coefficients


def _in_element(cubic: FloatArray) -> tuple[float, float]:
    """Smallest distance from the origin in one element, and its place from 0 to 1."""
    square = sum((Polynomial(c) ** 2 for c in cubic.T), start=Polynomial([0.0]))
    slope = square.deriv()
    roots = slope.trim(1e-14 * float(np.max(np.abs(slope.coef)))).roots()
    inside = np.clip(roots.real[np.abs(roots.imag) < 1e-3], 0.0, 1.0)
    places = _polished(slope, np.concatenate([[0.0, 1.0], POWERS[:, 1], inside]))
    distance = np.linalg.norm((places[:, None] ** np.arange(4)) @ cubic, axis=1)
    best = int(np.argmin(distance))
    return float(distance[best]), float(places[best])


def _polished(slope: Polynomial, places: FloatArray) -> FloatArray:
    """Places after two Newton steps towards roots, kept in the element."""
    for _ in range(2):
        rate = slope.deriv()(places)
        step = np.where(rate > 0.0, slope(places) / np.where(rate > 0.0, rate, 1.0), 0.0)
        places = np.clip(places - step, 0.0, 1.0)
    return places
