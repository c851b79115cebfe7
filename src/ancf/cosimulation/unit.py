"""A unit of co-simulation (FMU, FMI 2.0 or 3.0) of another program as the controller of a run."""

from __future__ import annotations

import base64
import shutil
import tempfile
import weakref
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple, cast

from ..errors import ModelError
from ..model import checks
from ..model.settings import FITS

EXTRA = "pip install 'ancf[fmu]'"
WHERE = "FmuController"
#: Kinds of variables that hold a real number, by the version of FMI.
NUMBERS = {"2.0": ("Real",), "3.0": ("Float64",)}

Question = Callable[[Any], Any]


class FmuController:
    """A unit that is given what the run is, takes its step, and leads the run by what it then is.

    For the `controller` of :func:`ancf.simulate`, :func:`ancf.resume` and :func:`ancf.catenary.run`, which
    ask it every `step`. At the time t of the run the unit gets its inputs as they are at t and goes on to
    t + step; what it gives there leads the run until t + step. So the unit is never behind the run, and
    the run feels its force within the same step, with the trapezoidal rule as a ramp; the unit itself knows
    no more of the run's motion within the step than its inputs say, which is why a unit with stiff springs
    wants the rates as well.

    Parameters
    ----------
    path : path
        The unit, a file that ends in ``.fmu``; it must be able to do co-simulation on this machine.
    step : float, s
        Of the exchange: the `control_step` of the run.
    inputs : mapping of str to callable
        By the name of an input of the unit, a function of the run (:class:`ancf.State` with ``t`` and
        ``inputs``) that returns a number.
    outputs : mapping of str to str
        By the name of an input of the run, the output of the unit that it follows.
    parameters : mapping of str to float, optional
        Numbers of the unit that are set before it starts.
    restart : bool
        Whether a resumed run may start the unit anew where it is, if the unit cannot give its state.

    Raises
    ------
    ModelError
        FMPy is not installed; the file is no such unit; a name is not one of its variables.

    Notes
    -----
    A run that begins anew, also from another state, starts the unit anew. A resumed one brings it to where it
    was, if its description says that its state can be written and read (``canGetAndSetFMUState`` and
    ``canSerializeFMUState``). FMI: Functional Mock-up Interface 2.0.4 and 3.0.1, Modelica Association.
    """

    def __init__(
        self,
        path: str | Path,
        *,
        step: float,
        inputs: Mapping[str, Question],
        outputs: Mapping[str, str],
        parameters: Mapping[str, float] | None = None,
        restart: bool = False,
    ) -> None:
        self.path, self.step = checks.path(path, f"{WHERE}.path"), checks.positive(step, f"{WHERE}.step")
        self.restart = checks.flag(restart, f"{WHERE}.restart")
        self.folder = tempfile.mkdtemp(prefix="ancf-")
        self._end = weakref.finalize(self, shutil.rmtree, self.folder, True)
        self._about = _read(self.path, self.folder)
        self._asks = [(_reference(self._about, n, "input"), n, _question(n, f)) for n, f in inputs.items()]
        self._gives = [(name, _reference(self._about, n, "output")) for name, n in outputs.items()]
        given = {} if parameters is None else parameters
        where = f"{WHERE}.parameters"
        self._set = [
            (_reference(self._about, n, "parameter"), checks.number(x, f"{where}[{n!r}]"))
            for n, x in given.items()
        ]
        self._unit: _Instance | None = None
        self._t = 0.0
        self._begun: tuple[float, list[tuple[int, float]]] = (0.0, [])

    @property
    def __name__(self) -> str:
        """What results say of their controller."""
        return f"unit {self.path.name}"

    def __call__(self, run: Any) -> None:
        """Take the unit's step from the time of the run, and lead the run by what it gives.

        Raises
        ------
        ModelError
            The unit refuses a step, gives no number, or is asked at other times than every `step`.
        """
        t = float(run.t)
        values = [(at, checks.number(f(run), f"{WHERE}.inputs[{n!r}]")) for at, n, f in self._asks]
        if self._unit is None or t < self._t - FITS * self.step:
            self._begin(t, values)
        unit = self._unit
        assert unit is not None
        if abs(t - self._t) > FITS * self.step:
            what = f"is {self.step:g} s, but the run asks at t = {t:.6g} s after {self._t - self.step:.6g} s"
            raise ModelError(f"{WHERE}.step", what, "give the run the same control_step")
        self._do(t, "its inputs", unit.give, values)
        self._do(t, "a step", unit.go, t, self.step)
        found = self._do(t, "its outputs", unit.ask, [at for _, at in self._gives])
        for (name, _), value in zip(self._gives, found, strict=True):
            run.inputs[name] = checks.number(value, f"{WHERE}.outputs[{name!r}] at t = {t + self.step:.6g} s")
        self._t = t + self.step

    def state(self) -> dict[str, Any]:
        """What the unit remembers, for the checkpoint of a run: its state as text, if it can give that.

        Raises
        ------
        ModelError
            The unit refuses.
        """
        if self._unit is None:
            return {}
        kept = {"t": self._t, "begun": list(self._begun)}
        if not self._about.keeps_state:
            return kept
        found = self._do(self._t, "to give its state", self._unit.state)
        return kept | {"unit": base64.b64encode(found).decode("ascii")}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Bring the unit to where it was, from what :meth:`state` gave.

        Raises
        ------
        ModelError
            The unit refuses, or cannot give its state and must not start anew.
        """
        if state and "unit" in state and self._about.keeps_state:
            start, values = state["begun"]
            self._begin(start, [(int(at), value) for at, value in values])
            assert self._unit is not None
            self._do(state["t"], "its state", self._unit.restore, base64.b64decode(state["unit"]))
            self._t = state["t"]
            return
        self._drop()
        if state and not self.restart:
            what = "cannot give its state (canSerializeFMUState): a resumed run would not be the same"
            hint = f"compute the run anew, or {WHERE}(..., restart=True) starts the unit anew at this time"
            raise ModelError(str(self.path), what, hint)

    def _begin(self, t: float, values: list[tuple[int, float]]) -> None:
        self._drop()
        self._unit = self._do(t, "a start", _Instance, self._about, self.folder)
        self._do(t, "a start", self._unit.begin, t, [*self._set, *values])
        self._begun, self._t = (t, values), t

    def _drop(self) -> None:
        if self._unit is not None:
            self._unit.end()
        self._unit = None

    def _do(self, t: float, what: str, function: Callable[..., Any], *arguments: Any) -> Any:
        """Call the unit; what it says against it is one message."""
        try:
            return function(*arguments)
        except Exception as error:  # FMPy raises plain ones
            raise ModelError(str(self.path), f"refuses {what} at t = {t:.6g} s: {error}") from error

    def close(self) -> None:
        """End the unit and remove what was unpacked; done by itself when the controller is forgotten."""
        self._drop()
        self._end()


class _About(NamedTuple):
    version: str  # "2.0" or "3.0"
    description: Any  # of FMPy

    @property
    def keeps_state(self) -> bool:
        """Whether the state of the unit can be written and read."""
        can = self.description.coSimulation
        return bool(can.canGetAndSetFMUstate and can.canSerializeFMUstate)


class _Instance:
    """A unit that runs, whatever the version of FMI."""

    def __init__(self, about: _About, folder: str) -> None:
        from fmpy.simulation import instantiate_fmu

        self.version = about.version
        self.slave: Any = instantiate_fmu(folder, about.description, "CoSimulation")

    def begin(self, t: float, values: list[tuple[int, float]]) -> None:
        """Set parameters and inputs while the unit starts at a time."""
        if self.version == "2.0":
            self.slave.setupExperiment(startTime=t)
            self.slave.enterInitializationMode()
        else:
            self.slave.enterInitializationMode(startTime=t)
        self.give(values)
        self.slave.exitInitializationMode()

    def give(self, values: list[tuple[int, float]]) -> None:
        """Set numbers by their references."""
        if values:
            write = self.slave.setReal if self.version == "2.0" else self.slave.setFloat64
            write([at for at, _ in values], [value for _, value in values])

    def ask(self, references: list[int]) -> list[float]:
        """Numbers by their references."""
        if not references:
            return []
        read = self.slave.getReal if self.version == "2.0" else self.slave.getFloat64
        return [float(value) for value in read(references)]

    def go(self, t: float, step: float) -> None:
        """Take a step."""
        told = self.slave.doStep(t, step)
        if told is not None and told[1]:
            raise RuntimeError("it has ended")

    def state(self) -> bytes:
        """What it remembers."""
        state = self.slave.getFMUState()
        try:
            return bytes(self.slave.serializeFMUState(state))
        finally:
            self.slave.freeFMUState(state)

    def restore(self, kept: bytes) -> None:
        """Make it remember what it did."""
        state = self.slave.deserializeFMUState(kept)
        try:
            self.slave.setFMUState(state)
        finally:
            self.slave.freeFMUState(state)

    def end(self) -> None:
        """Free it."""
        self.slave.terminate()
        self.slave.freeInstance()


def _read(path: Path, folder: str) -> _About:
    """Unpack a unit and read what it describes."""
    try:
        import fmpy
    except ImportError:
        raise ModelError(WHERE, "FMPy is not installed, which runs units of co-simulation", EXTRA) from None
    if not path.is_file():
        raise ModelError(str(path), "there is no such file")
    try:
        fmpy.extract(str(path), folder)
        description = fmpy.read_model_description(folder, validate=False)
    except Exception as error:  # of zip, of XML, of FMPy
        raise ModelError(str(path), f"is no unit of co-simulation: {error}") from error
    version = ".".join(description.fmiVersion.split(".")[:2])
    if version not in NUMBERS:
        raise ModelError(str(path), f"is of FMI {description.fmiVersion}, must be of 2.0 or 3.0")
    if description.coSimulation is None:
        raise ModelError(str(path), "is for model exchange alone", "export it for co-simulation")
    return _About(version, description)


def _question(name: str, given: Any) -> Question:
    hint = 'such as lambda run: run.position("head")[2]'
    checks.function(given, f"{WHERE}.inputs[{name!r}]", "the run", hint)
    return cast(Question, given)


def _reference(about: _About, name: str, causality: str) -> int:
    """Reference of a variable of a unit by its name."""
    known = {v.name: v for v in about.description.modelVariables if v.type in NUMBERS[about.version]}
    fits = [n for n, v in known.items() if v.causality == causality and not v.dimensions]
    checks.choice(name, f"{WHERE}.{causality}s", fits)
    return int(known[name].valueReference)
