"""A computation that checks itself: again with half the step, and with twice the elements."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from .analysis import equilibrium, simulate, stable_step
from .arrays import FloatArray
from .errors import ModelError, SolveError
from .model import checks
from .model.bodies.beam import Beam
from .model.integrators import Explicit, Integrator, Radau, Trapezoidal
from .model.model import Model
from .model.refine import refined
from .model.tables import Readable, Sheet, Table, number
from .results.overview import shown_points
from .results.result import Result
from .results.state import State
from .results.tension import cables, extremes, middles
from .viz.export.tables import sensor_columns

__all__ = ["Change", "Verification", "repeated", "verify"]

Answer = Result | State
#: Computes a model again: the model, the step (None: an equilibrium) and the integrator.
Repeat = Callable[[Model, float | None, Integrator], Answer]
#: Order in the length of the elements that is counted on: positions have 4, forces 2.
MESH_ORDER = 2
ENERGIES = ("kinetic", "strain", "potential", "dissipated", "supplied")


@dataclass(frozen=True)
class Change:
    """How one output changes.

    Parameters
    ----------
    output, unit : str
    value : float
        As computed; of a history its largest size.
    half_step, twice_elements : float or None
        Change with half the step, and with twice the elements; of a history the largest at any
        time. None where there is no step.
    error : float
        Estimated error of the value after Richardson: for a method of order p a change d leaves
        d 2^p/(2^p - 1), and both parts are added.
    """

    output: str
    unit: str
    value: float
    half_step: float | None
    twice_elements: float
    error: float


@dataclass(frozen=True)
class Verification(Readable):
    """What :func:`ancf.verify` found; ``print`` shows the table.

    Parameters
    ----------
    result : Result or State
        The computation as it was asked for.
    changes : tuple of Change
    runs : tuple of dict
        ``what``, ``elements``, ``step`` s, ``steps`` and ``cpu_seconds`` of each computation.
    """

    result: Answer
    changes: tuple[Change, ...]
    runs: tuple[dict[str, Any], ...]

    def __repr__(self) -> str:
        return f"Verification({len(self.changes)} outputs, {len(self.runs)} runs)"

    def __getitem__(self, output: str) -> Change:
        found = {change.output: change for change in self.changes}
        if output not in found:
            raise ModelError("Verification", f'has no output "{output}"', checks.nearest(output, list(found)))
        return found[output]

    def as_dict(self) -> dict[str, Any]:
        """Runs and changes, plain values by name."""
        return {"runs": [*self.runs], "changes": [asdict(change) for change in self.changes]}

    def _sheet(self) -> Sheet:
        runs = [(run["what"], _described(run)) for run in self.runs]
        return Sheet("Verification", runs, [Table(COLUMNS, self.rows(), 60)])

    def rows(self) -> list[tuple[str, ...]]:
        """Cells of the table under COLUMNS."""
        return [_row(change) for change in self.changes]


COLUMNS = ("output", "unit", "value", "half the step", "twice the elements", "estimated error")


def verify(
    model: Model,
    *,
    t_end: float | None = None,
    step: float | None = None,
    start: Any = None,
    integrator: Integrator | None = None,
    output_step: float | None = None,
    sensors: Sequence[Any] | None = None,
    outputs: Sequence[Any] | None = None,
) -> Verification:
    """Compute, then again with half the step and with elements of half the length, and compare.

    Without ``t_end`` it is the equilibrium, which has no step. All takes about five times as long as once.

    Parameters
    ----------
    model : Model
    t_end, step, integrator, output_step, sensors
        As for :func:`ancf.simulate`.
    start : callable, optional
        Finds the start of a model, for each mesh: ``ancf.equilibrium``; default the initial shape.
    outputs : sequence of points or their names, optional
        Points whose place at the end is compared; default those of the first four bodies.

    Raises
    ------
    ModelError
        As :func:`ancf.simulate`; or the start is a state, which belongs to one mesh.
    SolveError
        A computation failed; a note of the error says which.
    """
    if start is not None:
        hint = "give start=ancf.equilibrium, or a function that finds a State of the model it is given"
        checks.function(start, "verify.start", "the model", hint)
    if (t_end is None) != (step is None):
        missing = "step" if step is None else "t_end"
        raise ModelError(
            f"verify.{missing}", "is missing", "give t_end and step, or none for the equilibrium"
        )
    points = None
    if outputs is not None:
        points = [str(model.point(item)) for item in checks.items(outputs, "verify.outputs", "of points")]
    listed = () if sensors is None else checks.items(sensors, "verify.sensors", "as of ancf.simulate")
    names = [_name(model.sensor(item, f"verify.sensors[{k}]")) for k, item in enumerate(listed)]

    def repeat(again: Model, size: float | None, method: Integrator) -> Answer:
        if t_end is None or step is None or size is None:
            return equilibrium(again)
        begin = None if start is None else start(again)
        every = step if output_step is None else output_step
        return simulate(
            again,
            t_end=t_end,
            step=size,
            start=begin,
            integrator=method,
            output_step=every,
            sensors=names or None,
        )

    method = Trapezoidal() if integrator is None else integrator
    return repeated(model, repeat(model, step, method), repeat, step, method, points)


def repeated(
    model: Model,
    first: Answer,
    repeat: Repeat,
    step: float | None,
    integrator: Integrator,
    outputs: Sequence[str] | None = None,
) -> Verification:
    """Compare a computation with two finer ones; `repeat` makes them as the first one was made."""
    labels = [str(p) for p in shown_points(model)] if outputs is None else outputs
    given = [one for one in _outputs(first, model, labels, 1) if not np.isposinf(one.values).any()]
    runs = [_run("as given", first, model, step)]

    def changes(what: str, finer: Model, size: float | None, method: Integrator) -> list[float]:
        try:
            answer = repeat(finer, size, method)
        except SolveError as error:
            error.add_note(f"when it was computed again with {what}, to verify it")
            raise
        runs.append(_run(what, answer, finer, size))
        new = {output.name: output for output in _outputs(answer, model, labels, 1 if finer is model else 2)}
        return [output.change(new[output.name]) for output in given]

    by_step = None if step is None else changes("half the step", model, step / 2, _halved(integrator))
    finer = refined(model)
    by_mesh = changes("twice the elements", finer, _stable(finer, step, integrator), integrator)
    found = [
        _changed(output, None if by_step is None else by_step[k], by_mesh[k], _order(integrator))
        for k, output in enumerate(given)
    ]
    return Verification(first, tuple(found), tuple(runs))


def _changed(output: _Output, by_step: float | None, by_mesh: float, order: int) -> Change:
    error = _left(MESH_ORDER) * by_mesh + (0.0 if by_step is None else _left(order) * by_step)
    largest = float(output.values[np.argmax(np.abs(output.values))])
    return Change(output.name, output.unit, largest, by_step, by_mesh, error)


def _left(order: int) -> float:
    return 2.0**order / (2.0**order - 1.0)


def _order(method: Integrator) -> int:
    """Order that is counted on: 2, of Radau the order of its stages, which joints and contacts leave."""
    return method.stages if isinstance(method, Radau) else 2


def _halved(method: Integrator) -> Integrator:
    """The method for half the step: one that chooses its steps gets the tolerance that halves them."""
    if not isinstance(method, Radau) or not method.adaptive:
        return method
    tolerance = max(method.tolerance / 2 ** (method.stages + 1), 1e-12)
    longest = None if method.max_step is None else method.max_step / 2
    shortest = None if method.min_step is None else method.min_step / 2
    return replace(method, tolerance=tolerance, max_step=longest, min_step=shortest)


def _stable(finer: Model, step: float | None, method: Integrator) -> float | None:
    """Step for the finer mesh: an explicit method needs a shorter one there."""
    if step is None or not isinstance(method, Explicit):
        return step
    limit = stable_step(finer, safety=0.9 * method.safety)
    while step > limit:
        step /= 2
    return step


class _Output(NamedTuple):
    """An output: one value, or a history with its times."""

    name: str
    unit: str
    values: FloatArray
    times: FloatArray | None = None

    def change(self, new: _Output) -> float:
        """Largest change, at the times of this one; a gap to what is not near is endless and has none."""
        values, endless = new.values, np.isposinf(new.values)
        if self.times is not None and new.times is not None:
            values = np.interp(self.times, new.times, np.where(endless, 0.0, values))
            endless = np.interp(self.times, new.times, endless) > 0.0
        return float(np.max(np.abs(values - self.values)[~endless], initial=0.0))


def _outputs(known: Answer, model: Model, labels: Sequence[str], parts: int) -> Iterator[_Output]:
    """All that is compared."""
    at = f"at t = {known.t[-1]:.6g} s" if isinstance(known, Result) else "at rest"
    for label in labels:
        place = np.atleast_2d(known.position(label))[-1]
        yield from (_Output(f"{label} {axis} {at}", "m", place[k : k + 1]) for k, axis in enumerate("xyz"))
    for name, ends in _tensions(known, model, parts).items():
        for text, value in zip(("smallest", "largest"), ends, strict=True):
            yield _Output(f"{name} {text} tension", "N", np.array([value]))
    for name, value in _energies(known).items():
        yield _Output(f"{name} energy {at}", "J", np.array([value]))
    for item in model.connections:
        if item.name in known.joints:
            force = np.linalg.norm(np.atleast_2d(known.joint_force(item)), axis=1)
            yield _Output(f"{item.name} largest force", "N", force.max(keepdims=True))
    if isinstance(known, Result) and known.provenance["settings"].get("sensors"):
        (_, times), *columns = sensor_columns(known.sensors, inside=False)
        for name, values in columns:
            label, _, unit = name.rpartition(" [")
            yield _Output(label, unit.rstrip("]"), np.asarray(values), times)


def _tensions(known: Answer, model: Model, parts: int) -> dict[str, tuple[float, float]]:
    """Extremes of the force in the middles of the elements of the coarse mesh, over the stored times."""
    found = extremes(known, cables(known), parts)
    for beam in model.beams.values():
        if beam.has_section:
            values = [known.tension(beam.at(x)) for x in middles(beam)]
            found[beam.name] = float(np.min(values)), float(np.max(values))
    return {name: found[name] for name in model.beams}


def _energies(known: Answer) -> dict[str, float]:
    if isinstance(known, State):
        return {name: float(getattr(known.energy, name)) for name in ("strain", "potential")}
    energy, work = known._end_energies()
    return dict(zip(ENERGIES, [*energy[-1].tolist(), *work[-1].tolist()], strict=True))


def _run(what: str, answer: Answer, model: Model, step: float | None) -> dict[str, Any]:
    elements = sum(body.elements for body in model.bodies.values() if isinstance(body, Beam))
    cost = {"steps": answer.stats.steps, "cpu_seconds": answer.stats.cpu_seconds}
    return {"what": what, "elements": elements, "step": step, **cost}


def _described(run: dict[str, Any]) -> str:
    steps = "" if run["step"] is None else f", {run['steps']} steps of {run['step']:g} s"
    return f"{run['elements']} elements{steps}, {run['cpu_seconds']:.3g} s CPU"


def _row(change: Change) -> tuple[str, ...]:
    step = "" if change.half_step is None else f"{change.half_step:.2g}"
    sizes = step, f"{change.twice_elements:.2g}", f"{change.error:.2g}"
    return change.output, change.unit, number(change.value), *sizes


def _name(item: Any) -> str:
    return str(getattr(item, "name", item))
