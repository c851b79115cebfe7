"""What every computation with a model begins and ends with: compiled, started, carried out."""

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

from . import garbage
from .compilation import expected
from .errors import Interrupted, ModelError, SolveError, StorageError
from .interrupts import heed, kept
from .model import checks
from .model.bodies.beam import Beam
from .model.doubts import doubts
from .model.functions.series import noises
from .model.integrators import INTEGRATORS, Integrator, Radau, Trapezoidal
from .model.model import Model
from .model.settings import steps_between
from .model.supports.jumps import jumps
from .model.supports.periods import few_steps
from .model.supports.support import Support
from .model.supports.winch import Winch
from .results import remembered
from .results.given import Given
from .results.impacts import unresolved
from .results.provenance import versions
from .results.read_store import ReadStore
from .results.result import Result, load, read
from .results.room import ROOM
from .results.setting_off import missed, setting_off
from .results.state import State
from .results.store import FileStore, MemoryStore
from .solvers.record import Progress
from .solvers.runs import AnyRun, run_of
from .system.consistency import check_gaps
from .system.left_out import heeded
from .system.redundancy import independent
from .system.sensors import Listing, listing
from .system.system import System


class Prepared(NamedTuple):
    """A simulation that has not taken a step yet."""

    system: System
    run: AnyRun
    header: dict[str, Any]
    method: Integrator
    given: Given | None = None  # what the inputs are, of a run that is led

    def store(self, file: str | Path | None) -> MemoryStore | FileStore:
        """Where what is computed goes: a results file, or the memory.

        Raises
        ------
        ModelError
            The file cannot be written.
        """
        if file is None:
            return MemoryStore(self.system, self.given)
        return FileStore(file, self.system, self.header, self.given)


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
    ends: bool = False,
) -> Prepared:
    """A simulation at its start, see :func:`simulate`; ``where`` stands in messages.

    ``ends``: sensors record the ends of springs, see :func:`ancf.system.sensors.listing`.

    Raises
    ------
    ModelError, SolveError
        Something given is wrong, or there are no accelerations at the start.
    """
    t0 = 0.0 if start is None else start.t
    with expected(model, method):
        made = compiled(model, method, t0, t_end, step, output_step, sensors, energy, where, ends)
        system = made.system
        q, v = system.initial_state(t0) if start is None else adopted(start, system, f"{where}.start")
        remembered.begin(system, q, v, None if start is None else start.known)
        check_gaps(system, q, f"{where}.start", t0)
        at_rest = start is not None and start.known.balanced
        for text in unresolved(system, q, method, step, at_rest=at_rest):
            warnings.warn(text, UserWarning, stacklevel=4)
            made.header["notes"].append(text)
        made.header["notes"] += missed(system, start, q, level=4)
        made.header["notes"] += setting_off(system, start, v, t0, t_end, step)
        made.run.start(q, v)
    return made


@garbage.without
def compiled(
    model: Model,
    method: Integrator,
    t_start: float,
    t_end: float,
    step: float,
    output_step: float | None,
    sensors: Sequence[Any] | None,
    energy: bool,
    where: str,
    ends: bool = False,
) -> Prepared:
    """A simulation that has no state yet; it is given one by ``run.start`` or ``run.restore``."""
    every = steps_between(where, t_end, step, output_step, t_start)
    system = independent(model)  # anew: the model may have changed since the start was computed
    if system.inputs.drives and isinstance(method, Radau):
        what = f'does not know "{system.inputs.drives[0].winch.name}", whose length follows from step to step'
        hint = "take Trapezoidal, GeneralizedAlpha or Explicit, or give its length as a function of time"
        raise ModelError(f"{where}.integrator", what, hint)
    system.sensors = _sensors(system, sensors, not isinstance(method, Radau), ends)
    if not checks.flag(energy, f"{where}.energy"):
        system.skip_energies()
    found = jumps(model, t_start, t_end, step)
    said = [*noises(model), *map(str, found)]
    for text in said:
        warnings.warn(text, UserWarning, stacklevel=6)
    header = header_of(system, method, t_start, t_end, step, output_step)
    quick = [] if isinstance(method, Radau) else few_steps(model, t_start, t_end, step, found)
    header["notes"] = [*said, *quick, *doubts(model)]
    return Prepared(system, run_of(method, system, t_start, t_end, step, every), header, method)


