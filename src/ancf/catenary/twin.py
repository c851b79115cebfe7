"""Twin contact wires: two wires side by side, each with its own droppers, that share the strips.

The design is that of one wire with both masses, stiffnesses and tensions, whose heights are those of both.
Then each wire gets its half, its own place across the track and its own droppers, and the whole line comes
to rest: the droppers lean, and draw the wires together between their arms. What this does to the heights is
taken out of the lengths of the droppers.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import SolveError
from ..model.points import Point
from .forms.form import Form, design, unstretched
from .forms.mesh import Mesh, Nodes
from .forms.shape import WireShape
from .lines.fittings import NO_DROPPERS, Droppers, SteadyArm
from .lines.line import Line
from .settle import mounted

#: Largest error of a height at a clamp, m, and rounds in which it has to be reached.
TOLERANCE, MOST_ROUNDS = 1e-5, 20
#: To which side of their middle the wires are: the first to the left.
SIDES = np.array([0.5, -0.5])


def design_twin(line: Line, mesh: Mesh | None) -> Form:
    """The form that a line of two contact wires is designed to have.

    Raises
    ------
    ModelError
        As :func:`ancf.catenary.forms.form.design`.
    SolveError
        The heights of the droppers are not found.

    """
    found = _parted(line, design(as_one(line), mesh))
    for _ in range(MOST_ROUNDS):
        rested = mounted(found)
        wrong = rested.contact_height - line.dropper_height
        if float(np.max(np.abs(wrong), initial=0.0)) < TOLERANCE:
            return replace(rested, settled=False, arm_hinges=None)
        natural = found.dropper_natural + wrong
        stiffness = found.dropper_stiffness
        if line.droppers.EA is not None:
            stiffness = line.droppers.EA / natural
        found = replace(
            rested,
            dropper_natural=natural,
            dropper_stiffness=stiffness,
            settled=False,
            arm_hinges=None,
        )
    what = f"heights of twin contact wires are {float(np.max(np.abs(wrong))):.2e} m off"
    raise SolveError("catenary.form", what, "less contact_spacing, or longer droppers")


def as_one(line: Line) -> Line:
    """The line with one contact wire for both."""
    arms: Any = line.steady_arm
    arms = tuple(_both(arm) for arm in arms) if isinstance(arms, tuple) else _both(arms)
    return replace(
        line,
        contact_wire=line.contact_wire.times(2),
        contact_spacing=None,
        droppers=_pair(line.droppers),
        steady_arm=arms,
    )


def _both(arm: SteadyArm) -> SteadyArm:
    return replace(arm, mass=2.0 * arm.mass)


def _pair(droppers: Droppers) -> Droppers:
    """Two droppers as one."""
    if droppers == NO_DROPPERS:
        return droppers
    keys = ("stiffness", "EA", "mass", "damping", "clamp_contact", "clamp_messenger")
    values = {key: getattr(droppers, key) for key in keys}
    return replace(droppers, **{key: 2.0 * value for key, value in values.items() if value is not None})


def _parted(line: Line, one: Form) -> Form:
    """The form of two wires out of that of one for both: it does not rest yet."""
    assert line.contact_spacing is not None
    first, second = (_half(line, one.contact, side * line.contact_spacing) for side in SIDES)
    twice = {
        key: None if shape is None else replace(shape, nodes=_twice(shape.nodes))
        for key, shape in (("messenger", one.messenger), ("auxiliary", one.auxiliary))
    }
    if one.auxiliary is not None:  # then the messenger's clamps are those of the long droppers
        twice["messenger"] = one.messenger
    force, give = 0.5 * np.repeat(one.dropper_force, 2), 2.0 * np.repeat(one.clamp_give, 2)
    made = replace(
        one,
        made_for=(line, one.mesh),
        line=line,
        contact=first,
        twin=second,
        messenger=twice["messenger"],
        auxiliary=twice["auxiliary"],
        stitches=tuple(replace(shape, nodes=_twice(shape.nodes)) for shape in one.stitches),
        dropper_load=0.5 * np.repeat(one.dropper_load, 2),
        dropper_force=force,
        clamp_give=give,
        contact_give=2.0 * np.repeat(one.contact_give, 2),
        contact_height=np.repeat(one.contact_height, 2),
        messenger_height=np.repeat(one.messenger_height, 2),
        arm_force=0.5 * one.arm_force,
        twin_arm_force=0.5 * one.arm_force,
        pull=_pulls(line, one.pull),
    )
    distance = np.linalg.norm(made.upper - made.lower, axis=1)
    length = distance - give * force
    natural, stiffness = unstretched(line.droppers, length, force, line.dropper_label)
    return replace(made, dropper_length=length, dropper_natural=natural, dropper_stiffness=stiffness)


def _half(line: Line, one: WireShape, aside: float) -> WireShape:
    """One of the wires, beside the middle of both by a distance in m."""
    places = one.position + np.array([0.0, aside, 0.0])
    return replace(one, wire=line.contact_wire, nodes=_twice(one.nodes), position=places)


def _twice(nodes: Nodes) -> Nodes:
    """Each clamp for the droppers of both wires."""
    return replace(nodes, dropper=np.repeat(nodes.dropper, 2))


def _pulls(line: Line, one: FloatArray) -> FloatArray:
    """Forces (4, 2) at the ends of contact wire, messenger, auxiliary and second contact wire, N."""
    pull = np.zeros((4, 2))
    pull[: len(one)] = one
    pull[[0, 3]] = line.contact_wire.tension
    return pull


def second_supports(overhead: Any) -> dict[int, Point]:
    """By the index of a support of an Overhead the second of twin contact wires there, if there are two."""
    found: dict[int, Point] = {}
    first = 0
    for part in overhead.parts or [overhead]:
        nodes = part.contact.shape.nodes.support.tolist()
        if part.twin is not None:
            found |= {first + i: part.twin.point(node) for i, node in enumerate(nodes)}
        first += len(nodes)
    return found
