"""Contacts of cables with cables, or of a cable with itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...errors import ModelError
from .. import checks
from ..bodies.beam import Beam
from ..bodies.rigid import Body, kind


@dataclass(frozen=True, slots=True, eq=False)
class CableContact:
    """Two cables or beams that may touch, or one that may touch itself, made by ``Model.add_contact``.

    Attributes
    ----------
    body, other : Beam
        The same one: it touches itself.
    stiffness : float
        Force per length and depth where they lie side by side, Pa.
    damping : float
        Force per length and rate of depth, Pa s.
    friction : float
        Coulomb's coefficient.
    stick : float or None
        Force per length and way against sliding, before it slips, Pa; None: as `stiffness`.
    radius : float or None
        Of both, m; None: half the diameters of their sections.

    """

    name: str
    body: Beam
    other: Beam
    stiffness: float
    damping: float
    friction: float
    stick: float | None
    radius: float | None

    def radius_of(self, body: Beam) -> float:
        """Radius of one of them, m."""
        return 0.5 * (body.section.diameter or 0.0) if self.radius is None else self.radius


def make_cable_contact(
    where: str,
    name: str,
    body: Body,
    other: Body,
    *,
    stiffness: Any,
    damping: Any,
    friction: Any,
    stick: Any,
    radius: Any,
) -> CableContact:
    """Check what ``Model.add_contact`` was given for two cables."""
    for end, key in ((body, "body"), (other, "other")):
        if not isinstance(end, Beam):
            raise ModelError(f"{where}.{key}", f'"{end.name}" is a {kind(end)}, must be a cable or a beam')
        if end.closed:
            raise ModelError(f"{where}.{key}", f'"{end.name}" is closed: cables that touch need two ends')
        if radius is None and end.section.diameter is None:
            what = f'the section of "{end.name}" has no diameter'
            raise ModelError(f"{where}.radius", what, "give radius=, or the section a diameter")
    assert isinstance(body, Beam)
    assert isinstance(other, Beam)
    return CableContact(
        name,
        body,
        other,
        checks.positive(stiffness, f"{where}.stiffness"),
        checks.non_negative(damping, f"{where}.damping"),
        checks.non_negative(friction, f"{where}.friction"),
        None if stick is None else checks.positive(stick, f"{where}.stick"),
        None if radius is None else checks.positive(radius, f"{where}.radius"),
    )


def between(item: CableContact) -> str:
    """What touches what."""
    return f"{item.body.name} and {'itself' if item.other is item.body else item.other.name}"
