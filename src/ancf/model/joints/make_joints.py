"""Checks of joints: what ``Model.connect``, ``hinge`` and ``clamp(to=)`` were given."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..bodies.beam import NODE_TOLERANCE, Beam
from ..bodies.rigid import Body, PointMass, RigidBody, kind
from ..points import Point, initial_position
from ..supports.support import node_of, require_node
from .basic import STRETCH, Fixation, Revolute, Spherical

COINCIDENT = 1e-9  # of the size of the model
NEAR = 1e-2  # below which two places are meant to be one
APART = "move one of them there; what stays apart is joined by a spring or a beam"

End = Point | FloatArray


def make_spherical(where: str, name: str, a: Point, b: End, size: Callable[[], float]) -> Spherical:
    """Check what ``Model.connect`` was given; `size` gives the size of the model in m."""
    check_pair(where, a, b, size)
    return Spherical(name, a, b)


def make_revolute(where: str, name: str, a: Point, b: End, axis: Any, size: Callable[[], float]) -> Revolute:
    """Check what ``Model.hinge`` was given; `size` gives the size of the model in m."""
    direction = checks.direction(axis, f"{where}.axis")
    for key, end in (("a", a), ("b", b)):
        if isinstance(end, Point):
            require_axes(end, f"{where}.{key}")
    check_pair(where, a, b, size)
    return Revolute(name, a, b, direction)


def make_fixation(where: str, name: str, point: Point, to: Body, stretch: Any) -> Fixation:
    """Check what ``Model.clamp`` was given with `to`."""
    if not isinstance(to, RigidBody):
        what = f'"{to.name}" is a {kind(to)}, must be a rigid body'
        raise ModelError(f"{where}.to", what, "model.connect(...) joins points of any two bodies")
    if isinstance(point.body, RigidBody):
        what = f'"{point.body.name}" is a rigid body, what is clamped to "{to.name}" is a node of a beam'
        hint = "make one rigid body of the two, or join them with model.hinge(...) or model.connect(...)"
        raise ModelError(f"{where}.point", what, hint)
    if isinstance(point.body, PointMass):
        raise ModelError(f"{where}.point", *_without_axes(point.body))
    require_node(point, f"{where}.point")
    return Fixation(name, point, to, checks.choice(stretch, f"{where}.stretch", STRETCH))


def check_pair(where: str, a: Point, b: End, size: Callable[[], float]) -> None:
    """Two places that coincide and are not the same place of one body."""
    if isinstance(b, Point):
        check_apart(where, a, b)
    first, second = initial_position(a), initial_position(b)
    gap = math.dist(first, second)
    if not coincide(gap, first, second, size):
        other = b if isinstance(b, Point) else f"the position {second.tolist()}"
        hint = _same_place(a, second) or (_same_place(b, first) if isinstance(b, Point) else "")
        if not hint and isinstance(b, Point) and gap <= NEAR * size():
            hint = _drawn_at(a, b) or _drawn_at(b, a)
        hint = hint or APART
        raise ModelError(f"{where}.b", f"{a} and {other} are {gap:.6g} m apart, must coincide", hint)


def _same_place(point: Point, place: FloatArray) -> str:
    """How a rigid body's point at a place is written, "" for other bodies."""
    body = point.body
    if not isinstance(body, RigidBody):
        return ""
    x, y, z = (round(float(c), 12) + 0.0 for c in body.axes.T @ (place - body.position))
    return f"{body.name}.at({x:.12g}, {y:.12g}, {z:.12g}) is there"


def _drawn_at(point: Point, other: Point) -> str:
    """How what has a point at its end is drawn from another one, "" for points within a beam."""
    body = point.body
    key = {0.0: "start", body.length: "end"}.get(point.x, "") if isinstance(body, Beam) else "at"
    return f'draw "{body.name}" with {key}={other}.initial_position' if key else ""


def coincide(gap: float, first: FloatArray, second: FloatArray, size: Callable[[], float]) -> bool:
    """Whether a gap, m, is round-off of its ends, or of the model; its size takes a look at all bodies."""
    own = max(float(np.max(np.abs(r))) for r in (first, second))
    return gap <= COINCIDENT * own or gap <= COINCIDENT * size()


def check_apart(where: str, a: Point, b: Point) -> None:
    """Two points that are not of one rigid body, nor the same one of a beam."""
    if a.body is not b.body:
        return
    body = a.body
    if isinstance(body, RigidBody):
        raise ModelError(f"{where}.b", f'{a} and {b} are points of one rigid body, "{body.name}"')
    extent = body.length if isinstance(body, Beam) else 0.0
    if abs(a.x - b.x) <= NODE_TOLERANCE * extent and (a.y, a.z) == (b.y, b.z):
        what = "node" if not a.eccentric and node_of(a) is not None else "point"
        raise ModelError(f"{where}.b", f"{b} is the same {what} as {a}")


def require_axes(point: Point, where: str) -> None:
    """A point of a body that can turn about every axis; of a beam a node."""
    body = point.body
    if isinstance(body, PointMass):
        raise ModelError(where, *_without_axes(body))
    if isinstance(body, Beam) and not body.has_section:
        what = f'"{body.name}" is a cable, which does not turn about its tangent, a hinge cannot hold it'
        hint = "hinge a rigid body and clamp the cable to it: model.clamp(point, to=body)"
        raise ModelError(where, what, hint)
    if isinstance(body, Beam):
        require_node(point, where)


def _without_axes(body: PointMass) -> tuple[str, str]:
    what = f'"{body.name}" is a point mass and has no orientation'
    return what, "join it with model.connect(...), or make it a rigid body"
