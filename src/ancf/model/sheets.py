"""What a model's tables say of each support, load and connection: where it is and its numbers."""

from __future__ import annotations

from typing import Any

import numpy as np

from .bodies import RigidBody
from .connections import Spring
from .contact import Contact
from .functions import TimeFunction
from .joints import Revolute, Slide
from .loads import DistributedLoad, Force, Moment
from .state_function import StateFunction
from .supports import Clamp, Hold, Pin
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
    return f"{shown} [{unit}]"


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


def axis(item: Revolute) -> str:
    """The axis of a hinge."""
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
    )
    return with_units(given) + (", slack" if item.slack else "")


def contact(item: Contact) -> str:
    """Stiffness, damping and place of a contact."""
    given = (("k", item.stiffness, "N/m"), ("c", item.damping or None, "N s/m"), ("s", item.s, "m"))
    return with_units(given)
