"""Equilibria and simulations with their sensitivities."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..model.joints.connections import Spring
from ..model.settings import steps_between
from ..preparation import Prepared, carried_out
from ..results.result import Result
from ..results.state import State
from ..solvers.record import Progress
from ..solvers.statics.equilibrium import Leaned
from ..system.system import System
from .answers import Face, Sensitivity
from .base import check_differentiable
from .family import Family
from .follow import Following
from .leaning import Leaning
from .memory import Memory
from .parameters import Parameter
from .samples import SensorSensitivity
from .statics import of_equilibrium


def of_state(
    state: State, leaned: Leaned, names: list[str] | None, parameters: list[Parameter]
) -> dict[str, Sensitivity]:
    """Sensitivities of an equilibrium of some bodies, or of all; ``leaned``: what friction did in it.

    Raises
    ------
    ModelError
        The model has none, or a parameter changes which unknowns there are.
    SolveError
        The equilibrium is neutral.
    """
    system = state.system
    check_differentiable(system, "equilibrium.sensitivities", follows=True)
    slack = [item.name for item in system.model.connections if isinstance(item, Spring) and item.slack]

    def branches(beside: System) -> tuple[bool, ...]:
        face = Face(beside, state.q, state.v, state.t, beside=True)
        return tuple(bool(face.spring_length(name) > face.springs[name].length) for name in slack)

    families = [Family(parameter, system, branches=branches) for parameter in parameters]
    others = [] if names is None else [name for name in system.model.bodies if name not in names]
    core = system.holding(others) if others else system.core
    memory = Memory(system, families)
    friction = Leaning(memory, core, state.q, leaned) if memory else None
    found = of_equilibrium(system, core, state.q, state.t, families, friction)
    made = {
        family.name: Sensitivity(family, state.t, state.q, state.v, dq, dv)
        for family, (dq, dv) in zip(families, found, strict=True)
    }
    for one in made.values():
        one.rests = state.rests
    memory.hand_to(list(made.values()))
    if memory:
        memory.rest(list(made.values()))
    return made


def with_sensitivities(
    made: Prepared,
    parameters: list[Parameter],
    start: State | None,
    store: Any,
    output_step: float | None,
    progress: Callable[[Progress], None] | None,
) -> Result:
    """Carry out a simulation, which stores every step, with sensitivities at the times of the outputs.

    Raises
    ------
    ModelError
        The model or the method has none, or the start does not know its own.
    SolveError
        As of :func:`ancf.simulate`, or the derivative jumps.
    """
    run: Any = made.run
    every = steps_between("simulate", run.t_end, run.h, output_step, run.t_start)
    following = Following(made, parameters, start, store, every)
    result = carried_out(made, store, progress, following)
    t, q, v = np.array(result.t), result.q[:], result.v[:]
    result.derivatives = {
        family.name: Sensitivity(family, t, q, v, *own)
        for family, own in zip(following.families, following.found(), strict=True)
    }
    if following.abreast:
        following.abreast.end()
    following.memory.hand_to(list(result.derivatives.values()))
    if following.samples.sampling.width:
        sensors = result.sensors
        sensors.derivatives = {
            family.name: SensorSensitivity(family, sensors, rows)
            for family, rows in zip(following.families, following.samples.rows, strict=True)
        }
    return result
