"""What one does with a model: equilibrium, simulation, modes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from .arrays import FloatArray
from .compilation import expected
from .control.lead import check_controller, led
from .control.live import Live
from .errors import ModelError, SolveError, StorageError
from .model import checks
from .model.bodies.beam import Beam
from .model.bodies.rigid import PointMass, RigidBody
from .model.doubts import doubts
from .model.integrators import Explicit, Integrator
from .model.model import Model
from .preparation import carried_out, given_state, method_of, prepared
from .results import free_turns, remembered
from .results import result as results
from .results.accuracy import of_locked_modes
from .results.modes import DampedModes, Modes
from .results.out_of_balance import explain_unstable, notes_of_balance, of_bends, of_loads, of_motion
from .results.result import Result
from .results.room import check_room
from .results.state import State
from .solvers.explicit.stability import stable_limit
from .solvers.modes.damped_modal import damped_modes_about
from .solvers.modes.modal import natural_modes
from .solvers.record import Progress
from .solvers.statics import equilibrium as statics
from .system.left_out import come_apart
from .system.redundancy import independent
from .system.system import System

__all__ = ["damped_modes", "equilibrium", "load", "modes", "simulate", "stable_step"]

#: Share of its natural length above which a cable at its start is not called pressed.
PRESSED = 0.999
#: Places of what is wrong with sensitivities.
SENSITIVITIES = "equilibrium.sensitivities", "simulate.sensitivities", "modes.sensitivities"


def equilibrium(
    model: Model,
    of: Sequence[Beam | str] | None = None,
    load_steps: int = 1,
    time: float = 0.0,
    sensitivities: Any = (),
) -> State:
    """Stable static equilibrium of a model.

    Parameters
    ----------
    model : Model
    of : sequence of bodies or names, optional
        Only these bodies find their equilibrium, the others stay in their initial shape.
    load_steps : int
        Steps in which the loads grow; a step that fails is halved.
    time : float
        Time at which loads and supports are taken, s.
    sensitivities : sequence of str or mapping
        Numbers of the model by which derivatives are wanted, see :func:`simulate`.

    Returns
    -------
    State
        Its velocities are those of ``set_motion`` at the deformed shape, zero by default.

    Raises
    ------
    ModelError
        A body is not supported, or a name is unknown.
    SolveError
        No equilibrium was found.
    """
    checks.integer(load_steps, "equilibrium.load_steps", 1, 100_000)
    time = checks.number(time, "equilibrium.time")
    names = None if of is None else _names(model, of)
    with expected(model):
        state, leaned = _at_rest(independent(model), names, load_steps, time)
    if checks.numbers_named(sensitivities, SENSITIVITIES[0]):
        from .sensitivity.compute import of_state

        state.derivatives = of_state(
            state, leaned, names, _parameters(model, sensitivities, SENSITIVITIES[0])
        )
    return state


def _parameters(model: Model, sensitivities: Any, where: str) -> list[Any]:
    """Numbers of a model by which derivatives are wanted; what computes them is loaded when there are any."""
    if not (sensitivities := checks.numbers_named(sensitivities, where)):
        return []
    from .sensitivity.parameters import parameters_of

    return parameters_of(model, sensitivities, where)


def equilibria(model: Model, times: Iterable[float]) -> list[State]:
    """The equilibria at several times, each as :func:`equilibrium` finds it; the model is compiled once."""
    with expected(model):
        system = independent(model)
        return [_at_rest(system, None, 1, time)[0] for time in times]


def _at_rest(
    system: System, names: list[str] | None, load_steps: int, time: float
) -> tuple[State, statics.Leaned]:
    q, stats, leaned = statics.equilibrium(system, names, load_steps, time)
    if (problem := come_apart(system, q, f"equilibrium at t = {time:.6g} s")) is not None:
        raise problem
    known = remembered.Remembered(memory=system.kept_memory(), balanced=True, laid=leaned.laid)
    return State(system, float(time), q, system.motion(q, time), stats, known), leaned


def simulate(
    model: Model,
    *,
    t_end: float,
    step: float,
    start: State | None = None,
    integrator: Integrator | None = None,
    output_step: float | None = None,
    sensors: Sequence[Any] | None = None,
    energy: bool = True,
    file: str | Path | None = None,
    progress: Callable[[Progress], None] | None = None,
    controller: Callable[[Live], Any] | None = None,
    control_step: float | None = None,
    sensitivities: Any = (),
) -> Result:
    """Simulate a model from its start to ``t_end``.

    Parameters
    ----------
    model : Model
    t_end, step : float
        End time and time step, s; the last step is shorter if they do not fit.
    start : State, optional
        Where to start, from :func:`equilibrium` or :meth:`Result.state`; default the initial shape and
        motion of the model at t = 0.
    integrator : Trapezoidal, GeneralizedAlpha, Radau or Explicit, optional
        Default the trapezoidal rule.
    output_step : float, optional
        Time between stored states, s, a multiple of ``step``; default every step.
    sensors : sequence, optional
        Points, springs and joints, as objects or by name, that are recorded at every step, which
        :attr:`Result.sensors` answers for; :class:`ancf.Radau` chooses its own steps and interpolates.
    energy : bool
        Account for the energies dissipated and supplied. Without it a step takes up to two evaluations
        of all forces less, :attr:`Result.energy` is not to be had, and a run that creates energy from
        nothing is not noticed.
    file : path, optional
        HDF5 file that takes the states while they are computed, and their derivatives by numbers of the
        model; default in memory.
    progress : callable, optional
        Called between blocks of steps with a :class:`ancf.results.Progress`.
    controller : callable, optional
        Called at the start and then every ``control_step`` with the run as it is, which answers as a
        :class:`State` and has ``inputs``: ``run.inputs["thrust"] = 5.0`` holds from the next step on.
    control_step : float, optional
        In s, a multiple of ``step``; default every step.
    sensitivities : sequence of str or mapping
        Numbers of the model by which derivatives are wanted, :meth:`Result.sensitivity` answers for them:
        names such as ``"beam.EI"``, ``"beam.length"``, ``"dropper 3.length"``, ``"tip load.force[2]"``,
        ``"gravity"`` (all of it, by a factor); or by a name of one's own a pair ``(value, build)`` where
        ``build(value)`` is the model with another value. They are the derivatives of the numbers that the
        run gives. Methods of the Newmark family; a start has to know its own.

    Returns
    -------
    Result

    Raises
    ------
    ModelError
        A wrong number, a file that cannot be written, or a controller that raised.
    SolveError
        A step failed; ``error.result`` holds what was computed until then.
    StorageError
        A SolveError: the file can no longer be written; ``error.result`` holds what had been stored.
    Interrupted
        Ctrl-C; ``interrupt.result`` holds what was computed until then.
    """
    if start is not None and not isinstance(start, State):
        raise ModelError(
            "simulate.start",
            f"must be a State, is {checks.shown(start)}",
            "such as start=ancf.equilibrium(model)",
        )
    checks.progress(progress, "simulate.progress")
    parameters = _parameters(model, sensitivities, SENSITIVITIES[1])
    made = prepared(
        model,
        method=method_of(integrator),
        t_end=t_end,
        step=step,
        start=start,
        output_step=None if parameters else output_step,
        sensors=sensors,
        energy=energy,
        ends=bool(parameters),
    )
    if parameters and controller is not None:
        raise ModelError(SENSITIVITIES[1], "a controller has no derivatives", "give one of both")
    if controller is not None:
        made = led(made, controller, check_controller(controller, control_step, step, "simulate"), "simulate")
    elif control_step is not None:
        raise ModelError("simulate.control_step", "has no effect without a controller")
    if parameters:
        if output_step is not None:
            made.header["settings"]["output_step"] = output_step
        made.header["settings"]["sensitivities"] = [one.name for one in parameters if one.named]
    if file is None:
        check_room(made.system, made.header["settings"])
    store = made.store(file)
    try:
        if parameters:
            from .sensitivity.compute import with_sensitivities

            return with_sensitivities(made, parameters, start, store, output_step, progress)
        return carried_out(made, store, progress)
    except SolveError as error:
        if start is None and not isinstance(error, StorageError):
            _advise_rest(error, model)
        raise


def load(path: str | Path, system: System | None = None) -> Result:
    """Result from a file that a simulation or :meth:`Result.save` wrote.

    It answers what the result in memory answered, sensitivities by numbers of the model included, and has its
    model; a question that needs the value of a Python function, which no file can keep, is a ModelError.

    Parameters
    ----------
    path : path
    system : System, optional
        The system that made it, if it is still there; else the file's model makes one when it is needed.

    Raises
    ------
    ModelError
        There is no such file, or it is not a results file.
    """
    from .sensitivity.kept import with_kept

    return with_kept(results.load(path, system))


def _advise_rest(error: SolveError, model: Model) -> None:
    """A cable that starts pressed together shoots off; its equilibrium is where it should start."""
    pressed = min(model.beams.values(), key=lambda beam: beam.stretch, default=None)
    if pressed is None or pressed.stretch > PRESSED:
        return
    begins = f'"{pressed.name}" begins pressed to {100 * pressed.stretch:.3g} % of its length'
    files = 'start = "equilibrium" in a model file'
    error.advise(f'{begins}: start=ancf.equilibrium(model, of=["{pressed.name}"]), or {files}')


def modes(model: Model, *, about: State | None = None, count: int = 10, sensitivities: Any = ()) -> Modes:
    """Lowest natural modes of a model about a state, without damping.

    Velocities are left out: of a model that rotates they are the modes at standstill, with the gyroscopic and
    centrifugal forces :func:`damped_modes` has them.

    Parameters
    ----------
    model : Model
    about : State, optional
        Equilibrium about which the model vibrates; default its initial shape. A state that is no equilibrium,
        or rotates, is named in ``notes``.
    count : int
        Number of modes.
    sensitivities : sequence of str or mapping
        Numbers of the model by which derivatives are wanted, see :func:`simulate`; `about` has to know its
        own.

    Raises
    ------
    ModelError
        More modes are wanted than there are free unknowns, or the initial shape is no equilibrium.
    SolveError
        The state is not a stable equilibrium.
    """
    known = about.derivatives if isinstance(about, State) else {}
    parameters = _parameters(model, sensitivities, SENSITIVITIES[2])
    if parameters and isinstance(about, State):
        from .sensitivity.parameters import check_known

        check_known(about, parameters, SENSITIVITIES[2])
    with expected(model):
        system = independent(model)
        q, v = given_state(system, about, "modes.about")
        joined = len(np.intersect1d(system.free, system.multipliers))
        checks.integer(count, "modes.count", 1, len(system.free) - 2 * joined)
        notes = _looked_at(system, q, about, "modes.about") + of_motion(system, q, v) + doubts(system.model)
        given = about is not None
        remembered.begin_small(system, q, None if about is None else about.known)
        about = State(system, 0.0, q, np.zeros_like(v)) if about is None else State(system, about.t, q, v)
        about.derivatives = known
        try:
            omega, shapes = natural_modes(about.system, about.q, count)
        except SolveError as error:
            if given and not notes:
                explain_unstable(error)
            raise
    notes += of_bends(system.model, omega) + free_turns.notes(about, omega, shapes)
    notes += of_locked_modes(about, omega, shapes) + of_loads(system, about.q, omega, shapes)
    made = Modes(omega, shapes, about, notes=notes)
    if not parameters:
        return made
    from .sensitivity.modal import of_modes

    return replace(made, derivatives=of_modes(made, parameters))


def damped_modes(model: Model, *, about: State | None = None, count: int = 10) -> DampedModes:
    """Lowest modes of a model with its damping, about an equilibrium or a steady rotation.

    A model rotates steadily if its velocities say so: those of ``set_motion(angular_velocity=...)``, or of a
    clamp that turns. The shape that centrifugal forces give it is found first. With the rotation come
    gyroscopic and centrifugal forces, so that modes whirl. Loads that follow the motion have all of their
    stiffness, so that what flutters has an eigenvalue with a positive real part.

    Parameters
    ----------
    model : Model
    about : State, optional
        An equilibrium or a state that rotates; default the initial shape and motion. One that is neither is
        named in ``notes``.
    count : int
        Number of modes.

    Raises
    ------
    ModelError
        More modes are wanted than there are free unknowns, or the initial shape is no equilibrium and does
        not rotate.
    SolveError
        The state moves otherwise than in a steady rotation; what stands still does not act alike from all
        sides of its axis; or there are more than 1500 unknowns.
    """
    with expected(model):
        system = independent(model)
        q, v = given_state(system, about, "damped_modes.about")
        time, known = (0.0, None) if about is None else (about.t, about.known)
        checks.integer(count, "damped_modes.count", 1, len(system.free) - 2 * len(system.multipliers))
        remembered.begin_small(system, q, known)
        values, shapes, whirl, spin, q = damped_modes_about(system, q, v, time, count)
        notes = [] if np.any(spin) else _looked_at(system, q, about, "damped_modes.about")
        return DampedModes(values, shapes, whirl, spin, State(system, time, q, v), notes)


def _looked_at(system: System, q: FloatArray, about: State | None, where: str) -> list[str]:
    """Whether a state is an equilibrium, see :func:`ancf.results.out_of_balance.notes_of_balance`."""
    if about is None:
        return notes_of_balance(system, q, 0.0, None, where)
    return notes_of_balance(system, q, about.t, about.known, where)


def stable_step(model: Model, *, about: State | None = None, safety: float = 0.9) -> float:
    """Largest step of an :class:`ancf.Explicit` run for small vibrations about a state, s.

    Parameters
    ----------
    model : Model
    about : State, optional
        Default the initial shape of the model at t = 0.
    safety : float
        Part of the limit of stability that is returned, above 0 and at most 1.

    Raises
    ------
    SolveError
        The mass matrix is singular.
    """
    method, system = Explicit(safety=safety), independent(checks.kind(model, "stable_step.model", Model))
    q, v = given_state(system, about, "stable_step.about")
    return method.safety * stable_limit(system, q, v)


def _names(model: Model, of: Any) -> list[str]:
    """Names of the bodies that ``of`` lists."""
    if isinstance(of, str | Beam | PointMass | RigidBody) or not isinstance(of, Sequence):
        raise ModelError("equilibrium.of", f"must be a list of bodies, is {checks.shown(of)}")
    found = []
    for k, item in enumerate(of):
        if isinstance(item, Beam | PointMass | RigidBody) and model.bodies.get(item.name) is not item:
            raise ModelError(f"equilibrium.of[{k}]", f'body "{item.name}" belongs to another model')
        if not isinstance(item, str | Beam | PointMass | RigidBody):
            raise ModelError(f"equilibrium.of[{k}]", f"must be a body or its name, is {checks.shown(item)}")
        found.append(model.body(item if isinstance(item, str) else item.name).name)
    return found
