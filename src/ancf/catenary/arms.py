"""Steady arms in the model: springs, hinged bars, uplift stops, masses. `overhead` is an Assembled."""

from __future__ import annotations

from typing import Any

import numpy as np

import ancf

from ..arrays import FloatArray
from ..errors import ModelError
from ..model.bodies.rigid import PointMass
from ..model.joints.connections import Spring
from ..model.points import Point
from ..model.supports.support import Hold
from .forms.form import Form
from .lines.fittings import SteadyArm, hangs

#: Length of a spring to a fixed point, m: long enough that its force keeps its direction, and unstretched.
LONG = 20.0
#: Stiffness of an uplift stop, N/m.
STOP = 1e5


def add_mass(model: ancf.Model, name: str, point: Point, mass: float) -> PointMass | None:
    """A mass that moves with a node of a wire; nothing if it is zero."""
    if mass == 0.0:
        return None
    body = model.add_point_mass(name, at=point.initial_position, mass=float(mass))
    model.connect(body, point)
    return body


def add_arms(overhead: Any, found: Form) -> None:
    """The steady arms of all supports but the first and the last; of twin wires each has its own."""
    nodes, rods = found.contact.nodes.support, hinges(found)
    overhead.supports = [overhead.contact.point(node) for node in nodes]
    made = _arms_of(overhead, found, overhead.supports, found.arm_force, rods[0])
    overhead.arms, overhead.arm_holds = made
    if overhead.twin is not None:
        points = [overhead.twin.point(node) for node in nodes]
        made = _arms_of(overhead, found, points, found.twin_arm_force, rods[1], " of the second wire")
        overhead.twin_arms, overhead.twin_arm_holds = made


def hinges(found: Form) -> tuple[FloatArray, ...]:
    """Of each contact wire (supports, 3) where its hinged arms are hinged, sideways and upwards, and how long
    they are without force, m; NaN of others.

    By the forces at rest of the design, along which the arms lie. In other states the hinges stay, whatever
    the arms carry there: nothing, or a push.

    Raises
    ------
    ModelError
        An arm would hang down in the design.

    """
    if found.arm_hinges is not None:
        return found.arm_hinges
    forces = (found.arm_force, found.twin_arm_force)
    return tuple(
        _hinges_of(found, shape.position[shape.nodes.support], force)
        for shape, force in zip(found.contacts, forces, strict=False)
        if force is not None
    )


def _hinges_of(found: Form, places: FloatArray, forces: FloatArray) -> FloatArray:
    made = np.full((len(forces), 3), np.nan)
    for k in range(1, len(forces) - 1):
        arm = found.arm(k)
        if arm.length is None:
            continue
        force = on_arm(found, k, forces)
        check_hinged(k, force)
        size, sense = float(np.linalg.norm(force)), arm.sense(float(force[1]))
        made[k, :2] = (places[k] + sense * arm.length * force / size)[1:]
        made[k, 2] = arm.length - sense * size / arm.stiffness
    return made


def on_arm(found: Form, k: int, forces: FloatArray) -> FloatArray:
    """Force (3,) of the arm of support k on wire and half of its own weight, of those on the wire, N."""
    carried: FloatArray = forces[k] + np.array([0.0, 0.0, 0.5 * found.arm(k).mass * found.line.gravity])
    return carried


def _arms_of(
    overhead: Any, found: Form, points: list[Point], forces: Any, rods: FloatArray, which: str = ""
) -> tuple[list[Spring | None], list[Hold | None]]:
    """The arms of one contact wire, with forces (supports, 3) in N at rest: springs, and what holds it."""
    model, before = overhead.model, overhead.prefix
    arms: list[Spring | None] = [None] * len(points)
    holds: list[Hold | None] = [None] * len(points)
    for k in range(1, len(points) - 1):
        point, arm, name = points[k], found.arm(k), f"{before}steady arm {k + 1}{which}"
        force = on_arm(found, k, forces)
        add_mass(model, f"{before}arm {k + 1}{which} mass", point, 0.5 * arm.mass)
        if arm.uplift_stop is not None:
            _add_stop(model, point, arm.uplift_stop, f"{before}uplift stop {k + 1}{which}")
        if arm.hinged:
            arms[k] = _add_hinged_arm(model, arm, point, rods[k], name)
            continue
        arms[k] = _add_vertical_arm(model, point, arm.vertical, force[2], name)
        if arm.lateral is None:
            holds[k] = model.hold(point, position="y")
        else:
            _add_lateral_arm(model, point, arm.lateral, force[1], f"{name} sideways")
    return arms, holds


def _add_stop(model: ancf.Model, point: Point, height: float, name: str) -> None:
    """A stop that the wire meets when it is lifted above its rest: a rope that becomes taut."""
    below = point.initial_position - [0.0, 0.0, LONG]
    model.add_spring(point, below, stiffness=STOP, length=LONG + height, slack=True, name=name)


def _add_vertical_arm(
    model: ancf.Model, point: Point, stiffness: float | None, load: float, name: str
) -> Spring | None:
    """The vertical spring of a steady arm; without stiffness its force at rest alone."""
    if stiffness:
        return add_long_spring(model, point, 2, stiffness, load, name)
    if load != 0.0:
        model.add_force(point, (0.0, 0.0, load), name=name)
    return None


def _add_lateral_arm(model: ancf.Model, point: Point, stiffness: float, load: float, name: str) -> None:
    """The sideways spring of a steady arm, beside its force at rest.

    A spring that pulled with this force would hold the wire upwards too, by force over length, and one that
    pushed would let it go: what `vertical` says would be more in one curve and less in the other.
    """
    add_long_spring(model, point, 1, stiffness, 0.0, name)
    model.add_force(point, (0.0, load, 0.0), name=f"{name}, at rest")


def add_long_spring(
    model: ancf.Model, point: Point, axis: int, stiffness: float, load: float, name: str
) -> Spring:
    """A spring along an axis that pulls with a load at rest, in N, in the direction of the axis."""
    distance = LONG + max(load, 0.0) / stiffness
    fixed = point.initial_position + distance * np.eye(3)[axis]
    return model.add_spring(point, fixed, stiffness=stiffness, length=distance - load / stiffness, name=name)


def _add_hinged_arm(model: ancf.Model, arm: SteadyArm, point: Point, rod: FloatArray, name: str) -> Spring:
    """A bar to its hinge on the mast, beside the wire: the cantilever follows the wire along the track."""
    hinge = np.array([point.initial_position[0], rod[0], rod[1]])
    made: Spring = model.add_spring(point, hinge, stiffness=arm.stiffness, length=float(rod[2]), name=name)
    return made


def check_hinged(k: int, force: FloatArray) -> None:
    """Raise ModelError where a hinged arm at support k would hang down, by its force (3,) on the wire, N."""
    if hangs(force):
        what = f"the wire pulls sideways with {abs(force[1]):.0f} N at support {k + 1}, which has to carry "
        what += (
            f"{round(force[2]) + 0:d} N: a hinged arm would hang down, its pull has to be larger than that"
        )
        hint = 'give more stagger, contact_support = "free", or vertical instead of length'
        raise ModelError("line.steady_arm.length", what, hint)
