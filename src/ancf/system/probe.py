"""Where the state of a material point is found in a state vector."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..elements.shapes import hermite
from ..model.beam import Beam

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True)
class Probe:
    """One material point: r, r_x and r_xx are sums of four slots of the state vector.

    Parameters
    ----------
    beam : Beam
    x : float
        Reference arc length, m.
    element : int
        Element that holds the point (the later one at a node, but the last at the end).
    slots : ndarray, shape (4,)
    S : ndarray, shape (3, 4)
        Factors of r, r_x and r_xx.
    """

    beam: Beam
    x: float
    element: int
    slots: IntArray
    S: FloatArray

    @property
    def element_length(self) -> float:
        """Reference length of the element, m."""
        return float(self.beam.node_x[self.element + 1] - self.beam.node_x[self.element])

    def moved(self, xi: float) -> Probe:
        """Probe at xi in [0, 1] of the same element."""
        h = self.element_length
        S = np.stack([hermite(xi, h, d) for d in range(3)])
        return Probe(self.beam, float(self.beam.node_x[self.element]) + xi * h, self.element, self.slots, S)

    def field(self, states: FloatArray, derivative: int = 0) -> FloatArray:
        """r or a derivative, shape (..., 3), from state vectors of shape (..., n)."""
        total = np.zeros((*states.shape[:-1], 3))
        for slot, factor in zip(self.slots.tolist(), self.S[derivative].tolist(), strict=True):
            if factor != 0.0:
                total += factor * states[..., slot : slot + 3]
        return total


def locate(beam: Beam, x: float, slots: IntArray) -> Probe:
    """Probe at reference arc length x of a beam whose nodes have these slots, shape (nodes, >= 2)."""
    e = int(np.clip(np.searchsorted(beam.node_x, x, side="right") - 1, 0, beam.elements - 1))
    h = float(beam.node_x[e + 1] - beam.node_x[e])
    xi = (x - beam.node_x[e]) / h
    S = np.stack([hermite(xi, h, d) for d in range(3)])
    return Probe(beam, x, e, slots[e : e + 2, :2].ravel(), S)
