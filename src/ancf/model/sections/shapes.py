"""Shapes of cross-sections and the integrals over them that the beams need."""

from __future__ import annotations

import math
from dataclasses import dataclass

ZETA_5 = 1.0369277551433699  # sum of 1/n^5
ODD = (1, 3, 5, 7, 9, 11)


@dataclass(frozen=True, slots=True)
class Rectangle:
    """Width (local y) and height (local z) in m."""

    width: float
    height: float

    def __str__(self) -> str:
        return f"rectangle {self.width:g} m wide (y) and {self.height:g} m high (z)"

    def moments(self) -> dict[str, float]:
        """Area and second and fourth moments, m^2, m^4, m^6."""
        b, h = self.width, self.height
        A, y2, z2 = b * h, b * b / 12, h * h / 12  # mean squares of y and z; products overflow to inf
        return {
            "A": A,
            "I_y": A * z2,
            "I_z": A * y2,
            "I_yyyy": 1.8 * A * y2 * y2,
            "I_zzzz": 1.8 * A * z2 * z2,
            "I_yyzz": A * y2 * z2,
        }

    def torsion_constant(self) -> float:
        """Saint-Venant's J, m^4, to rounding.

        Notes
        -----
        With the sides a >= b, ``J = a b^3/3 (1 - 192 b/(pi^5 a) sum tanh(n pi a/(2 b))/n^5)`` over odd n
        (Timoshenko and Goodier, Theory of Elasticity, section 109). The sum without the tanh is
        31/32 zeta(5); of ``1 - tanh(x) = 2/(exp(2 x) + 1)`` six terms are left to sum.
        """
        a, b = max(self.width, self.height), min(self.width, self.height)
        small = [math.exp(-n * math.pi * a / b) for n in ODD]
        rest = sum(2 * e / (1 + e) / n**5 for n, e in zip(ODD, small, strict=True))
        return a * b * b * b / 3 * (1 - 192 * b / (math.pi**5 * a) * (31 / 32 * ZETA_5 - rest))

    def contains(self, y: float, z: float) -> bool:
        """Whether (y, z) in m lies in the shape, with a little slack at its edge."""
        return max(abs(y) / self.width, abs(z) / self.height) <= 0.5 * (1 + 1e-9)


@dataclass(frozen=True, slots=True)
class Circle:
    """Diameter in m."""

    diameter: float

    def __str__(self) -> str:
        return f"circle with a diameter of {self.diameter:g} m"

    def moments(self) -> dict[str, float]:
        """Area and second and fourth moments, m^2, m^4, m^6."""
        d2 = self.diameter * self.diameter  # products overflow to inf
        second, fourth = math.pi / 64 * d2 * d2, math.pi / 512 * d2 * d2 * d2
        return {
            "A": math.pi / 4 * d2,
            "I_y": second,
            "I_z": second,
            "I_yyyy": fourth,
            "I_zzzz": fourth,
            "I_yyzz": fourth / 3,
        }

    def torsion_constant(self) -> float:
        """Saint-Venant's J, m^4: the polar moment."""
        return 2 * self.moments()["I_y"]

    def contains(self, y: float, z: float) -> bool:
        """Whether (y, z) in m lies in the shape, with a little slack at its edge."""
        return math.hypot(y, z) <= 0.5 * self.diameter * (1 + 1e-9)
