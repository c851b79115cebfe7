"""``ancf run``: from a model file to OUT/results.h5, OUT/summary.json, OUT/sensors.csv and a short table."""

from __future__ import annotations

import time
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import ModelError, SolveError
from ..model.checks import shown
from ..model.file import Study, read_study
from ..model.file.paths import assignments
from ..model.integrators import Integrator
from ..model.model import Model
from ..model.points import Point
from ..model.settings import SimulationSettings
from .output import OutputFolder
from .screen import Screen, console

if TYPE_CHECKING:
    from .. import Result, State


def run_file(
    path: Path,
    folder: Path,
    quiet: bool = False,
    verify: bool = False,
    resume: bool = False,
    given: list[str] | None = None,
) -> None:
    """Read, compute, write and print; with `verify` compute again, finer, and compare.

    With `resume` the simulation goes on where the results file in the folder ends; one that is complete is
    left as it is, which is no error: who always resumes need not know whether there is something to do.
    `given` are values in place of those of the file, ``PATH=VALUE``.

    Raises
    ------
    ModelError
        The model file or the folder is wrong; nothing was computed.
    SolveError, KeyboardInterrupt
        What was computed until then is in the folder; a note of the error says so.

    """
    study = read_study(path, assignments(given))
    if study.simulation is None and study.equilibrium is None:
        hint = "add a table [simulation] with t_end and step, or [equilibrium]"
        raise ModelError(str(path), "nothing to compute", hint)
    if resume and study.simulation is None:
        raise ModelError(str(path), "asks for no simulation that could go on", "leave out --resume")
    output = OutputFolder(folder)
    with output.locked():
        output.clear()
        run = Run(study, path, output, Screen(quiet), resume)
        result = run.compute()
        if verify:
            run.verify(result)


class Run:
    """One run of a study."""

    def __init__(
        self, study: Study, path: Path, output: OutputFolder, screen: Screen, resume: bool = False
    ) -> None:
        self.study, self.path, self.output, self.screen = study, path, output, screen
        self.resume = resume
        self.start = time.perf_counter(), time.process_time()

    def compute(self) -> Result:
        """Compute and write; the summary is written for a run that stops early as well."""
        self.screen.announce_compilation()
        try:
            result = self._result()
        except (SolveError, ModelError, KeyboardInterrupt) as error:
            self._keep(error)
            raise
        self._finish(result)
        return result

    def verify(self, result: Result) -> None:
        """Compute again with half the step and with twice the elements, write and print the changes."""
        from .verification import print_verification, verified

        try:
            found = verified(self.study, result, self._again)
        finally:
            self.output.again.unlink(missing_ok=True)
        self.output.write_verification(
            {"title": self.study.title, "model_file": str(self.path), **found.as_dict()}
        )
        if not self.screen.quiet:
            print_verification(console(), found)
            console().print(f"written: {self.output.verification}", soft_wrap=True)

    def _again(self, model: Model, step: float | None, method: Integrator) -> Result | State:
        settings = self.study.simulation
        if settings is None or step is None:
            return self._equilibrium(model)
        every = settings.output_step or settings.step
        return self._simulation(
            replace(settings, step=step, output_step=every), model, method, self.output.again
        )

    def _result(self) -> Result:
        settings = self.study.simulation
        if settings is None:
            return self._statics()
        if self.resume:
            return self._resumed(settings)
        method = settings.integrator
        return self._simulation(settings, self.study.model, method, self.output.results)

    def _resumed(self, settings: SimulationSettings) -> Result:
        import ancf

        from ..resumption import REACHED
        from .results_file import open_result

        path = self.output.results
        old = open_result(path)
        _check_same(old, self.study, path)
        if old.status == "complete" and abs(settings.t_end - float(old.t[-1])) < REACHED * settings.step:
            self.screen.say(f"{path} is complete up to t = {old.t[-1]:g} s, there is nothing to do")
            return old
        with self.screen.progress(round((settings.t_end - float(old.t[-1])) / settings.step)) as report:
            return ancf.resume(path, t_end=settings.t_end, progress=report)

    def _simulation(
        self, settings: SimulationSettings, model: Model, method: Integrator, file: Path
    ) -> Result:
        import ancf

        start = self._equilibrium(model, settings.equilibrium_of) if settings.start == "equilibrium" else None
        with self.screen.progress(round(settings.t_end / settings.step)) as report:
            return ancf.simulate(
                model,
                t_end=settings.t_end,
                step=settings.step,
                start=start,
                integrator=method,
                output_step=settings.output_step,
                sensors=settings.sensors,
                file=file,
                progress=report,
            )

    def _equilibrium(self, model: Model, of: tuple[str, ...] | None = None) -> State:
        import ancf

        given = self.study.equilibrium
        self.screen.say("looking for the equilibrium ...")
        return ancf.equilibrium(model, of=of, load_steps=given.load_steps if given else 1)

    def _statics(self) -> Result:
        from .statics import store

        return store(self.study, self._equilibrium(self.study.model), self.output.results)

    def _finish(self, result: Result, error: BaseException | None = None) -> None:
        from .summary import print_summary, summarise

        wall, cpu = time.perf_counter() - self.start[0], time.process_time() - self.start[1]
        seconds = {"wall_seconds": wall, "cpu_seconds": result.stats.cpu_seconds, "process_cpu_seconds": cpu}
        summary = summarise(self.study, self.path, result, seconds, error)
        self.output.write_summary(summary)
        written = [self.output.results, self.output.summary]
        if self.study.simulation is not None and self.study.simulation.sensors:
            from ..viz.export.tables import sensor_columns, write_table

            write_table(self.output.sensors, sensor_columns(result.sensors))
            written.append(self.output.sensors)
        if error is None and not self.screen.quiet:
            print_summary(console(), summary)
            console().print(f"written: {', '.join(map(str, written))}", soft_wrap=True)

    def _keep(self, error: BaseException) -> None:
        result = getattr(error, "result", None)
        if result is None:
            return
        error.add_note(f"results up to t = {result.t[-1]:.6g} s kept in {self.output.results}")
        try:
            self._finish(result, error)
        except (OSError, ModelError) as other:
            note = "summary and table cannot be written"
            error.add_note(f"{self.output.path}: {note}: {getattr(other, 'strerror', None) or other}")


def _check_same(old: Result, study: Study, path: Path) -> None:
    """Raise ModelError if a results file is of another model, or of another simulation of it."""
    hint = "run it without --resume, which replaces the file"
    if old.model.to_dict() != study.model.to_dict():
        raise ModelError(str(path), "is of another model than this file describes", hint)
    wanted, settings = study.simulation, old.provenance["settings"]
    assert wanted is not None
    recorded = [study.model.sensor(name) for name in wanted.sensors]
    points = [str(item) for item in recorded if isinstance(item, Point)]
    given = {
        "step": wanted.step,
        "output_step": wanted.output_step or wanted.step,
        "integrator": wanted.integrator.name,
        "method": asdict(wanted.integrator),
        "sensors": list(
            dict.fromkeys([*points, *(item.name for item in recorded if not isinstance(item, Point))])
        ),
    }
    for key, value in given.items():
        if settings.get(key) != value:
            what = f"was computed with {key} = {shown(settings.get(key))}, the model file has {shown(value)}"
            raise ModelError(str(path), what, hint)
