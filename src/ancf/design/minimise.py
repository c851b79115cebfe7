"""``ancf.minimise``: parameters with which a number of a run or equilibrium is least, by exact gradients."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..model import checks
from ..model.model import Model
from ..model.tables import Readable, Sheet, Table, number
from ..results.state import State
from .calibration_data import bounds_of, start_of
from .gradient import check_still
from .number import Numbers

WHERE = "minimise"


@dataclass(frozen=True)
class Optimum(Readable):
    """What :func:`ancf.minimise` found; ``print`` shows it as tables.

    Parameters
    ----------
    values : dict of str to float
        Parameters.
    objective : float
        The number there.
    slope : dict of str to float
        Its derivatives there; at a bound they need not vanish.
    constraints : dict of str to float
        Numbers of the constraints there, by formula.
    gradients : int
        Runs with gradients that it took, of the objective and of each constraint.
    converged : bool
    message : str
        Of the search.
    """

    values: dict[str, float]
    objective: float
    slope: dict[str, float]
    constraints: dict[str, float]
    gradients: int
    converged: bool
    message: str

    def __repr__(self) -> str:
        found = ", ".join(f"{name}={number(x)}" for name, x in self.values.items())
        return f"Optimum({number(self.objective)} at {found})"

    def _sheet(self) -> Sheet:
        facts = [
            ("objective", number(self.objective)),
            ("search", f"{self.message}; {self.gradients} runs with gradients"),
            ("note", "" if self.converged else "the search stopped before it was done"),
        ]
        rows = [(name, number(x), number(self.slope[name], 3)) for name, x in self.values.items()]
        kept = [(formula, number(x)) for formula, x in self.constraints.items()]
        tables = [Table(("parameter", "value", "derivative"), rows), Table(("constraint", "value"), kept)]
        return Sheet("Optimum", facts, tables)


def minimise(
    model: Model | Callable[..., Model],
    objective: str,
    parameters: Mapping[str, tuple[float, float]],
    *,
    t_end: float | None = None,
    step: float | None = None,
    start: Mapping[str, float] | None = None,
    constraints: Mapping[str, tuple[float | None, float | None]] | None = None,
    begin: Callable[..., State] | None = None,
    integrator: Any = None,
    most: int = 100,
) -> Optimum:
    """Find parameters within bounds with which a number of a simulation is least, or of an equilibrium.

    SciPy's SLSQP with the exact gradients of :func:`ancf.gradient`.

    Parameters
    ----------
    model : Model or callable
        With the parameters as names of its numbers, see :func:`ancf.model.vary.varied`; or
        ``build(**parameters)`` returns the model.
    objective : str
        As of :func:`ancf.gradient`. What shall be greatest takes a minus sign.
    parameters : mapping
        Bounds (low, high) by name.
    t_end, step, integrator
        As of :func:`ancf.simulate`. Without ``t_end`` and ``step`` the numbers are those of the equilibrium.
    start : mapping, optional
        Where to begin, default the middle of the bounds.
    constraints : mapping, optional
        Bounds (low, high) of other numbers by their formulas, None for none.
    begin : function, optional
        ``begin(model, sensitivities=...)`` is the state from which the run starts, such as
        ``ancf.equilibrium``; default the initial shape. Without ``t_end`` that state is what is asked.
    most : int
        Steps of the search at most.

    Returns
    -------
    Optimum

    Raises
    ------
    ModelError
        What is given is wrong.
    SolveError
        A run failed.
    """
    from scipy import optimize

    checks.text(objective, f"{WHERE}.objective")
    if begin is not None:
        checks.function(begin, f"{WHERE}.begin", "a model that finds a state, such as ancf.equilibrium")
    bounds = bounds_of(parameters, WHERE)
    if t_end is None or step is None:
        check_still(t_end, step, integrator, WHERE)
    problem = _Problem(model, bounds, {"t_end": t_end, "step": step, "integrator": integrator}, begin)
    kept = checks.mapping(constraints, f"{WHERE}.constraints", "bounds (low, high) of formulas")
    limits = [_limit(problem, *item) for item in kept.items()]
    search: Any = optimize.minimize
    found = search(
        lambda u: problem.at(objective, u),
        problem.units(start_of(start, bounds, WHERE)),
        jac=True,
        method="SLSQP",
        bounds=[(0.0, 1.0)] * len(bounds),
        constraints=[one for pair in limits for one in pair],
        options={"maxiter": checks.integer(most, f"{WHERE}.most", 1, 100_000), "ftol": 1e-12},
    )
    value, slope = problem.at(objective, found.x)
    scale = problem.widths
    return Optimum(
        values=problem.values(found.x),
        objective=float(value),
        slope=dict(zip(bounds, (slope / scale).tolist(), strict=True)),
        constraints={text: float(problem.at(text, found.x)[0]) for text in kept},
        gradients=problem.gradients,
        converged=bool(found.success),
        message=str(found.message),
    )


class _Problem:
    """Numbers of a run as functions of numbers from 0 to 1."""

    def __init__(
        self, model: Any, bounds: dict[str, tuple[float, float]], settings: dict[str, Any], begin: Any
    ) -> None:
        self.numbers = Numbers(model, list(bounds), settings, begin, WHERE)
        self.bounds = bounds
        self.widths = np.array([high - low for low, high in bounds.values()])
        self.gradients = 0
        self._known: dict[tuple[str, bytes], tuple[float, FloatArray]] = {}

    def values(self, u: FloatArray) -> dict[str, float]:
        """Parameters."""
        pairs = zip(self.bounds.items(), u.tolist(), strict=True)
        return {name: low + (high - low) * x for (name, (low, high)), x in pairs}

    def units(self, values: Mapping[str, float]) -> FloatArray:
        """Numbers from 0 to 1 of parameters."""
        return np.array([(values[name] - low) / (high - low) for name, (low, high) in self.bounds.items()])

    def at(self, text: str, u: FloatArray) -> tuple[float, FloatArray]:
        """A number and its derivatives by u; each is computed once."""
        key = text, np.asarray(u).tobytes()
        if key not in self._known:
            self.gradients += 1
            value, slope = self.numbers.at(text, self.values(np.clip(u, 0.0, 1.0)))
            self._known[key] = value, np.array([slope[name] for name in self.bounds]) * self.widths
        return self._known[key]


def _limit(problem: _Problem, text: str, given: Any) -> Sequence[dict[str, Any]]:
    """What SLSQP wants of a number between two bounds: functions that are not negative."""
    where = f'{WHERE}.constraints["{text}"]'
    if not isinstance(given, tuple | list) or len(given) != 2:
        raise ModelError(where, f"must be a pair (low, high), is {checks.shown(given)}")
    low, high = (None if x is None else checks.number(x, where) for x in given)
    made = []
    for bound, sign in ((low, 1.0), (high, -1.0)):
        if bound is not None:
            made.append(
                {
                    "type": "ineq",
                    "fun": lambda u, b=bound, s=sign: s * (problem.at(text, u)[0] - b),
                    "jac": lambda u, s=sign: s * problem.at(text, u)[1],
                }
            )
    return made
