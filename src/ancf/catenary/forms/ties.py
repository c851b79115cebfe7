"""Ties: droppers between two wires on the way to a form, from their vertical forces and their ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray
from ..lines.fittings import Droppers


@dataclass(frozen=True, slots=True)
class Ties:
    """Droppers between two wires.

    Parameters
    ----------
    lift : (n,) N
        Vertical forces between their clamps.
    vector : (n, 3) m
        From node to node, up.
    give : (2, n) m/N
        What the lower and the upper wire give too little at the clamps, on their meshes.
    droppers : Droppers
    gravity : float, m/s^2

    """

    lift: FloatArray
    vector: FloatArray
    give: FloatArray
    droppers: Droppers
    gravity: float

    @property
    def length(self) -> FloatArray:
        """Lengths (n,) from clamp to clamp, m: the clamps give more than the nodes."""
        length: FloatArray = self.distance - self.give.sum(axis=0) * self.force
        return length

    @property
    def distance(self) -> FloatArray:
        """Lengths (n,) from node to node, m."""
        distance: FloatArray = np.linalg.norm(self.vector, axis=1)
        return distance

    @property
    def force(self) -> FloatArray:
        """Forces (n,) along themselves, N."""
        force: FloatArray = self.lift * self.distance / self.vector[:, 2]
        return force

    @property
    def lean(self) -> FloatArray:
        """Sideways force by the sideways extent (n,), N/m."""
        lean: FloatArray = self.lift / self.vector[:, 2]
        return lean

    @property
    def down(self) -> FloatArray:
        """Vertical forces (n, 3) on what they hang from, their weight and clamp included, N."""
        load = self.lift + self.weight(self.droppers.clamp_messenger)
        return -np.outer(load, [0.0, 0.0, 1.0])

    def weight(self, clamp: float) -> FloatArray:
        """Weights (n,) at one end, N: half of the dropper and a clamp in kg."""
        weight: FloatArray = (0.5 * self.droppers.mass * self.length + clamp) * self.gravity
        return weight
