"""Connections between points: springs, beside the joints."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ..arrays import FloatArray
from ..errors import ModelError
from . import checks
from .contact import Contact
from .guides import Cylindrical, Planar
from .joints import Fixation, Revolute, Slide, Spherical
from .points import Point, initial_position
from .surfaces import SurfaceContact

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

    """

    name: str
    a: Point
    b: Point | FloatArray
    stiffness: float
    damping: float
    length: float
    slack: bool


Connection = (
    Spherical | Revolute | Cylindrical | Planar | Fixation | Slide | Spring | Contact | SurfaceContact
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
) -> Spring:
    """Check what ``Model.add_spring`` was given."""
    distance = math.dist(initial_position(a), initial_position(b))
    if not 0.0 < distance < math.inf:
        raise ModelError(f"{where}.b", "its two ends coincide, the spring has no direction")
    k = checks.non_negative(stiffness, f"{where}.stiffness")
    c = checks.non_negative(damping, f"{where}.damping")
    if k == 0.0 and c == 0.0:
        raise ModelError(f"{where}.stiffness", "stiffness and damping are both 0")
    natural = distance if length is None else checks.non_negative(length, f"{where}.length")
    return Spring(name, a, b, k, c, natural, checks.flag(slack, f"{where}.slack"))
