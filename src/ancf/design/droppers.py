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
    from ..catenary.mesh import Mesh

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
    """What :func:`shortest` found.

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
        from ..catenary.derivatives import place_of

        self.line, self.parameters, self.settings = line, dict(parameters), dict(settings)
        self.evaluated = self.settings.pop("evaluated", 0)
        self.formulas, self.mesh, self.report = formulas, mesh, report
        self.widths = np.array([p.high - p.low for p in self.parameters.values()])
        self.places = [
            [place_of(line, label, f"parameters.{name}.droppers") for label in p.labels]
            for name, p in self.parameters.items()
        ]
        self.tried: list[Tried] = []
        self._known: dict[bytes, tuple[FloatArray, FloatArray]] = {}
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
        u = np.clip(u, 0.0, 1.0)
        key = u.tobytes()
        if key not in self._known:
            values = self.values(u)
            try:
                numbers, slopes = self._run(values)
            except SolveError as error:
                error.advise("with " + ", ".join(f"{name} = {1e3 * x:.4g} mm" for name, x in values.items()))
                raise
            self._known[key] = numbers, slopes * self.widths
            others = {f.text: float(x) for f, x in zip(self.formulas[1:], numbers[1:], strict=True)}
            self.tried.append(Tried(values, float(numbers[0]), others))
            if self.report is not None:
                self.report(self.tried[-1])
        return self._known[key]

    def _run(self, values: dict[str, float]) -> tuple[FloatArray, FloatArray]:
        from .. import catenary

        line = replace(self.line, dropper_lengths=tuple(self.lengths(values).tolist()))
        wanted = {name: p.labels for name, p in self.parameters.items()}
        done = catenary.run(line, mesh=self.mesh, sensitivities=wanted, **self.settings)
        count = len(done.recordings)
        which = checks.integer(self.evaluated, "run.evaluated", 0, count - 1)
        answers = _Numbers(catenary.statistics(done, which))
        own = catenary.slopes(done, which)
        numbers, rows = [], []
        for formula in self.formulas:
            value, by = gradient_of(formula, answers)
            numbers.append(value)
            each = [sum(float(x) * own[name][NUMBERS[key]] for key, x in by.items()) for name in wanted]
            rows.append(each)
        return np.array(numbers), np.array(rows)


class _Numbers:
    """Statistics of a run by the names of formulas."""

    def __init__(self, found: Any) -> None:
        self.found = found

    def value(self, name: str) -> float:
        """A number."""
        try:
            return float(self.found[NUMBERS[name]].value)
        except KeyError:
            raise ModelError(f"optimise: {name}", "is not to be had of this run") from None

    def ask(self, quantity: str, item: str) -> Any:
        """Nothing is asked of items."""
        raise AssertionError(quantity)


def least(
    runs: LineRuns, limits: Mapping[str, tuple[float | None, float | None]] | None = None, most: int = 30
) -> LineOptimum:
    """Search for the lengths with which the first formula of the runs is least, by SciPy's SLSQP.

    Parameters
    ----------
    runs : LineRuns
        The formulas after the first are those of the limits.
    limits : mapping, optional
        Bounds (low, high) of other numbers by their formulas, None for none.
    most : int
        Steps of the search at most.

    Raises
    ------
    SolveError
        A run failed.
    """
    from scipy import optimize

    start = np.array([(p.start - p.low) / (p.high - p.low) for p in runs.parameters.values()])
    first = abs(float(runs.at(start)[0][0])) or 1.0
    conditions = []
    for k, (low, high) in enumerate((limits or {}).values(), start=1):
        for bound, sign in ((low, 1.0), (high, -1.0)):
            if bound is not None:
                scale = abs(bound) or 1.0
                conditions.append(
                    {
                        "type": "ineq",
                        "fun": lambda u, k=k, b=bound, s=sign / scale: s * (runs.at(u)[0][k] - b),
                        "jac": lambda u, k=k, s=sign / scale: s * runs.at(u)[1][k],
                    }
                )
    search: Any = optimize.minimize
    found = search(
        lambda u: (runs.at(u)[0][0] / first, runs.at(u)[1][0] / first),
        start,
        jac=True,
        method="SLSQP",
        bounds=[(0.0, 1.0)] * len(start),
        constraints=conditions,
        options={"maxiter": most, "ftol": 1e-5},
    )
    numbers, slopes = runs.at(found.x)
    values = runs.values(np.clip(found.x, 0.0, 1.0))
    return LineOptimum(
        lengths=runs.lengths(values),
        values=values,
        slope=dict(zip(values, (slopes[0] / runs.widths).tolist(), strict=True)),
        objective=float(numbers[0]),
        first=runs.tried[0].objective,
        constraints=runs.tried[-1].constraints and dict(zip(limits or {}, numbers[1:].tolist(), strict=True)),
        tried=runs.tried,
        converged=bool(found.success),
        message=str(found.message),
    )
