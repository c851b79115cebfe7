"""Connections between points: spherical joints and springs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ancf.errors import ModelError
from ancf.model import checks
from ancf.model.checks import FloatArray
from ancf.model.points import Point
from ancf.model.supports import require_node


@dataclass(frozen=True, slots=True, eq=False)
class Spherical:
    """Two nodes keep the same position and turn freely."""

    name: str
    a: Point
    b: Point


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


Connection = Spherical | Spring


def initial_position(end: Point | FloatArray) -> FloatArray:
    """Initial position (3,) of a point or of a fixed position, m."""
    return end.body.initial_position(end.x) if isinstance(end, Point) else end


def make_spherical(where: str, name: str, a: Point, b: Point, size: float) -> Spherical:
    """Check what ``Model.connect`` was given; `size` is the size of the model in m."""
    nodes = require_node(a, f"{where}.a"), require_node(b, f"{where}.b")
    if a.body is b.body and nodes[0] == nodes[1]:
        raise ModelError(f"{where}.b", f"{b} is the same node as {a}")
    gap = float(np.linalg.norm(initial_position(a) - initial_position(b)))
    if gap > 1e-9 * size:
        raise ModelError(f"{where}.b", f"{a} and {b} are {gap:.6g} m apart, must coincide")
    return Spherical(name, a, b)


def check_repeated(where: str, new: Spherical, others: list[Connection]) -> None:
    """No two joints between the same two points."""
    for other in others:
        if isinstance(other, Spherical) and {other.a, other.b} == {new.a, new.b}:
            raise ModelError(f"{where}.b", f'"{other.name}" connects {new.a} and {new.b} already')


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
    distance = float(np.linalg.norm(initial_position(a) - initial_position(b)))
    if not 0.0 < distance < np.inf:
        raise ModelError(f"{where}.b", "its two ends coincide, the spring has no direction")
    k = checks.non_negative(stiffness, f"{where}.stiffness")
    c = checks.non_negative(damping, f"{where}.damping")
    if k == 0.0 and c == 0.0:
        raise ModelError(f"{where}.stiffness", "stiffness and damping are both 0")
    natural = distance if length is None else checks.non_negative(length, f"{where}.length")
    return Spring(name, a, b, k, c, natural, checks.flag(slack, f"{where}.slack"))
