"""The three things one does with a model: equilibrium, simulation, modes."""

from __future__ import annotations

import signal
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .errors import Interrupted, ModelError, SolveError, StorageError
from .interrupts import heed, kept
from .model import checks
from .model.beam import Beam
from .model.bodies import PointMass, RigidBody
from .model.integrators import INTEGRATORS, Explicit, Integrator, Trapezoidal
from .model.model import Model
from .model.settings import steps_between
from .results import remembered
from .results.modes import Modes
from .results.provenance import versions
from .results.read_store import ReadStore
from .results.result import Result, load, read
from .results.state import State
from .results.store import FileStore, MemoryStore
from .solvers import statics
from .solvers.modal import natural_modes
from .solvers.record import Progress
from .solvers.runs import AnyRun, run_of
from .solvers.stability import stable_limit
from .system.consistency import check_gaps, check_independent
from .system.sensors import Listing, listing
from .system.system import System

__all__ = ["equilibrium", "load", "modes", "simulate", "stable_step"]

#: Share of its natural length above which a cable at its start is not called pressed.
PRESSED = 0.999


def equilibrium(
    model: Model, of: Sequence[Beam | str] | None = None, load_steps: int = 1, time: float = 0.0
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
    system = _system(model)
    q, stats = statics.equilibrium(system, names, load_steps, time)
    known = remembered.Remembered(memory=remembered.memory_of(system))
    return State(system, float(time), q, system.motion(q, time), stats, known)


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
        HDF5 file that takes the states while they are computed; default in memory.
    progress : callable, optional
        Called between blocks of steps with a :class:`ancf.results.Progress`.

    Returns
    -------
    Result

    Raises
    ------
    ModelError
        A wrong number, or a file that cannot be written.
    SolveError
        A step failed; ``error.result`` holds what was computed until then.
    StorageError
        A SolveError: the file can no longer be written; ``error.result`` holds what had been stored.
    Interrupted
        Ctrl-C; ``interrupt.result`` holds what was computed until then.
    """
    if start is not None and not isinstance(start, State):
        raise ModelError(
            "simulate.start", f"must be a State, is {checks.shown(start)}", "see ancf.equilibrium"
        )
    made = prepared(
        model,
        method=_integrator(integrator),
        t_end=t_end,
        step=step,
        start=start,
        output_step=output_step,
        sensors=sensors,
        energy=energy,
    )
    store = MemoryStore(made.system) if file is None else FileStore(file, made.system, made.header)
    try:
        return carried_out(made, store, progress)
    except SolveError as error:
        if start is None and not isinstance(error, StorageError):
            _advise_rest(error, model)
        raise


class Prepared(NamedTuple):
    """A simulation that has not taken a step yet."""

    system: System
    run: AnyRun
    header: dict[str, Any]


def prepared(
    model: Model,
    *,
    method: Integrator,
    t_end: float,
    step: float,
    start: State | None,
    output_step: float | None,
    sensors: Sequence[Any] | None,
    energy: bool,
    where: str = "simulate",
) -> Prepared:
    """A simulation at its start, see :func:`simulate`; ``where`` stands in messages.

    Raises
    ------
    ModelError, SolveError
        Something given is wrong, or there are no accelerations at the start.
    """
    t0 = 0.0 if start is None else start.t
    every = steps_between(where, t_end, step, output_step, t0)
    system = _system(model)  # anew: the model may have changed since the start was computed
    q, v = system.initial_state(t0) if start is None else _adopted(start, system, f"{where}.start")
    remembered.begin(system, q, v, None if start is None else start.known)
    check_gaps(system, q, f"{where}.start")
    system.sensors = _sensors(system, sensors)
    if not checks.flag(energy, f"{where}.energy"):
        system.skip_energies()
    header = _header(system, method, t0, t_end, step, output_step)
    run = run_of(method, system, t0, t_end, step, every)
    run.start(q, v)
    return Prepared(system, run, header)


def carried_out(made: Prepared, store: Any, progress: Callable[[Progress], None] | None) -> Result:
    """Take all steps and give the result, also with the errors; see :func:`simulate`.

    Parameters
    ----------
    made : Prepared
    store : MemoryStore, FileStore or another Recorder with ``path`` and ``close``
    progress : callable or None

    Raises
    ------
    SolveError, StorageError, ModelError, Interrupted
        With what was computed until then.
    """
    system, run, header = made

    def finished(status: str) -> Result:
        store.update(run.stats, status)
        if isinstance(store, MemoryStore):
            return Result(store, header, system)
        store.close()
        return load(store.path, system)

    def look(now: Progress) -> None:
        heed()
        if progress is not None:
            progress(now)

    with _salvaged(system), kept(signal.SIGINT):
        try:
            run.go(store, look)
        except StorageError:
            raise
        except (SolveError, ModelError) as error:
            error.result = finished("failed")
            raise
        except KeyboardInterrupt as stop:
            raise Interrupted(finished("interrupted")) from stop
        if run.caution:
            warnings.warn(run.caution, UserWarning, stacklevel=3)
        return finished("complete")


@contextmanager
def _salvaged(system: System) -> Iterator[None]:
    """What a file holds that can no longer be written goes with the error."""
    try:
        yield
    except StorageError as error:
        with suppress(ModelError):  # nothing may have reached the disk
            error.result = read(ReadStore(error.where, "failed"), system)
        raise


def _integrator(given: Integrator | None) -> Integrator:
    if given is None:
        return Trapezoidal()
    if not isinstance(given, tuple(INTEGRATORS.values())):
        known = "one of " + ", ".join(f"ancf.{kind.__name__}()" for kind in INTEGRATORS.values())
        raise ModelError("simulate.integrator", f"must be {known}, is {checks.shown(given)}")
    return given


def _advise_rest(error: SolveError, model: Model) -> None:
    """A cable that starts pressed together shoots off; its equilibrium is where it should start."""
    pressed = min(model.beams.values(), key=lambda beam: beam.stretch, default=None)
    if pressed is None or pressed.stretch > PRESSED:
        return
    begins = f'"{pressed.name}" begins pressed to {100 * pressed.stretch:.3g} % of its length'
    files = 'start = "equilibrium" in a model file'
    error.advise(f'{begins}: start=ancf.equilibrium(model, of=["{pressed.name}"]), or {files}')


def modes(model: Model, *, about: State | None = None, count: int = 10) -> Modes:
    """Lowest natural modes of a model about a state, without damping.

    Parameters
    ----------
    model : Model
    about : State, optional
        Equilibrium about which the model vibrates; default its initial shape.
    count : int
        Number of modes.

    Raises
    ------
    ModelError
        More modes are wanted than there are free unknowns.
    SolveError
        The state is not a stable equilibrium.
    """
    system = _system(model)
    q, v = _given_state(system, about, "modes.about")
    about = State(system, 0.0, q, np.zeros_like(v)) if about is None else State(system, about.t, q, v)
    omega, shapes = natural_modes(about.system, about.q, count)
    return Modes(omega, shapes, about)


def _system(model: Model) -> System:
    system = System(model)
    check_independent(system)
    return system


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
    method, system = Explicit(safety=safety), _system(model)
    q, v = _given_state(system, about, "stable_step.about")
    return method.safety * stable_limit(system, q, v)


def _given_state(system: System, about: Any, where: str) -> tuple[Any, Any]:
    """State vectors of a state, or of the initial shape and motion where none is given."""
    if about is None:
        return system.initial_state()
    if not isinstance(about, State):
        raise ModelError(where, f"must be a State, is {checks.shown(about)}", "see ancf.equilibrium")
    return _adopted(about, system, where)


def _sensors(system: System, given: Any) -> Listing:
    """What ``sensors`` lists."""
    where = "simulate.sensors"
    if given is None:
        return Listing()
    if not isinstance(given, Sequence) or isinstance(given, str | bytes):
        what = f"must be a list of points, springs and joints, is {checks.shown(given)}"
        raise ModelError(where, what, 'such as sensors=["wire.at(3)", dropper]')
    return listing(system, [system.model.sensor(item, f"{where}[{k}]") for k, item in enumerate(given)])


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


def _adopted(state: State, system: System, where: str) -> tuple[Any, Any]:
    """State vectors of a state in the numbering of a system with the same bodies."""
    mine, theirs = system.model.bodies, state.bodies
    same = mine.keys() == theirs.keys() and all(
        system.slots[n].shape == state.slots[n].shape and _same_nodes(mine[n], theirs[n]) for n in mine
    )
    if not same:
        raise ModelError(where, "is a state of another model: its bodies or their nodes differ")
    return system.adopt(state.slots, state.joints, state.q, state.v, state.t)


def _same_nodes(a: Any, b: Any) -> bool:
    if not isinstance(a, Beam) or not isinstance(b, Beam):
        return type(a) is type(b)
    return a.element == b.element and np.array_equal(a.node_x, b.node_x)


def _header(
    system: System, method: Integrator, t0: float, t_end: float, step: float, output_step: float | None
) -> dict[str, Any]:
    """What made a result: model, settings, versions, time."""
    model, listed = system.model, system.sensors
    return {
        "title": model.title,
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "model": model.to_dict(),
        "settings": {
            "t_start": t0,
            "t_end": t_end,
            "step": step,
            "output_step": output_step or step,
            "integrator": method.name,
            "method": asdict(method),
            **method.settings(),
            "energy": system.core.accounted,
            "sensors": [*map(str, listed.points), *listed.connections],
        },
        "versions": versions(),
    }
