"""Joints: spherical joint, hinge, fixation to a rigid body and sliding joint."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...arrays import FloatArray
from ..bodies.beam import Beam
from ..bodies.rigid import PointMass, RigidBody
from ..functions.function import TimeFunction
from ..points import Point

STRETCH = ("free", "fixed")
AT_END = ("stop", "clamp", "release")


@dataclass(frozen=True, slots=True, eq=False)
class Spherical:
    """Two points, or a point and a fixed position (3,) in m, keep the same position and turn freely."""

    name: str
    a: Point
    b: Point | FloatArray

    @property
    def shared(self) -> bool:
        """Whether both are nodes on centrelines or point masses, which can share their unknowns."""
        return is_free_node(self.a) and isinstance(self.b, Point) and is_free_node(self.b)


@dataclass(frozen=True, slots=True, eq=False)
class Revolute:
    """A hinge: two points keep the same position, their bodies turn about one axis against each other.

    Attributes
    ----------
    a : Point
        Of a rigid body, or a node of a beam with a cross-section.
    b : Point or (3,) array
        The same, or a fixed position, m: the ground.
    axis : (3,) array
        Unit vector, initial global direction; fixed in both bodies.

    """

    name: str
    a: Point
    b: Point | FloatArray
    axis: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Fixation:
    """A node of a beam or cable clamped to a rigid body where it is initially.

    Attributes
    ----------
    point : Point
        At a node.
    to : RigidBody
    stretch : str
        "free": the directions of the slopes are held in the body, their lengths are free; "fixed": all
        of the slopes is held.

    """

    name: str
    point: Point
    to: RigidBody
    stretch: str


@dataclass(frozen=True, slots=True, eq=False)
class Slide:
    """A sliding joint: a point stays on a line of the carrier, free to move along it and to turn.

    Attributes
    ----------
    point : Point or (3,) array
        The sliding point of another body, or the position of a fixed ring, m.
    carrier : Beam or RigidBody
    line : ((3,) array, (3,) array) or None
        Of a rigid carrier: start and end of the line in body axes, m; s runs from 0 to their distance.
    offset : (float, float)
        Of a beam with a cross-section: the line's place (y, z) in it, m.
    s : float
        Initial arc length: on a beam the reference arc length, m.
    tolerance : float
        Largest distance of the point from the line at s that was allowed, m.
    mass : float
        Moves along the line with s, kg.
    friction : float
        Coulomb's coefficient.
    friction_velocity : float
        Speed at which friction has grown to its full size, m/s.
    viscous : float
        N s/m.
    force : TimeFunction or None
        Drive along +s, N.
    motion : TimeFunction or None
        Prescribed s, m.
    release : (3,) array or None
        Unit vector: no force in this direction.
    unilateral : (3,) array or None
        Unit vector: the only direction of the force that the carrier receives, normal to `release`.
    at_end : str
        "stop" ends the computation when s reaches an end of the line, "clamp" holds the point there,
        "release" lets it go.

    """

    name: str
    point: Point | FloatArray
    carrier: Beam | RigidBody
    line: tuple[FloatArray, FloatArray] | None
    offset: tuple[float, float]
    s: float
    tolerance: float
    mass: float
    friction: float
    friction_velocity: float
    viscous: float
    force: TimeFunction | None
    motion: TimeFunction | None
    release: FloatArray | None
    unilateral: FloatArray | None
    at_end: str

    @property
    def length(self) -> float:
        """Largest s, m."""
        if isinstance(self.carrier, Beam):
            return self.carrier.length
        return line_length(self.line)


Joint = Spherical | Revolute | Fixation | Slide


def is_free_node(point: Point) -> bool:
    """Whether a point is a node on a centreline or a point mass: its position is three unknowns."""
    if isinstance(point.body, PointMass):
        return True
    return isinstance(point.body, Beam) and not point.eccentric and point.body.node_at(point.x) is not None


def line_length(line: tuple[FloatArray, FloatArray] | None) -> float:
    """Distance of the two ends of a line, m; 0 without one."""
    return 0.0 if line is None else math.dist(*line)
