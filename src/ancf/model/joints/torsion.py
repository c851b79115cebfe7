"""Torsion springs between bodies, or a body and the ground."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..bodies.beam import Beam
from ..bodies.rigid import PointMass, RigidBody
from ..kind import TORSION, Kind, Look
from ..points import Point
from ..supports.support import require_node
from ..tables import number, numbers
from .make_joints import End, check_apart

#: Sine of the angle between the tangent of a cable and the axis below which its turning is not seen.
SEEN = 1e-3


@dataclass(frozen=True, slots=True, eq=False)
class TorsionSpring:
    """Torsion spring and damper about an axis, between two bodies or a body and the ground.

    Attributes
    ----------
    a : Point
        Of a rigid body, or a node of a beam or cable.
    b : Point or (3,) array
        The same of another body, or a fixed position, m: the ground.
    axis : (3,) array
        Unit vector, initial global direction; it turns with a rigid body or a beam, and stays on the ground.
    stiffness : float
        N m/rad.
    damping : float
        N m s/rad.
    angle : float
        Angle by which a is turned against b about the axis from the initial position, without moment, rad.

    """

    name: str
    a: Point
    b: Point | FloatArray
    axis: FloatArray
    stiffness: float
    damping: float
    angle: float

    @property
    def frame(self) -> End:
        """The end that keeps the axis: the ground, a rigid body, or a beam with a cross-section."""
        return self.a if _firmness(self.a) > _firmness(self.b) else self.b

    @property
    def turning(self) -> Point:
        """The other end."""
        other = self.b if self.frame is self.a else self.a
        assert isinstance(other, Point)
        return other


def _firmness(end: End) -> int:
    if not isinstance(end, Point):
        return 3
    if isinstance(end.body, RigidBody):
        return 2
    return 1 if end.body.has_section else 0


def make_torsion_spring(
    where: str, name: str, a: Point, b: End, *, axis: Any, stiffness: Any, damping: Any, angle: Any
) -> TorsionSpring:
    """Check what ``Model.add_torsion_spring`` was given."""
    for key, end in (("a", a), ("b", b)):
        if isinstance(end, Point):
            _check_end(end, f"{where}.{key}")
    if isinstance(b, Point):
        check_apart(where, a, b)
    k = checks.non_negative(stiffness, f"{where}.stiffness")
    c = checks.non_negative(damping, f"{where}.damping")
    if k == 0.0 and c == 0.0:
        hint = "an angle is measured without a spring: joint_angle(hinge) of results and runs"
        raise ModelError(f"{where}.stiffness", "stiffness and damping are both 0", hint)
    direction = checks.direction(axis, f"{where}.axis")
    made = TorsionSpring(name, a, b, direction, k, c, checks.number(angle, f"{where}.angle"))
    if _firmness(made.frame) == 0:
        what = f"{a} and {b} are of two cables, which have no axes"
        raise ModelError(
            f"{where}.b", what, 'element = "nonlocking" for one of them, or a rigid body between them'
        )
    body, point = made.turning.body, made.turning
    if isinstance(body, Beam) and not body.has_section:
        across = np.cross(body.initial_tangent(point.x), direction)
        if float(np.linalg.norm(across)) < SEEN:
            what = f'is along the tangent of "{body.name}", a cable, which has no torsion'
            raise ModelError(f"{where}.axis", what, "an axis across the cable")
    return made


def _check_end(end: Point, where: str) -> None:
    if isinstance(end.body, PointMass):
        what = f'"{end.body.name}" is a point mass and has no orientation'
        raise ModelError(where, what, "make it a rigid body")
    if isinstance(end.body, Beam):
        require_node(end, where)


def _sheet(item: TorsionSpring) -> str:
    text = f"{number(item.stiffness)} N m/rad, axis {numbers(item.axis)}"
    text += f", damping {number(item.damping)} N m s/rad" if item.damping else ""
    return text + (f", no moment at {number(item.angle)} rad" if item.angle else "")


TORSION_SPRING = Kind(
    TorsionSpring,
    "torsion_spring",
    "torsion spring",
    "add_torsion_spring",
    lambda: import_module("ancf.model.file.joint_items").TorsionSpringEntry,
    _sheet,
    ends=("a", "b"),
    asked=TORSION,
    look=Look("diamond", "white", 5.0),
)
