"""What is possible and hardly meant: numbers that look like those of other units."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from .joints.torsion import TorsionSpring
from .kinds import kind_of
from .points import Point
from .sections.section import Section
from .supports.support import node_of
from .supports.winch import Winch
from .surfaces.body_contact import BodyContact
from .surfaces.cable_contact import CableContact
from .surfaces.surface import SurfaceContact
from .surroundings.fluids import Fluid
from .surroundings.velocity_field import VelocityField
from .surroundings.waves import REGULAR, Waves

#: Of solids, N/m^2: gels and foams have a thousand or more.
SOFTEST = 1e3
#: Of solids, kg/m^3: from foams to osmium, 22,600.
LIGHTEST, HEAVIEST = 10.0, 25_000.0
#: Speeds of pulls along a line, sqrt(EA/rhoA), m/s: a Slinky has 0.1, soft silicone 5, DNA 600, steel 5000,
#: diamond 18,000, carbon nanotubes 27,000; stiffnesses that stand for inextensible lines some 100,000.
SLOWEST, FASTEST = 0.05, 1e6
#: Radius of gyration of a section, sqrt(EI/EA), m: decks of bridges are 60 m wide at most and have 20. Nor is
#: a beam's larger than its length: it would be more than three times as thick as long.
WIDEST = 50.0
#: Mass per length, kg/m: decks of bridges have 50,000, immersed tunnels 300,000.
HEAVIEST_LINE = 1e6
#: Of lines with their outer diameter, kg/m^3: air has 1.2, foams more than 10. Above there is no bound: a
#: flat belt may touch with a diameter next to none.
AIR = 1.0
#: Gravity, m/s^2: Jupiter has 25, the Earth 9.8.
STRONGEST = 30.0
#: Of fluids with a surface, kg/m^3, and mass that a cable displaces over its own: the lightest buoys have 20.
THINNEST, LIGHT = 10.0, 50.0
#: Full turns by which a torsion spring is wound at most, unsaid.
TURNS = 4.0
#: Of Coulomb's friction: rubber on dry concrete has about 1.
ROUGHEST = 3.0
#: Deviations of gusts over their mean speed; how far the mean wind may be from that of the gusts.
GUSTIEST, OTHER_WIND = 0.5, 0.3
#: Peak periods, s, and the steepest sea states 2 pi Hs/(g Tp^2) there, linear between: DNV-RP-C205, 3.5.4.
PEAKS, STEEPEST = (8.0, 15.0), (1.0 / 15.0, 1.0 / 25.0)


def doubts(model: Any) -> list[str]:
    """What is said of sections, fluids, friction and winches, one line each; a shared section once."""
    found: dict[str, None] = dict.fromkeys(_of_gravity(model))
    for name, beam in model.beams.items():
        wet = [text for f in model.fluids if f.acts_on(name) for text in _in_fluid(beam.section, f)]
        own = (
            *_of_section(beam.section),
            *_of_line(beam.section, beam.length),
            *(wet or _in_air(beam.section)),
        )
        found |= dict.fromkeys(f'"{name}": {text}' for text in own)
    for fluid in model.fluids:
        found |= dict.fromkeys(f'"{fluid.name}": {text}' for text in _of_fluid(fluid, model))
    rubbing = (c for c in model.connections if isinstance(c, SurfaceContact | CableContact | BodyContact))
    for item in (*model.grounds, *rubbing):
        if item.friction > ROUGHEST:
            what = f"a friction of {item.friction:g} is more than surfaces have, rubber on concrete about 1"
            found[f'"{item.name}": {what}: is it an angle, or per cent?'] = None
    for item in model.connections:
        if isinstance(item, TorsionSpring) and abs(item.angle) > TURNS * 2 * math.pi:
            found[f'"{item.name}": is free of moment at {item.angle:g} rad: was it meant in degrees?'] = None
    found |= dict.fromkeys(_of_winches(model))
    return [*found]


def drawn_otherwise(model: Any) -> Iterator[str]:
    """Beams and cables whose initial shape is longer or shorter than they are without forces."""
    for beam in model.beams.values():
        if abs(beam.stretch - 1) > 1e-12:
            share = f"{100 * abs(beam.stretch - 1):.3g} % {'longer' if beam.stretch > 1 else 'shorter'}"
            yield f'body "{beam.name}" starts {share} than its natural length {beam.length:g} m'


def _of_section(section: Section) -> Iterator[str]:
    if section.E is not None and section.E < SOFTEST:
        hint = "in N/m^2, steel has 2.1e11"
        yield f"E = {section.E:g} N/m^2 is softer than any solid: was it meant in GPa? ({hint})"
    if section.rho is not None and not LIGHTEST <= section.rho <= HEAVIEST:
        kind = "lighter" if section.rho < LIGHTEST else "heavier"
        yield f"rho = {section.rho:g} kg/m^3 is {kind} than any solid (in kg/m^3, steel has 7850)"


def _of_gravity(model: Any) -> Iterator[str]:
    size = float(np.linalg.norm(model.gravity))
    if size > STRONGEST:
        yield f"gravity of {size:g} m/s^2 is more than planets have, on Earth it is 9.81: is it in m/s^2?"


def _of_line(section: Section, length: float) -> Iterator[str]:
    """Numbers of a section that do not fit each other, or the length of its beam."""
    if section.rhoA >= HEAVIEST_LINE:
        yield f"rhoA = {section.rhoA:g} kg/m is more than any bridge has, some 5e4: is it in kg/m?"
    speed = math.sqrt(section.EA) / math.sqrt(section.rhoA)
    if not SLOWEST <= speed <= FASTEST:
        what = f"with EA = {section.EA:g} N and rhoA = {section.rhoA:g} kg/m a pull runs along it at"
        yield f"{what} {speed:.3g} m/s: rubber has some 30, steel 5000: is EA in N, rhoA in kg/m?"
    stiffest = max(section.EI_y, section.EI_z)
    thick = math.sqrt(stiffest) / math.sqrt(section.EA)
    if thick > min(length, WIDEST):
        what = f"EI = {stiffest:g} N m^2 with EA = {section.EA:g} N is that of a section some"
        yield f"{what} {3.5 * thick:.3g} m thick, and it is {length:g} m long: is EI in N m^2, EA in N?"


def _in_air(section: Section) -> Iterator[str]:
    if section.diameter is None or section.rho is not None:
        return
    density = section.rhoA / (0.25 * math.pi * section.diameter**2)
    if density < AIR:
        what = f"a diameter of {section.diameter:g} m and {section.rhoA:g} kg/m make {density:.3g} kg/m^3"
        yield f"{what}, less than air: is its diameter in m, rhoA in kg/m?"


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
    directions = {} if fluid.waves is None else {"waves run": fluid.waves.direction}
    directions |= {} if fluid.gusts is None else {"gusts blow": fluid.gusts.values["direction"]}
    for what, angle in directions.items():
        if abs(angle) > 2 * math.pi:
            yield f"its {what} in the direction of {angle:g} rad: was it meant in degrees?"
    if fluid.waves is not None:
        yield from _of_waves(fluid.waves, float(-model.gravity[2]))
    if fluid.gusts is not None:
        yield from _of_gusts(fluid.gusts.values, fluid.velocity)


def _of_gusts(v: Mapping[str, Any], velocity: VelocityField) -> Iterator[str]:
    """Turbulence beyond that of any site, and a mean wind that is not the one of the gusts."""
    if v["deviation"] > GUSTIEST * v["speed"]:
        share = 100.0 * v["deviation"] / v["speed"]
        yield f"its gusts deviate by {share:.0f} % of the mean wind, those of cities by some 30 %"
    by_place = len(velocity.heights) or velocity.parts or velocity.law is not None
    if by_place or not velocity.uniform.constant:
        return
    given = velocity.uniform(0.0)
    along = np.array([math.cos(v["direction"]), math.sin(v["direction"]), 0.0])
    if np.linalg.norm(given - v["speed"] * along) > OTHER_WIND * v["speed"]:
        shown = ", ".join(f"{x:.3g}" for x in given)
        wanted = ", ".join(f"{x:.3g}" for x in v["speed"] * along + 0.0)
        yield (
            f"its gusts are those of a wind of ({wanted}) m/s, which velocity= has to give; it is ({shown})"
        )
