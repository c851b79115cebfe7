"""How many elements a beam needs, from an estimate of the error of its shape: ``elements="auto"``.

The curve is the path of the beam, or the catenary in which a cable of this length hangs between its ends.
Two errors are added up:

* a cubic follows a smooth curve with an error that falls with the fourth power of its length h;
* a cubic cannot follow an arc of radius a without strains of about (h/a)^4. Their energy, EA (h/a)^8, resists
  curvature as a bending stiffness of EA h^8/a^6 would do, and moves a cable with the horizontal force H by
  that over H a. It counts in stiff cables only.

The two factors are from equilibria of pinned cables with EA of 10^2 to 10^8 weights and of all slopes.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..sections.section import Section
from .beam import MOST_ELEMENTS
from .layout import initial_shape

Shape = Callable[[FloatArray], tuple[FloatArray, FloatArray]]

#: Largest error of a position, as a share of the length.
ERROR = 1e-4
#: Of the error of the curve through the right nodes, and of that by the stiffness against stretch.
FACTOR, LOCKING = 6.0, 1e-6
FEWEST = 4
#: Horizontal distance of the ends over the length below which a slack cable hangs as a fold.
FOLD = 0.02


@dataclass(frozen=True)
class Catenary:
    """Positions (n, 2) and unit tangents (n, 2) of a hanging cable at fractions of its length.

    Parameters
    ----------
    length : float, m
        Stretched.
    a : float, m
        Horizontal force over weight per length: the radius at the lowest place.
    x : float, m
        From the start to the lowest place.
    stiffness : float
        EA over the horizontal force.
    """

    length: float
    a: float
    x: float
    stiffness: float

    def __call__(self, fraction: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Two arrays (n, 2)."""
        u = (fraction * self.length + self.a * math.sinh(-self.x / self.a)) / self.a
        root = np.sqrt(1.0 + u * u)
        position = self.a * np.stack([np.arcsinh(u), root], axis=1)
        return position, np.stack([1.0 / root, u / root], axis=1)

    def locking_error(self, n: int) -> float:
        """Error of a position by what n elements resist to stretch, m."""
        start = math.sinh(-self.x / self.a)
        nearest = max(start, min(0.0, start + self.length / self.a))
        radius = self.a * (1.0 + nearest * nearest)
        return LOCKING * self.stiffness * (self.length / n / radius) ** 8 * radius


def count(
    where: str,
    section: Any,
    gravity: FloatArray,
    *,
    start: Any,
    end: Any,
    path: Any,
    length: Any,
    closed: bool,
    element: str,
) -> int:
    """Number of elements with which the estimated error of every position is below ``ERROR`` of the length.

    Raises
    ------
    ModelError
        There is no curve by which to judge, or it needs too many.
    """
    place = f"{where}.elements"
    if element == "original":
        what = '"auto" is not known for element "original", whose error is not that of its shape'
        raise ModelError(place, what, "give a number, and look at ancf run --verify")
    arc_length, shape = initial_shape(where, start, end, path, closed)
    natural = arc_length if length is None else checks.positive(length, f"{where}.length")
    if path is None:
        ends = shape(np.array([0.0, 1.0]))[0]
        shape = _hanging(place, section, gravity, ends[0], ends[1], natural)
    return _fewest(place, shape, shape.length if isinstance(shape, Catenary) else arc_length)


def _fewest(place: str, shape: Shape, length: float) -> int:
    n = FEWEST
    while (found := error(shape, n, length)) > ERROR * length:
        n = max(n + 1, math.ceil(n * (found / (ERROR * length)) ** 0.125))
        if n > MOST_ELEMENTS:
            raise ModelError(place, f'"auto" would need more than {MOST_ELEMENTS}', "give a number")
    return n


def error(shape: Shape, n: int, length: float) -> float:
    """Estimated error of a position with n elements, m."""
    stiff = shape.locking_error(n) if isinstance(shape, Catenary) else 0.0
    return FACTOR * interpolation_error(shape, n, length) + stiff


def interpolation_error(shape: Shape, n: int, length: float) -> float:
    """Largest distance of a curve from the cubics through n + 1 of its points and tangents, m."""
    r, t = shape(np.linspace(0.0, 1.0, n + 1))
    t = length / n * t
    worst = 0.0
    for u in (0.25, 0.5, 0.75):
        between = (
            (2 * u**3 - 3 * u**2 + 1) * r[:-1]
            + (u**3 - 2 * u**2 + u) * t[:-1]
            + (3 * u**2 - 2 * u**3) * r[1:]
            + (u**3 - u**2) * t[1:]
        )
        right = shape((np.arange(n) + u) / n)[0]
        worst = max(worst, float(np.linalg.norm(between - right, axis=1).max()))
    return worst


def _hanging(
    place: str, section: Any, gravity: FloatArray, start: FloatArray, end: FloatArray, natural: float
) -> Shape:
    """The catenary between two points, m; its stretch is that of the horizontal force all along."""
    g = float(np.linalg.norm(gravity))
    if not isinstance(section, Section) or g == 0.0:
        what = '"auto" judges by the shape, and this beam is straight and has no weight'
        raise ModelError(place, what, "give a number, a path, or the model a gravity")
    up = -gravity / g
    height = float((end - start) @ up)
    across = float(np.linalg.norm(end - start - height * up))
    weight = section.rhoA * g
    if across < FOLD * natural:
        if natural > abs(height) * (1 + 1e-3):
            what = f"ends are {across:.3g} m apart beside each other: the cable hangs as a fold"
            raise ModelError(place, f'"auto" is not known here: its {what}', "give a number")
        return Catenary(natural, 1e6 * natural, 0.0, 0.0)

    def missing(force: float) -> float:
        """Length of the cable less that of the catenary, in the square roots without the height."""
        a = force / weight
        own = max((natural * (1 + force / section.EA)) ** 2 - height**2, 0.0)
        return math.sqrt(own) - 2 * a * math.sinh(across / (2 * a))

    low, high = weight * across / 1000.0, weight * across
    while missing(high) < 0.0:
        high *= 10.0
    for _ in range(200):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if missing(middle) < 0.0 else (low, middle)
    a, whole = high / weight, natural * (1 + high / section.EA)
    return Catenary(whole, a, across / 2 - a * math.atanh(height / whole), section.EA / high)
