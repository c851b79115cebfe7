"""Plain description of a model: dicts, lists, numbers and text, ready for JSON."""

from __future__ import annotations

from dataclasses import asdict, fields
from typing import Any

import numpy as np

from .bodies.beam import Beam
from .bodies.layout import PLACED, is_straight
from .bodies.rigid import IN_FLUID as BODY_IN_FLUID
from .bodies.rigid import Body, PointMass, RigidBody
from .functions.function import TimeFunction
from .kind import Kind
from .loads.state_function import StateFunction
from .points import Point
from .sections.inertia import OPTIONAL
from .sections.section import DAMPINGS, MOMENTS, Rectangle, Section
from .surfaces.surface import Surface
from .surroundings.grounds import Relief
from .surroundings.gusts import Gusts
from .surroundings.velocity_field import VelocityField
from .surroundings.waves import Waves

MOTION = ("velocity", "angular_velocity", "about")
#: Of beams only, and only where there are any.
VELOCITIES = ("along", "velocities")


def section(item: Section) -> dict[str, Any]:
    """Stiffnesses, mass and damping, and shape, material and moments when there are any."""
    plain = {key: getattr(item, key) for key in ("EA", "EI_y", "EI_z", "rhoA", *DAMPINGS)}
    given = {key: _plain(getattr(item, key)) for key in OPTIONAL}
    plain |= {key: value for key, value in given.items() if value is not None}
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
    given = {key: plain[key] for key in DAMPINGS} | {key: plain[key] for key in OPTIONAL if key in plain}
    kind = plain.get("shape")
    if kind is None:
        return Section(EA=plain["EA"], EI=plain["EI_y"], rhoA=plain["rhoA"], **given)
    given.update({key: plain[key] for key in ("E", "nu", "rho", "J", "shear_factors")})
    if kind == "rectangle":
        return Section.rectangle(plain["width"], plain["height"], **given)
    if kind == "circle":
        return Section.circle(**given)
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
    return {**plain, **_in_fluid(item), "motion": motion}


def _in_fluid(item: PointMass | RigidBody) -> dict[str, float]:
    """What a fluid does to it, if it does anything."""
    return {key: value for key in BODY_IN_FLUID if (value := getattr(item, key))}


def rigid_body(item: RigidBody) -> dict[str, Any]:
    """All of a rigid body."""
    plain: dict[str, Any] = {"type": "rigid_body", "name": item.name, "at": item.position.tolist()}
    plain["mass"] = item.mass
    for key in ("inertia", "axes"):
        plain[key] = getattr(item, key).tolist()
    plain |= _in_fluid(item)
    plain["motion"] = {key: getattr(item, key).tolist() for key in MOTION}
    return plain


def beam(item: Beam) -> dict[str, Any]:
    """All of a beam; values at the nodes only when they are needed, arc lengths only when uneven."""
    plain: dict[str, Any] = {"type": "beam", "name": item.name, "section": section(item.section)}
    for key in ("element", "strain", "poisson", "natural_shape", "length", "stretch", "elements"):
        plain[key] = getattr(item, key)
    plain["gauss"] = list(item.gauss)
    plain["start"], plain["end"] = item.node_position[0].tolist(), item.node_position[-1].tolist()
    if not np.array_equal(item.node_x, np.linspace(0.0, item.length, item.elements + 1)):
        plain["nodes"] = item.node_x.tolist()
    plain["y_axis"] = item.node_y[0].tolist()
    if item.closed:
        plain["closed"] = True
    if not is_straight(item):
        plain |= {key: getattr(item, key).tolist() for key in PLACED}
    if item.natural_beam is not None:
        natural = {key: getattr(item.natural_beam, key).tolist() for key in PLACED}
        plain["natural"] = {"stretch": item.natural_beam.stretch, **natural}
    keys = (*MOTION, *VELOCITIES) if item.along.size else MOTION
    plain["motion"] = {key: getattr(item, key).tolist() for key in keys}
    return plain


def other(item: Any, kind: Kind) -> dict[str, Any]:
    """A support, load or connection: its type and its fields, under the keys of its method and of files."""
    keys = dict(zip(kind.ends, kind.keys or kind.ends, strict=True))
    names = (field.name for field in fields(item))
    return {"type": kind.word, **{keys.get(name, name): _plain(getattr(item, name)) for name in names}}


def fields_of(item: Any) -> dict[str, Any]:
    """A fluid, ground or surface: what is not None of it, under the keys of its method and of files."""
    if isinstance(item, Surface):
        return item.describe()
    plain = {field.name: _plain(getattr(item, field.name)) for field in fields(item)}
    return {key: value for key, value in plain.items() if value is not None}


def point(item: Point) -> str:
    """A point as text from which the very same point is read: its label, or all digits of its place."""
    if item.label == item.body.name or item.label.endswith((".start", ".end", ".centre")):
        return item.label
    shown = (item.x, item.y, item.z) if item.eccentric else (item.x,)
    return f"{item.body.name}.at({', '.join(map(_digits, shown))})"


def _digits(value: float) -> str:
    short = f"{value:.12g}"
    return short if float(short) == value else repr(float(value))


def _plain(value: Any) -> Any:
    if isinstance(value, Point):
        return point(value)
    if isinstance(value, Beam | PointMass | RigidBody | Surface):
        return value.name
    if isinstance(value, TimeFunction | StateFunction | VelocityField | Relief | Waves | Gusts):
        return value.describe()
    if isinstance(value, np.ndarray):
        return value.tolist()
    return [_plain(part) for part in value] if isinstance(value, tuple) else value
