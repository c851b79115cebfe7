"""Steps one by one: a run that a program of its own leads."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..compilation import check_model
from ..errors import ModelError, SolveError
from ..files import writing
from ..model import checks
from ..model.integrators import Integrator, Radau, integrator_from
from ..model.model import Model
from ..model.settings import FITS, MOST_STEPS
from ..preparation import Prepared, compiled, method_of, prepared
from ..results.checkpoints import Checkpoint
from ..results.given import Given, gone_on
from ..results.read_store import ReadStore
from ..results.sensors import Sensors
from ..results.state import State
from ..results.store import FileStore, MemoryStore
from ..solvers.stepping import Run
from ..system.left_out import heeded
from ..system.sensors import by_ends
from .ahead import Ahead
from .foreseen import Foreseen
from .live import Live


class Stepper(Live):
    """A run that takes steps when it is asked to; see :func:`ancf.stepper`.

    It answers all questions of a :class:`ancf.State`, of now: ``run.position(tip)``, ``run.energy``.
    """

    def __init__(self, made: Prepared) -> None:
        made.system.inputs = Foreseen(made.system.inputs)
        if made.given is None and made.system.sensors:  # without them nothing grows with the run
            made = made._replace(given=Given.begun(made.run.t_start, made.system.inputs.given))
        self._made = made
        self._store = MemoryStore(made.system)
        super().__init__(made)
        run = made.run
        if not run.begun:
            run.begin(self._store)
            self._store.forget()
        self._ahead: Ahead | None = None
        if isinstance(run, Run) and not len(self.system.spare):  # nobody has to look at each state
            self._ahead = Ahead(run, self._store)

    def advance(self, steps: int = 1) -> None:
        """Take some steps with the inputs as they are.

        Parameters
        ----------
        steps : int

        Raises
        ------
        SolveError
            A step failed. The run is then where it was before that step, can be asked, and can go on,
            perhaps with other inputs.
        ModelError
            A function of time failed.
        """
        if steps == 1 and type(steps) is int and self._ahead is not None and self._ahead.one():
            self.t = self._run.t_start + self._run.done * self._run.h
            return
        if type(steps) is not int or steps < 1:
            checks.integer(steps, "advance.steps", 1, int(MOST_STEPS))
        run = self._run
        if run.done + steps > MOST_STEPS:
            raise ModelError("advance.steps", f"the run would have more than {MOST_STEPS:.0e} steps")
        if self._ahead is not None:
            try:
                self._ahead.take(steps)
            finally:
                self.t = run.t_start + run.done * run.h
            return
        before = run.snapshot()
        try:
            for _ in range(steps):
                before = run.snapshot()
                run.take(1, heeded(self.system, self._store))
                self._store.forget()
        except (SolveError, ModelError):
            run.put_back(before)
            raise
        finally:
            self.look()

    def snapshot(self) -> Checkpoint:
        """All that decides how the run goes on from now, for :meth:`restore`.

        Returns
        -------
        Checkpoint
            It has the time as ``snapshot.t``, s, and can be pickled; its size is that of some fifty
            state vectors, most of it a matrix that is kept.
        """
        rows = 0
        if self.system.sensors:
            if self._ahead is not None:
                self._ahead.hand_over()
            rows = self._store.recorded
        return Checkpoint(self._run.snapshot(), 1, rows)

    def restore(self, checkpoint: Checkpoint) -> None:
        """Go back to a snapshot: the run goes on from there to the same bits, its inputs as they were then.

        What was recorded since is forgotten. Of a line whose spans sleep (``reduce=True``) the matrix is made
        anew, so that it goes on but for what Newton's method leaves: 0.04 N of a contact force of 150 N.

        Parameters
        ----------
        checkpoint : Checkpoint
            From :meth:`snapshot` of this run, or of another one of the same model, step and integrator.

        Raises
        ------
        ModelError
            It is none, or does not fit; the run is then where it was.
        """
        if self._ahead is not None:
            self._ahead.hand_over()
        self._check_checkpoint(checkpoint)
        self._run.put_back(checkpoint.snapshot)
        self._store.unrecord(checkpoint.samples)
        if self._made.given is not None:
            self._made.given.back(checkpoint.snapshot.t, self.system.inputs.given)
        if self._ahead is not None:
            self._ahead.rewound()
        self.look()

    def _check_checkpoint(self, given: Any) -> None:
        where, run = "restore.checkpoint", self._run
        if not isinstance(given, Checkpoint):
            raise ModelError(where, f"must be what run.snapshot() gave, is {checks.shown(given)}")
        t, done = given.snapshot.t, given.snapshot.values["done"]
        if abs(t - (run.t_start + done * run.h)) > FITS * run.h:
            what = f"is of step {done} at t = {t:.6g} s, where this run is not with steps of {run.h:g} s"
            raise ModelError(where, what, "give one of a run with the same start and step")
        if self.system.sensors and given.samples > self._store.recorded:
            what = "is later than this run, whose sensors have not recorded so much"
            raise ModelError(where, what, "advance it as far first, or make the stepper without sensors")

    @property
    def sensors(self) -> Sensors:
        """What was recorded at every step so far; see :attr:`ancf.Result.sensors`.

        Raises
        ------
        ModelError
            There are no sensors.
        """
        listing = self.system.sensors
        if not listing:
            raise ModelError("stepper.sensors", "there are none", 'give stepper(..., sensors=["wire.at(3)"])')
        if self._ahead is not None:
            self._ahead.hand_over()
        return Sensors(listing, lambda: self._store.samples, _Whole(self))

    def save(self, file: str | Path) -> None:
        """Write a results file with the present state, from which the run can go on to the last bit.

        ``ancf.stepper(model, start=file)`` does so with steps one by one, ``ancf.resume(file, t_end=...)``
        with the inputs as they are, and :func:`ancf.load` reads the state.

        Raises
        ------
        ModelError
            It cannot be written.
        """
        path = checks.path(file, "save.file")
        if self._ahead is not None:
            self._ahead.hand_over()
        header = {**self._made.header, "settings": {**self._made.header["settings"], "t_end": self.t}}
        with writing(path):
            store = FileStore(path, self.system, header, self._history())
        rows = 0
        if self.system.sensors:
            samples = self._store.samples
            rows = len(samples["time"])
            store.record(
                samples["time"], np.concatenate([samples[k] for k in ("q", "v", "measured")], axis=1)
            )
        q, v, work = self._run.now()
        store.append(np.array([self.t]), q[None], v[None], work[None])
        store.put(Checkpoint(self._run.snapshot(), 1, rows))
        store.update(self.stats, "interrupted")
        store.close()

    def _led(self) -> bool:
        return bool(self.model.inputs)

    def _history(self) -> Given:
        """What the inputs were; without sensors what they are."""
        return self._made.given or Given.begun(self.t, self.system.inputs.given)


class _Whole:
    """What :class:`ancf.results.sensors.Sensors` asks of a result."""

    def __init__(self, run: Stepper) -> None:
        self.model, self.bodies, self.slots = run.model, run.bodies, run.slots
        self.springs, self.joints, self.arcs = run._springs, run._joints, run._arcs
        self.lengths, self._kept, self._led = run.lengths, run._history, run._led
        self._turned_to = run._turned_to


def stepper(
    model: Model,
    *,
    step: float | None = None,
    start: State | str | Path | None = None,
    integrator: Integrator | None = None,
    sensors: Sequence[Any] | None = None,
    energy: bool = True,
) -> Stepper:
    """A run whose steps are taken one by one, with inputs that may change between them.

    Parameters
    ----------
    model : Model
    step : float
        Time step, s.
    start : State or path, optional
        Where to start, default the initial shape and motion at t = 0; or a file that
        :meth:`ancf.Stepper.save` wrote or a simulation, from which the run goes on to the last bit, with
        its step, integrator and sensors. Inputs that were given until a state stay as they are in it.
    integrator : Trapezoidal, GeneralizedAlpha, Explicit or Radau(adaptive=False), optional
        Default the trapezoidal rule.
    sensors : sequence, optional
        Points, springs and joints that are recorded at every step, see :attr:`ancf.Stepper.sensors`.
    energy : bool
        Account for the energies dissipated and supplied.

    Returns
    -------
    Stepper

    Raises
    ------
    ModelError
        Something given is wrong, or a file of another model.
    SolveError
        There are no accelerations at the start.
    """
    if isinstance(start, str | Path):
        check_model(model)
        given = {"step": step, "integrator": integrator, "sensors": sensors}
        for key, value in given.items():
            if value is not None:
                raise ModelError(f"stepper.{key}", "cannot be given: it is that of the file")
        return _gone_on(model, start)
    _check_start(start)
    method = method_of(integrator, "stepper")
    refuse_adaptive(method, "stepper")
    size = checks.positive(step, "stepper.step")
    t0 = 0.0 if start is None else start.t
    made = prepared(
        model,
        method=method,
        t_end=t0 + MOST_STEPS * size,
        step=size,
        start=start,
        output_step=None,
        sensors=sensors,
        energy=energy,
        where="stepper",
    )
    return Stepper(made)


def _check_start(start: Any) -> None:
    if start is not None and not isinstance(start, State):
        what = f"must be a State or a file, is {checks.shown(start)}"
        raise ModelError("stepper.start", what, "such as start=ancf.equilibrium(model)")


def refuse_adaptive(method: Integrator, where: str) -> None:
    """Raise ModelError if a method chooses its own steps, which nothing could lead."""
    if isinstance(method, Radau) and method.adaptive:
        what = "chooses its own steps, and inputs are given between steps of one length"
        raise ModelError(f"{where}.integrator", what, "take ancf.Radau(adaptive=False)")


def _gone_on(model: Model, file: str | Path) -> Stepper:
    """A stepper from a checkpoint."""
    old = ReadStore(file)
    found = old.checkpoint()
    if found is None or "method" not in old.header["settings"]:
        hint = "start=ancf.load(file).state() starts anew from its last state"
        raise ModelError(str(file), "has no checkpoint from which a run could go on", hint)
    if model.to_dict() != old.header["model"]:
        raise ModelError("stepper.model", f'is not the model that "{file}" describes')
    settings = old.header["settings"]
    method = integrator_from(settings["integrator"], settings["method"])
    refuse_adaptive(method, "stepper")
    t0, step, listed = settings["t_start"], settings["step"], settings["sensors"]
    ends = by_ends(old.listing(model.bodies), model.connections)
    made = _made_again(model, method, t0, step, listed or None, settings["energy"], ends, found)
    if listed:
        made = made._replace(given=gone_on(old.given, t0, found.snapshot.t, made.system.inputs.given, True))
    run = Stepper(made)
    if listed:
        samples = old.samples
        values = np.concatenate([samples[k][: found.samples] for k in ("q", "v", "measured")], axis=1)
        run._store.record(samples["time"][: found.samples], values)
    return run


def gone_on_from(model: Model, checkpoint: Checkpoint, method: Integrator, step: float) -> Stepper:
    """A stepper without sensors and accounts of energy, from the snapshot of one like it that began at 0 s.

    Raises
    ------
    ModelError
        The snapshot is of another model.
    """
    return Stepper(_made_again(model, method, 0.0, step, None, False, False, checkpoint))


def _made_again(
    model: Model,
    method: Integrator,
    t0: float,
    step: float,
    sensors: Sequence[Any] | None,
    energy: bool,
    ends: bool,
    checkpoint: Checkpoint,
) -> Prepared:
    """A run that stands where another one of the same model left a snapshot."""
    t_end = t0 + MOST_STEPS * step
    made = compiled(model, method, t0, t_end, step, None, sensors, energy, "stepper", ends)
    made.run.restore(checkpoint.snapshot)
    return made
