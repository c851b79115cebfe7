"""What springs do, from state vectors: the same face for one state or a history."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..model.joints.connections import Spring
from ..model.names import unknown
from ..model.points import Point
from .cross_angles import CrossAngles


class SpringFields(CrossAngles):
    """Values of springs; shapes are () for a state, (n_t,) for a history.

    A spring is the object that the model gave, or its name.
    """

    _springs: dict[str, Spring]

    @property
    def springs(self) -> dict[str, Spring]:
        """Springs by name."""
        return self._springs

    def spring_length(self, spring: Spring | str) -> FloatArray:
        """Distance of the spring's two ends, m.

        Raises
        ------
        ModelError
            There is no such spring.
        """
        length: FloatArray = np.linalg.norm(self._between(self._spring(spring), rates=False), axis=-1)
        return length

    def spring_force(self, spring: Spring | str) -> FloatArray:
        """Force of the spring, N, positive in tension, damping included; zero while it is slack.

        Raises
        ------
        ModelError
            There is no such spring.
        """
        item = self._spring(spring)
        d, rate = self._between(item, rates=False), self._between(item, rates=True)
        length: FloatArray = np.linalg.norm(d, axis=-1)
        growth = np.einsum("...k,...k->...", d, rate) / np.maximum(length, 1e-100)
        extension = length - item.length
        tension: FloatArray = item.stiffness * extension + item.damping * growth
        if not item.slack:
            return tension + _beside(item, extension, growth)
        carries: FloatArray = np.where((extension > 0.0) & (tension > 0.0), tension, 0.0)
        return carries

    def _between(self, spring: Spring, *, rates: bool) -> FloatArray:
        """Vector from the first to the second end, m, or its rate, m/s, shape (..., 3)."""
        total: FloatArray = np.zeros(3)
        for end, sign in ((spring.a, -1.0), (spring.b, 1.0)):
            if isinstance(end, Point):
                total = total + sign * self._probe(end).field(self.rates if rates else self.q)
            elif not rates:
                total = total + sign * end
        return total

    def _spring(self, spring: Any) -> Spring:
        name = getattr(spring, "name", spring)
        found = self._springs.get(name) if isinstance(name, str) else None
        if found is None:
            raise unknown("spring", "spring", name, self._springs)
        return found


def _beside(item: Spring, extension: FloatArray, rate: FloatArray) -> FloatArray:
    """Force of the curves and the friction of a spring, N."""
    force: FloatArray = np.zeros_like(extension)
    for curve, x in ((item.law, extension), (item.damper, rate)):
        if curve is not None:
            force = force + _along(curve, x)
    if item.friction:
        force = force + item.friction * np.tanh(rate / item.friction_velocity)
    return force


def _along(curve: FloatArray, x: FloatArray) -> FloatArray:
    """Values of a curve (n, 2), which goes straight on beyond its ends."""
    k = np.clip(np.searchsorted(curve[:, 0], x, side="right") - 1, 0, len(curve) - 2)
    low, high = curve[k], curve[k + 1]
    slope = (high[..., 1] - low[..., 1]) / (high[..., 0] - low[..., 0])
    value: FloatArray = low[..., 1] + slope * (x - low[..., 0])
    return value


def springs_of(connections: list[Any]) -> dict[str, Spring]:
    """Springs among the connections of a model, by name."""
    return {item.name: item for item in connections if isinstance(item, Spring)}
