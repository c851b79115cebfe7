"""What is possible and hardly meant: materials whose numbers look like those of other units."""

from __future__ import annotations

from typing import Any

#: Of solids, N/m^2: gels and foams have a thousand or more.
SOFTEST = 1e3
#: Of solids, kg/m^3: from foams to osmium, 22,600.
LIGHTEST, HEAVIEST = 10.0, 25_000.0


def doubts(model: Any) -> list[str]:
    """What is said of sections of a material, one line each; a section that several bodies share once."""
    found: dict[str, None] = {}
    for name, beam in model.beams.items():
        section = beam.section
        if section.E is not None and section.E < SOFTEST:
            hint = "in N/m^2, steel has 2.1e11"
            found[
                f'"{name}": E = {section.E:g} N/m^2 is softer than any solid: was it meant in GPa? ({hint})'
            ] = None
        if section.rho is not None and not LIGHTEST <= section.rho <= HEAVIEST:
            kind = "lighter" if section.rho < LIGHTEST else "heavier"
            given = f'"{name}": rho = {section.rho:g} kg/m^3 is {kind} than any solid'
            found[f"{given} (in kg/m^3, steel has 7850)"] = None
    return [*found]
