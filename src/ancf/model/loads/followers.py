"""Loads that turn with what they act on: forces in the axes of a body, and pressure."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..bodies.beam import Beam
from ..bodies.rigid import PointMass, kind
from ..functions.function import TimeFunction
from ..kind import Kind, Push
from ..sheets import value
from ..tables import numbers
from .laws import Parameter, law


def _check_axes(where: str, item: Any) -> None:
    """A cable has a tangent alone, a point mass no axes."""
    body, force = item.point.body, item.force
    if isinstance(body, PointMass):
        what = f'"{body.name}" is a point mass and has no orientation'
        raise ModelError(f"{where}.point", what, "make it a rigid body")
    if isinstance(body, Beam) and not body.has_section:
        if not force.constant or not np.any(force(0.0)[1:]):
            return
        what = f'has parts across the tangent, but "{body.name}" is a cable, which has no axes there'
        raise ModelError(f"{where}.force", what, 'give (F, 0, 0), or add_beam(..., element="nonlocking")')


FOLLOWER_FORCE = law(
    "follower_force",
    "follower force",
    Parameter(
        "force",
        "vector function",
        "N",
        "In the axes of the body: along the tangent or the section's normal, then along its y and z",
    ),
    says="A force that turns with the tangent of a cable, the section of a beam or a rigid body.",
    push=Push("force", "N", frame="axes"),
    check=_check_axes,
)


add_follower_force: Any = FOLLOWER_FORCE.add


@dataclass(frozen=True, slots=True, eq=False)
class Pressure:
    """Load normal to a beam and to a fixed direction, that turns with the beam.

    Attributes
    ----------
    body : Beam
    pressure : TimeFunction
        N per m of present length, along tangent x axis.
    axis : (3,) array
        Unit vector.
    """

    name: str
    body: Beam
    pressure: TimeFunction
    axis: FloatArray

    @property
    def between(self) -> tuple[float, float]:
        """All of the body."""
        return 0.0, self.body.length


def add_pressure(model: Any, body: Beam | str, pressure: Any, axis: Any, name: str | None = None) -> Pressure:
    """Add a pressure on a beam or cable: a load normal to its tangent and to an axis, which turns with it.

    Parameters
    ----------
    body : Beam
    pressure : function of time, N/m
        Per present length, in the direction tangent x axis.
    axis : (3,)
        Normal of the plane in which it turns, any length.
    name : str
        Default "pressure on beam".
    """
    where = model._where("add_pressure", name, body)
    clean = model._body(body, f"{where}.body")
    if not isinstance(clean, Beam):
        what = f'"{clean.name}" is a {kind(clean)}, pressure acts on a beam or cable'
        raise ModelError(f"{where}.body", what)
    label = model._names.of_item(name, f"pressure on {clean.name}", where)
    function = TimeFunction(pressure, 1, f"{where}.pressure", "N/m")
    made: Pressure = model.add_load(Pressure(label, clean, function, checks.direction(axis, f"{where}.axis")))
    return made


PRESSURE = Kind(
    Pressure,
    "pressure",
    "pressure",
    "add_pressure",
    lambda: import_module("ancf.model.file.items").PressureEntry,
    lambda item: f"{value(item.pressure, 'N/m')}, axis {numbers(item.axis)}",
    ends=("body",),
    push=Push("pressure", "N/m", frame="normal"),
    add=add_pressure,
    batch="pressure",
    inputs=lambda item: [item.pressure],
)
