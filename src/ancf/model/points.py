"""Point: a material point of a body."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..arrays import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Point:
    """A point of a body; equal to another with the same body name and the same place.

    Parameters
    ----------
    body : Beam, PointMass or RigidBody
    x : float
        Of a beam: reference arc length from the start, m. Of a rigid body: place along its first axis
        from the centre of mass, m. Of a point mass: 0.
    label : str
        ``beam.start``, ``beam.end``, ``beam.at(0.5)``, ``beam.at(0.5, 0.01, 0)``, the name of a point
        mass, ``hub.centre`` or ``hub.at(0.1, 0, 0.2)``.
    y, z : float
        Of a beam: place in the cross-section along its local axes, m. Of a rigid body: place along its
        second and third axes, m.

    """

    body: Any  # these classes make points, and are not known here
    x: float
    label: str
    y: float = 0.0
    z: float = 0.0

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Point):
            return NotImplemented
        return self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    def __str__(self) -> str:
        return self.label

    def __repr__(self) -> str:
        return f"Point({self.label})"

    @property
    def eccentric(self) -> bool:
        """Whether the point is off a beam's centreline or off a rigid body's centre of mass."""
        off: bool = self.body.off_centre(self.x, self.y, self.z)
        return off

    @property
    def initial_position(self) -> FloatArray:
        """Initial position (3,), m."""
        position: FloatArray = self.body.initial_position(self.x, self.y, self.z)
        return position

    @property
    def _key(self) -> tuple[str, float, float, float]:
        return self.body.name, self.x, self.y, self.z


def initial_position(end: Point | FloatArray) -> FloatArray:
    """Initial position (3,) of a point or of a fixed position, m."""
    return end.initial_position if isinstance(end, Point) else end
