"""Loads: forces, moments and distributed loads, constant or functions of time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...errors import ModelError
from .. import checks
from ..bodies.beam import Beam
from ..bodies.rigid import Body, PointMass, kind
from ..functions.function import TimeFunction
from ..points import Point
from .state_function import StateFunction, force_function


@dataclass(frozen=True, slots=True, eq=False)
class Force:
    """Force (3,) in N at a point, in fixed directions, or by a law of the point's state."""

    name: str
    point: Point
    force: TimeFunction | StateFunction


@dataclass(frozen=True, slots=True, eq=False)
class Moment:
    """Moment (3,) in N m at a point, in fixed directions.

    On a cable it acts on the slope r_x, on a beam on the section.
    """

    name: str
    point: Point
    moment: TimeFunction


@dataclass(frozen=True, slots=True, eq=False)
class DistributedLoad:
    """Load (3,) in N per m of reference length, between two reference arc lengths in m.

    In fixed directions, or by a law of the state of the points along the body.
    """

    name: str
    body: Beam
    load: TimeFunction | StateFunction
    between: tuple[float, float]


Load = Force | Moment | DistributedLoad


def make_moment(where: str, name: str, point: Point, moment: Any) -> Moment:
    """Check what ``Model.add_moment`` was given; a cable takes no torque, a point mass no moment."""
    function, body = TimeFunction(moment, 3, f"{where}.moment", "N m"), point.body
    if isinstance(body, PointMass):
        what = f'"{body.name}" is a point mass and has no orientation, no moment turns it'
        raise ModelError(f"{where}.point", what, "make it a rigid body")
    if function.constant and isinstance(body, Beam) and not body.has_section:
        value, tangent = function(0.0), body.initial_tangent(point.x)
        size = float(np.linalg.norm(value))
        if size > 0.0 and float(np.linalg.norm(np.cross(value / size, tangent))) <= 1e-9:
            what = f"{value.tolist()} N m is a torque about the tangent, which a cable cannot take"
            raise ModelError(f"{where}.moment", what)
    return Moment(name, point, function)


def make_distributed(
    where: str, name: str, body: Body, load: Any, between: Any, size: float
) -> DistributedLoad:
    """Check what ``Model.add_distributed_load`` was given; size of the model in m."""
    if not isinstance(body, Beam):
        what = f'"{body.name}" is a {kind(body)}, a distributed load acts on a beam or cable'
        raise ModelError(f"{where}.body", what, "model.add_force(...) acts on any body")
    middle = body.initial_position(0.5 * body.length)
    function = force_function(load, f"{where}.load", middle, lambda: size, "N/m")
    if between is None:
        return DistributedLoad(name, body, function, (0.0, body.length))
    x0, x1 = checks.array(between, f"{where}.between", (2,)).tolist()
    slack = 1e-9 * body.length
    if not -slack <= x0 < x1 <= body.length + slack:
        what = f"is {x0:g} to {x1:g} m, must be 0 <= x0 < x1 <= {body.length:g} m"
        raise ModelError(f"{where}.between", what)
    return DistributedLoad(name, body, function, (max(x0, 0.0), min(x1, body.length)))
