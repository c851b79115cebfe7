"""Rods: stiff bars that keep points of a wire in place while a line is found, and tell their forces."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

import ancf

from ...arrays import FloatArray
from ...model.points import Point

STIFFNESS = 1e8  # N/m
LENGTH = 100.0  # m, so that its force keeps its direction


@dataclass(slots=True)
class Rods:
    """A group of rods, one for each of n points.

    Parameters
    ----------
    target : (n, 3) m
        Where the points are wanted.
    anchor : (n, 3) m
        Fixed ends.
    load : (n,) N
        Forces that are expected, tension positive; the rods are made so that with these the points are
        in their places.

    """

    target: FloatArray
    anchor: FloatArray
    load: FloatArray
    points: list[Point] = field(default_factory=list)
    natural: FloatArray = field(default_factory=lambda: np.zeros(0))

    def add_to(self, model: ancf.Model, points: list[Point]) -> None:
        """Add the rods to a model."""
        self.points = points
        self.natural = np.linalg.norm(self.anchor - self.target, axis=1) - self.load / STIFFNESS
        for point, anchor, length in zip(points, self.anchor, self.natural.tolist(), strict=True):
            model.add_spring(point, anchor, stiffness=STIFFNESS, length=length)

    def forces(self, state: ancf.State) -> FloatArray:
        """Tensions (n,) of the rods in an equilibrium, N."""
        position = np.array([state.position(p) for p in self.points]).reshape(-1, 3)
        length = np.linalg.norm(self.anchor - position, axis=1)
        tension: FloatArray = STIFFNESS * (length - self.natural)
        return tension


def add_leans(
    model: ancf.Model, points: list[Point], place: FloatArray, aim: FloatArray, stiffness: FloatArray
) -> None:
    """Pull points (n,) that are near `place` (n, 3) sideways to the lines y = `aim` (n,) m, N/m each.

    It is what a dropper under a vertical force does that leans: the force times the slope.
    """
    anchor = place + LENGTH * np.eye(3)[1]
    for point, end, y, k in zip(points, anchor, aim.tolist(), stiffness.tolist(), strict=True):
        if k > 0.0:
            model.add_spring(point, end, stiffness=k, length=float(end[1]) - y)


def along(target: FloatArray, axis: int, load: FloatArray) -> Rods:
    """Rods that hold one component of the points: 1 for y, 2 for z; tension pulls in its direction."""
    return Rods(target, target + LENGTH * np.eye(3)[axis], load)
