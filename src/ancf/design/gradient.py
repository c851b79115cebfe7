"""``ancf.gradient``: the derivatives of one number of a run or an equilibrium by any number of parameters."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from typing import Any

import numpy as np

from .. import garbage
from ..analysis import equilibrium, simulate
from ..arrays import FloatArray, IntArray
from ..errors import ModelError
from ..model import checks
from ..model.joints.basic import Slide
from ..model.kinds import kind_of
from ..model.model import Model
from ..model.points import Point
from ..model.surfaces.contact import Contact
from ..preparation import method_of, prepared
from ..results.state import State
from ..sensitivity.adjoint import Adjoint, UnsolvedError
from ..sensitivity.adjoint_joints import adjoint_of
from ..sensitivity.answers import Face
from ..sensitivity.objective import Key, is_metered, touched_by
from ..sensitivity.parameters import Parameter, parameters_of
from ..system.sensors import listing
from ..system.system import System
from ..viz.pictures.questions import QUANTITIES, ask
from .backwards import gradient_of
from .cases import check_asked
from .formulas import Formula, Vocabulary

#: What an objective may name.
OF_RUN = Vocabulary(("t",), tuple(QUANTITIES))
WHERE = "gradient.objective"
#: Quantities of runs that have no derivatives, and why.
UNKNOWN = dict.fromkeys(
    ("reaction", "reaction_moment"), "it depends on accelerations, which states do not keep"
)
#: Quantities of sliding joints that depend on the direction of the carrier.
ALONG_CARRIER = "normal_force", "sliding_friction"


def gradient(
    model: Model,
    objective: str,
    parameters: Any,
    *,
    t_end: float | None = None,
    step: float | None = None,
    start: State | None = None,
    integrator: Any = None,
) -> tuple[float, dict[str, float]]:
    """A number of a simulation and its exact derivatives by parameters of the model.

    Without ``t_end`` and ``step`` it is a number of the equilibrium, ``"tension(rope.start)"``, with the
    sensitivities of :func:`ancf.equilibrium`.

    Models of cables, beams, springs, masses, rigid bodies and joints, sliding ones as well, in fluids with
    currents, gusts and waves, with loads of all kinds, on grounds and surfaces, with friction that remembers
    the way, and with contacts of strips and wires, have an adjoint: derivatives by all parameters together
    take about as much as a few runs, and memory that does not grow with their number, nor much with that of
    the steps. Others, with contacts of cables or of bodies with each other, winches, laws that stay in Python
    or clamps that turn with time, or in which a sliding joint opens, closes or reaches an end, take the
    sensitivities of :func:`ancf.simulate`, whose cost grows with the number of parameters, as does what is
    asked of a contact. The numbers are the same.

    Parameters
    ----------
    model : Model
    objective : str
        Formula of the histories of the run, as of a study's outputs, that gives one number:
        ``"integral(norm(velocity(beam.end))**2)"``, ``"last(position(beam.end)[2])"``,
        ``"smoothmax(tension(rope.start), 0.1)"``.
    parameters : sequence of str or mapping
        As ``sensitivities`` of :func:`ancf.simulate`.
    t_end, step, start, integrator
        As of :func:`ancf.simulate`; a start has to know its own derivatives. Without ``t_end`` it is the
        equilibrium that is asked, default that of :func:`ancf.equilibrium`.

    Returns
    -------
    value : float
    slope : dict of str to float
        Derivatives per unit of each parameter.

    Raises
    ------
    ModelError
        The formula, a parameter or a number is wrong.
    SolveError
        The run fails, or a step is cut into parts.
    """
    formula = Formula(checks.text(objective, WHERE), WHERE, OF_RUN)
    check_asked(model, [formula])
    wanted = parameters_of(model, parameters, "gradient.parameters")
    if t_end is None or step is None:
        check_still(t_end, step, integrator, "gradient")
        return _at_rest(model, formula, wanted, start)
    check_has_derivative(formula)
    made = prepared(
        model,
        method=method_of(integrator, "gradient"),
        t_end=t_end,
        step=step,
        start=start,
        output_step=None,
        sensors=None,
        energy=True,
        where="gradient",
    )
    settings = {"t_end": t_end, "step": step, "start": start, "integrator": integrator}
    if not wanted:  # the value alone needs no way back
        result = simulate(model, **settings)
        return slopes_of(formula, np.asarray(result.t), result)[0], {}
    way = adjoint_of(made.system)
    if way is not None and not _asks_contacts(model, formula):
        with suppress(UnsolvedError):  # what it cannot solve, sensitivities may
            return _backward(way, made, formula, wanted, start)
    return _forward(model, formula, wanted, settings)


def check_still(t_end: Any, step: Any, integrator: Any, where: str) -> None:
    """Raise ModelError unless none of what a simulation needs is given: then it is the equilibrium."""
    for name, other in (("step", t_end), ("t_end", step)):
        if other is not None:
            hint = "give t_end and step, or none for the equilibrium"
            raise ModelError(f"{where}.{name}", "is missing", hint)
    if integrator is not None:
        raise ModelError(f"{where}.integrator", "has no effect on an equilibrium", "give t_end and step")


def _at_rest(
    model: Model, formula: Formula, parameters: list[Parameter], start: State | None
) -> tuple[float, dict[str, float]]:
    """Of an equilibrium: a history of one time."""
    state = equilibrium(model, sensitivities=parameters) if start is None else start
    found = {pair: np.asarray(ask(state, *pair))[None] for pair in dict.fromkeys(formula.asked)}
    value, slopes = gradient_of(formula, Histories(np.zeros(1), found))
    made = {}
    for parameter in parameters:
        own = state.sensitivity(parameter.name)
        parts = (np.sum(slope[0] * np.asarray(ask(own, *pair))) for pair, slope in slopes.items())
        made[parameter.name] = float(sum(parts))
    return value, made


def check_has_derivative(formula: Formula) -> None:
    """Raise ModelError if a formula asks for what has no derivative in a run."""
    for quantity, item in formula.asked:
        if quantity in UNKNOWN:
            hint = "take the force of a spring or joint there, or the tension beside it"
            raise ModelError(WHERE, f"{quantity}({item}) has no derivative: {UNKNOWN[quantity]}", hint)


def _asks_contacts(model: Model, formula: Formula) -> bool:
    """Whether a formula asks for numbers of contacts, which depend on all that may touch; not of strips."""
    items = [model.sensor(item) for _, item in formula.asked]
    return any(not isinstance(item, Point | Contact) and "contact" in kind_of(item).word for item in items)


class Histories:
    """Histories that are there already, as formulas ask for them."""

    def __init__(self, t: FloatArray, found: dict[Key, FloatArray]) -> None:
        self.t, self.found = t, found

    def value(self, name: str) -> Any:
        """The times."""
        return self.t

    def ask(self, quantity: str, item: str) -> Any:
        """A history."""
        return self.found[quantity, item]


def slopes_of(formula: Formula, t: FloatArray, source: Any) -> tuple[float, dict[Key, FloatArray]]:
    """Value of a formula and its derivatives by the histories that it asks a source for."""
    found = {pair: np.asarray(ask(source, *pair)) for pair in dict.fromkeys(formula.asked)}
    return gradient_of(formula, Histories(t, found))


def _forward(
    model: Model, formula: Formula, parameters: list[Parameter], settings: dict[str, Any]
) -> tuple[float, dict[str, float]]:
    result = simulate(model, sensitivities=parameters, **settings)
    value, slopes = slopes_of(formula, np.asarray(result.t), result)
    made = {}
    for parameter in parameters:
        own, total = result.sensitivity(parameter.name), 0.0
        for pair, slope in slopes.items():
            total += float(np.sum(slope * own.answer(lambda face, pair=pair: ask(face, *pair))))
        made[parameter.name] = total
    return value, made


def unknowns_of(system: System, pair: Key) -> IntArray:
    """Entries of the state vectors on which a history depends; of a sliding joint its carrier's too."""
    quantity, item = pair[0], system.model.sensor(pair[1])
    if is_metered(system, pair):
        return touched_by(system, pair[1])
    behind = _between(item) if quantity == "twist" else []
    found = [listing(system, [item, *behind], False, ends=True).index]
    if quantity in ALONG_CARRIER and isinstance(item, Slide):
        slides = [one for one in system.model.connections if isinstance(one, Slide)]
        batch, j = system.parts["slides"], slides.index(item)
        slots = np.unique(batch.line_slot[batch.first[j] : batch.first[j + 1]])
        found.append((slots[slots >= 0, None] + np.arange(3)).ravel())
    return np.unique(np.concatenate(found)).astype(np.int64)


