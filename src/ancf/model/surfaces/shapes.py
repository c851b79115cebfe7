"""Shapes of surfaces that beams and cables touch: planes, bodies of revolution, and meshes of triangles.

A shape is a class here with its parameters, its word in :data:`SHAPES`, that of the class in small letters,
and a profile in :mod:`ancf.contact.profiles`; checks, tables in files, description and pictures follow.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from .mesh import Mesh
from .shape import AT, AXIS, RADIUS, Parameter, Shape


@dataclass(frozen=True, eq=False)
class Plane(Shape):
    """All below a plane.

    Parameters
    ----------
    at : (3,) m
        A point of it.
    normal : (3,)
        Direction away from it, any length.
    """

    at: Any = (0.0, 0.0, 0.0)
    normal: Any = (0.0, 0.0, 1.0)

    parameters = (AT, Parameter("normal", "direction", "-", "Direction away from it, any length"))

    @property
    def direction(self) -> FloatArray:
        """Its normal."""
        return np.asarray(self.normal)


@dataclass(frozen=True, eq=False)
class Cylinder(Shape):
    """A cylinder: a drum, a bollard, a pulley without flanges.

    Parameters
    ----------
    radius : float, m
    at : (3,) m
        Its middle.
    axis : (3,)
    length : float, m
        Default without end.
    """

    radius: float
    at: Any = (0.0, 0.0, 0.0)
    axis: Any = (0.0, 0.0, 1.0)
    length: float | None = None

    parameters = (RADIUS, AT, AXIS, Parameter("length", "positive", "m", "Length, default without end"))

    @property
    def numbers(self) -> list[float]:
        """Radius, length or 0."""
        return [self.radius, self.length or 0.0]

    @property
    def outline(self) -> list[tuple[float, float]]:
        """Its side, of one without end a piece, and its ends."""
        half = 2.0 * self.radius if self.length is None else 0.5 * self.length
        side = [(self.radius, -half), (self.radius, half)]
        return side if self.length is None else [(0.0, -half), *side, (0.0, half)]

    @property
    def narrowest(self) -> float:
        """The radius."""
        return self.radius


@dataclass(frozen=True, eq=False)
class Sphere(Shape):
    """A sphere.

    Parameters
    ----------
    radius : float, m
    at : (3,) m
    """

    radius: float
    at: Any = (0.0, 0.0, 0.0)

    parameters = (RADIUS, AT)

    @property
    def numbers(self) -> list[float]:
        """Radius."""
        return [self.radius]

    @property
    def outline(self) -> list[tuple[float, float]]:
        """A half circle."""
        return _arc(0.0, 0.0, self.radius, -0.5 * math.pi, 0.5 * math.pi)

    @property
    def narrowest(self) -> float:
        """The radius."""
        return self.radius


@dataclass(frozen=True, eq=False)
class Capsule(Shape):
    """A cylinder with round ends.

    Parameters
    ----------
    radius : float, m
    length : float, m
        Between the centres of the ends.
    at : (3,) m
        Its middle.
    axis : (3,)
    """

    radius: float
    length: float
    at: Any = (0.0, 0.0, 0.0)
    axis: Any = (0.0, 0.0, 1.0)

    parameters = (
        RADIUS,
        Parameter("length", "positive", "m", "Length between the centres of its round ends"),
        AT,
        AXIS,
    )

    @property
    def numbers(self) -> list[float]:
        """Radius, length."""
        return [self.radius, self.length]

    @property
    def outline(self) -> list[tuple[float, float]]:
        """Two quarters of a circle."""
        half = 0.5 * self.length
        low = _arc(0.0, -half, self.radius, -0.5 * math.pi, 0.0)
        return low + _arc(0.0, half, self.radius, 0.0, 0.5 * math.pi)

    @property
    def narrowest(self) -> float:
        """The radius."""
        return self.radius


@dataclass(frozen=True, eq=False)
class Torus(Shape):
    """A ring of round wire: what runs through it touches its inner side.

    Parameters
    ----------
    radius : float, m
        Of the centreline.
    tube : float, m
        Radius of the wire.
    at : (3,) m
    axis : (3,)
    """

    radius: float
    tube: float
    at: Any = (0.0, 0.0, 0.0)
    axis: Any = (0.0, 0.0, 1.0)

    parameters = (
        Parameter("radius", "positive", "m", "Radius of the centreline"),
        Parameter("tube", "positive", "m", "Radius of the wire of the ring"),
        AT,
        AXIS,
    )

    def check(self) -> None:
        """The ring has a hole."""
        if self.tube >= self.radius:
            what = f"is {self.tube:g} m, must be less than the radius {self.radius:g} m"
            raise ModelError("Torus.tube", what, "a ring has a hole; without one it is an ancf.Sphere")

    @property
    def numbers(self) -> list[float]:
        """Radius of the centreline, radius of the wire."""
        return [self.radius, self.tube]

    @property
    def outline(self) -> list[tuple[float, float]]:
        """A circle."""
        return _arc(self.radius, 0.0, self.tube, -math.pi, math.pi)

    @property
    def narrowest(self) -> float:
        """The radius of the wire."""
        return self.tube


@dataclass(frozen=True, eq=False)
class Sheave(Shape):
    """A pulley with a groove: a round bottom, straight flanks, and a cylinder beyond the rim.

    Parameters
    ----------
    radius : float, m
        At the bottom of the groove.
    groove : float, m
        Radius of the round bottom, more than that of the cable.
    depth : float, m
        Of the groove, from the bottom to the rim.
    angle : float, rad
        Between the flanks.
    at : (3,) m
        Middle of the groove, on the axis.
    axis : (3,)
    """

    radius: float
    groove: float
    depth: float
    angle: float = 0.25 * math.pi
    at: Any = (0.0, 0.0, 0.0)
    axis: Any = (0.0, 0.0, 1.0)

    parameters = (
        Parameter("radius", "positive", "m", "Radius at the bottom of the groove"),
        Parameter("groove", "positive", "m", "Radius of the round bottom, more than the cable's"),
        Parameter("depth", "positive", "m", "Depth of the groove, from the bottom to the rim"),
        Parameter("angle", "positive", "rad", "Angle between the flanks"),
        AT,
        AXIS,
    )

    def check(self) -> None:
        """The flanks open, and the groove is as deep as its round bottom."""
        if checks.positive(self.angle, "Sheave.angle") >= math.pi:
            raise ModelError("Sheave.angle", f"is {self.angle:g} rad, must be less than pi")
        least = self.groove * (1.0 - math.sin(0.5 * self.angle))
        if self.depth < least:
            what = f"is {self.depth:g} m, the round bottom alone is {least:g} m deep"
            raise ModelError("Sheave.depth", what, "give a deeper groove, or a smaller radius of it")

    @property
    def numbers(self) -> list[float]:
        """Radius, radius of the groove, depth, sine of half the angle."""
        return [self.radius, self.groove, self.depth, math.sin(0.5 * self.angle)]

    @property
    def outline(self) -> list[tuple[float, float]]:
        """Rim, flank, bottom, flank, rim."""
        half = 0.5 * self.angle
        s, c = math.sin(half), math.cos(half)
        middle, rim = self.radius + self.groove, self.radius + self.depth
        edge = self.groove * c + (self.depth - self.groove * (1.0 - s)) / c * s
        bottom = _arc(middle, 0.0, -self.groove, half - 0.5 * math.pi, 0.5 * math.pi - half)
        outer = edge + 0.3 * self.groove
        return [(rim, -outer), (rim, -edge), *bottom, (rim, edge), (rim, outer)]

    @property
    def narrowest(self) -> float:
        """The radius."""
        return self.radius


def _arc(rho: float, z: float, radius: float, first: float, last: float) -> list[tuple[float, float]]:
    """Points of an arc about (rho, z), angles from outwards; from inwards if radius < 0."""
    angles = np.linspace(first, last, 13).tolist()
    return [(rho + radius * math.cos(a), z + abs(radius) * math.sin(a)) for a in angles]


#: By their words in files; the place in this table is their number in kernels.
SHAPES: dict[str, type[Shape]] = {
    "plane": Plane,
    "cylinder": Cylinder,
    "sphere": Sphere,
    "capsule": Capsule,
    "torus": Torus,
    "sheave": Sheave,
    "mesh": Mesh,
}
