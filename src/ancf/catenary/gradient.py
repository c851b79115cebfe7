"""The derivatives of one number of a run along a line by the lengths of any number of droppers, backwards."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from .. import garbage
from ..arrays import FloatArray, IntArray
from ..errors import ModelError
from ..model import checks
from ..model.points import Point
from ..preparation import Prepared, prepared
from ..results.result import Result
from ..results.store import MemoryStore
from ..sensitivity.adjoint import Adjoint, UnsolvedError
from ..sensitivity.adjoint_joints import adjoint_of
from ..sensitivity.answers import Face
from ..sensitivity.objective import Key, touched_by
from ..system.sensors import listing
from .answers.passing import check_run as check_pantograph
from .answers.run_data import Run
from .answers.signals import Butterworth, filter_of
from .answers.weights import MM, NUMBERS, Weights, weights_of
from .assemble import Assembled
from .broken import broken_of, labels
from .collectors import Collector
from .derivatives import check_run, slopes
from .forms.mesh import Mesh
from .forms.route_form import AnyForm
from .lines.line import Line
from .plan import Plan
from .ready import STEP, Ready, ready
from .recorded import recorded
from .run import Speed, planned, relaxed, settings_of, simulated
from .twin import second_supports
from .vehicles.pantograph import Pantograph

WHERE = "gradient"
SUPPORT = "support"


def gradient(
    line: Line | AnyForm | Assembled | str | Path,
    objective: str = "deviation",
    droppers: Mapping[str, Sequence[str]] | None = None,
    *,
    speed: Speed,
    pantograph: Pantograph | str | Sequence[Pantograph | str] = "en50318-2002",
    spacing: float | Sequence[float] | None = None,
    start: float | None = None,
    window: tuple[float, float] | None = None,
    until: float | None = None,
    contact: str = "penalty",
    contact_stiffness: float | None = None,
    contact_damping: float = 0.0,
    step: float = STEP,
    mesh: Mesh | None = None,
    integrator: Any = None,
    modify: Callable[[Assembled], Any] | None = None,
    roof: Any = None,
    underside: Any = None,
    broken_droppers: Sequence[str] = (),
    evaluated: int = 0,
    filter: Butterworth | None = None,
) -> tuple[float, dict[str, float]]:
    """A number of a run along a line and its exact derivatives by lengths of droppers.

    They come from one pass back through the run, whose cost hardly grows with the number of droppers: which
    of all droppers of a line matter, and how much their errors do, is asked at once. The derivatives are
    those of :func:`ancf.catenary.run` with ``sensitivities``, which knows those of all numbers, by fewer
    droppers.

    Parameters
    ----------
    line : Line, Form, Overhead, str or path
        As of :func:`ancf.catenary.run`; no route.
    objective : str
        A key of :func:`ancf.catenary.slopes`: "deviation", "mean_force", "maximum", "uplift" and so on.
    droppers : mapping, optional
        By a name the droppers that are made longer alike, ``{"first": ["6-1", "7-1"]}`` (span and number
        from 1); default each dropper on its own, by its label.
    speed, pantograph, spacing, start, window, until, contact, contact_stiffness, contact_damping
        As of :func:`ancf.catenary.run`.
    step, mesh, integrator, modify, roof, underside, broken_droppers
        As there.
    evaluated : int
        The pantograph, from 0.
    filter : Butterworth, optional
        As of :func:`ancf.catenary.statistics`.

    Returns
    -------
    value : float
        N or, of the uplift, mm.
    slope : dict of str to float
        Unit of the value per m of natural length.

    Raises
    ------
    ModelError
        What was given is wrong, or has no derivatives: a route, springs that are relaxed at a height that
        the droppers move, a sliding joint with GGL.
    SolveError
        A step failed.

    See Also
    --------
    ancf.gradient : of any model.
    """
    checks.choice(objective, f"{WHERE}.objective", NUMBERS)
    plan = planned(
        line,
        speed=speed,
        pantograph=pantograph,
        spacing=spacing,
        start=start,
        window=window,
        until=until,
        contact=contact,
        contact_stiffness=contact_stiffness,
        contact_damping=contact_damping,
        step=step,
        mesh=mesh,
        modify=modify,
        roof=roof,
        underside=underside,
        broken_droppers=broken_droppers,
    )
    chosen = filter_of(filter, WHERE)
    wanted = _each(plan, broken_droppers) if droppers is None else droppers
    check_run(plan, wanted, None, integrator)
    plan = relaxed(plan, False)
    begun = ready(plan, active=False, sleeps=False, sensitivities=wanted)
    if not begun.wanted:
        raise ModelError(f"{WHERE}.droppers", "must name a dropper", '{"first": ["6-1"]}, or None for all')
    settings = {**settings_of(begun, integrator), "t_end": plan.duration}

    def weighed(run: Run) -> Weights:
        return weights_of(run, objective, check_pantograph(run, WHERE, evaluated), chosen)

    with suppress(UnsolvedError):  # what it cannot solve, sensitivities may
        found = _backwards(begun, settings, weighed, evaluated)
        if found is not None:
            return found
    run = simulated(plan, integrator, None, sensitivities=wanted)
    own = slopes(run, check_pantograph(run, WHERE, evaluated), chosen)
    return weighed(run).value, {name: numbers[objective] for name, numbers in own.items()}


def _each(plan: Plan, broken: Sequence[str]) -> dict[str, list[str]]:
    """Each dropper of a line on its own, but those that are gone."""
    gone = {*broken, *(broken_of(plan.door.given) if plan.door.given is not None else ())}
    return {label: [label] for label in labels(plan.form.line) if label not in gone}


@garbage.without
def _backwards(
    begun: Ready, settings: dict[str, Any], weighed: Callable[[Run], Weights], evaluated: int
) -> tuple[float, dict[str, float]] | None:
    """The number and its derivatives by parameter, or None where the model has no adjoint."""
    kept = {key: settings[key] for key in ("t_end", "step", "start", "sensors", "energy")}
    made = prepared(
        begun.overhead.model, method=settings["integrator"], **kept, output_step=None, where=WHERE
    )
    way = adjoint_of(made.system)
    if way is None:  # as with sliding joints that only push
        return None
    adjoint = way(made, begun.wanted, settings["start"], WHERE)
    run = recorded(_taken(adjoint, made), begun, {})
    weights = weighed(run)
    asking = _Asking(begun, weights, evaluated, run)
    adjoint.ask(asking, {key: asking.unknowns(made.system, key) for key in asking.weights})
    total = adjoint.backwards(asking.weights) + asking.of_rest()
    if not np.all(np.isfinite(total)):
        raise ModelError(WHERE, "the number has no finite derivative")
    return weights.value, {one.name: float(x) for one, x in zip(begun.wanted, total, strict=True)}


def _taken(adjoint: Adjoint, made: Prepared) -> Result:
    """What the steps of an adjoint record on its way forwards."""
    store = MemoryStore(made.system)
    adjoint.forwards(store)
    store.update(made.run.stats, "complete")
    return Result(store, made.header, made.system)


class _Asking:
    """The histories on which a number of a run depends, as an adjoint asks for them, and their weights."""

    def __init__(self, begun: Ready, weights: Weights, evaluated: int, run: Run) -> None:
        self.begun, self.lifted, self.points = begun, weights.lifted, dict[str, Point]()
        self.weights: dict[Key, FloatArray] = {}
        if weights.lifted is None:
            collector: Collector = begun.collectors[evaluated]
            self.weights = {("contact_force", meter.name): weights.force for meter in collector.meters}
            return
        row, column = weights.lifted
        by = np.zeros((len(run.t), 3))
        by[row, 2] = MM
        self.points = {SUPPORT: self._highest(row, column, run)}
        self.weights = {("position", SUPPORT): by}

    def _highest(self, row: int, column: int, run: Run) -> Point:
        """The support; of twin contact wires that of the one which is higher then."""
        first, second = self.begun.overhead.supports[column], second_supports(self.begun.overhead).get(column)
        if second is None or run.result is None:
            return first
        own = run.result.sensors.position(first)[row, 2] - self.begun.rest.height[column]
        return second if run.uplift[row, column] > own else first

    def __call__(self, face: Face, keys: Iterable[Key]) -> dict[Key, FloatArray]:
        """Histories of the states of a face."""
        return {key: np.asarray(self._ask(face, key)) for key in keys}

    def _ask(self, face: Face, key: Key) -> FloatArray:
        point = self.points.get(key[1])
        return face.contact_force(key[1]) if point is None else face.position(point)

    def unknowns(self, system: Any, key: Key) -> IntArray:
        """Entries of the state vectors on which a history depends."""
        point = self.points.get(key[1])
        return touched_by(system, key[1]) if point is None else listing(system, [point], False).index

    def of_rest(self) -> FloatArray:
        """What parameters do to the height at rest, from which an uplift is measured."""
        wanted = self.begun.wanted
        if self.lifted is None or (alone := self.begun.alone) is None:
            return np.zeros(len(wanted))
        point = self.points[SUPPORT]
        return np.array([-MM * float(alone.sensitivity(one.name).position(point)[2]) for one in wanted])
