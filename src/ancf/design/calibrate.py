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
from ..model.settings import SimulationSettings
from ..worker import one_thread
from .calibration_data import TIME, bounds_of, columns_of, priors_of, start_of
from .calibration_problem import Computed, Problem
from .fit import Fit
from .processes import without_script
from .weights import NOTABLE, ROUNDS, SETTLED, apart
from .work import packed, unpacked

#: Step of the central differences, in units of the distance of the bounds (or of its logarithm).
STEP = 1e-4
#: Residuals of a model that could not be computed, in units of those at the start.
FAILED = 1e3
#: Points between the bounds at which the model is computed to begin at the best, if no start is given.
STARTS = 8
#: Points whose derivatives are kept: a step that is not taken goes back to the one before.
RECENT = 3


def calibrate(
    build: Callable[..., Any],
    data: Any,
    parameters: Mapping[str, tuple[float, float]],
    *,
    start: Mapping[str, float] | None = None,
    deviations: Mapping[str, float] | float | None = None,
    priors: Mapping[str, tuple[float, float]] | None = None,
    step: float | None = None,
    begin: str = "reference",
    integrator: Any = None,
    workers: int = 0,
    most: int = 100,
    tolerance: float | None = None,
) -> Fit:
    """Find the parameters with which a model is nearest to measured histories.

    The derivatives are central differences; each takes two runs for every parameter, in parallel if there
    are workers, but none for a parameter by which `build` gives them itself.

    Parameters
    ----------
    build : callable
        ``build(**parameters)`` returns a Model, which is simulated, or numbers (n,) by column of the data,
        or a pair of these numbers and the derivatives that are known: by parameter, then by column, (n,).
    data : path, DataFrame or mapping
        A column ``t`` in s, increasing, and measured ones. For a Model their names are formulas of its
        outputs, such as ``position(cable.at(0.5))[2]``. Empty or NaN entries are left out.
    parameters : mapping
        Bounds (low, high) by name. Of positive bounds that differ by more than ten times the logarithm is
        looked for.
    start : mapping, optional
        Where to begin, default the means of the priors, else the middle of the bounds. Where neither is
        given, eight points between the bounds are computed, and the best is the start.
    deviations : float or mapping, optional
        Standard deviation of the noise of the columns, up to a common factor, which the residuals tell.
        Default in proportion to the spread of each column, and where the residuals of two columns then differ
        by more than 1.5 times, from the residuals of each. With priors the whole deviation, needed.
    priors : mapping, optional
        What is known of parameters before: mean and standard deviation (mean, deviation) by name. Each counts
        as one more number that was measured, with this deviation.
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
    tolerance : float, optional
        Relative decrease of the sum of squares below which the search ends; default 1e-12, round-off.

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
    known = priors_of(priors, bounds)
    given = checks.mapping(start, "calibrate.start", "a number for each parameter")
    begun = start_of({name: mean for name, (mean, _) in known.items()} | given, bounds)
    columns = columns_of(data)
    times = columns.pop(TIME)
    problem = Problem(build, bounds, times, columns, _settings(times, step, begin, integrator), known)
    problem.scale(deviations)
    count = sum(int(np.sum(np.isfinite(column))) for column in columns.values()) + len(known)
    if count <= len(bounds):
        raise ModelError("calibrate.data", f"has {count} numbers for {len(bounds)} parameters", "give more")
    checks.integer(most, "calibrate.most", 1, 100_000)
    with _pool(problem, checks.integer(workers, "calibrate.workers", 0, 10_000)) as compute:
        points = [problem.units(begun)] if start or known else _over(len(bounds))
        at, first = _best(compute, points)
        search = _Search(compute, FAILED * (1.0 + float(np.max(np.abs(first.residuals)))), len(points) - 1)

        def least(begin: FloatArray) -> Any:
            return least_squares(
                search.residuals,
                begin,
                jac=search.derivatives,
                bounds=(np.zeros(len(bounds)), np.ones(len(bounds))),
                x_scale="jac",
                xtol=1e-10,
                ftol=1e-12 if tolerance is None else checks.positive(tolerance, "calibrate.tolerance"),
                gtol=1e-12,
                max_nfev=most,
            )

        found = _weighed(problem, search, least, at)
        covariance = problem.covariance(found.x, found.jac, found.fun)
    return problem.fit(found, covariance, search.evaluations)


def _over(count: int) -> list[FloatArray]:
    """Points (p,) evenly over the unit cube from its middle on, multiples of powers of a golden number.

    Source: M. Roberts, The unreasonable effectiveness of quasirandom sequences (2018).
    """
    golden = 2.0
    for _ in range(60):
        golden = (1.0 + golden) ** (1.0 / (count + 1))
    steps = golden ** -np.arange(1.0, count + 1.0)
    return [(0.5 + k * steps) % 1.0 for k in range(STARTS)]


def _best(
    compute: Callable[[Sequence[FloatArray]], list[Any]], points: list[FloatArray]
) -> tuple[FloatArray, Computed]:
    """The point with the least residuals, and what it gives.

    Raises
    ------
    ModelError, SolveError
        The model cannot be computed at any, or what is given for it is wrong.
    """
    first = compute(points[:1])[0]
    if isinstance(first, ModelError):
        raise first
    made = [first, *(compute(points[1:]) if len(points) > 1 else ())]
    good = [k for k, one in enumerate(made) if not isinstance(one, Exception)]
    if not good:
        raise first
    best = min(good, key=lambda k: float(np.sum(made[k].residuals ** 2)))
    return points[best], made[best]


def _weighed(problem: Problem, search: _Search, least: Callable[[FloatArray], Any], begin: FloatArray) -> Any:
    """The least sum of squares, with columns weighed by their noise where it is not given."""
    found = least(begin)
    limit = NOTABLE
    for _ in range(ROUNDS):
        noise = problem.noise(found)
        if apart(noise) <= limit:
            break
        limit = SETTLED
        search.weigh(problem.weigh(noise))
        found = least(found.x)
    return found


@dataclass
class _Search:
    """What SciPy calls."""

    compute: Callable[[Sequence[FloatArray]], list[Any]]
    failed: float
    evaluations: int = 0
    size: int = 0
    known: dict[bytes, Computed] = field(default_factory=dict)
    weights: Any = 1.0

    def weigh(self, weights: FloatArray) -> None:
        """Weights (n,) of the residuals from now on."""
        self.weights = weights

    def residuals(self, u: FloatArray) -> FloatArray:
        """Residuals (n,); large ones where the model cannot be computed, so that the step is not taken."""
        self.evaluations += 1
        made = self.compute([u])[0]
        if isinstance(made, ModelError) and not self.size:
            raise made
        if isinstance(made, Exception):
            return np.full(self.size, self.failed)
        self.size = len(made.residuals)
        self.known = dict([*self.known.items()][-RECENT:]) | {u.tobytes(): made}
        return np.asarray(self.weights * made.residuals)

    def derivatives(self, u: FloatArray) -> FloatArray:
        """Those that the model gives (n, p), else central differences, one-sided at the bounds."""
        here = self.known[u.tobytes()].derivatives
        low, high = np.maximum(u - STEP, 0.0), np.minimum(u + STEP, 1.0)
        unknown = [k for k in range(len(u)) if k not in here]
        points = []
        for k in unknown:
            for end in (low, high):
                point = u.copy()
                point[k] = end[k]
                points.append(point)
        self.evaluations += len(points)
        made = self.compute(points)
        wrong = next((one for one in made if isinstance(one, Exception)), None)
        if wrong is not None:
            raise wrong
        columns = dict(here)
        for k, below, above in zip(unknown, made[::2], made[1::2], strict=True):
            columns[k] = (above.residuals - below.residuals) / (high[k] - low[k])
        return np.stack([self.weights * columns[k] for k in range(len(u))], axis=1)


@contextmanager
def _pool(problem: Problem, workers: int) -> Iterator[Callable[[Sequence[FloatArray]], list[Any]]]:
    """What computes the residuals at several points, errors among them."""
    if not workers:
        yield lambda points: [_tried(problem, point) for point in points]
        return
    content = packed(problem.computed)
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


def _tried(problem: Problem, point: FloatArray) -> Any:
    try:
        return problem.computed(point)
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
