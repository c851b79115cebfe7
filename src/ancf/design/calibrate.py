"""``ancf.calibrate``: parameters of a model from measured histories, by least squares."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from multiprocessing import get_context
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError, SolveError
from ..model import checks
from ..model.file import Study
from ..model.model import Model
from ..model.settings import SimulationSettings
from ..worker import one_thread
from .calibration_data import TIME, bounds_of, columns_of, is_logarithmic, numbers_of, start_of
from .cases import OF_MODEL, histories
from .fit import Fit
from .formulas import Formula
from .processes import without_script
from .work import packed, unpacked

#: Step of the central differences, in units of the distance of the bounds (or of its logarithm).
STEP = 1e-4
#: Singular values of the derivatives below this part of the largest tell nothing.
NOTHING = 1e-9
#: Residuals of a model that could not be computed, in units of those at the start.
FAILED = 1e3


def calibrate(
    build: Callable[..., Any],
    data: Any,
    parameters: Mapping[str, tuple[float, float]],
    *,
    start: Mapping[str, float] | None = None,
    deviations: Mapping[str, float] | float | None = None,
    step: float | None = None,
    begin: str = "reference",
    integrator: Any = None,
    workers: int = 0,
    most: int = 100,
) -> Fit:
    """Find the parameters with which a model is nearest to measured histories.

    The derivatives are central differences; each takes two runs for every parameter, in parallel if there
    are workers.

    Parameters
    ----------
    build : callable
        ``build(**parameters)`` returns a Model, which is simulated, or numbers (n,) by column of the data.
    data : path, DataFrame or mapping
        A column ``t`` in s, increasing, and measured ones. For a Model their names are formulas of its
        outputs, such as ``position(cable.at(0.5))[2]``. Empty or NaN entries are left out.
    parameters : mapping
        Bounds (low, high) by name. Of positive bounds that differ by more than ten times the logarithm is
        looked for.
    start : mapping, optional
        Where to begin, default the middle of the bounds.
    deviations : float or mapping, optional
        Standard deviation of the noise of the columns, up to a common factor, which the residuals tell;
        default in proportion to the spread of each column.
    step : float, s
        Time step of a Model's simulation, needed for one.
    begin : "reference" or "equilibrium"
        Where a Model starts.
    integrator : integrator
        Of a Model, default the trapezoidal rule.
    workers : int
        Processes for the derivatives; 0: in this one.
    most : int
        Steps of the search at most.

    Returns
    -------
    Fit

    Raises
    ------
    ModelError
        What is given is wrong, or the data do not fit the model.
    SolveError
        The model cannot be computed at the start.
    """
    from scipy.optimize import least_squares

    bounds = bounds_of(parameters)
    columns = columns_of(data)
    times = columns.pop(TIME)
    problem = _Problem(build, bounds, times, columns, _settings(times, step, begin, integrator))
    problem.scale(deviations)
    count = sum(int(np.sum(np.isfinite(column))) for column in columns.values())
    if count <= len(bounds):
        raise ModelError("calibrate.data", f"has {count} numbers for {len(bounds)} parameters", "give more")
    checks.integer(most, "calibrate.most", 1, 100_000)
    with _pool(problem, checks.integer(workers, "calibrate.workers", 0, 10_000)) as compute:
        first = compute([problem.units(start_of(start, bounds))])[0]
        if isinstance(first, Exception):
            raise first
        search = _Search(problem, compute, FAILED * (1.0 + float(np.max(np.abs(first)))))
        found = least_squares(
            search.residuals,
            problem.units(start_of(start, bounds)),
            jac=search.derivatives,
            bounds=(np.zeros(len(bounds)), np.ones(len(bounds))),
            x_scale="jac",
            xtol=1e-10,
            ftol=1e-12,
            gtol=1e-12,
            max_nfev=most,
        )
        covariance = _covariance(problem, found.x, found.jac, found.fun)
    return problem.fit(found, covariance, search.evaluations)


@dataclass
class _Problem:
    """The model as a function of numbers from 0 to 1."""

    build: Callable[..., Any]
    bounds: dict[str, tuple[float, float]]
    times: FloatArray
    columns: dict[str, FloatArray]
    settings: SimulationSettings | None
    scales: dict[str, float] = field(default_factory=dict)

    def scale(self, given: Any) -> None:
        """Take what the residuals are divided by."""
        for name, column in self.columns.items():
            here = given.get(name) if isinstance(given, Mapping) else given
            spread = float(np.nanstd(column)) if here is None else here
            if here is None and spread == 0.0:
                raise ModelError(f'calibrate.data["{name}"]', "is constant", "give its deviation")
            self.scales[name] = checks.positive(spread, f"calibrate.deviations: {name}")
        if isinstance(given, Mapping):
            for name in given:
                if name not in self.columns:
                    what = "is the deviation of no column"
                    raise ModelError(
                        f"calibrate.deviations: {name}", what, checks.nearest(name, self.columns)
                    )

    def values(self, u: FloatArray) -> dict[str, float]:
        """Parameters of numbers (p,) from 0 to 1."""
        made = {}
        for x, (name, (low, high)) in zip(u.tolist(), self.bounds.items(), strict=True):
            made[name] = low * (high / low) ** x if is_logarithmic(low, high) else low + (high - low) * x
        return made

    def units(self, values: Mapping[str, float]) -> FloatArray:
        """Numbers (p,) from 0 to 1 of parameters."""
        made = []
        for name, (low, high) in self.bounds.items():
            x = values[name]
            linear = (x - low) / (high - low)
            made.append(np.log(x / low) / np.log(high / low) if is_logarithmic(low, high) else linear)
        return np.array(made)

    def slopes(self, u: FloatArray) -> FloatArray:
        """Derivatives (p,) of the parameters with respect to these numbers."""
        values = self.values(u)
        return np.array(
            [
                values[name] * np.log(high / low) if is_logarithmic(low, high) else high - low
                for name, (low, high) in self.bounds.items()
            ]
        )

    def predicted(self, u: FloatArray) -> dict[str, FloatArray]:
        """The model at the times of the data (n,), by column."""
        made = self.build(**self.values(u))
        if isinstance(made, Model):
            made = self._simulated(made)
        if not isinstance(made, Mapping) or not set(self.columns) <= set(made):
            given = checks.listed(made) if isinstance(made, Mapping) else checks.shown(made)
            what = f"must return a Model, or numbers for {checks.listed(self.columns)}; returned {given}"
            raise ModelError("calibrate.build", what)
        return {name: numbers_of(made[name], self.times, name) for name in self.columns}

    def _simulated(self, model: Model) -> dict[str, FloatArray]:
        if self.settings is None:
            raise ModelError("calibrate.step", "is missing: the time step of the model's simulation")
        formulas = {name: Formula(name, f'calibrate.data["{name}"]', OF_MODEL) for name in self.columns}
        return histories(Study(model, self.settings, None), formulas, self.times)

    def residuals(self, u: FloatArray) -> FloatArray:
        """Model less data, scaled, of all entries that are there."""
        found = self.predicted(u)
        parts = [(found[name] - x) / self.scales[name] for name, x in self.columns.items()]
        there = [np.isfinite(x) for x in self.columns.values()]
        return np.concatenate([part[good] for part, good in zip(parts, there, strict=True)])

    def fit(self, found: Any, covariance: FloatArray, evaluations: int) -> Fit:
        """The answer."""
        predicted = self.predicted(found.x)
        good = {name: np.isfinite(x) for name, x in self.columns.items()}
        return Fit(
            values=self.values(found.x),
            bounds=self.bounds,
            covariance=covariance,
            t={name: self.times[rows] for name, rows in good.items()},
            measured={name: x[good[name]] for name, x in self.columns.items()},
            predicted={name: predicted[name][rows] for name, rows in good.items()},
            scales=self.scales,
            evaluations=evaluations + 2,
            converged=bool(found.success),
            message=str(found.message),
        )


@dataclass
class _Search:
    """What SciPy calls."""

    problem: _Problem
    compute: Callable[[Sequence[FloatArray]], list[Any]]
    failed: float
    evaluations: int = 0
    size: int = 0

    def residuals(self, u: FloatArray) -> FloatArray:
        """Residuals (n,); large ones where the model cannot be computed, so that the step is not taken."""
        self.evaluations += 1
        made = self.compute([u])[0]
        if isinstance(made, ModelError) and not self.size:
            raise made
        if isinstance(made, Exception):
            return np.full(self.size, self.failed)
        self.size = len(made)
        return np.asarray(made)

    def derivatives(self, u: FloatArray) -> FloatArray:
        """Central differences (n, p), one-sided at the bounds."""
        low, high = np.maximum(u - STEP, 0.0), np.minimum(u + STEP, 1.0)
        points = []
        for k in range(len(u)):
            for end in (low, high):
                point = u.copy()
                point[k] = end[k]
                points.append(point)
        self.evaluations += len(points)
        made = self.compute(points)
        wrong = next((one for one in made if isinstance(one, Exception)), None)
        if wrong is not None:
            raise wrong
        columns = [(made[2 * k + 1] - made[2 * k]) / (high[k] - low[k]) for k in range(len(u))]
        return np.stack(columns, axis=1)


def _covariance(problem: _Problem, u: FloatArray, jacobian: Any, residuals: FloatArray) -> FloatArray:
    """Of the parameters: that of least squares with the noise that the residuals tell."""
    freedom = max(len(residuals) - len(u), 1)
    noise = float(residuals @ residuals) / freedom
    _, singular, rows = np.linalg.svd(np.asarray(jacobian), full_matrices=False)
    told = singular > NOTHING * max(float(singular[0]), 1e-300)
    weights = np.where(told, 1.0 / np.where(told, singular, 1.0) ** 2, 0.0)
    made = noise * (rows.T * weights) @ rows
    blind = np.sqrt(np.sum(rows[~told] ** 2, axis=0)) > 1e-6
    made[np.ix_(blind, blind)] = 0.0
    made[blind, blind] = np.inf
    slope = problem.slopes(u)
    return np.asarray(made * np.outer(slope, slope))


@contextmanager
def _pool(problem: _Problem, workers: int) -> Iterator[Callable[[Sequence[FloatArray]], list[Any]]]:
    """What computes residuals at several points, errors among them."""
    if not workers:
        yield lambda points: [_tried(problem, point) for point in points]
        return
    content = packed(problem.residuals)
    with one_thread(), without_script():
        context = get_context("spawn")
        with ProcessPoolExecutor(
            workers, mp_context=context, initializer=_begin, initargs=(content,)
        ) as pool:
            yield lambda points: [*pool.map(_in_process, points)]


_residuals: list[Any] = []


def _begin(content: bytes) -> None:
    _residuals[:] = [unpacked(content)]


def _in_process(point: FloatArray) -> Any:
    try:
        return _residuals[0](point)
    except (ModelError, SolveError) as error:
        error.result = None
        return error


def _tried(problem: _Problem, point: FloatArray) -> Any:
    try:
        return problem.residuals(point)
    except (ModelError, SolveError) as error:
        return error


def _settings(times: FloatArray, step: Any, begin: str, integrator: Any) -> SimulationSettings | None:
    if step is None:
        return None
    from ..preparation import method_of

    clean = checks.positive(step, "calibrate.step")
    checks.choice(begin, "calibrate.begin", ("reference", "equilibrium"))
    steps = max(1, int(np.ceil(float(times[-1]) / clean - 1e-9)))
    return SimulationSettings(
        t_end=steps * clean,
        step=clean,
        integrator=method_of(integrator),
        start=begin,
    )
