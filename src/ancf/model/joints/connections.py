"""Connections between points: springs, beside the joints."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..points import Point, initial_position
from ..surfaces.body_contact import BodyContact
from ..surfaces.cable_contact import CableContact
from ..surfaces.contact import Contact
from ..surfaces.surface import SurfaceContact
from .basic import Fixation, Revolute, Slide, Spherical
from .guides import Cylindrical, Planar
from .rigid_joints import Guide, Universal, Weld
from .torsion import TorsionSpring

#: Rate at which the friction of a spring has grown to 0.76 of its size, m/s.
FRICTION_VELOCITY = 0.01

__all__ = ["Connection", "Spherical", "Spring", "initial_position", "make_spring"]


@dataclass(frozen=True, slots=True, eq=False)
class Spring:
    """Spring and damper between a point and a point or a fixed position (3,) in m.

    Attributes
    ----------
    stiffness : float
        N/m.
    damping : float
        N s/m.
    length : float
        Length without force, m.
    slack : bool
        It carries tension only.
    law : (n, 2) array or None
        Elongation in m and force in N of a spring beside it, linear between the rows and beyond them.
    damper : (n, 2) array or None
        Rate of elongation in m/s and force in N of a damper beside it, in the same way.
    friction, friction_velocity : float
        Coulomb's force in N, which has grown to 0.76 of its size at this rate in m/s.

    """

    name: str
    a: Point
    b: Point | FloatArray
    stiffness: float
    damping: float
    length: float
    slack: bool
    law: FloatArray | None = None
    damper: FloatArray | None = None
    friction: float = 0.0
    friction_velocity: float = FRICTION_VELOCITY

    @property
    def damped(self) -> bool:
        """Whether it takes energy."""
        return self.damping > 0.0 or self.friction > 0.0 or self.damper is not None


Connection = (
    Spherical
    | Revolute
    | Cylindrical
    | Planar
    | Universal
    | Weld
    | Guide
    | Fixation
    | Slide
    | Spring
    | TorsionSpring
    | Contact
    | SurfaceContact
    | CableContact
    | BodyContact
)


def make_spring(
    where: str,
    name: str,
    a: Point,
    b: Point | FloatArray,
    *,
    stiffness: Any,
    damping: Any,
    length: Any,
    slack: Any,
    law: Any = None,
    damper: Any = None,
    friction: Any = 0.0,
    friction_velocity: Any = FRICTION_VELOCITY,
) -> Spring:
    """Check what ``Model.add_spring`` was given."""
    distance = math.dist(initial_position(a), initial_position(b))
    if not 0.0 < distance < math.inf:
        hint = 'a place farther off with length=, or forces by formulas: add_force(point, ["-30*x", 0, 0])'
        raise ModelError(f"{where}.b", "its two ends coincide, the spring has no direction", hint)
    made = Spring(
        name,
        a,
        b,
        checks.non_negative(stiffness, f"{where}.stiffness"),
        checks.non_negative(damping, f"{where}.damping"),
        distance if length is None else checks.non_negative(length, f"{where}.length"),
        checks.flag(slack, f"{where}.slack"),
        None if law is None else checks.curve(law, f"{where}.law"),
        None if damper is None else checks.curve(damper, f"{where}.damper"),
        checks.non_negative(friction, f"{where}.friction"),
        checks.positive(friction_velocity, f"{where}.friction_velocity"),
    )
    if made.stiffness == 0.0 and made.law is None and not made.damped:
        raise ModelError(f"{where}.stiffness", "stiffness and damping are both 0")
    for key, given in (("law", made.law), ("damper", made.damper), ("friction", made.friction or None)):
        if made.slack and given is not None:
            what = "cannot be given for a spring that is slack"
            raise ModelError(f"{where}.{key}", what, "a law may be 0 in compression")
    _check_damper(made, where)
    return made


def _check_damper(made: Spring, where: str) -> None:
    """A damper takes energy at every rate."""
    if made.damper is None:
        return
    rate, force = made.damper.T
    slope = np.diff(force) / np.diff(rate)
    beyond = np.array([[rate[0] - 1.0, force[0] - slope[0]], [rate[-1] + 1.0, force[-1] + slope[-1]]])
    power = np.prod(np.vstack([made.damper, beyond]), axis=1)
    if np.any(power < 0.0) or not np.any((rate == 0.0) & (force == 0.0)):
        what = "drives: its force has to be 0 at rest and to have the sign of the rate"
        raise ModelError(f"{where}.damper", what, "rate in m/s and force in N, [[-1, -50], [0, 0], [1, 90]]")
