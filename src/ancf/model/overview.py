"""Overview of a model and of a section: the sheets that ``print`` and notebooks show."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from ancf.model.beam import Beam
from ancf.model.bodies import Body, RigidBody, kind
from ancf.model.connections import Spring
from ancf.model.contact import Contact
from ancf.model.functions import TimeFunction
from ancf.model.joints import Fixation, Revolute, Slide, Spherical
from ancf.model.loads import DistributedLoad, Force, Load, Moment
from ancf.model.points import Point
from ancf.model.section import DAMPINGS, Section
from ancf.model.shapes import Circle, Rectangle
from ancf.model.supports import Clamp, Hold, Pin, Support
from ancf.model.tables import Sheet, Table, counted, number, numbers, plural, with_units

if TYPE_CHECKING:
    from ancf.model.model import Model

BODY_COLUMNS = (
    "body",
    "kind",
    "elements",
    "length [m]",
    "mass [kg]",
    "EA [N]",
    "EI [N m^2]",
    "from [m]",
    "to [m]",
)
NAMES = {
    Pin: "pin",
    Clamp: "clamp",
    Hold: "hold",
    Force: "force",
    Moment: "moment",
    DistributedLoad: "distributed load",
    Spherical: "spherical joint",
    Revolute: "hinge",
    Fixation: "clamp to a body",
    Slide: "sliding joint",
    Spring: "spring",
    Contact: "contact",
}
DAMPING_UNITS = ("N s/m^2", "N s", "N m^2 s", "N s")


def of_model(model: Model) -> Sheet:
    """Bodies, supports, loads and connections of a model; of hundreds the first and the last."""
    bodies = list(model.bodies.values())
    facts = [
        ("gravity", f"{numbers(model.gravity)} m/s^2"),
        ("bodies", sizes(bodies)),
        ("supports", counted(NAMES[type(item)] for item in model.supports)),
        ("loads", counted(NAMES[type(item)] for item in model.loads)),
        ("connections", counted(NAMES[type(item)] for item in model.connections)),
    ]
    tables = [
        body_table(bodies),
        Table(("support", "at", "holds"), [_support(item) for item in model.supports]),
        Table(("load", "on", "value"), [_load(item) for item in model.loads]),
        Table(("connection", "kind", "between", "data"), [_connection(item) for item in model.connections]),
    ]
    return Sheet(f'Model "{model.title}"' if model.title else "Model", facts, tables)


def sizes(bodies: Iterable[Body]) -> str:
    """``1 cable, 2 point masses; 16 elements, 1.6 kg`` of some bodies."""
    given = list(bodies)
    elements = sum(body.elements for body in given if isinstance(body, Beam))
    total = sum(mass(body) for body in given)
    return (
        f"{counted(kind(b) for b in given)}; {plural(elements, 'element')}, {number(total)} kg"
        if given
        else ""
    )


def body_table(bodies: Iterable[Body]) -> Table:
    """A row for each body: kind, elements, length, mass, stiffnesses and initial place."""
    return Table(BODY_COLUMNS, [_body(body) for body in bodies])


def mass(body: Body) -> float:
    """Mass of a body, kg."""
    return body.section.rhoA * body.length if isinstance(body, Beam) else body.mass


def of_section(section: Section) -> Sheet:
    """Shape, material, stiffnesses, mass and damping of a section."""
    s = section
    material = with_units((("E", s.E, "N/m^2"), ("nu", s.nu, ""), ("rho", s.rho, "kg/m^3")))
    moments = (("A", s.A, "m^2"), ("I_y", s.I_y, "m^4"), ("I_z", s.I_z, "m^4"), ("J", s.J, "m^4"))
    damping = zip(DAMPINGS, (getattr(s, key) or None for key in DAMPINGS), DAMPING_UNITS, strict=True)
    facts = [
        ("shape", _shape(s)),
        ("material", material),
        ("moments", with_units(moments)),
        ("stiffness", with_units((("EA", s.EA, "N"), *_bending(s)))),
        ("mass", with_units((("rhoA", s.rhoA, "kg/m"),))),
        ("damping", with_units(damping)),
    ]
    return Sheet("Section", facts)


def _bending(s: Section) -> tuple[tuple[str, float, str], ...]:
    if s.EI_y == s.EI_z:
        return (("EI", s.EI_y, "N m^2"),)
    return ("EI_y", s.EI_y, "N m^2"), ("EI_z", s.EI_z, "N m^2")


def _shape(s: Section) -> str:
    if isinstance(s.shape, Rectangle):
        return f"rectangle, {number(s.shape.width)} x {number(s.shape.height)} m"
    if isinstance(s.shape, Circle):
        return f"circle, diameter {number(s.shape.diameter)} m"
    return "" if s.A is None else "given by its moments"


def _body(body: Body) -> tuple[str, ...]:
    if not isinstance(body, Beam):
        place = numbers(body.position, 4)
        return body.name, kind(body), "", "", number(body.mass), "", "", place, ""
    s = body.section
    bending = number(s.EI_y) if s.EI_y == s.EI_z else f"{number(s.EI_y)}, {number(s.EI_z)}"
    ends = (numbers(body.node_position[k], 4) for k in (0, -1))
    name = f"{body.element} beam" if body.has_section else body.element
    sizes = (str(body.elements), number(body.length), number(mass(body)))
    return body.name, name, *sizes, number(s.EA), bending, *ends


def _support(item: Support) -> tuple[str, str, str]:
    """Name, point, and what it holds or moves."""
    if isinstance(item, Clamp):
        held = _clamped(item)
    elif isinstance(item, Hold):
        letters = (
            ("position", item.position),
            ("r_x", item.slope),
            ("r_y", item.slope_y),
            ("r_z", item.slope_z),
        )
        parts = [f"{name} {', '.join(text)}" for name, text in letters if text]
        held = "; ".join(parts + (["twist"] if item.twist else []))
    else:
        held = "position"
    moves = "" if item.displacement is None else f"; displacement {value(item.displacement, 'm')}"
    return item.name, str(item.point), held + moves


def _clamped(item: Clamp) -> str:
    if isinstance(item.point.body, RigidBody):
        held = "position, rotation"
    else:
        held = "position, slopes" if item.stretch == "fixed" else "position, directions of slopes"
    if item.rotation is None:
        return held
    return f"{held}; turns by {value(item.rotation, 'rad')} about {numbers(item.axis)}"


def _load(item: Load) -> tuple[str, str, str]:
    if isinstance(item, DistributedLoad):
        x0, x1 = item.between
        whole = x0 == 0.0 and x1 == item.body.length
        part = "" if whole else f", {number(x0)} to {number(x1)} m"
        return item.name, f"{item.body.name}{part}", value(item.load, "N/m")
    given = value(item.force, "N") if isinstance(item, Force) else value(item.moment, "N m")
    return item.name, str(item.point), given


def _connection(item: Any) -> tuple[str, str, str, str]:
    """Name, kind, the two things it connects, and its numbers."""
    data = ""
    if isinstance(item, Slide | Contact):
        between = f"{place(item.point)} along {item.carrier.name}"
    elif isinstance(item, Fixation):
        between = f"{place(item.point)}, {item.to.name}"
    else:
        between = f"{place(item.a)}, {place(item.b)}"
    if isinstance(item, Spring):
        given = (
            ("k", item.stiffness, "N/m"),
            ("c", item.damping or None, "N s/m"),
            ("length", item.length, "m"),
        )
        data = with_units(given) + (", slack" if item.slack else "")
    elif isinstance(item, Revolute):
        data = f"axis {numbers(item.axis)}"
    elif isinstance(item, Slide):
        data = with_units(
            (("s", item.s, "m"), ("mass", item.mass or None, "kg"), ("mu", item.friction or None, ""))
        )
    elif isinstance(item, Contact):
        data = with_units(
            (("k", item.stiffness, "N/m"), ("c", item.damping or None, "N s/m"), ("s", item.s, "m"))
        )
    return item.name, NAMES[type(item)], between, data


def place(end: Any) -> str:
    """A point by its label, a fixed position by its coordinates."""
    return str(end) if isinstance(end, Point) else f"{numbers(np.asarray(end), 4)} m"


def value(function: TimeFunction, unit: str) -> str:
    """A constant with its unit, a formula, or the name of a function of time."""
    if function.constant:
        values = function(0.0)
        return f"{number(float(values[0])) if function.size == 1 else numbers(values)} {unit}"
    given = function.describe()
    if isinstance(given, dict):
        return f"table of {plural(len(given['t']), 'time')} [{unit}]"
    shown = f"({', '.join(map(str, given))})" if isinstance(given, list) else str(given)
    return f"{shown} [{unit}]"
