"""A simulation that goes on where its results file ends."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from .analysis import carried_out, prepared
from .errors import ModelError
from .files import drafted, writing
from .model import checks
from .model.integrators import integrator_from
from .results.provenance import versions
from .results.result import Result, load
from .results.store import FileStore
from .solvers.record import Progress, Stats

__all__ = ["resume"]

#: Part of a step by which a run may miss its end and has reached it.
REACHED = 1e-6
#: Numbers that are copied at once.
AT_ONCE = 2_000_000


def resume(
    file: str | Path, *, t_end: float | None = None, progress: Callable[[Progress], None] | None = None
) -> Result:
    """Simulate on from the last stored state of a results file, with its model and its settings.

    What is computed is added to the file: it then holds one history from the first start to ``t_end``, with
    work and counters that go on. The accelerations are computed anew from the state, as when a simulation
    starts from any state; what the steps before have left in a method is gone.

    Parameters
    ----------
    file : path
        Of a run that ended, failed, was stopped or killed; no other process may be writing to it.
    t_end : float, optional
        Default the end time that the run was given.
    progress : callable, optional
        Called between blocks of steps.

    Raises
    ------
    ModelError
        The file cannot be read or written, holds no state of a simulation, has reached ``t_end``, or its
        model had a Python function, which a file cannot keep: the message names it.
    SolveError, StorageError, Interrupted
        As from :func:`ancf.simulate`; the file keeps what was computed until then.
    """
    old = load(file)
    settings, path = _settings(old, file), Path(file)
    end = settings["t_end"] if t_end is None else checks.number(t_end, "resume.t_end")
    last = float(old.t[-1])
    if end - last < REACHED * settings["step"]:
        what = f'"{path}" has reached t = {last:g} s, there is nothing to do until {end:g} s'
        raise ModelError("resume.t_end", what, "give a later t_end")
    prepared_run = prepared(
        old.model,
        method=integrator_from(settings["integrator"], settings["method"]),
        t_end=end,
        step=settings["step"],
        start=old.state(),
        output_step=settings["output_step"],
        sensors=_sensors(old),
        energy=settings["energy"],
        where="resume",
    )
    header = _header(old, prepared_run.header, last)
    with writing(path), drafted(path) as draft:
        _copy(old, FileStore(draft, prepared_run.system, header), last)
    store = Continued(FileStore.reopened(path, prepared_run.system), old)
    return carried_out(prepared_run, store, progress)


class Continued:
    """A file that holds a history already; what a run computes is added to it.

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

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def _settings(old: Result, file: str | Path) -> dict[str, Any]:
    """Settings of the simulation, once there is something to go on from."""
    settings: dict[str, Any] = old.provenance["settings"]
    if "method" not in settings:
        raise ModelError(str(file), "holds an equilibrium and no simulation", "start one: ancf.simulate(...)")
    if not len(old.t):
        raise ModelError(str(file), "holds no state to go on from", "simulate it again")
    missing = old.model.missing_functions()
    if missing:
        listed = ", ".join(f'"{function}" of "{item}"' for item, function in missing)
        what = f"has lost Python functions, which a file cannot keep: {listed}"
        hint = "go on in the script that has them: ancf.simulate(model, start=ancf.load(file).state(), ...)"
        raise ModelError(str(file), what, f"{hint}; formulas and tables are kept")
    return settings


def _sensors(old: Result) -> list[Any] | None:
    """What was recorded."""
    if not old.provenance["settings"]["sensors"]:
        return None
    listing = old.sensors.listing
    return [*listing.points, *listing.connections]


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


def _copy(old: Result, file: FileStore, last: float) -> None:
    """Write a history to another file, in which nothing of a run that was killed is left."""
    rows = max(1, AT_ONCE // old.q.shape[1])
    arrays = old._store.arrays
    for k in range(0, len(old.t), rows):
        part = slice(k, k + rows)
        file.copy(*(np.asarray(arrays[name][part]) for name in ("time", "q", "v", "work", "energy")))
    if old.provenance["settings"]["sensors"]:
        samples = old._store.samples
        count = int(np.searchsorted(samples["time"], last, side="right"))  # some may be ahead of the states
        rows = max(1, AT_ONCE // max(1, samples["q"].shape[1]))
        for k in range(0, count, rows):
            part = slice(k, min(k + rows, count))
            values = np.concatenate([samples[name][part] for name in ("q", "v", "measured")], axis=1)
            file.record(samples["time"][part], values)
    file.update(old.stats, "running")
    file.close()
