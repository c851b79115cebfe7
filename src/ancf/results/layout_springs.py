"""Springs of a results file: what is needed to read their forces from its states, without the model."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..model.bodies import Body
from ..model.connections import Spring
from ..model.model import Model
from ..model.points import Point
from ..system.spring_fields import springs_of

FloatArray = NDArray[np.float64]


def write_springs(file: Any, model: Model) -> None:
    """Write the group ``springs`` of an HDF5 file: by number in the model, names may hold any character."""
    group = file.create_group("springs")
    for k, spring in enumerate(springs_of(model.connections).values()):
        a = group.create_group(f"{k:06d}").attrs
        a["name"], a["slack"] = spring.name, spring.slack
        for key in ("stiffness", "damping", "length"):
            a[key] = getattr(spring, key)
        for key, end in (("a", spring.a), ("b", spring.b)):
            if isinstance(end, Point):
                a[key], a[f"{key}_body"], a[f"{key}_label"] = (end.x, end.y, end.z), end.body.name, end.label
            else:
                a[key], a[f"{key}_body"] = end, ""


def read_springs(file: Any, bodies: dict[str, Body]) -> dict[str, Spring]:
    """Springs by name; files written before there was the group have none."""
    springs = {}
    for item in file.get("springs", {}).values():
        a = item.attrs
        given = {key: float(a[key]) for key in ("stiffness", "damping", "length")}
        first = _end(a, "a", bodies)
        assert isinstance(first, Point)
        name = str(a["name"])
        springs[name] = Spring(name, first, _end(a, "b", bodies), slack=bool(a["slack"]), **given)
    return springs


def _end(attrs: Any, key: str, bodies: dict[str, Body]) -> Point | FloatArray:
    """A point of a body, or a fixed position."""
    place: FloatArray = np.asarray(attrs[key], dtype=np.float64)
    body = str(attrs[f"{key}_body"])
    if not body:
        return place
    x, y, z = place.tolist()
    return Point(bodies[body], x, str(attrs[f"{key}_label"]), y, z)
