"""Outputs of a linear model: formulas of what a state answers, and their derivatives by states and inputs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..model import checks
from ..model.model import Model
from ..results import moments
from ..results.state import State
from ..sensitivity.answers import MOVED, Face, derivative, is_linear
from ..solvers.modes.linear import Directions
from ..system.reactions import held_part, support_name
from ..system.sensors import turning
from ..viz.pictures.questions import POINT, QUANTITIES, ask
from ..viz.style import UNITS
from .backwards import gradient_of
from .cases import sensor_of
from .formulas import Formula, Vocabulary
from .units import unit_of_formula

WHERE = "linearise.outputs"
#: Quantities that have no linear part, and why.
UNKNOWN = {
    "speed": "at rest it is the size of what is zero: ask for components, velocity(...)[0]",
    "friction_force": "friction depends on the way",
    "slipping": "friction depends on the way",
}
#: What a state is asked for beside what is drawn, with its unit.
ACCELERATION = "acceleration"
OF_STATE = Vocabulary((), (*QUANTITIES, ACCELERATION))
#: Those that follow from accelerations.
BY_INERTIA = (ACCELERATION, "reaction", "reaction_moment")
#: By which ratio the bend of a smooth quantity falls at least with half the step, and which share of the
#: largest slope is a kink.
FALLS, KINK = 1.4, 1e-4
#: Share of the largest entry that is nothing.
NOTHING = 1e-11

Pair = tuple[str, str]


def formulas_of(model: Model, outputs: Any) -> dict[str, Formula]:
    """Outputs as they were given, by name.

    Raises
    ------
    ModelError
        They are no formulas, or ask for what there is not.
    """
    hint = 'such as outputs=["position(load)[0]", "tension(rope.start)"]'
    if isinstance(outputs, str) or not isinstance(outputs, Mapping | Sequence):
        raise ModelError(WHERE, f"must be a list of formulas or a dict, is {checks.shown(outputs)}", hint)
    named = outputs.items() if isinstance(outputs, Mapping) else ((text, text) for text in outputs)
    found: dict[str, Formula] = {}
    for name, given in named:
        where = f"{WHERE}[{len(found)}]" if not isinstance(outputs, Mapping) else f'{WHERE}["{name}"]'
        if not isinstance(given, str):
            raise ModelError(where, f"must be a formula, is {checks.shown(given)}", hint)
        formula = Formula(given, where, OF_STATE)
        for quantity, item in formula.asked:
            if quantity in UNKNOWN:
                raise ModelError(where, f"{quantity}({item}) has no linear part", UNKNOWN[quantity])
            nouns = (POINT,) if quantity == ACCELERATION else QUANTITIES[quantity].nouns
            sensor_of(model, quantity, item, where, nouns)
        if name in found:
            raise ModelError(where, f'"{name}" is an output already')
        found[checks.text(name, where)] = formula
    return found


def unit_of(formula: Formula) -> str:
    """Unit of a formula, "" where it does not tell."""
    return unit_of_formula(formula.text, {ACCELERATION: "m/s^2"} | UNITS) or ""


class _Found:
    """Answers that are there already, as formulas ask for them."""

    def __init__(self, found: dict[Pair, FloatArray]) -> None:
        self.found = found

    def value(self, name: str) -> Any:
        """There are no names in these formulas."""
        raise ModelError(WHERE, f'"{name}" is not known here')

    def ask(self, quantity: str, item: str) -> Any:
        """An answer."""
        return self.found[quantity, item]


class Outputs:
    """Values of formulas in an equilibrium and their slopes.

    Parameters
    ----------
    state : State
        The equilibrium.
    directions : Directions
    """

    def __init__(self, state: State, directions: Directions) -> None:
        self.state, self.system, self.to = state, state.system, directions
        self.kept: dict[Pair, tuple[FloatArray, FloatArray]] = {}

    def of(self, formulas: Sequence[Formula]) -> tuple[FloatArray, FloatArray]:
        """Values (outputs,) and slopes by states, inputs and rates of inputs, (outputs, states + 2 inputs).

        Raises
        ------
        ModelError
            A formula gives no number, or has a kink here.
        """
        values, slopes = np.zeros(len(formulas)), np.zeros((len(formulas), len(self.to.q)))
        for k, formula in enumerate(formulas):
            for pair in dict.fromkeys(formula.asked):
                if pair not in self.kept:
                    self.kept[pair] = self._answer(*pair, formula.where)
            found = {pair: self.kept[pair][0] for pair in formula.asked}
            values[k], by = gradient_of(formula, _Found(found))
            for pair, slope in by.items():
                along = self.kept[pair][1]
                slopes[k] += along.reshape(len(along), -1) @ np.ravel(slope)
                self._check_smooth(formula, found, pair)
        return values, slopes

    def _check_smooth(self, formula: Formula, found: dict[Pair, FloatArray], pair: Pair) -> None:
        """Raise ModelError if a formula has a kink where an answer moves most, as the size of zero."""
        along = self.kept[pair][1]
        size = np.max(np.abs(along).reshape(len(along), -1), axis=1)
        way = along[int(np.argmax(size))] / max(float(np.max(size)), 1e-300)
        step = 1e-4 * max(float(np.max(np.abs(found[pair]))), 1.0)

        def moved(by: float) -> float:
            return formula(_Found(found | {pair: found[pair] + by * way}))

        here = moved(0.0)
        bends = [abs(moved(by) + moved(-by) - 2.0 * here) / by for by in (step, 0.5 * step)]
        if bends[0] < FALLS * bends[1] and bends[1] * step > 1e-9 * max(abs(here), 1e-3 * step):
            what = f'"{formula.text}" has a kink in this state: it is the size of what is zero'
            raise ModelError(formula.where, what, "ask for a component")

    def _answer(self, quantity: str, item: str, where: str) -> tuple[FloatArray, FloatArray]:
        """An answer and its slopes along all directions, (directions, ...)."""
        if quantity == ACCELERATION:
            probe = self.state._probe(item)
            return np.zeros(3), probe.field(self.to.a)
        if quantity in BY_INERTIA:
            return np.asarray(getattr(self.state, quantity)(item)), self._held(quantity, item)
        here = np.asarray(ask(self.state, quantity, item))

        def question(q: FloatArray, v: FloatArray) -> FloatArray:
            return np.asarray(ask(Face(self.system, q, v, self.state.t, True), quantity, item))

        if is_linear(quantity, self.system):
            return here, question(self.to.q, self.to.v)
        total = np.zeros((len(self.to.q), *here.shape))
        none = np.zeros_like(self.to.q)
        for dq, dv, x in ((self.to.q, none, self.to.q), (none, self.to.v, self.to.v)):
            rows = np.flatnonzero(np.any(x != 0.0, axis=1))
            if len(rows):
                total[rows] += self._along(
                    question, dq[rows], dv[rows], x[rows], f"{quantity}({item})", where
                )
        return here, total

    def _along(
        self,
        question: Callable[[FloatArray, FloatArray], FloatArray],
        dq: FloatArray,
        dv: FloatArray,
        x: FloatArray,
        asked: str,
        where: str,
    ) -> FloatArray:
        """Slopes along directions, (rows, ...), by differences over changes of one size."""
        n = self.system.n
        most = np.max(np.abs(x[:, :n]) * self.system.core.weight, axis=1)
        most = np.where(most > 0.0, most, np.max(np.abs(x), axis=1))
        e = (MOVED / most)[:, None]
        q, v = self.state.q, self.state.v

        def moved(by: float) -> FloatArray:
            return question(q + by * e * dq, v + by * e * dv)

        found, here = derivative(moved, 1.0), moved(0.0)
        bends = [np.abs(moved(by) + moved(-by) - 2.0 * here) / by for by in (1.0, 0.5)]
        steep = max(float(np.max(np.abs(found))), float(np.max(bends[0])))
        if np.any(
            (bends[0] < FALLS * bends[1]) & (bends[1] > KINK * steep) & (bends[1] > 1e-9 * np.abs(here))
        ):
            what = f"{asked} has a kink in this state: it is the size of what is zero, or something slackens"
            raise ModelError(where, what, "ask for a component, or take an equilibrium beside it")
        shape = (len(e),) + (1,) * (found.ndim - 1)
        return np.asarray(found / e.reshape(shape))

    def _held(self, quantity: str, item: str) -> FloatArray:
        """Slopes of reactions and their moments, (directions, 3)."""
        name, forces = support_name(self.system, item), self.to.r
        if quantity == "reaction":
            return np.array([held_part(self.system, name, r) for r in forces])
        support = next(one for one in self.system.model.supports if one.name == name)
        here = self.state._held_forces(name)
        vectors = turning(self.system, support)
        q = np.broadcast_to(self.state.q, forces.shape)
        by_force = moments.turned(q, forces, vectors, vectors)
        by_turn = moments.turned(self.to.q, np.broadcast_to(here, forces.shape), vectors, vectors)
        return np.asarray(by_force + by_turn)


def check_rates(
    slopes: FloatArray, scale: FloatArray, formulas: Sequence[Formula], names: Sequence[str]
) -> None:
    """Raise ModelError if an output depends on the rate of an input that is a speed."""
    for formula, row in zip(formulas, slopes, strict=True):
        for name, entry, most in zip(names, row, scale, strict=True):
            if abs(entry) > NOTHING * most:
                what = f'"{formula.text}" depends on how fast "{name}" changes, which is a speed'
                hint = (
                    "ask for what follows from places and velocities, or give the acceleration as the input"
                )
                raise ModelError(formula.where, what, hint)
