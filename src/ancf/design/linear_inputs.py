"""Inputs of a linear model as they are asked for: loads and winches, supports and slides that move, turns."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..model import checks
from ..model.functions.inputs import Input
from ..model.names import unknown
from ..model.supports.support import AXES, Clamp
from ..solvers.modes.damped_modal import Damped
from ..solvers.modes.linear_moved import Moved, columns_of, forces_of, moved_alone, slope, turned
from ..system.inputs import Drive
from ..system.nodes import node_of
from ..system.reactions import AT_REST
from ..system.system import System

#: Motions as inputs: their order and their unit; of supports and slides, and of clamps that turn.
SHIFTS = {"velocity": (1, "m/s"), "acceleration": (2, "m/s^2")}
TURNS = {"angular_velocity": (1, "rad/s"), "angular_acceleration": (2, "rad/s^2")}
MOTION = re.compile(r"\s*(\w+)\((.+)\)\s*(?:\[\s*([012])\s*\]\s*)?")
#: Share of a vector by which a turn moves it, below which it is one about the vector itself.
ALONG = 1e-9
DOCS = "ancf docs linearise"

Makes = Callable[[Damped, FloatArray], Moved]


class Inputs:
    """Inputs as they were given: names, units and values in the equilibrium, and what they act on.

    Raises
    ------
    ModelError
        One is unknown, acts on nothing, or is what no linear model has.
    """

    def __init__(self, system: System, time: float, given: Any) -> None:
        self.system, self.time, self.model = system, time, system.model
        if given is None:
            given = [name for name in self.model.inputs if self._pushes(name) or self._drives(name)]
        if isinstance(given, str | Input) or not isinstance(given, Sequence):
            what = f"must be a list of inputs, is {checks.shown(given)}"
            raise ModelError("linearise.inputs", what, 'such as inputs=["thrust"]')
        self.names: list[str] = []
        self.units: list[str] = []
        self.values: list[float] = []
        self.motions: list[tuple[int, Makes]] = []  # input, what it moves
        self.moved: list[tuple[str, str]] = []  # name and unit
        self._keys: list[Any] = []
        for k, item in enumerate(given):
            self._take(item, f"linearise.inputs[{k}]")

    def _take(self, item: Any, where: str) -> None:
        name = item.name if isinstance(item, Input) else item
        if not isinstance(name, str):
            what = f"must be the name of an input or a motion of a support, is {checks.shown(item)}"
            raise ModelError(where, what, 'such as "thrust" or "acceleration(hook)[2]"')
        if name in self.names:
            raise ModelError(where, f'"{name}" is an input already')
        motion = MOTION.fullmatch(name)
        if name in self.model.inputs:
            self._check_acts(name, where)
            self.units.append(self.model.inputs[name].unit)
            self.values.append(self.system.inputs.given[name])
        elif motion is not None:
            self._take_motion(motion[1], motion[2].strip("\"' "), motion[3], where)
        else:
            error = unknown(where, "input", name, self.model.inputs)
            hint = error.hint or 'motions of supports are such as "acceleration(hook)[2]"'
            raise ModelError(where, error.what, hint)
        self.names.append(name)

    def _take_motion(self, word: str, item: str, part: str | None, where: str) -> None:
        """A motion of a support or a slide: what it moves is made when the matrices are there."""
        order, unit = (SHIFTS | TURNS).get(word, (0, ""))
        if not order:
            what = f'"{word}" is no motion that can be an input: {checks.listed((*SHIFTS, *TURNS))} are'
            raise ModelError(where, what, f"a place or an angle that jumps has neither rate, see {DOCS}")
        if item in self._driven_slides():
            key, makes = self._slid(word, item, part, where)
            does, named = f'moves "{item}"', (f"place of {item}", "m")
        elif part is None:
            what = f'"{word}({item})" has three components'
            raise ModelError(where, what, f"give one, such as {word}({item})[2]")
        elif word in TURNS:
            key, makes = self._turned(item, int(part), order, where)
            does, named = (
                f'turns "{item}" about {AXES[int(part)]}',
                (f"turn of {item} {AXES[int(part)]}", "rad"),
            )
        else:
            key = self._held(item, int(part), where)
            makes = _alone(key, order)
            does = f'moves "{item}" along {AXES[int(part)]}'
            named = f"displacement of {item} {AXES[int(part)]}", "m"
        if key in self._keys:
            raise ModelError(where, f"{does}, which another input does already")
        self._keys.append(key)
        self.moved.append(named)
        self.motions.append((len(self.names), makes))
        self.units.append(unit)
        self.values.append(0.0)

    def _driven_slides(self) -> list[str]:
        """Sliding joints whose motion is given."""
        return [item.name for item in self.model.connections if getattr(item, "motion", None) is not None]

    def _slid(self, word: str, joint: str, part: str | None, where: str) -> tuple[int, Makes]:
        """A slide that is led along its carrier."""
        if part is not None or word in TURNS:
            raise ModelError(
                where,
                f'"{joint}" is led along its carrier',
                f"write {word.removeprefix('angular_')}({joint})",
            )
        arc = self.system.numbering.arcs[joint]
        return arc, _alone(arc, SHIFTS[word][0])

    def _turned(self, name: str, c: int, order: int, where: str) -> tuple[Any, Makes]:
        """The vectors that a clamp holds, turned about a global axis."""
        clamps = {item.name: item for item in self.model.supports if isinstance(item, Clamp)}
        if name not in clamps:
            raise unknown(where, "clamp", name, clamps)
        body = clamps[name].point.body
        numbering = self.system.numbering
        node = node_of(body, clamps[name].point.x)
        slots = numbering.slots[body.name][node, 1 : numbering.shared[body.name]]
        axis = np.eye(3)[c]

        def makes(made: Damped, gain: FloatArray) -> Moved:
            found = turned(made, slots, axis, order, gain)
            if np.max(np.abs(found.along)) <= ALONG * np.max(np.abs(made.q[slots])):
                what = f'turns "{body.name}" about its own line, which a cable does not feel'
                raise ModelError(where, what, 'element="nonlocking" and "original" have a twist')
            return found

        return (int(slots[0]), c), makes

    def _check_acts(self, name: str, where: str) -> None:
        """Raise ModelError if an input of the model does nothing, or what is not linear."""
        inputs = self.system.inputs
        to = next((d.winch for d in inputs.drives if name in d.winch.length.inputs), None)
        if to is not None:
            what = f'"{name}" is the length to which "{to.name}" goes as fast as it can, which is not linear'
            raise ModelError(where, what, "let an input be its speed=")
        for drive in self._drives(name):
            rate = self._speed(drive, inputs.given)
            if abs(rate) > AT_REST * self.model.size:
                what = f'"{drive.winch.name}" goes with {rate:.4g} m/s, about which nothing is at rest'
                raise ModelError(where, what, "give the input the value at which it stands")
        if not self._pushes(name) and not self._drives(name):
            raise ModelError(
                where, f'"{name}" acts on nothing in this model', "let a load or a winch depend on it"
            )

    def _pushes(self, name: str) -> bool:
        """Whether loads depend on an input."""
        inputs = self.system.inputs
        return any(name in inputs.loads[k].inputs for k in inputs.led)

    def _drives(self, name: str) -> list[Drive]:
        """Winches whose speed an input gives."""
        drives = self.system.inputs.drives
        return [d for d in drives if d.winch.speed is not None and name in d.winch.speed.inputs]

    def _held(self, support: str, c: int, where: str) -> int:
        """Unknown of a component of a position that a support holds."""
        positions = self.system.constraints.positions
        if support not in positions:
            raise unknown(where, "support", support, positions)
        found = [i for i in positions[support] if i % 3 == c]
        if not found:
            what = f'"{support}" does not hold {AXES[c]}, or another support of the same node does'
            raise ModelError(where, what, "name the support that holds it")
        return found[0]

    def acting(self, made: Damped) -> tuple[FloatArray, list[Moved]]:
        """Forces of the inputs on all unknowns, (n, inputs), and what they move."""
        forces, moved = np.zeros((self.system.n, len(self.names))), []
        own = {name: k for k, name in enumerate(self.names) if name in self.model.inputs}
        for name, k in own.items():
            if self._pushes(name):
                forces[:, k] = forces_of(made, name)
        for k, makes in self.motions:
            moved.append(makes(made, np.eye(len(self.names))[k]))
        for drive in self.system.inputs.drives:
            gain = np.zeros(len(self.names))
            for name, k in own.items():
                gain[k] = self._rate(drive, name) if drive in self._drives(name) else 0.0
            if np.any(gain):
                moved.append(moved_alone(made, drive.unknown, 1, gain, columns_of(made, drive.unknown)))
                self.moved.append((f"length of {drive.winch.name}", "m"))
        return forces, moved

    def _speed(self, drive: Drive, given: Mapping[str, float]) -> float:
        """Speed of a winch under inputs, m/s."""
        assert drive.winch.speed is not None
        return float(drive.winch.speed.under(given, np.array([self.time]))[0, 0])

    def _rate(self, drive: Drive, name: str) -> float:
        """The same per unit of an input."""
        given = self.system.inputs.given

        def changed(by: float) -> FloatArray:
            return np.array([self._speed(drive, given | {name: given[name] + by})])

        return float(slope(changed, max(abs(given[name]), 1.0))[0])


def _alone(unknown_of: int, order: int) -> Makes:
    """One held unknown that moves."""
    return lambda made, gain: moved_alone(made, unknown_of, order, gain)
