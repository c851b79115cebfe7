"""What can be drawn over time: the questions that a result answers, by name, and what they are asked of."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks
from ...model.bodies.beam import Beam
from ...model.bodies.rigid import PointMass, RigidBody
from ...model.functions.inputs import Input
from ...model.kind import CONTACT, JOINT, SLIDE, SPRING, SURFACE_CONTACT, TORSION
from ...model.kinds import CONNECTIONS, kind_of
from ...model.names import POINT_LABEL
from ...model.points import Point
from ...model.supports.support import Clamp, Hold, Pin


class Question(NamedTuple):
    """A method of a result, what it is asked of, and whether the answer has components, with their names."""

    method: str
    nouns: tuple[str, ...]
    vector: bool = False
    letters: str = "xyz"


POINT = "point"
SUPPORT = "support"
INPUT = "input"

QUANTITIES: dict[str, Question] = {
    "position": Question("position", (POINT,), vector=True),
    "velocity": Question("velocity", (POINT,), vector=True),
    "speed": Question("velocity", (POINT,)),
    "tension": Question("tension", (POINT,)),
    "strain": Question("strain", (POINT,)),
    "curvature": Question("curvature", (POINT,)),
    "bending_moment": Question("bending_moment", (POINT,)),
    "torque": Question("torque", (POINT,)),
    "twist": Question("twist", (POINT,)),
    "spring_force": Question("spring_force", (SPRING,)),
    "spring_length": Question("spring_length", (SPRING,)),
    "torsion_angle": Question("torsion_angle", (TORSION,)),
    "torsion_moment": Question("torsion_moment", (TORSION,)),
    "contact_force": Question("contact_force", (CONTACT, SURFACE_CONTACT)),
    "contact_gap": Question("contact_gap", (CONTACT, SURFACE_CONTACT)),
    "friction_force": Question("friction_force", (SURFACE_CONTACT,)),
    "slipping": Question("slipping", (SURFACE_CONTACT,)),
    "arc_length": Question("arc_length", (SLIDE, CONTACT)),
    "arc_rate": Question("arc_rate", (SLIDE,)),
    "normal_force": Question("normal_force", (SLIDE,), vector=True),
    "sliding_friction": Question("sliding_friction", (SLIDE,)),
    "multiplier": Question("multiplier", (JOINT, SLIDE), vector=True),
    "joint_force": Question("joint_force", (JOINT, SLIDE), vector=True),
    "joint_moment": Question("joint_moment", (JOINT,), vector=True),
    "joint_angle": Question("joint_angle", (JOINT,)),
    "joint_rate": Question("joint_rate", (JOINT,)),
    "joint_angles": Question("joint_angles", (JOINT,), vector=True, letters="12"),
    "joint_rates": Question("joint_rates", (JOINT,), vector=True, letters="12"),
    "joint_displacement": Question("joint_displacement", (JOINT,)),
    "joint_velocity": Question("joint_velocity", (JOINT,)),
    "reaction": Question("reaction", (SUPPORT,), vector=True),
    "reaction_moment": Question("reaction_moment", (SUPPORT,), vector=True),
    "input": Question("input", (INPUT,)),
}
SCALARS = [name for name, question in QUANTITIES.items() if not question.vector]
#: What is asked when no quantity is given.
DEFAULTS = {
    POINT: "position",
    SPRING: "spring_force",
    TORSION: "torsion_moment",
    CONTACT: "contact_force",
    SURFACE_CONTACT: "contact_force",
    SLIDE: "arc_length",
    JOINT: "joint_force",
    SUPPORT: "reaction",
    INPUT: "input",
}


def ask(source: Any, quantity: str, item: Any) -> FloatArray:
    """History (n,) or (n, k) of a quantity of an item.

    Raises
    ------
    ModelError
        What the result itself raises, for a wrong name or point.
    """
    answer: FloatArray = np.asarray(getattr(source, QUANTITIES[quantity].method)(item))
    if quantity == "speed":
        answer = np.linalg.norm(answer, axis=-1)
    return np.where(np.isfinite(answer), answer, np.nan)


def quantity_of(source: Any, item: Any, quantity: str | None) -> str:
    """The quantity that is asked of an item: the given one if it suits, or the default.

    Raises
    ------
    ModelError
        There is no such quantity, it does not suit, or the item is nothing that can be drawn.
    """
    noun = noun_of(source, item)
    if quantity is None:
        return DEFAULTS[noun]
    checks.choice(quantity, "plot.quantity", (*QUANTITIES, "energy"))
    wanted = QUANTITIES[quantity].nouns if quantity in QUANTITIES else ()
    if noun not in wanted:
        what = f'"{quantity}" is not asked of a {noun}, which "{label(item)}" is'
        suits = [name for name, question in QUANTITIES.items() if noun in question.nouns]
        raise ModelError("plot.quantity", what, f"of a {noun} there are: {', '.join(suits)}")
    return quantity


def noun_of(source: Any, item: Any) -> str:
    """What an item is: "point", "support", "spring", "contact", "sliding joint", "joint" or "input"."""
    if isinstance(item, Point | PointMass | RigidBody | Beam):
        return POINT
    if isinstance(item, Pin | Clamp | Hold):
        return SUPPORT
    if isinstance(item, Input):
        return INPUT
    for kind in CONNECTIONS:
        if isinstance(item, kind.item):
            return kind.asked
    if not isinstance(item, str):
        what = (
            f"must be a point, support, spring, contact, joint or input, or its name, is {checks.shown(item)}"
        )
        raise ModelError("plot", what, 'such as result.plot("beam.end")')
    named = known(source)
    if item in named:
        return named[item]
    if item.strip() not in source.bodies and not POINT_LABEL.fullmatch(item.strip()):
        what = f'"{item}" is no point, support, spring, contact, joint or input here'
        names = [*source.bodies, *named]
        hint = checks.nearest(item, names) or f"there are: {checks.listed(names)}"
        hint = f'what is drawn of the others: quantity="{item}"' if item in (*QUANTITIES, "energy") else hint
        raise ModelError("plot", what, hint)
    return POINT


def known(source: Any) -> dict[str, str]:
    """Names of springs, contacts, joints, supports and inputs, with what they are."""
    asked = {*source.joints, *source.springs, *source.torsion_springs, *source._contacts()}
    found = {item.name: kind_of(item).asked for item in source.model.connections if item.name in asked}
    return found | dict.fromkeys(source.held_supports(), SUPPORT) | dict.fromkeys(source.model.inputs, INPUT)


def label(item: Any) -> str:
    """Text of an item for a legend."""
    return str(item) if isinstance(item, str | Point) else str(item.name)