def carried_out(
    made: Prepared, store: Any, progress: Callable[[Progress], None] | None, recorder: Any = None
) -> Result:
    """Take all steps and give the result, also with the errors; see :func:`simulate`.

    Parameters
    ----------
    made : Prepared
    store : MemoryStore, FileStore or another Recorder with ``path`` and ``close``
    progress : callable or None
    recorder : Recorder, optional
        Takes what is stored in the store's place, and hands it on.

    Raises
    ------
    SolveError, StorageError, ModelError, Interrupted
        With what was computed until then.
    """
    system, run, header = made.system, made.run, made.header

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
            run.go(heeded(system, store if recorder is None else recorder), look)
        except StorageError:
            raise
        except (SolveError, ModelError) as error:
            error.result = finished("failed")
            _name_jump(error, made)
            raise
        except MemoryError as error:
            full = SolveError(f"t = {run.t_start + run.done * run.h:.6g} s", "the memory is full", ROOM)
            full.result = finished("failed")
            raise full from error
        except KeyboardInterrupt as stop:
            run.stopped(store)
            raise Interrupted(finished("interrupted")) from stop
        if run.caution:
            warnings.warn(run.caution, UserWarning, stacklevel=4)
        return finished("complete")


def _name_jump(error: SolveError | ModelError, made: Prepared) -> None:
    """Of a step that fails where a motion jumps, that is the cause and no other."""
    if not isinstance(error, SolveError) or not len(error.result.t):
        return
    settings = made.header["settings"]
    soon = float(error.result.t[-1]) + settings["output_step"] + settings["step"]
    for jump in jumps(made.system.model, settings["t_start"], settings["t_end"], settings["step"]):
        if jump.of_value and jump.time <= soon:
            error.hint = ""
            error.advise(str(jump))


@contextmanager
def _salvaged(system: System) -> Iterator[None]:
    """What a file holds that can no longer be written goes with the error."""
    try:
        yield
    except StorageError as error:
        with suppress(ModelError):  # nothing may have reached the disk
            error.result = read(ReadStore(error.where, "failed"), system)
        raise


def method_of(given: Integrator | None, where: str = "simulate") -> Integrator:
    """The integrator that was given, or the default; ModelError for anything else."""
    if given is None:
        return Trapezoidal()
    if not isinstance(given, tuple(INTEGRATORS.values())):
        known = "one of " + ", ".join(f"ancf.{kind.__name__}()" for kind in INTEGRATORS.values())
        raise ModelError(f"{where}.integrator", f"must be {known}, is {checks.shown(given)}")
    return given


def given_state(system: System, about: Any, where: str) -> tuple[Any, Any]:
    """State vectors of a state, or of the initial shape and motion where none is given."""
    if about is None:
        return system.initial_state()
    if not isinstance(about, State):
        raise ModelError(
            where, f"must be a State, is {checks.shown(about)}", "such as about=ancf.equilibrium(model)"
        )
    return adopted(about, system, where)


def _sensors(system: System, given: Any, accelerations: bool, ends: bool) -> Listing:
    """What ``sensors`` lists."""
    where = "simulate.sensors"
    if given is None:
        return Listing()
    if not isinstance(given, Sequence) or isinstance(given, str | bytes):
        what = f"must be a list of points, springs, joints and supports, is {checks.shown(given)}"
        raise ModelError(where, what, 'such as sensors=["wire.at(3)", dropper]')
    items = [system.model.sensor(item, f"{where}[{k}]") for k, item in enumerate(given)]
    for item in items:
        if isinstance(item, Winch):
            what = f'"{item.name}" is a winch, which is no point and has no reaction'
            raise ModelError(where, what, "list the end of its cable, which has tension and natural_length")
    held = next((item for item in items if isinstance(item, Support)), None)
    if held is not None and not accelerations:
        what = f'"{held.name}" is a support, and with Radau the steps have no accelerations'
        raise ModelError(where, what, "ask the result for its reaction at the stored times")
    return listing(system, items, accelerations, ends)


def adopted(state: State, system: System, where: str) -> tuple[Any, Any]:
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


def once_a_step(model: Model) -> list[str]:
    """Names of loads and fluids of a compiled model whose Python functions numba could not compile."""
    items: list[Any] = [*model.loads, *model.fluids]
    laws = [(item, getattr(item, key, None)) for item in items for key in ("force", "load", "velocity")]
    return [item.name for item, law in laws if getattr(law, "once", None)]


def header_of(
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
            "called once a step": once_a_step(model),
        },
        "versions": versions(),
    }
