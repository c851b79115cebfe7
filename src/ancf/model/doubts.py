"""What is possible and hardly meant: numbers that look like those of other units."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from .fluids import Fluid
from .section import Section

#: Of solids, N/m^2: gels and foams have a thousand or more.
SOFTEST = 1e3
#: Of solids, kg/m^3: from foams to osmium, 22,600.
LIGHTEST, HEAVIEST = 10.0, 25_000.0
#: Of fluids with a surface, kg/m^3, and mass that a cable displaces over its own: the lightest buoys have 20.
THINNEST, LIGHT = 10.0, 50.0


def doubts(model: Any) -> list[str]:
    """What is said of sections and fluids, one line each; a section that several bodies share once."""
    found: dict[str, None] = {}
    for name, beam in model.beams.items():
        found |= dict.fromkeys(f'"{name}": {text}' for text in _of_section(beam.section))
        for fluid in model.fluids:
            if fluid.acts_on(name):
                found |= dict.fromkeys(f'"{name}": {text}' for text in _in_fluid(beam.section, fluid))
    for fluid in model.fluids:
        found |= dict.fromkeys(f'"{fluid.name}": {text}' for text in _of_fluid(fluid))
    return [*found]


def _of_section(section: Section) -> Iterator[str]:
    if section.E is not None and section.E < SOFTEST:
        hint = "in N/m^2, steel has 2.1e11"
        yield f"E = {section.E:g} N/m^2 is softer than any solid: was it meant in GPa? ({hint})"
    if section.rho is not None and not LIGHTEST <= section.rho <= HEAVIEST:
        kind = "lighter" if section.rho < LIGHTEST else "heavier"
        yield f"rho = {section.rho:g} kg/m^3 is {kind} than any solid (in kg/m^3, steel has 7850)"


def _in_fluid(section: Section, fluid: Fluid) -> Iterator[str]:
    if section.diameter is None:
        return
    displaced = fluid.density * math.pi * section.diameter**2 / 4
    if displaced > LIGHT * section.rhoA:
        what = f'displaces {displaced:.3g} kg/m of "{fluid.name}" and has {section.rhoA:.3g} kg/m'
        yield f"{what}: is its diameter of {section.diameter:g} m in m?"


def _of_fluid(fluid: Fluid) -> Iterator[str]:
    if fluid.below is not None and 0.0 < fluid.density < THINNEST:
        yield f"{fluid.density:g} kg/m^3 with a surface at z = {fluid.below:g} m: water has 1000 to 1030"
    if fluid.waves is not None and abs(fluid.waves.direction) > 2 * math.pi:
        yield f"its waves run in the direction of {fluid.waves.direction:g} rad: was it meant in degrees?"
