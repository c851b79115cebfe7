"""What is possible and hardly meant: numbers that look like those of other units."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from .body_contact import BodyContact
from .cable_contact import CableContact
from .fluids import Fluid
from .kinds import kind_of
from .points import Point
from .section import Section
from .supports import node_of
from .surfaces import SurfaceContact
from .waves import REGULAR, Waves
from .winch import Winch

#: Of solids, N/m^2: gels and foams have a thousand or more.
SOFTEST = 1e3
#: Of solids, kg/m^3: from foams to osmium, 22,600.
LIGHTEST, HEAVIEST = 10.0, 25_000.0
#: Of fluids with a surface, kg/m^3, and mass that a cable displaces over its own: the lightest buoys have 20.
THINNEST, LIGHT = 10.0, 50.0
#: Of Coulomb's friction: rubber on dry concrete has about 1.
ROUGHEST = 3.0
#: Peak periods, s, and the steepest sea states 2 pi Hs/(g Tp^2) there, linear between: DNV-RP-C205, 3.5.4.
PEAKS, STEEPEST = (8.0, 15.0), (1.0 / 15.0, 1.0 / 25.0)


def doubts(model: Any) -> list[str]:
    """What is said of sections, fluids, friction and winches, one line each; a shared section once."""
    found: dict[str, None] = {}
    for name, beam in model.beams.items():
        found |= dict.fromkeys(f'"{name}": {text}' for text in _of_section(beam.section))
        for fluid in model.fluids:
            if fluid.acts_on(name):
                found |= dict.fromkeys(f'"{name}": {text}' for text in _in_fluid(beam.section, fluid))
    for fluid in model.fluids:
        found |= dict.fromkeys(f'"{fluid.name}": {text}' for text in _of_fluid(fluid, model))
    rubbing = (c for c in model.connections if isinstance(c, SurfaceContact | CableContact | BodyContact))
    for item in (*model.grounds, *rubbing):
        if item.friction > ROUGHEST:
            what = f"a friction of {item.friction:g} is more than surfaces have, rubber on concrete about 1"
            found[f'"{item.name}": {what}: is it an angle, or per cent?'] = None
    found |= dict.fromkeys(_of_winches(model))
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


def _of_winches(model: Any) -> Iterator[str]:
    """Winches at ends that nothing holds: the cable shortens and nothing is drawn."""
    for winch in model.supports:
        if isinstance(winch, Winch) and not _held(model, winch.point):
            end = winch.point
            yield f'"{winch.name}": nothing holds {end}: pin it, or connect it to what carries the winch'


def _held(model: Any, end: Point) -> bool:
    """Whether a support holds the position of an end, or something is joined to it."""
    there = [s.point for s in model.supports if any(name.startswith("position") for name in s.held)]
    there += [p for c in model.connections for p in kind_of(c).ends_of(c) if isinstance(p, Point)]
    return any(p.body is end.body and node_of(p) == node_of(end) for p in there)


def _of_waves(waves: Waves, g: float) -> Iterator[str]:
    """A sea state that is steeper than any, by its significant height and peak period."""
    steep = 2.0 * math.pi * waves.height / (g * waves.period**2) if g > 0.0 else 0.0
    share = min(max((waves.period - PEAKS[0]) / (PEAKS[1] - PEAKS[0]), 0.0), 1.0)
    most = STEEPEST[0] + share * (STEEPEST[1] - STEEPEST[0])
    if waves.given["spectrum"] != REGULAR and steep > most:
        what = f"waves of Hs = {waves.height:g} m with Tp = {waves.period:g} s break"
        limit = math.sqrt(2.0 * math.pi * waves.height / (g * most))
        yield (
            f"{what}: their steepness 2 pi Hs/(g Tp^2) is {steep:.3g}, that of seas at most {most:.2g} "
            f"(DNV-RP-C205); with this height Tp is at least about {limit:.3g} s"
        )


def _of_fluid(fluid: Fluid, model: Any) -> Iterator[str]:
    if fluid.below is not None and 0.0 < fluid.density < THINNEST:
        yield f"{fluid.density:g} kg/m^3 with a surface at z = {fluid.below:g} m: water has 1000 to 1030"
    if fluid.waves is not None and abs(fluid.waves.direction) > 2 * math.pi:
        yield f"its waves run in the direction of {fluid.waves.direction:g} rad: was it meant in degrees?"
    if fluid.waves is not None:
        yield from _of_waves(fluid.waves, float(-model.gravity[2]))
