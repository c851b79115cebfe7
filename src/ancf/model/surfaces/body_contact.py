"""Contacts of rigid bodies with rigid bodies, by the surfaces that they carry."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...errors import ModelError
from .. import checks
from ..tables import with_units
from .mesh import Mesh
from .shapes import Capsule, Sphere
from .surface import Surface


@dataclass(frozen=True, slots=True, eq=False)
class BodyContact:
    """Two rigid bodies, or one and the ground, that may touch, made by ``Model.add_contact``.

    Attributes
    ----------
    surface, other : Surface
        What touches what.
    stiffness : float
        Force per depth, N/m.
    damping : float
        Force per rate of depth, N s/m.
    friction : float
        Coulomb's coefficient.
    stick : float or None
        Force per way against sliding, before it slips, N/m; None: as `stiffness`.

    """

    name: str
    surface: Surface
    other: Surface
    stiffness: float
    damping: float
    friction: float
    stick: float | None


def make_body_contact(
    where: str,
    name: str,
    surface: Surface,
    other: Surface,
    *,
    stiffness: Any,
    damping: Any,
    friction: Any,
    stick: Any,
) -> BodyContact:
    """Check what ``Model.add_contact`` was given for two surfaces."""
    if surface.on is other.on:
        what = "both are on the ground" if surface.on is None else f'both are on "{surface.on.name}"'
        raise ModelError(
            f"{where}.other", what, "carry one of them by another rigid body: add_surface(on=...)"
        )
    if not can_touch(surface, other):
        words = f"a {surface.shape.word} and a {other.shape.word}"
        hint = "spheres and capsules touch every shape but a mesh: give one of the two bodies some of them"
        raise ModelError(f"{where}.other", f"{words} cannot touch", hint)
    return BodyContact(
        name,
        surface,
        other,
        checks.positive(stiffness, f"{where}.stiffness"),
        checks.non_negative(damping, f"{where}.damping"),
        checks.non_negative(friction, f"{where}.friction"),
        None if stick is None else checks.positive(stick, f"{where}.stick"),
    )


def can_touch(one: Surface, two: Surface) -> bool:
    """Whether there is a law for two shapes."""
    shapes = one.shape, two.shape
    if any(isinstance(shape, Mesh) for shape in shapes):
        return False
    return any(isinstance(shape, Sphere | Capsule) for shape in shapes)


def between(item: BodyContact) -> str:
    """What touches what."""
    return f"{item.surface.name} and {item.other.name}"


def data(item: BodyContact) -> str:
    """Stiffness, damping and friction."""
    given = (
        ("k", item.stiffness, "N/m"),
        ("c", item.damping or None, "N s/m"),
        ("mu", item.friction or None, ""),
    )
    return with_units(given)
