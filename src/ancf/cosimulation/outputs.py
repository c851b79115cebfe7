"""What a unit gives: questions to the state of a run, and names and units of their answers."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..control.stepper import Stepper
from ..model.bodies.beam import Beam
from ..model.supports.support import Clamp
from ..results.state import State

#: Questions with their units, and the names of their parts.
OF_POINT = {"position": "m", "velocity": "m/s"}
OF_LINE = {"tension": "N"}
OF_SPRING = {"spring_force": "N", "spring_length": "m"}
OF_JOINT = {"joint_force": "N"}
OF_SUPPORT = {"reaction": "N"}
#: Of joints that do not slide, and of clamps.
MOMENT_OF_JOINT, MOMENT_OF_CLAMP = {"joint_moment": "N m"}, {"reaction_moment": "N m"}
#: Questions whose parts are along x, y and z.
ALONG_AXES = (*OF_POINT, *OF_SUPPORT, *OF_JOINT, *MOMENT_OF_JOINT, *MOMENT_OF_CLAMP)
OF_TORSION = {"torsion_angle": "rad", "torsion_moment": "N m"}
OF_TURNING = {"joint_angle": "rad", "joint_rate": "rad/s"}
OF_CROSS = {"joint_angles": "rad", "joint_rates": "rad/s"}
OF_TRAVEL = {"joint_displacement": "m", "joint_velocity": "m/s"}
#: Questions whose parts have numbers.
COUNTED = (*OF_CROSS,)
OF_CONTACT = {"contact_force": "N", "contact_gap": "m"}
#: Of a strip, which has one place on a wire; of a contact that rubs.
OF_STRIP, OF_RUBBING = {"arc_length": "m"}, {"friction_force": "N", "slipping": "1"}
#: What a question is called.
WORDS = {"friction_force": "friction"}
#: What the answers are, for the description of a unit: {of} is the point or connection, {part} an axis.
SAID = {
    "position": "place of {of} along {part}",
    "velocity": "velocity of {of} along {part}",
    "tension": "axial force at {of}, positive where it pulls",
    "spring_force": 'force of the spring "{of}", positive where it pulls',
    "spring_length": 'length of the spring "{of}"',
    "joint_force": 'force along {part} that the second end of the joint "{of}" receives',
    "joint_moment": 'moment about {part} that the second end of the joint "{of}" receives',
    "reaction": 'force along {part} that the support "{of}" gives',
    "reaction_moment": 'moment about {part} that the support "{of}" gives',
    "torsion_angle": 'angle by which the torsion spring "{of}" is turned',
    "torsion_moment": 'moment of the torsion spring "{of}", positive against a growing angle',
    "joint_angle": 'angle by which the joint "{of}" has turned',
    "joint_rate": 'rate of the angle of the joint "{of}"',
    "joint_angles": 'angle {part} of the joint "{of}"',
    "joint_rates": 'rate of angle {part} of the joint "{of}"',
    "joint_displacement": 'way of the joint "{of}" along its axis',
    "joint_velocity": 'rate of the way of the joint "{of}"',
    "contact_force": 'force of the contact "{of}", never negative',
    "contact_gap": 'gap of the contact "{of}", negative while it touches',
    "arc_length": 'place of "{of}" on its carrier, by arc length',
    "friction_force": 'friction of the contact "{of}", by size',
    "slipping": 'share of the friction of the contact "{of}" that slips, 0 to 1',
}
_IDENTIFIER = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*")


@dataclass(frozen=True)
class Output:
    """One number.

    Parameters
    ----------
    name : str
        By FMI's rules for structured names.
    question, of : str
        Method of a state, and the point or connection that it is asked for.
    part : int
        Place in the answer.
    unit : str
    """

    name: str
    question: str
    of: str
    part: int
    unit: str

    @property
    def said(self) -> str:
        """What it is, in words."""
        part = str(self.part + 1) if self.question in COUNTED else "xyz"[self.part]
        return SAID[self.question].format(of=self.of, part=part)

    def value(self, state: State) -> float:
        """What it is in a state."""
        return float(np.ravel(getattr(state, self.question)(self.of))[self.part])


def outputs_of(run: Stepper) -> list[Output]:
    """Outputs for all sensors of a run."""
    return [
        output for of, question, unit in _questions(run) for output in _parts(run, str(of), question, unit)
    ]


def _questions(run: Stepper) -> Iterator[tuple[Any, str, str]]:
    listing = run.system.sensors
    clamps = {item.name for item in run.model.supports if isinstance(item, Clamp)}
    for point in listing.points:
        questions = OF_POINT | (OF_LINE if isinstance(point.body, Beam) else {})
        yield from ((point, question, unit) for question, unit in questions.items())
    for name in listing.connections:
        questions = OF_SPRING if name in run.springs else OF_TORSION if name in run.torsion_springs else {}
        questions = questions | (OF_JOINT if name in run.joints else {})
        if name in run.arcs:
            questions = questions | {"arc_length": "m"}
        elif name in run.joints:
            questions = questions | MOMENT_OF_JOINT
            questions = questions | (OF_TURNING if run.has_angle(name) else {})
            questions = questions | (OF_CROSS if run.has_angles(name) else {})
            questions = questions | (OF_TRAVEL if run.has_travel(name) else {})
        if name in listing.columns:
            questions = questions | OF_CONTACT | (OF_RUBBING if run.sensors.rubs(name) else OF_STRIP)
        questions = questions | (OF_SUPPORT if name in listing.held else {})
        questions = questions | (MOMENT_OF_CLAMP if name in clamps else {})
        yield from ((name, question, unit) for question, unit in questions.items())


def _parts(run: Stepper, of: str, question: str, unit: str) -> Iterator[Output]:
    count = np.size(getattr(run, question)(of))
    word = (
        WORDS.get(question, question)
        .removeprefix("spring_")
        .removeprefix("contact_")
        .removeprefix("torsion_")
    )
    for k in range(count):
        part = f".{'xyz'[k]}" if question in ALONG_AXES else (f"[{k + 1}]" if question in COUNTED else "")
        yield Output(f"{structured(of)}.{word}{part}", question, of, k, unit)


def structured(name: str) -> str:
    """A name as FMI has it: quoted unless it is made of identifiers and dots."""
    if _IDENTIFIER.fullmatch(name):
        return name
    escaped = name.replace("\\", "\\\\").replace("'", "\\'")
    return f"'{escaped}'"
