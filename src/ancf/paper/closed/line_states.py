"""Overhead lines at rest beside formulas: temperature, wind, curves, gradients, droppers as built."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from ... import catenary
from ...arrays import FloatArray
from ..check import Check

G, AIR = 9.81, 1.225  # m/s^2, kg/m^3
#: A wire that bends so little that it is a string, alone between level supports.
STRING = catenary.Wire(EA=12e6, EI=1.0, mass=0.95, tension=10e3, diameter=12.2e-3)
FINE = catenary.Mesh(contact_support=0.05)
#: Five spans with two wires, and elements that follow the bends at the droppers.
LENGTHS = (30.0, 36.0, 32.0, 38.0, 30.0)
KINKS = catenary.Mesh(contact=2.0, messenger=2.0, contact_support=0.05, dropper=0.1)


def checks(short: bool = False) -> list[Check]:
    """What a formula or the design itself says of a line at rest; the short form has no fine meshes."""
    return [*_temperature(), *_wind(short), *([] if short else _curve()), _gradient(), _as_built()]


def alone(length: float, spans: int, **given: object) -> catenary.Line:
    """A contact wire alone, held at its supports."""
    spread = [catenary.Span(length=length, droppers=())] * spans
    arm = catenary.SteadyArm(vertical=1e8)
    return catenary.Line(spans=tuple(spread), contact_wire=STRING, steady_arm=arm, **given)  # type: ignore[arg-type]


def coupled(**given: object) -> catenary.Line:
    """A short line with messenger, EN 50318's wires without bending."""
    spans = [catenary.Span(length=a, droppers=tuple(a * np.arange(0.1, 1.0, 0.2))) for a in LENGTHS]
    made: dict[str, object] = {
        "spans": tuple(spans),
        "contact_wire": catenary.Wire(EA=15e6, EI=1.0, mass=1.35, tension=20e3),
        "messenger_wire": catenary.Wire(EA=11.6e6, EI=1.0, mass=1.07, tension=16e3),
        "droppers": catenary.Droppers(stiffness=1e5),
        "steady_arm": catenary.SteadyArm(vertical=300.0),
        "system_height": 1.2,
        "anchors": "tension",
    }
    return catenary.Line(**(made | given))  # type: ignore[arg-type]


def warmed(line: catenary.Line, degrees: float) -> catenary.Form:
    """The line at another temperature than the 10 degrees of its design."""
    return catenary.form(replace(line, conditions=catenary.Conditions(temperature=degrees)), FINE)


def _temperature() -> list[Check]:
    found = []
    line, fixed = alone(40.0, 5, anchors="tension"), alone(60.0, 1, anchors="fixed")
    rest = catenary.form(line, FINE)
    anchored = 80.0  # the support that is nearest to the middle
    for degrees in (-30.0, 50.0):
        warmer = degrees - line.temperature
        hot = warmed(line, degrees)
        travel = float((hot.contact.position - rest.contact.position)[-1, 0])
        wanted = STRING.expansion * warmer * (line.length - anchored)
        name = f"Overhead line, {degrees:g} °C: an end with weights travels"
        found.append(Check(name, travel, wanted, 1e-3 * abs(wanted), "m", "alpha L dT"))
        pull, wanted = float(warmed(fixed, degrees).pull[0, 0]), hung(STRING, 60.0, warmer)
        name = f"Overhead line, {degrees:g} °C: tension between fixed ends"
        found.append(Check(name, pull, wanted, 1e-3 * wanted, "N", "equation of state of a parabola"))
    return found


def hung(wire: catenary.Wire, length: float, warmer: float) -> float:
    """Tension in N of a wire between fixed ends that was hung with its tension and is warmer now."""
    weight = wire.mass * G

    def natural(tension: float) -> float:
        slack = weight**2 * length**3 / (24.0 * tension**2)
        return (length + slack) / (1.0 + tension / wire.EA)

    wanted = natural(wire.tension) * (1.0 + wire.expansion * warmer)
    return float(brentq(lambda tension: natural(tension) - wanted, 1e2, 1e5))


def _wind(short: bool) -> list[Check]:
    line, speed = alone(50.0, 2, anchors="tension"), 25.0
    blown = catenary.form(replace(line, conditions=catenary.Conditions(wind=speed)), FINE)
    x, y = blown.contact.position[:, 0], blown.contact.position[:, 1]
    pressure = 0.5 * AIR * speed**2
    aside, wanted = float(np.interp(25.0, x, y)), pressure * 12.2e-3 * 50.0**2 / 8.0 / STRING.tension
    name = f"Overhead line, wind of {speed:g} m/s: blow-off of one wire"
    one = Check(name, aside, wanted, 0.01 * wanted, "m", "w l^2/(8 T)")
    return [one, *([] if short else _blown_together(speed, pressure))]


