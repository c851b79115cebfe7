"""Motion: a model file as a unit of co-simulation runs it; the script in the unit calls nothing else."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path

from ..analysis import equilibrium
from ..control.stepper import Stepper, gone_on_from, stepper
from ..errors import ModelError
from ..model import checks
from ..model.file import Study, read_study
from ..model.model import Model
from ..model.settings import FITS, SimulationSettings
from ..results.checkpoints import Checkpoint, from_bytes, to_bytes
from .outputs import Output

#: Files in a unit.
MODEL, OUTPUTS = "model.toml", "outputs.json"


class Motion:
    """A model that another program leads: inputs in, steps, outputs out. Its time 0 is where that begins.

    The run begins when something is asked first; an input that changes until :meth:`begin` changes the
    equilibrium from which it starts, later ones hold from the next step on.

    Parameters
    ----------
    folder : Path
        With the model file and the list of outputs.

    Attributes
    ----------
    inputs : dict of str to float
    outputs : list of Output
    """

    def __init__(self, folder: Path) -> None:
        self.study = read_study(folder / MODEL)
        self.outputs = [Output(**given) for given in json.loads((folder / OUTPUTS).read_text("utf-8"))]
        self.inputs = {name: item.value for name, item in self.study.model.inputs.items()}
        self._run: Stepper | None = None
        self._start, self._done = 0.0, 0
        self._placed = self._begun = False  # whether its first time is known, and it does not start anew

    def place(self, time: float) -> None:
        """Tell the time of the other program at which it begins."""
        self._start, self._placed = time, True

    def begin(self) -> None:
        """Let the start be what it is now: inputs that are given from now on hold from the next step on."""
        self._begun = self.run is not None

    @property
    def run(self) -> Stepper:
        """The run, which begins now if it has not."""
        if self._run is None:
            self._run = begun(self.study, self.inputs)
        return self._run

    def give(self, name: str, value: float) -> None:
        """Give an input; a step refuses one that is no finite number."""
        if self.inputs[name] != value and not self._begun:
            self._run = None
        self.inputs[name] = value
        if self._run is not None and math.isfinite(value):
            self._run.inputs[name] = value

    def said(self, name: str) -> str:
        """What the model file says of an input, or that it is one."""
        return self.study.model.inputs[name].description or f'input "{name}" of the model'

    def value(self, output: Output) -> float:
        """What an output is now."""
        return output.value(self.run)

    def advance(self, time: float, interval: float) -> None:
        """Go on from a time by an interval of communication, s.

        Raises
        ------
        ModelError
            The interval is no multiple of the model's step, the time is not where the run is, or an input is
            no finite number.
        SolveError
            A step failed.
        """
        step = settings_of(self.study).step
        checks.number(time, "do_step.time")
        checks.number(interval, "do_step.interval")
        for name, value in self.inputs.items():
            checks.number(value, f'input "{name}"')
        if not (self._placed or self._done):
            self._start = time
        ratio = (time - self._start) / step
        if abs(ratio - self._done) > max(FITS * abs(ratio), 0.01):
            now = self._start + self._done * step
            raise ModelError("do_step.time", f"is {time:.9g} s, the run is at {now:.9g} s")
        last = round((time + interval - self._start) / step)
        if last <= self._done or abs((time + interval - self._start) / step - last) > 0.01:
            what = f"is {interval:g} s, must be a multiple of the model's step of {step:g} s"
            raise ModelError("do_step.interval", what, "change the communication step, or simulation.step")
        self.begin()
        self.run.advance(last - self._done)
        self._done = last

    def state(self) -> Kept:
        """All that decides how it goes on, for :meth:`restore`."""
        run = None if self._run is None else self._run.snapshot()
        return Kept(dict(self.inputs), self._start, self._done, run, self._placed, self._begun)

    def restore(self, kept: Kept) -> None:
        """Be as when a state was taken, of this motion or of one of the same unit in another process.

        Raises
        ------
        ModelError
            The state is of another unit.
        """
        if kept.inputs.keys() != self.inputs.keys():
            raise ModelError("state", f"is of a unit with the inputs {', '.join(kept.inputs) or 'none'}")
        if kept.run is None:
            self._run = None
        elif self._run is None:
            settings = settings_of(self.study)
            self._run = gone_on_from(self.study.model, kept.run, settings.integrator, settings.step)
        else:
            self._run.restore(kept.run)
        self.inputs = dict(kept.inputs)
        self._start, self._done = kept.start, kept.done
        self._placed, self._begun = kept.placed, kept.begun


@dataclass(frozen=True)
class Kept:
    """State of a motion.

    Parameters
    ----------
    inputs : dict of str to float
    start : float, s
        Time of the other program at which the run began.
    done : int
        Steps since then.
    run : Checkpoint or None
        None: it has not begun.
    placed, begun : bool
        Whether it was told its first time, and does not start anew.
    """

    inputs: dict[str, float]
    start: float
    done: int
    run: Checkpoint | None
    placed: bool = False
    begun: bool = True

    def to_bytes(self) -> bytes:
        """The state as bytes: a line of JSON, and the snapshot of the run."""
        head = {name: getattr(self, name) for name in ("inputs", "start", "done", "placed", "begun")}
        return json.dumps(head).encode() + b"\n" + (b"" if self.run is None else to_bytes(self.run))

    @classmethod
    def from_bytes(cls, data: bytes) -> Kept:
        """The state that :meth:`to_bytes` wrote.

        Raises
        ------
        ModelError
            The bytes are not all of one.
        """
        try:
            head, _, rest = bytes(data).partition(b"\n")
            made = cls(**json.loads(head), run=from_bytes(rest) if rest else None)
        except (TypeError, ValueError) as error:
            raise ModelError("state", f"is none of this package: {error}") from None
        if rest and made.run is None:
            raise ModelError("state", "is not whole", "take it again")
        return made


def settings_of(study: Study) -> SimulationSettings:
    """The simulation of a study.

    Raises
    ------
    ModelError
        It has none.
    """
    if study.simulation is None:
        hint = "add a table [simulation] with t_end, step and sensors"
        raise ModelError("simulation", "is missing: a unit of co-simulation needs a step", hint)
    return study.simulation


def begun(study: Study, inputs: dict[str, float], sensors: tuple[str, ...] = ()) -> Stepper:
    """A stepper from the start that a model file asks for, with these inputs."""
    settings, model = settings_of(study), study.model
    if any(model.inputs[name].value != value for name, value in inputs.items()):
        given = [{**model.inputs[name].described(), "value": value} for name, value in inputs.items()]
        model = Model.from_dict({**model.to_dict(), "inputs": given})
    start = None
    if settings.start == "equilibrium":
        steps = study.equilibrium.load_steps if study.equilibrium else 1
        start = equilibrium(model, of=settings.equilibrium_of, load_steps=steps)
    return stepper(
        model,
        step=settings.step,
        start=start,
        integrator=settings.integrator,
        sensors=sensors or None,
        energy=False,
    )
