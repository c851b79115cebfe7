"""``ancf.linearise``: a linear state space about an equilibrium, for controllers and observers."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..compilation import expected
from ..errors import ModelError, SolveError
from ..model import checks
from ..model.inputs import Input
from ..model.model import Model
from ..model.names import unknown
from ..model.supports import AXES
from ..preparation import given_state
from ..results.out_of_balance import notes_of_balance
from ..results.remembered import Remembered
from ..results.state import State
from ..solvers.damped_modal import Damped
from ..solvers.linear import Linear, Moved, columns_of, forces_of, slope
from ..system.inputs import Drive
from ..system.reactions import AT_REST
from ..system.redundancy import independent
from ..system.system import System
from .linear_model import LinearModel, Reading
from .linear_outputs import Outputs, check_rates, formulas_of, unit_of

#: Motions of supports as inputs: their order and their unit.
MOTIONS = {"velocity": (1, "m/s"), "acceleration": (2, "m/s^2")}
MOTION = re.compile(r"\s*(\w+)\((.+)\)\s*\[\s*([012])\s*\]\s*")
#: Units of the amplitude of a mode and of its rate, with a modal mass of 1 kg.
OF_MODE, OF_RATE = "m kg^0.5", "m kg^0.5/s"


def linearise(
    model: Model,
    *,
    about: State | None = None,
    inputs: Sequence[Any] | None = None,
    outputs: Sequence[str] | Mapping[str, str] = (),
    modes: int | None = None,
) -> LinearModel:
    """Linear state space of a model about an equilibrium: x' = A x + B u, y = C x + D u.

    Joints are eliminated, so that the eigenvalues of A are those of :func:`damped_modes`; damping, currents
    and loads that follow the motion are in it as there. A, B, C and D are dense arrays in SI units.

    Parameters
    ----------
    model : Model
    about : State, optional
        Equilibrium, at rest; default the initial shape. A state that is no equilibrium is named in ``notes``.
    inputs : sequence of str or Input, optional
        Inputs of the model by name, default all that act on loads or are speeds of winches, and motions of
        supports beside the given ones:
        ``"acceleration(SUPPORT)[2]"`` in m/s^2 along z, whose displacement and velocity become states, or
        ``"velocity(SUPPORT)[2]"`` in m/s, whose displacement becomes one. An input that is the speed of a
        winch acts without the limit of its acceleration.
    outputs : sequence of str or mapping of str to str
        Formulas of one number each, as of a study's outputs, perhaps by names:
        ``"position(load)[0]"``, ``"tension(rope.start)"``, ``"reaction(hook)[2]"``,
        ``"acceleration(load)[0]"``.
    modes : int, optional
        Keep the lowest modes alone, see :meth:`LinearModel.reduced`.

    Returns
    -------
    LinearModel

    Raises
    ------
    ModelError
        An input or output is unknown or has no linear part, or the initial shape is no equilibrium.
    SolveError
        The state moves or rotates, something has no mass, or there are more than 1500 unknowns.
    """
    with expected(model):
        formulas = formulas_of(model, outputs)
        system = independent(model)
        q, v = given_state(system, about, "linearise.about")
        known = None if about is None else about.known
        for name, value in known.inputs.items() if known is not None else ():
            if name in system.inputs.given:
                system.inputs.give(name, value)
        time = 0.0 if about is None else about.t
        _check_rest(system, q, v)
        notes = notes_of_balance(system, q, time, known, "linearise.about")
        given = _Inputs(system, time, inputs)
        made = _damped(system, q, v, time)
        linear = Linear(made, *given.acting(made))
        given_known = Remembered(inputs=dict(system.inputs.given)) if known is None else known
        state = State(system, time, made.q, made.v, None, given_known)
        directions = linear.directions()
        texts = list(formulas.values())
        values, slopes = Outputs(state, directions).of(texts)
        count = linear.states + len(given.names)
        check_rates(
            slopes[:, count:], np.max(np.abs(directions.r[count:]), axis=1, initial=0.0), texts, given.names
        )
        names, units = _states(linear, given.moved_names)
        found = LinearModel(
            A=linear.A,
            B=linear.B,
            C=slopes[:, : linear.states],
            D=slopes[:, linear.states : count],
            inputs=tuple(given.names),
            outputs=tuple(formulas),
            states=names,
            input_units=tuple(given.units),
            output_units=tuple(map(unit_of, texts)),
            state_units=units,
            inputs_at=np.array(given.values),
            outputs_at=values,
            frequencies_hz=np.sqrt(np.maximum(linear.squares, 0.0)) / (2.0 * np.pi),
            about=state,
            notes=notes,
            reading=Reading(system, made.q, *linear.reading()),
        )
    return found if modes is None else found.reduced(modes)


def _check_rest(system: System, q: FloatArray, v: FloatArray) -> None:
    """Raise SolveError if a state moves or rotates."""
    rates = np.abs(v) * system.weights()
    if np.max(rates, initial=0.0) > AT_REST:
        worst = int(np.argmax(rates[: system.n]))
        what = f"the state moves, {system.numbering.describe(worst)} with {v[worst]:.4g} m/s"
        hint = "give ancf.equilibrium(model); of what rotates ancf.damped_modes has the modes"
        raise SolveError("linearise", what, hint)


def _damped(system: System, q: FloatArray, v: FloatArray, time: float) -> Damped:
    """Its errors are of this call."""
    try:
        return Damped(system, q, np.zeros_like(v), time)
    except SolveError as error:
        raise SolveError("linearise", error.what, error.hint) from None


def _states(linear: Linear, moved: list[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Names and units of the states."""
    modes = [f"mode {k}" for k in range(1, len(linear.squares) + 1)]
    quick = [name for name, one in zip(moved, linear.moved, strict=True) if one.order == 2]
    names = [*modes, *moved, *(f"rate of {name}" for name in (*modes, *quick))]
    units = [*[OF_MODE] * len(modes), *["m"] * len(moved), *[OF_RATE] * len(modes), *["m/s"] * len(quick)]
    return tuple(names), tuple(units)


