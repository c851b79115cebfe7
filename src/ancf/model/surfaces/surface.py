"""Surfaces that beams and cables touch, on the ground or on rigid bodies, and contacts with them."""

from __future__ import annotations

from dataclasses import MISSING, dataclass, fields
from typing import Any

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..bodies.beam import Beam
from ..bodies.rigid import Body, RigidBody, kind
from ..tables import number, numbers, with_units
from .cable_contact import CableContact
from .shape import Shape
from .shapes import SHAPES


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """A surface, made by ``Model.add_surface``.

    Attributes
    ----------
    shape : Shape
    on : RigidBody or None
        What carries it; None: the ground.

    """

    name: str
    shape: Shape
    on: RigidBody | None

    def body_axes(self, r: FloatArray) -> FloatArray:
        """Initial places (..., 3) in m in the axes in which the shape is given."""
        return r if self.on is None else (r - self.on.position) @ self.on.axes

    def describe(self) -> dict[str, Any]:
        """Plain JSON-able form."""
        plain = {"name": self.name, **self.shape.describe()}
        return plain if self.on is None else {**plain, "on": self.on.name}


@dataclass(frozen=True, slots=True, eq=False)
class SurfaceContact:
    """A beam or cable that may touch a surface, made by ``Model.add_contact``.

    Attributes
    ----------
    stiffness : float
        Force per length and depth, Pa.
    damping : float
        Force per length and rate of depth, Pa s.
    friction : float
        Coulomb's coefficient.
    stick : float or None
        Force per length and way against sliding, before it slips, Pa; None: as `stiffness`.
    radius : float
        Of the beam, m.

    """

    name: str
    body: Beam
    surface: Surface
    stiffness: float
    damping: float
    friction: float
    stick: float | None
    radius: float


def shape_of(given: Any, numbers_of_it: dict[str, Any], where: str) -> Shape:
    """A shape as it is, or by its word and its numbers.

    Raises
    ------
    ModelError
        There is no such shape, or a number is wrong or missing.
    """
    if isinstance(given, Shape):
        if numbers_of_it:
            what = f"a shape is given already, {sorted(numbers_of_it)} have no effect"
            raise ModelError(where, what, "give the shape as text, or its numbers to the shape")
        return given
    if not isinstance(given, str):
        what = f"must be a shape, is {checks.shown(given)}"
        raise ModelError(f"{where}.shape", what, "such as ancf.Cylinder(radius=0.2)")
    made = SHAPES[checks.choice(given, f"{where}.shape", list(SHAPES))]
    asked = {field.name: field.default is MISSING for field in fields(made)}
    for key in numbers_of_it:
        if key not in asked:
            raise ModelError(f"{where}.{key}", f"a {given} has none", checks.nearest(key, asked))
    for key, needed in asked.items():
        if needed and key not in numbers_of_it:
            raise ModelError(f"{where}.{key}", f"a {given} needs it")
    try:
        return made(**numbers_of_it)
    except ModelError as error:
        place = error.where.removeprefix(made.__name__)
        raise ModelError(where + place, error.what, error.hint) from None


def make_surface_contact(
    where: str,
    name: str,
    body: Body,
    surface: Surface,
    *,
    stiffness: Any,
    damping: Any,
    friction: Any,
    stick: Any,
    radius: Any,
) -> SurfaceContact:
    """Check what ``Model.add_contact`` was given for a surface."""
    if not isinstance(body, Beam):
        raise ModelError(where, f'"{body.name}" is a {kind(body)}, must be a cable or a beam')
    if radius is None and body.section.diameter is None:
        what = f'the section of "{body.name}" has no diameter'
        raise ModelError(f"{where}.radius", what, "give radius=, or the section a diameter")
    r = 0.5 * (body.section.diameter or 0.0) if radius is None else checks.positive(radius, f"{where}.radius")
    groove = getattr(surface.shape, "groove", None)
    if groove is not None and groove <= r:
        what = f'the groove of "{surface.name}" has the radius {groove:g} m, "{body.name}" {r:g} m'
        raise ModelError(where, what, "give the groove a larger radius, about 1.06 times that of the cable")
    return SurfaceContact(
        name,
        body,
        surface,
        checks.positive(stiffness, f"{where}.stiffness"),
        checks.non_negative(damping, f"{where}.damping"),
        checks.non_negative(friction, f"{where}.friction"),
        None if stick is None else checks.positive(stick, f"{where}.stick"),
        r,
    )


def touches_with_its_own(contact: SurfaceContact, beam: Beam) -> bool:
    """Whether a contact has the radius of the section of this beam, as it has unless another one is given."""
    return beam.section.diameter is not None and contact.radius == 0.5 * beam.section.diameter


def lie(item: Surface) -> str:
    """Where a surface is."""
    return f"{numbers(item.shape.place, 4)} m on {'the ground' if item.on is None else item.on.name}"


def shape(item: Surface) -> str:
    """Shape and numbers of a surface."""
    plain = item.shape.describe()
    word = plain.pop("shape")
    units = {p.name: "" if p.unit == "-" else f" {p.unit}" for p in item.shape.parameters}
    given = [f"{key} {number(x)}{units[key]}" for key, x in plain.items() if not isinstance(x, list)]
    axis = f"{'normal' if word == 'plane' else 'axis'} {numbers(item.shape.direction)}"
    return ", ".join([word, *given] + ([] if word == "sphere" else [axis]))


def between(item: SurfaceContact) -> str:
    """What touches what."""
    return f"{item.body.name} on {item.surface.name}"


def data(item: SurfaceContact | CableContact) -> str:
    """Stiffness, damping and friction of a contact of a cable."""
    given = (
        ("k", item.stiffness, "Pa"),
        ("c", item.damping or None, "Pa s"),
        ("mu", item.friction or None, ""),
        ("radius", item.radius, "m"),
    )
    return with_units(given)
