"""Supports by what they hold: a point of the model stands for the support at it."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from ...errors import ModelError, named
from .. import checks
from ..bodies.rigid import PointMass, RigidBody
from ..lookup import own_point, parse_point
from ..names import unknown
from ..points import Point


def support_asked(model: Any, support: Any, names: Collection[str], where: str) -> str:
    """Name of the support that is meant: by itself, by its name, or by the point that it holds.

    Parameters
    ----------
    model : Model
    support : support, Point, PointMass, RigidBody or str
    names : collection of str
        Of those that can be asked.
    where : str
        For messages.

    Raises
    ------
    ModelError
        There is none, or several hold the point.
    """
    name = getattr(support, "name", support)
    if isinstance(name, str) and name in names and not isinstance(support, PointMass | RigidBody):
        return name
    point = _point(model, support)
    if point is None:
        raise unknown(where, "support", name, names)
    found = [item.name for item in model.supports if item.name in names and item.point == point]
    if len(found) == 1:
        return str(found[0])
    there = f"supports are: {checks.listed(names)}" if names else "there are no supports"
    if found:
        raise ModelError(named(str(point)), f"is held by several supports: {checks.listed(found)}", "ask one")
    raise ModelError(named(str(point)), f"is held by no support here; {there}", _carried(model, point))


def _point(model: Any, given: Any) -> Point | None:
    """The point of a model that is meant, None if it is nothing of the kind."""
    if isinstance(given, Point):
        return given
    if isinstance(given, PointMass | RigidBody):
        return own_point(given, "point")
    try:
        return parse_point(model.bodies, given) if isinstance(given, str) else None
    except ModelError:
        return None


def _carried(model: Any, point: Point) -> str:
    """The joint that carries a point which no support holds."""
    joints = [item.name for item in model.connections if point in (getattr(item, k, None) for k in "ab")]
    return f'joint_force("{joints[0]}") is the force of the joint there' if joints else ""
