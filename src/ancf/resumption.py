"""A simulation that goes on where its results file ends."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import fields
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from .control.lead import check_controller, led, name_of
from .control.live import Live
from .control.memory import restored
from .errors import ModelError
from .files import drafted, results_at, writing
from .model import checks
from .model.describe import point
from .model.integrators import Integrator, integrator_from
from .model.model import Model
from .preparation import Prepared, carried_out, compiled, prepared
from .results.checkpoints import Checkpoint
from .results.given import gone_on
from .results.provenance import versions
from .results.read_store import ReadStore
from .results.result import Result, load
from .results.store import FileStore
from .solvers.checkpoint import Snapshot
from .solvers.record import Progress, Stats
from .system.sensors import by_ends

__all__ = ["resume"]

#: Part of a step by which a run may miss its end and has reached it.
REACHED = 1e-6
#: Numbers that are copied at once.
AT_ONCE = 2_000_000


def resume(
    file: str | Path,
    *,
    t_end: float | None = None,
    model: Model | None = None,
    progress: Callable[[Progress], None] | None = None,
    controller: Callable[[Live], Any] | None = None,
) -> Result:
    """Simulate on from the checkpoint of a results file, with its settings.

    The file then holds one history from the first start to ``t_end``, the same to the last bit as if the run
    had not been stopped: states, samples, work, counters and messages. Steps behind the checkpoint, of a run
    that was killed and of the last ones of a run that ended, are computed once more.

    Parameters
    ----------
    file : path
        Results file, or its folder, of a run that ended, failed, was stopped or killed; no other process may
        be writing to it.
    t_end : float, optional
        Default the end time that the run was given.
    model : Model, optional
        The model that was computed, with its Python functions, which a file cannot keep; default that of
        the file.
    progress : callable, optional
        Called between blocks of steps.
    controller : callable, optional
        That of the run, if it had one. It takes what it remembered back by ``restore(state)``, if it has this
        method and ``state()``, which returned that for the checkpoint: numbers, texts, lists, dicts.

    Raises
    ------
    ModelError
        The file cannot be read or written, holds no state of a simulation, has reached ``t_end``, is of
        another model, or its model had a Python function and is not given: the message names it.
    SolveError, StorageError, Interrupted
        As from :func:`ancf.simulate`; the file keeps what was computed until then.

    Warns
    -----
    UserWarning
        The controller had changed what it holds, and has no such methods.
        The file has no checkpoint, as one of an earlier version: the run starts anew from the last stored
        state, with accelerations that are computed anew.
    """
    checks.progress(progress, "resume.progress")
    old = load(file)
    settings, path = _settings(old, file, model), results_at(Path(file))
    _check_led(settings, controller, file)
    end = settings["t_end"] if t_end is None else checks.number(t_end, "resume.t_end")
    last = float(old.t[-1])
    checkpoint = old._store.checkpoint() if isinstance(old._store, ReadStore) else None
    slack = REACHED * settings["step"]
    unfinished = checkpoint is not None and old.status != "complete" and end - last > -slack
    if end - last < slack and not unfinished:
        what = f'"{path}" has reached t = {last:g} s, there is nothing to do until {end:g} s'
        raise ModelError("resume.t_end", what, "give a later t_end")
    given = model or old.model, integrator_from(settings["integrator"], settings["method"])
    if checkpoint is None:
        return _anew(old, given, settings, end, path, progress, controller)
    times = settings["t_start"], end, settings["step"], settings["output_step"]
    made = compiled(*given, *times, _sensors(old), settings["energy"], "resume", _by_ends(old))
    try:
        made.run.restore(checkpoint.snapshot)
    except (ModelError, LookupError, TypeError, ValueError) as error:
        what = "has a checkpoint that does not fit its model"
        raise ModelError(str(path), f"{what}: {error}", "resume with the version that made it") from None
    if said := _remember(controller, checkpoint.snapshot):
        warnings.warn(said, UserWarning, stacklevel=3)
    made = _led(made, old, checkpoint.snapshot.t, controller)
    header = _header(old, made.header, checkpoint.snapshot.t)
    with writing(path), drafted(path) as draft:
        store = FileStore(draft, made.system, header, made.given)
        _copy(old, store, checkpoint.rows, checkpoint.samples, checkpoint)
    return carried_out(made, FileStore.reopened(path, made.system, made.given), progress)


def _led(made: Prepared, old: Result, t: float, controller: Callable[[Live], Any] | None) -> Prepared:
    """A simulation that goes on at t, with what its inputs were and its controller."""
    settings = old.provenance["settings"]
    now = made.system.inputs.given
    given = gone_on(old._store.given, settings["t_start"], t, now, controller is not None)
    made = made._replace(given=given)
    if controller is None:
        return made
    return led(made, controller, round(settings["control_step"] / settings["step"]), "resume")


def _remember(controller: Any, snapshot: Snapshot) -> str:
    """Let a controller remember; see :func:`ancf.control.memory.restored`."""
    if controller is None:
        return ""
    return restored(controller, name_of(controller), snapshot.values.get("controller", {}))


def _anew(
    old: Result,
    given: tuple[Model, Integrator],
    settings: dict[str, Any],
    end: float,
    path: Path,
    progress: Callable[[Progress], None] | None,
    controller: Callable[[Live], Any] | None,
) -> Result:
    """Start from the last stored state, as of any result."""
    text = f'"{path}" has no checkpoint: the run starts anew from its last state, with new accelerations'
    warnings.warn(text, UserWarning, stacklevel=4)
    last = float(old.t[-1])
    made = prepared(
        given[0],
        method=given[1],
        t_end=end,
        step=settings["step"],
        start=old.state(),
        output_step=settings["output_step"],
        sensors=_sensors(old),
        energy=settings["energy"],
        where="resume",
        ends=_by_ends(old),
    )
    made = _led(made, old, last, controller)
    header = _header(old, made.header, last)
    samples = 0
    if settings["sensors"]:  # some may be ahead of the states
        samples = int(np.searchsorted(old._store.samples["time"], last, side="right"))
    with writing(path), drafted(path) as draft:
        _copy(old, FileStore(draft, made.system, header, made.given), len(old.t), samples)
    store = Continued(FileStore.reopened(path, made.system, made.given), old)
    return carried_out(made, store, progress)


class Continued:
    """A file that holds a history already; what a run computes that starts anew at its end is added to it.

    Parameters
    ----------
    file : FileStore
    old : Result
        What it holds.
    """

    def __init__(self, file: FileStore, old: Result) -> None:
        self.path, self._file = file.path, file
        self._last, self._stats = float(old.t[-1]), old.stats
        self._work = np.array(old._store.arrays["work"][-1])

    def append(self, t: Any, q: Any, v: Any, work: Any) -> None:
        """Add states but the start, which is there."""
        new = t > self._last
        self._file.append(t[new], q[new], v[new], work[new] + self._work)

    def record(self, t: Any, samples: Any) -> None:
        """Add samples but those of the start."""
        new = t > self._last
        self._file.record(t[new], samples[new])

    def update(self, stats: Stats, status: str) -> None:
        """Counters of both runs."""
        both = (getattr(self._stats, f.name) + getattr(stats, f.name) for f in fields(Stats))
        self._file.update(Stats(*both), status)

    def due(self) -> bool:
        """Never: the run has another start than the history, which a checkpoint would have to know."""
        return False

    def keep(self, snapshot: Snapshot) -> None:
        """Take no checkpoint."""

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def _settings(old: Result, file: str | Path, model: Model | None) -> dict[str, Any]:
    """Settings of the simulation, once there is something to go on from."""
    if model is not None and not isinstance(model, Model):
        raise ModelError("resume.model", f"must be a Model, is {checks.shown(model)}")
    settings: dict[str, Any] = old.provenance["settings"]
    if "method" not in settings:
        raise ModelError(str(file), "holds an equilibrium and no simulation", "start one: ancf.simulate(...)")
    if not len(old.t):
        raise ModelError(str(file), "holds no state to go on from", "simulate it again")
    if derived := settings.get("sensitivities"):
        what = f"has sensitivities by {checks.listed(derived)}, which a resumed run does not carry on"
        hint = "simulate(model, start=ancf.load(file).state(), sensitivities=[...], file=...)"
        raise ModelError(str(file), what, hint)
    if model is not None:
        if _plain(model.to_dict()) != _plain(old.model.to_dict()):
            hint = "give the model that was computed, or simulate(model, start=ancf.load(file).state(), ...)"
            raise ModelError("resume.model", f'is not the model that "{file}" describes', hint)
        return settings
    missing = old.model.missing_functions()
    if missing:
        listed = ", ".join(f'"{function}" of "{item}"' for item, function in missing)
        what = f"has lost Python functions, which a file cannot keep: {listed}"
        hint = "go on in the script that has them: ancf.resume(file, model=model, ...)"
        raise ModelError(str(file), what, f"{hint}; formulas and tables are kept")
    return settings


def _check_led(settings: dict[str, Any], controller: Any, file: str | Path) -> None:
    """Raise ModelError unless a controller is given where the run had one, and nowhere else."""
    name = settings.get("controller")
    if (name is None) != (controller is None):
        what = f'of "{file}" had no controller' if name is None else f'of "{file}" was led by "{name}"'
        hint = "leave it out" if name is None else "give it: ancf.resume(file, controller=...)"
        raise ModelError("resume.controller", f"the run {what}", hint)
    if controller is not None:
        check_controller(controller, settings["control_step"], settings["step"], "resume")


def _sensors(old: Result) -> list[Any] | None:
    """What was recorded."""
    if not old.provenance["settings"]["sensors"]:
        return None
    listing = old.sensors.listing
    return [*(point(item) for item in listing.points), *listing.connections]


def _by_ends(old: Result) -> bool:
    """Whether springs were recorded by their ends: a file goes on with the columns that it has."""
    if not old.provenance["settings"]["sensors"]:
        return False
    return by_ends(old.sensors.listing, old.model.connections)


def _header(old: Result, new: dict[str, Any], last: float) -> dict[str, Any]:
    """The header of the history: that of its first run, with the new end and where and when it went on."""
    before = old.provenance
    now = {
        "t": last,
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "versions": versions(),
    }
    settings = {**before["settings"], "t_end": new["settings"]["t_end"]}
    return {**before, "settings": settings, "resumed": [*before.get("resumed", []), now]}


def _copy(
    old: Result, file: FileStore, count: int, samples: int, checkpoint: Checkpoint | None = None
) -> None:
    """Write the first states and samples of a history to another file, and what goes with them."""
    rows = max(1, AT_ONCE // old.q.shape[1])
    arrays = old._store.arrays
    for k in range(0, count, rows):
        part = slice(k, min(k + rows, count))
        file.copy(*(np.asarray(arrays[name][part]) for name in ("time", "q", "v", "work", "energy")))
    if samples:
        recorded = old._store.samples
        rows = max(1, AT_ONCE // sum(max(1, recorded[name].shape[1]) for name in ("q", "v", "measured")))
        for k in range(0, samples, rows):
            part = slice(k, min(k + rows, samples))
            values = np.concatenate([recorded[name][part] for name in ("q", "v", "measured")], axis=1)
            file.record(recorded["time"][part], values)
    if checkpoint is not None:
        file.put(checkpoint)
    file.update(old.stats, "running")
    file.close()


def _plain(described: Any) -> Any:
    """A description without the units of its series, whose values are the same; earlier files have none."""
    if isinstance(described, dict):
        series = {"t", "value"} <= described.keys()
        return {key: _plain(part) for key, part in described.items() if not (series and key == "unit")}
    return [_plain(part) for part in described] if isinstance(described, list) else described