def _blown_together(speed: float, pressure: float) -> list[Check]:
    wires = {
        "contact_wire": catenary.Wire(EA=12e6, EI=1.0, mass=0.95, tension=12e3, diameter=12.2e-3),
        "messenger_wire": catenary.Wire(EA=7e6, EI=1.0, mass=0.6, tension=9e3, diameter=10.5e-3),
    }
    span = catenary.Span(length=48.0, droppers=tuple(np.arange(2.0, 48.0, 4.0)))
    line = coupled(spans=(span,) * 3, **wires)
    mesh = catenary.Mesh(contact=1.0, messenger=1.0, contact_support=0.05, dropper=0.1)
    rest = catenary.form(line, mesh)
    blown = catenary.form(replace(line, conditions=catenary.Conditions(wind=speed)), mesh)
    middle = slice(12, 24)
    lean = (rest.dropper_force / rest.dropper_length)[middle]
    wanted = two_strings(line, lean, pressure)
    assert blown.messenger is not None
    found = []
    for name, shape, places in zip(
        ("contact wire", "messenger"), (blown.contact, blown.messenger), wanted, strict=True
    ):
        aside = float(shape.position[shape.nodes.dropper[middle], 1].max())
        whole = f"Overhead line, wind of {speed:g} m/s: blow-off of two wires, {name}"
        origin = "two strings that droppers join by their lean, parabolas of the loads"
        found.append(Check(whole, aside, float(places.max()), 0.01 * float(places.max()), "m", origin))
    return found


def two_strings(line: catenary.Line, lean: FloatArray, pressure: float) -> FloatArray:
    """Sideways places (2, n) in m at the droppers, which pull with `lean` (n,) in N/m where they lean."""
    assert line.messenger_wire is not None
    x, length = np.array(line.spans[0].droppers), line.spans[0].length
    low, high = np.minimum.outer(x, x), np.maximum.outer(x, x)
    whole, load, n = np.zeros((2 * x.size, 2 * x.size)), [], x.size
    for k, wire in enumerate((line.contact_wire, line.messenger_wire)):
        part = slice(k * n, (k + 1) * n)
        whole[part, part] = low * (length - high) / length / wire.tension
        load.append(pressure * (wire.diameter or 0.0) * x * (length - x) / 2.0 / wire.tension)
    couple = np.block([[-np.diag(lean), np.diag(lean)], [np.diag(lean), -np.diag(lean)]])
    places: FloatArray = np.linalg.solve(np.eye(2 * n) - whole @ couple, np.concatenate(load))
    return places.reshape(2, n)


def _curve() -> list[Check]:
    radius = 600.0
    spans = [replace(span, radius=radius) for span in coupled().spans]
    made = catenary.form(coupled(spans=tuple(spans)), KINKS)
    wanted = -0.5 * (LENGTHS[1] + LENGTHS[2]) / radius
    found = []
    for name, force, tension in (
        ("contact wire on its arm", made.arm_force[2, 1], 20e3),
        ("messenger on its support", made.support_side[2], 16e3),
    ):
        exact = tension * wanted
        name = f"Overhead line, curve of {radius:g} m: {name}"
        found.append(Check(name, float(force), exact, 1e-3 * abs(exact), "N", "T/R over half of both spans"))
    return found


def _gradient() -> Check:
    heights = (5.3, 5.3, 5.25, 5.2, 5.2, 5.2)
    line = coupled(height=heights)
    wrong = catenary.form(line).contact_height - np.interp(line.dropper_x, line.supports, heights)
    name = "Overhead line, gradient: largest error of a height at rest"
    return Check(name, float(np.abs(wrong).max()), 0.0, 5e-4, "m", "straight from support to support")


def _as_built() -> Check:
    line = coupled(stagger=0.25, contact_support="free")
    lengths = catenary.form(line, catenary.Mesh(contact=2.0, messenger=3.0)).dropper_natural
    built = catenary.form(replace(line, dropper_lengths=lengths), catenary.Mesh(contact=1.3, messenger=2.2))
    name = "Overhead line, droppers as designed, hung on another mesh: largest error of a height"
    wrong = float(np.abs(built.contact_height - line.dropper_height).max())
    return Check(name, wrong, 0.0, 1e-4, "m", "the heights that the design wants")
