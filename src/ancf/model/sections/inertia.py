"""Rotary inertia of a section, given freely."""

from __future__ import annotations

from typing import Any

from ...errors import ModelError
from .. import checks
from .fluid import IN_FLUID

#: Keywords of a section that are None where they are not given.
OPTIONAL = (*IN_FLUID, "rotary_inertia")


def rotary(given: Any) -> dict[str, tuple[float, float] | None]:
    """Checked moments of inertia (rho I_y, rho I_z) per length, kg m, from a number or two; None for none."""
    where = "Section.rotary_inertia"
    if given is None:
        return {"rotary_inertia": None}
    if isinstance(given, tuple | list):
        y, z = checks.array(given, where, (2,)).tolist()
        return {"rotary_inertia": (checks.positive(y, f"{where}[0]"), checks.positive(z, f"{where}[1]"))}
    both = checks.positive(given, where)
    return {"rotary_inertia": (both, both)}


def of_cable(section: Any) -> float:
    """Moment of inertia per length of a cable about every axis across it, kg m; 0 where none was given.

    Raises
    ------
    ModelError
        There are two different ones.
    """
    if section.rotary_inertia is None:
        return 0.0
    y, z = section.rotary_inertia
    if abs(y - z) > 1e-9 * max(y, z):
        what = f"a cable has one about all axes across it, given are {y:g} and {z:g} kg m"
        raise ModelError("Section.rotary_inertia", what, "give one number")
    return float(y)


def of_beam(section: Any) -> tuple[float, float]:
    """(rho I_y, rho I_z) of a beam with a cross-section, kg m: as given, or of its material."""
    given: tuple[float, float] | None = section.rotary_inertia
    return (section.rho * section.I_y, section.rho * section.I_z) if given is None else given
