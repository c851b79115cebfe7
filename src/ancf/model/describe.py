"""Plain description of a model: dicts, lists, numbers and text, ready for JSON."""

from __future__ import annotations

from dataclasses import asdict, fields
from typing import Any

import numpy as np

from ancf.model.beam import Beam
from ancf.model.bodies import Body, PointMass, RigidBody
from ancf.model.functions import TimeFunction
from ancf.model.points import Point
from ancf.model.section import DAMPINGS, MOMENTS, Rectangle, Section

MOTION = ("velocity", "angular_velocity", "about")


def section(item: Section) -> dict[str, Any]:
    """Stiffnesses, mass and damping, and shape, material and moments when there are any."""
    plain = {key: getattr(item, key) for key in ("EA", "EI_y", "EI_z", "rhoA", *DAMPINGS)}
    if item.shear_factors is None:
        return plain
    keys = ("E", "nu", "rho", *MOMENTS)
    material = {**{key: getattr(item, key) for key in keys}, "shear_factors": list(item.shear_factors)}
    if item.shape is None:
        return {"shape": "moments", **material, **plain}
    kind = "rectangle" if isinstance(item.shape, Rectangle) else "circle"
    return {"shape": kind, **asdict(item.shape), **material, **plain}


def section_of(plain: dict[str, Any]) -> Section:
    """The Section that ``section`` described."""
    given = {key: plain[key] for key in DAMPINGS}
    kind = plain.get("shape")
    if kind is None:
        return Section(EA=plain["EA"], EI=plain["EI_y"], rhoA=plain["rhoA"], **given)
    given.update({key: plain[key] for key in ("E", "nu", "rho", "J", "shear_factors")})
    if kind == "rectangle":
        return Section.rectangle(plain["width"], plain["height"], **given)
    if kind == "circle":
        return Section.circle(plain["diameter"], **given)
    return Section.from_moments(**given, **{key: plain[key] for key in MOMENTS if key != "J"})


def body(item: Body) -> dict[str, Any]:
    """All of a body."""
    if isinstance(item, Beam):
        return beam(item)
    return point_mass(item) if isinstance(item, PointMass) else rigid_body(item)


def point_mass(item: PointMass) -> dict[str, Any]:
    """All of a point mass."""
    motion = {"velocity": item.velocity.tolist()}
    plain = {"type": "point_mass", "name": item.name, "at": item.position.tolist(), "mass": item.mass}
    return {**plain, "motion": motion}


def rigid_body(item: RigidBody) -> dict[str, Any]:
    """All of a rigid body."""
    plain: dict[str, Any] = {"type": "rigid_body", "name": item.name, "at": item.position.tolist()}
    plain["mass"] = item.mass
    for key in ("inertia", "axes"):
        plain[key] = getattr(item, key).tolist()
    plain["motion"] = {key: getattr(item, key).tolist() for key in MOTION}
    return plain


def beam(item: Beam) -> dict[str, Any]:
    """All of a beam; values at the nodes only when it is curved, node_x only when uneven."""
    plain: dict[str, Any] = {"type": "beam", "name": item.name, "section": section(item.section)}
    for key in ("element", "strain", "poisson", "natural_shape", "length", "stretch", "elements"):
        plain[key] = getattr(item, key)
    plain["gauss"] = list(item.gauss)
    plain["start"], plain["end"] = item.node_position[0].tolist(), item.node_position[-1].tolist()
    if not np.array_equal(item.node_x, np.linspace(0.0, item.length, item.elements + 1)):
        plain["nodes"] = item.node_x.tolist()
    if item.has_section:
        plain["y_axis"] = item.node_y[0].tolist()
    if not np.all(item.node_tangent == item.node_tangent[0]):
        for key in ("node_position", "node_tangent", *(["node_y"] if item.has_section else [])):
            plain[key] = getattr(item, key).tolist()
    plain["motion"] = {key: getattr(item, key).tolist() for key in MOTION}
    return plain


def other(item: Any, kind: str) -> dict[str, Any]:
    """A support, load or connection: its type and its fields."""
    return {"type": kind, **{field.name: _plain(getattr(item, field.name)) for field in fields(item)}}


def _plain(value: Any) -> Any:
    if isinstance(value, Point):
        return value.label
    if isinstance(value, Beam | PointMass | RigidBody):
        return value.name
    if isinstance(value, TimeFunction):
        return value.describe()
    if isinstance(value, np.ndarray):
        return value.tolist()
    return [_plain(part) for part in value] if isinstance(value, tuple) else value
