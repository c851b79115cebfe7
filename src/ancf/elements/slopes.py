"""Tangents r_x and mean strains of all elements of a cable in many states; kernels have their own."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray, IntArray
from .shapes import gauss, hermite

#: A component of the chord per length and of the slopes at both ends of the elements, (n_t, n) each.
Vectors = tuple[FloatArray, FloatArray, FloatArray]

#: Gauss points of a mean over an element.
POINTS = 5


def vectors_of(node_x: FloatArray, slots: IntArray, states: FloatArray) -> list[Vectors]:
    """Three components; places of the nodes, m, their slots (n + 1, 2), and states (n_t, size)."""
    h, made = np.diff(node_x), []
    for k in range(3):
        place, ends = (np.take(states, slots[:, vector] + k, axis=1) for vector in (0, 1))
        made.append((np.diff(place, axis=1) / h, ends[:, :-1], ends[:, 1:]))
    return made


def slope(part: Vectors, xi: float = 0.5) -> FloatArray:
    """A component of r_x in the elements, shape (n_t, n), at their middles or another share."""
    _, first, chord, last = hermite(xi, 1.0, 1).tolist()
    total: FloatArray = chord * part[0] + first * part[1] + last * part[2]
    return total


def mean_strain(vectors: list[Vectors], strain: str) -> FloatArray:
    """Mean axial strain of each element, "paper" or "material", (n_t, n): its projection in the middle."""
    paper = strain == "paper"
    total: FloatArray = np.zeros_like(vectors[0][0])
    for xi, weight in zip(*(x.tolist() for x in gauss(POINTS)), strict=True):
        square = sum(np.square(slope(part, xi)) for part in vectors)
        total += 0.5 * weight * square if paper else weight * np.sqrt(square)
    total -= 0.5 if paper else 1.0
    return total
