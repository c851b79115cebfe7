"""Plain description of a model: dicts, lists, numbers and text, ready for JSON."""

from __future__ import annotations

from dataclasses import asdict, fields
from typing import Any

import numpy as np

from ancf.model.beam import Beam
from ancf.model.functions import TimeFunction
from ancf.model.points import Point
from ancf.model.section import Rectangle, Section


def section(item: Section) -> dict[str, Any]:
    """Stiffnesses, mass and damping, and shape and material when there are any."""
    keys = ["EA", "EI_y", "EI_z", "rhoA", "damping", "axial_damping", "bending_damping"]
    plain: dict[str, Any] = {key: getattr(item, key) for key in keys}
    if item.shape is None:
        return plain
    kind = "rectangle" if isinstance(item.shape, Rectangle) else "circle"
    material = {"E": item.E, "nu": item.nu, "rho": item.rho}
    return {"shape": kind, **asdict(item.shape), **material, **plain}


def beam(item: Beam) -> dict[str, Any]:
    """All of a beam; node positions and tangents only when it is curved, node_x only when uneven."""
    plain: dict[str, Any] = {"type": "beam", "name": item.name, "section": section(item.section)}
    for key in ("element", "strain", "poisson", "natural_shape", "length", "stretch", "elements"):
        plain[key] = getattr(item, key)
    plain["gauss"] = list(item.gauss)
    plain["start"], plain["end"] = item.node_position[0].tolist(), item.node_position[-1].tolist()
    if not np.array_equal(item.node_x, np.linspace(0.0, item.length, item.elements + 1)):
        plain["nodes"] = item.node_x.tolist()
    if not np.all(item.node_tangent == item.node_tangent[0]):
        plain["node_position"] = item.node_position.tolist()
        plain["node_tangent"] = item.node_tangent.tolist()
    motion = ("velocity", "angular_velocity", "about")
    plain["motion"] = {key: getattr(item, key).tolist() for key in motion}
    return plain


def other(item: Any, kind: str) -> dict[str, Any]:
    """A support, load or connection: its type and its fields."""
    return {"type": kind, **{field.name: _plain(getattr(item, field.name)) for field in fields(item)}}


def _plain(value: Any) -> Any:
    if isinstance(value, Point):
        return value.label
    if isinstance(value, Beam):
        return value.name
    if isinstance(value, TimeFunction):
        return value.describe()
    if isinstance(value, np.ndarray):
        return value.tolist()
    return list(value) if isinstance(value, tuple) else value
