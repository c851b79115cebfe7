"""``ancf.linearise``: a linear state space about an equilibrium, for controllers and observers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..compilation import expected
from ..errors import SolveError
from ..model.model import Model
from ..preparation import given_state
from ..results.out_of_balance import notes_of_balance
from ..results.remembered import Remembered, begin_small
from ..results.state import State
from ..solvers.modes.damped_modal import Damped
from ..solvers.modes.linear import Linear
from ..system.reactions import AT_REST
from ..system.redundancy import independent
from ..system.system import System
from .linear_inputs import Inputs
from .linear_model import LinearModel, Reading
from .linear_outputs import Outputs, check_rates, formulas_of, unit_of

#: Unit of the amplitude of a mode, with a modal mass of 1 kg.
OF_MODE = "m kg^0.5"


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
        Inputs of the model by name, default all that act on loads or are speeds of winches, and motions
        beside the given ones: ``"acceleration(SUPPORT)[2]"`` in m/s^2 along z, whose displacement and
        velocity become states, or ``"velocity(SUPPORT)[2]"`` in m/s, whose displacement becomes one;
        ``"angular_acceleration(CLAMP)[2]"`` and ``"angular_velocity(CLAMP)[2]"`` about z in rad/s^2 and
        rad/s; ``"acceleration(JOINT)"`` and ``"velocity(JOINT)"`` of a sliding joint with a given motion,
        along its carrier. An input that is the speed of a winch acts without the limit of its acceleration.
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
        begin_small(system, q, known)
        given = Inputs(system, time, inputs)
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
        names, units = _states(linear, given.moved)
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


def _states(linear: Linear, moved: list[tuple[str, str]]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Names and units of the states."""
    modes = [(f"mode {k}", OF_MODE) for k in range(1, len(linear.squares) + 1)]
    quick = [named for named, one in zip(moved, linear.moved, strict=True) if one.order == 2]
    rates = [(f"rate of {name}", f"{unit}/s") for name, unit in (*modes, *quick)]
    names, units = zip(*modes, *moved, *rates, strict=True)
    return names, units
