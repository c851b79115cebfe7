"""Lengths of droppers with which a number of a run along an overhead line is least, by exact gradients."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError, SolveError
from ..model import checks
from .backwards import gradient_of
from .formulas import Formula, Vocabulary
from .lines import HIGHEST, OF_FORCE, SIGMA

if TYPE_CHECKING:
    from ..catenary import Line
    from ..catenary.derivatives import Linearised
    from ..catenary.forms.mesh import Mesh

#: Numbers of a run that have derivatives, by their names in formulas.
NUMBERS = {SIGMA: "deviation", HIGHEST: "uplift", **{key: key for key in OF_FORCE}}
OF_RUN = Vocabulary(tuple(NUMBERS))
WHERE = "optimise"


@dataclass(frozen=True)
class Droppers:
    """Droppers that are made longer alike.

    Parameters
    ----------
    labels : tuple of str
        Such as "6-1", span and number from 1.
    low, high, start : float
        By how much, m.
    """

    labels: tuple[str, ...]
    low: float
    high: float
    start: float = 0.0


@dataclass(frozen=True)
class Tried:
    """One run of a search: parameters in m, its objective and the numbers of the constraints."""

    values: dict[str, float]
    objective: float
    constraints: dict[str, float]


@dataclass(frozen=True)
class LineOptimum:
    """What :func:`ancf.design.descent.least` found.

    Parameters
    ----------
    lengths : (n,)
        Natural lengths of all droppers, m: ``dropper_lengths`` of the line.
    values, slope : dict of str to float
        Changes of length by parameter, m, and the derivatives of the objective there, per m.
    objective, first : float
        The number at the optimum and at the start.
    constraints : dict of str to float
    tried : list of Tried
        All runs with gradients, in their order.
    converged : bool
    message : str
    """

    lengths: FloatArray
    values: dict[str, float]
    slope: dict[str, float]
    objective: float
    first: float
    constraints: dict[str, float]
    tried: list[Tried] = field(repr=False)
    converged: bool
    message: str


class LineRuns:
    """Numbers of a run along a line and their derivatives by lengths of droppers.

    Parameters
    ----------
    line : Line
        Its droppers have their lengths, or those of its design.
    parameters : mapping of str to Droppers
    settings : mapping
        Of the run, as of :func:`ancf.catenary.run`, speed in m/s.
    formulas : sequence of Formula
        The objective first.
    mesh : Mesh, optional
    report : callable, optional
        Called with each :class:`Tried`.

    Raises
    ------
    ModelError
        A dropper is not there, or what is given is wrong.
    """

    def __init__(
        self,
        line: Line,
        parameters: Mapping[str, Droppers],
        settings: Mapping[str, Any],
        formulas: list[Formula],
        mesh: Mesh | None = None,
        report: Callable[[Tried], None] | None = None,
    ) -> None:
        from .. import catenary
        from ..catenary.broken import place_of

        self.line, self.parameters, self.settings = line, dict(parameters), dict(settings)
        self.evaluated = self.settings.pop("evaluated", 0)
        self.formulas, self.mesh, self.report = formulas, mesh, report
        self.widths = np.array([p.high - p.low for p in self.parameters.values()])
        self.places = [
            [place_of(line, label, f"parameters.{name}.droppers") for label in p.labels]
            for name, p in self.parameters.items()
        ]
        self.tried: list[Tried] = []
        self._known: dict[bytes, Linearised] = {}
        self.natural = np.array(catenary.form(line, mesh).dropper_natural)

    def values(self, u: FloatArray) -> dict[str, float]:
        """Changes of length in m, of numbers from 0 to 1."""
        return {
            name: p.low + (p.high - p.low) * float(x)
            for (name, p), x in zip(self.parameters.items(), u, strict=True)
        }

    def lengths(self, values: Mapping[str, float]) -> FloatArray:
        """Natural lengths of all droppers, m."""
        made = self.natural.copy()
        for places, by in zip(self.places, values.values(), strict=True):
            made[places] += by
        return made

    def at(self, u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Numbers by formula, (m,), and their derivatives by u, (m, n); each run is taken once."""
        return self.predicted(u, u)

    def known(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Places (r, n) of all runs, their numbers (r, m) and the derivatives of these, (r, m, n)."""
        places = [np.frombuffer(key) for key in self._known]
        found = [self.at(u) for u in places]
        return np.stack(places), np.stack([x for x, _ in found]), np.stack([slope for _, slope in found])

    def predicted(self, u: FloatArray, near: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What the run with the parameters ``near`` tells of those at u: its force changes linearly."""
        made = self._linearised(np.clip(near, 0.0, 1.0))
        answers = _Numbers(made.at((np.clip(u, 0.0, 1.0) - np.clip(near, 0.0, 1.0)) * self.widths))
        numbers, rows = [], []
        for formula in self.formulas:
            value, by = gradient_of(formula, answers)
            numbers.append(value)
            rows.append(sum(float(x) * answers.found[NUMBERS[key]][1] for key, x in by.items()))
        return np.array(numbers), np.array(rows) * self.widths

    def _linearised(self, u: FloatArray) -> Linearised:
        """The run with parameters from 0 to 1; each is taken once."""
        key = u.tobytes()
        if key not in self._known:
            values = self.values(u)
            try:
                self._known[key] = self._run(values)
            except SolveError as error:
                error.advise("with " + ", ".join(f"{name} = {1e3 * x:.4g} mm" for name, x in values.items()))
                raise
            numbers = self.at(u)[0]
            others = {f.text: float(x) for f, x in zip(self.formulas[1:], numbers[1:], strict=True)}
            self.tried.append(Tried(values, float(numbers[0]), others))
            if self.report is not None:
                self.report(self.tried[-1])
        return self._known[key]

    def _run(self, values: dict[str, float]) -> Linearised:
        from .. import catenary
        from ..catenary.derivatives import Linearised

        line = replace(self.line, dropper_lengths=tuple(self.lengths(values).tolist()))
        wanted = {name: p.labels for name, p in self.parameters.items()}
        done = catenary.run(line, mesh=self.mesh, sensitivities=wanted, **self.settings)
        count = len(done.recordings)
        return Linearised(done, checks.integer(self.evaluated, "run.evaluated", 0, count - 1))


class _Numbers:
    """Statistics of a run, with their derivatives, by the names of formulas."""

    def __init__(self, found: Mapping[str, tuple[float, FloatArray]]) -> None:
        self.found = found

    def value(self, name: str) -> float:
        """A number."""
        try:
            return self.found[NUMBERS[name]][0]
        except KeyError:
            raise ModelError(f"optimise: {name}", "is not to be had of this run") from None

    def ask(self, quantity: str, item: str) -> Any:
        """Nothing is asked of items."""
        raise AssertionError(quantity)
