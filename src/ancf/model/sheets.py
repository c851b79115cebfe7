"""What a model's tables say of each support, load and connection: where it is and its numbers."""

from __future__ import annotations

from typing import Any

import numpy as np

from .bodies.rigid import RigidBody
from .functions.function import TimeFunction
from .joints.basic import Revolute, Slide
from .joints.connections import Spring
from .joints.guides import Cylindrical, Planar
from .loads.load import DistributedLoad, Force, Moment
from .loads.state_function import StateFunction
from .supports.support import Clamp, Hold, Pin
from .supports.winch import Winch
from .surfaces.contact import Contact
from .surroundings.fluids import Fluid
from .surroundings.grounds import Ground, Relief
from .surroundings.velocity_field import VelocityField
from .tables import number, numbers, plural, with_units


def place(end: Any) -> str:
    """A point by its label, a body by its name, a fixed position by its coordinates."""
    if isinstance(end, np.ndarray):
        return f"{numbers(end, 4)} m"
    return str(getattr(end, "name", end))


def value(function: TimeFunction | StateFunction, unit: str) -> str:
    """A constant with its unit, a formula, or the name of a function of time."""
    if isinstance(function, TimeFunction) and function.constant:
        values = function(0.0)
        return f"{number(float(values[0])) if function.size == 1 else numbers(values)} {unit}"
    given = function.describe()
    if isinstance(given, dict):
        return f"table of {plural(len(given['t']), 'time')} [{unit}]"
    shown = f"({', '.join(map(str, given))})" if isinstance(given, list) else str(given)
    return f"{shown} [{unit}]{way(getattr(function, 'once', ''))}"


def way(once: str | None) -> str:
    """How a Python function is called, where that is known and not by compiled code."""
    return ", called once a step" if once else ""


def pin(item: Pin) -> str:
    """What a pin holds and how it moves."""
    return "position" + _moves(item)


def clamp(item: Clamp) -> str:
    """What a clamp holds and how it moves."""
    if isinstance(item.point.body, RigidBody):
        held = "position, rotation"
    else:
        held = "position, slopes" if item.stretch == "fixed" else "position, directions of slopes"
    if item.rotation is not None:
        held += f"; turns by {value(item.rotation, 'rad')} about {numbers(item.axis)}"
    if item.rotation_vector is not None:
        held += f"; turns by {value(item.rotation_vector, 'rad')}"
    return held + _moves(item)


def hold(item: Hold) -> str:
    """What single components hold and how they move."""
    letters = (
        ("position", item.position),
        ("r_x", item.slope),
        ("r_y", item.slope_y),
        ("r_z", item.slope_z),
    )
    parts = [f"{name} {', '.join(text)}" for name, text in letters if text]
    return "; ".join(parts + (["twist"] if item.twist else [])) + _moves(item)


def winch(item: Winch) -> str:
    """The length that it leaves."""
    text = f"nothing; length {value(item.length, 'm')}"
    if item.speed is None:
        return text
    word = "at most" if item.goes_to_length else "speed"
    return f"{text}, {word} {value(item.speed, 'm/s')}, {item.acceleration:g} m/s^2"


def _moves(item: Pin | Clamp | Hold) -> str:
    return "" if item.displacement is None else f"; displacement {value(item.displacement, 'm')}"


def force(item: Force) -> str:
    """Its value."""
    return value(item.force, "N")


def moment(item: Moment) -> str:
    """Its value."""
    return value(item.moment, "N m")


def distributed(item: DistributedLoad) -> str:
    """Its value."""
    return value(item.load, "N/m")


def part(item: DistributedLoad) -> str:
    """The body and its part that is loaded."""
    x0, x1 = item.between
    whole = x0 == 0.0 and x1 == item.body.length
    return item.body.name + ("" if whole else f", {number(x0)} to {number(x1)} m")


def nothing(item: Any) -> str:
    """A kind without numbers."""
    return ""


def axis(item: Revolute | Cylindrical | Planar) -> str:
    """The axis of a hinge or a guide."""
    return f"axis {numbers(item.axis)}"


def along(item: Slide | Contact) -> str:
    """What slides along what."""
    return f"{place(item.point)} along {item.carrier.name}"


def slide(item: Slide) -> str:
    """Arc length, mass and friction of a sliding joint."""
    given = (("s", item.s, "m"), ("mass", item.mass or None, "kg"), ("mu", item.friction or None, ""))
    return with_units(given)


def spring(item: Spring) -> str:
    """Stiffness, damping and length of a spring."""
    given = (
        ("k", item.stiffness, "N/m"),
        ("c", item.damping or None, "N s/m"),
        ("length", item.length, "m"),
        ("friction", item.friction or None, "N"),
    )
    curves = [
        f"{key} of {len(rows)} points"
        for key in ("law", "damper")
        if (rows := getattr(item, key)) is not None
    ]
    return ", ".join([with_units(given), *(["slack"] if item.slack else []), *curves])


def contact(item: Contact) -> str:
    """Stiffness, damping and place of a contact."""
    given = (("k", item.stiffness, "N/m"), ("c", item.damping or None, "N s/m"), ("s", item.s, "m"))
    return with_units(given)


def between_heights(item: Fluid) -> str:
    """Where a fluid is, and on which bodies it acts."""
    parts = []
    if item.above is not None:
        parts.append(f"above z = {number(item.above)} m")
    if item.below is not None:
        parts.append(f"below z = {number(item.below)} m")
    where = " and ".join(parts) or "everywhere"
    return where if item.on is None else f"{where}, on {', '.join(item.on)}"


def fluid(item: Fluid) -> str:
    """Density, velocity and waves of a fluid."""
    text = f"{number(item.density)} kg/m^3, {_velocity(item.velocity)}"
    if (gusts := item.gusts) is not None:
        text += f", gusts of {number(gusts.values['deviation'])} m/s"
    if (waves := item.waves) is not None:
        word = waves.given["spectrum"]
        text += f", {word} waves of {number(waves.height)} m and {number(waves.period)} s"
    return text


def _velocity(field: VelocityField) -> str:
    if not field.moves:
        return "at rest"
    if len(field.heights):
        return f"velocity by a profile of {plural(len(field.heights), 'height')}"
    if field.law is not None or field.parts:
        return f"velocity {_given(field.describe())} [m/s]{way(field.once)}"
    return f"velocity {value(field.uniform, 'm/s')}"


def _given(given: Any) -> str:
    return f"({', '.join(map(str, given))})" if isinstance(given, list) else str(given)


def lie_of_ground(item: Ground) -> str:
    """Where a ground is, and which bodies lie on it."""
    if isinstance(item.height, Relief):
        where = f"table of {len(item.height.x)} x {len(item.height.y)} heights"
    else:
        where = f"z = {number(item.height)} m"
    if item.normal is not None:
        where += f", normal {numbers(item.normal)}"
    return where if item.on is None else f"{where}, on {', '.join(item.on)}"


def ground(item: Ground) -> str:
    """Stiffness, damping and friction of a ground."""
    text = f"stiffness {number(item.stiffness)} Pa/m"
    if item.damping:
        text += f", damping {number(item.damping)} Pa s/m"
    return f"{text}, friction {number(item.friction)}" if item.friction else text