def _between(point: Any) -> list[Point]:
    """Points in all elements between the start of a beam, from which it is twisted, and one of its points."""
    x = point.body.node_x
    ends = zip(x[:-1].tolist(), x[1:].tolist(), strict=True)
    return [Point(point.body, 0.5 * (a + b), "") for a, b in ends if a < point.x]


@garbage.without
def _backward(
    way: type[Adjoint], made: Any, formula: Formula, parameters: list[Parameter], start: State | None
) -> tuple[float, dict[str, float]]:
    pairs = list(dict.fromkeys(formula.asked))
    unknowns = {pair: unknowns_of(made.system, pair) for pair in pairs}

    def asked(face: Face, pairs: Iterable[Key]) -> dict[Key, FloatArray]:
        return {pair: np.asarray(ask(face, *pair)) for pair in pairs}

    run = way(made, parameters, start, "gradient")
    run.ask(asked, unknowns)
    t, found = run.forwards()
    value, slopes = gradient_of(formula, Histories(t, found))
    total = run.backwards({pair: slopes[pair] for pair in pairs})
    if not np.all(np.isfinite(total)):
        raise ModelError(WHERE, f'"{formula.text}" has no finite derivative')
    return value, {one.name: float(x) for one, x in zip(parameters, total, strict=True)}
