"""Contact of a wire with a straight strip, and the checks of what ``Model.add_contact`` was given."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..bodies import nearest
from ..bodies.beam import Beam
from ..bodies.rigid import Body, kind
from ..points import Point

PERPENDICULAR = 1e-6  # cosine or sine below which directions are perpendicular or the same


@dataclass(frozen=True, slots=True, eq=False)
class Contact:
    """A wire rests on a straight strip through a point, which pushes and never pulls.

    Attributes
    ----------
    point : Point
        The strip's.
    carrier : Beam
        The wire.
    stiffness : float
        Force per overlap, N/m.
    damping : float
        Force per rate of overlap, N s/m.
    strip, normal : (3,) arrays
        Unit vectors along the strip and of the force that the wire receives.
    s : float
        Reference arc length near which the wire crosses the strip at the start, m.
    profile : (n, 2) array or None
        Reference arc lengths, m, and by how much the wire's surface stands out towards the strip there, m.

    """

    name: str
    point: Point
    carrier: Beam
    stiffness: float
    damping: float
    strip: FloatArray
    normal: FloatArray
    s: float
    profile: FloatArray | None = None

    @property
    def travel(self) -> FloatArray:
        """Unit vector across strip and normal: the direction in which the strip goes along the wire."""
        across: FloatArray = np.cross(self.strip, self.normal)
        return across


def make_contact(
    where: str,
    name: str,
    point: Point,
    carrier: Body,
    *,
    stiffness: Any,
    damping: Any,
    strip: Any,
    normal: Any,
    s: Any,
    profile: Any = None,
) -> Contact:
    """Check what ``Model.add_contact`` was given."""
    if not isinstance(carrier, Beam):
        what = f'"{carrier.name}" is a {kind(carrier)}, must be a cable or a beam'
        raise ModelError(f"{where}.along", what)
    if carrier.closed:
        what = f'"{carrier.name}" is closed: a strip needs a wire with ends'
        raise ModelError(f"{where}.along", what, "a surface on a rigid body")
    if point.body is carrier:
        what = f'"{carrier.name}" is the body of {point} itself, it cannot touch itself'
        raise ModelError(f"{where}.along", what)
    along, across = checks.direction(strip, f"{where}.strip"), checks.direction(normal, f"{where}.normal")
    if abs(float(along @ across)) > PERPENDICULAR:
        what = f"must be perpendicular to strip, their cosine is {float(along @ across):.3g}"
        raise ModelError(f"{where}.normal", what)
    start = _start(where, point, carrier, np.cross(along, across), s)
    return Contact(
        name,
        point,
        carrier,
        checks.positive(stiffness, f"{where}.stiffness"),
        checks.non_negative(damping, f"{where}.damping"),
        along,
        across,
        start,
        None if profile is None else checks.curve(profile, f"{where}.profile"),
    )


def _start(where: str, point: Point, wire: Beam, travel: FloatArray, s: Any) -> float:
    """Arc length near the crossing: as given, or nearest to the point."""
    found = nearest.along_beam(wire, (0.0, 0.0), point.initial_position)[0]
    key, start = ("along", found) if s is None else ("s", checks.number(s, f"{where}.s"))
    if not 0.0 <= start <= wire.length:
        raise ModelError(f"{where}.s", f"s = {start:g} m is off the wire, 0 <= s <= {wire.length:g} m")
    if float(travel @ wire.initial_tangent(start)) <= PERPENDICULAR:
        what = f'"{wire.name}" does not run along strip x normal = {(travel + 0.0).tolist()} there'
        raise ModelError(f"{where}.{key}", what, "turn the strip round, or the wire")
    return start