class _Inputs:
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
        self.motions: list[tuple[int, int, int, str]] = []  # input, unknown, order, name
        self.moved_names: list[str] = []
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
            self._take_motion(motion[1], motion[2].strip("\"' "), int(motion[3]), where)
        else:
            error = unknown(where, "input", name, self.model.inputs)
            hint = error.hint or 'motions of supports are such as "acceleration(hook)[2]"'
            raise ModelError(where, error.what, hint)
        self.names.append(name)

    def _take_motion(self, word: str, support: str, c: int, where: str) -> None:
        if word not in MOTIONS:
            what = f'"{word}" is no motion that can be an input, which velocity and acceleration are'
            raise ModelError(where, what, f"a place that jumps has neither: acceleration({support})[{c}]")
        unknown_of = self._held(support, c, where)
        if any(unknown_of == one[1] for one in self.motions):
            raise ModelError(where, f'moves "{support}" along {AXES[c]}, which another input does already')
        order, unit = MOTIONS[word]
        self.motions.append((len(self.names), unknown_of, order, f"displacement of {support} {AXES[c]}"))
        self.units.append(unit)
        self.values.append(0.0)

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
        for k, unknown_of, order, name in self.motions:
            moved.append(Moved(unknown_of, order, np.eye(len(self.names))[k]))
            self.moved_names.append(name)
        for drive in self.system.inputs.drives:
            gain = np.zeros(len(self.names))
            for name, k in own.items():
                gain[k] = self._rate(drive, name) if drive in self._drives(name) else 0.0
            if np.any(gain):
                moved.append(Moved(drive.unknown, 1, gain, columns_of(made, drive.unknown)))
                self.moved_names.append(f"length of {drive.winch.name}")
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
