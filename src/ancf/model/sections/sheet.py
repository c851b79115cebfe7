"""Overview of a section: the sheet that ``print`` and notebooks show."""

from __future__ import annotations

from typing import Any

from ..tables import Sheet, number, with_units
from .shapes import Circle, Rectangle

DAMPING_UNITS = ("N s/m^2", "N s", "N m^2 s", "N s")


def of_section(section: Any, dampings: tuple[str, ...]) -> Sheet:
    """Shape, material, stiffnesses, mass and damping of a section."""
    s = section
    material = with_units((("E", s.E, "N/m^2"), ("nu", s.nu, ""), ("rho", s.rho, "kg/m^3")))
    moments = (("A", s.A, "m^2"), ("I_y", s.I_y, "m^4"), ("I_z", s.I_z, "m^4"), ("J", s.J, "m^4"))
    damping = zip(dampings, (getattr(s, key) or None for key in dampings), DAMPING_UNITS, strict=True)
    facts = [
        ("shape", _shape(s)),
        ("material", material),
        ("moments", with_units(moments)),
        ("stiffness", with_units((("EA", s.EA, "N"), *_bending(s)))),
        ("mass", with_units((("rhoA", s.rhoA, "kg/m"), *_rotary(s)))),
        ("damping", with_units(damping)),
        ("in a fluid", _in_fluid(s)),
    ]
    return Sheet("Section", facts)


def _rotary(s: Any) -> tuple[tuple[str, float, str], ...]:
    if s.rotary_inertia is None:
        return ()
    y, z = s.rotary_inertia
    if y == z:
        return (("rotary inertia", y, "kg m"),)
    return ("rotary inertia about y", y, "kg m"), ("about z", z, "kg m")


def _bending(s: Any) -> tuple[tuple[str, float, str], ...]:
    if s.EI_y == s.EI_z:
        return (("EI", s.EI_y, "N m^2"),)
    return ("EI_y", s.EI_y, "N m^2"), ("EI_z", s.EI_z, "N m^2")


def _shape(s: Any) -> str:
    if isinstance(s.shape, Rectangle):
        return f"rectangle, {number(s.shape.width)} x {number(s.shape.height)} m"
    if isinstance(s.shape, Circle):
        return f"circle, diameter {number(s.shape.diameter)} m"
    return "" if s.A is None else "given by its moments"


def _in_fluid(s: Any) -> str:
    own = s.diameter if not isinstance(s.shape, Circle) else None
    parts = [] if own is None else [f"diameter {number(own)} m"]
    for key in ("drag", "added_mass"):
        given = getattr(s, key)
        if given is not None:
            parts.append(f"{key.replace('_', ' ')} {number(given[0])} normal, {number(given[1])} tangential")
    return ", ".join(parts)
