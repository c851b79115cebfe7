"""Samples of parameters: grids, lists and designs of random numbers, as a table with a row for each case."""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..model import checks
from .distributions import Discrete, Distribution, distribution_of, standard
from .extras import pandas

if TYPE_CHECKING:
    from pandas import DataFrame

METHODS = ("grid", "list", "random", "latin-hypercube", "sobol", "saltelli", "morris")
#: Methods whose rows do not change when more are asked for: the first ones are those that were there.
GROWING = ("random", "sobol", "saltelli", "morris")
#: Methods whose rows are drawn from the distributions, so that they can be correlated.
DRAWN = ("random", "latin-hypercube", "sobol")
MOST = 10_000_000
#: Levels of Morris' trajectories, and the probability that is left out at each end where a range has none.
LEVELS, OUTSIDE = 4, 0.01
#: Key in ``DataFrame.attrs`` of how samples were made.
DESIGN = "ancf design"


def sample(
    parameters: Mapping[str, Any],
    *,
    method: str = "latin-hypercube",
    count: int | None = None,
    seed: int = 0,
    correlations: Mapping[tuple[str, str], float] | None = None,
) -> DataFrame:
    """Values of parameters for the cases of a study.

    Parameters
    ----------
    parameters : mapping
        By name a distribution, such as ``ancf.Uniform(1e6, 3e6)``, or a list of values.
    method : str
        "grid" (all combinations of lists), "random", "latin-hypercube", "sobol", "saltelli" (for Sobol'
        indices), "morris" (for elementary effects).
    count : int
        Rows; of "saltelli" base points, each with a row for each parameter and two more; of "morris"
        trajectories, each with a row for each parameter and one more. A grid has its own.
    seed : int
        The same seed gives the same samples. More samples of "random", "sobol", "saltelli" and "morris"
        begin with those of fewer.
    correlations : mapping, optional
        By pairs of names the correlation of the normal scores (a Gaussian copula); of normal distributions
        it is that of the values.

    Returns
    -------
    pandas.DataFrame
        A column for each parameter; ``attrs`` keep how it was made.

    Raises
    ------
    ModelError
        What is given is wrong, or pandas is missing.
    """
    frame = pandas()
    checks.choice(method, "sample.method", tuple(name for name in METHODS if name != "list"))
    if not isinstance(parameters, Mapping) or not parameters:
        raise ModelError("sample.parameters", "must be a distribution or a list of values by name")
    kinds = {str(name): distribution_of(kind, f"sample.{name}") for name, kind in parameters.items()}
    seed = checks.integer(seed, "sample.seed", 0, 2**63 - 1)
    pairs = checks.mapping(correlations, "sample.correlations", '{("EA", "EI"): 0.5}')
    design: dict[str, Any] = {
        "method": method,
        "parameters": {name: kind.describe() for name, kind in kinds.items()},
    }
    if method == "grid":
        columns = _grid(kinds, count, pairs)
        design["count"] = len(next(iter(columns.values())))
    else:
        if count is None:
            hint = 'method="grid" takes all combinations of listed values'
            raise ModelError("sample.count", f"is missing: {method} needs how many", hint)
        count = checks.integer(count, "sample.count", 1, MOST)
        u = unit_samples(method, count, len(kinds), seed)
        if len(u) > MOST:
            raise ModelError("sample.count", f"makes {len(u)} cases, at most {MOST}")
        u = _correlated(u, [*kinds], pairs, method)
        columns = {name: _values(kind, x, method) for (name, kind), x in zip(kinds.items(), u.T, strict=True)}
        design |= {"count": count, "seed": seed}
        design["correlations"] = [[*pair, float(value)] for pair, value in pairs.items()]
    made = frame.DataFrame(columns)
    made.attrs[DESIGN] = design
    return made


def unit_samples(method: str, count: int, dimension: int, seed: int) -> FloatArray:
    """Samples (n, dimension) in the unit cube."""
    from scipy.stats import qmc

    if method == "random":
        return np.random.default_rng(seed).random((count, dimension))
    if method == "latin-hypercube":
        return np.asarray(qmc.LatinHypercube(dimension, seed=np.random.default_rng(seed)).random(count))
    if method == "morris":
        return _trajectories(count, dimension, seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # any number may be asked for, powers of 2 are balanced
        if method == "sobol":
            return _sobol(count, dimension, seed)
        return _saltelli(_sobol(count, 2 * dimension, seed))


def _sobol(count: int, dimension: int, seed: int) -> FloatArray:
    from scipy.stats import qmc

    if dimension > qmc.Sobol.MAXDIM:
        raise ModelError("sample.method", f"Sobol' sequences have at most {qmc.Sobol.MAXDIM} dimensions")
    points = qmc.Sobol(dimension, scramble=True, seed=np.random.default_rng(seed)).random(count)
    return np.asarray(points, dtype=np.float64)


def _saltelli(points: FloatArray) -> FloatArray:
    """Rows A, A with one column of B after the other, B, for each base point; the order that SALib takes."""
    a, b = np.split(points, 2, axis=1)
    count, dimension = a.shape
    rows = np.repeat(a[:, None, :], dimension + 2, axis=1)
    for k in range(dimension):
        rows[:, 1 + k, k] = b[:, k]
    rows[:, -1] = b
    return rows.reshape(count * (dimension + 2), dimension)


def _trajectories(count: int, dimension: int, seed: int) -> FloatArray:
    """Morris' walks over a grid of levels; each has a stream of its own, so that more of them change none.

    Levels are counted, so that those of all walks are the same numbers.
    """
    rows = np.empty((count, dimension + 1, dimension), dtype=np.int64)
    for k in range(count):
        draw = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(k,)))
        lower = draw.integers(0, LEVELS // 2, dimension)
        up = draw.random(dimension) < 0.5
        rows[k, 0] = np.where(up, lower, lower + LEVELS // 2)
        for i, place in enumerate(draw.permutation(dimension)):
            rows[k, i + 1] = rows[k, i]
            rows[k, i + 1, place] += LEVELS // 2 if up[place] else -(LEVELS // 2)
    return rows.reshape(-1, dimension) / (LEVELS - 1)


def _values(kind: Distribution, u: FloatArray, method: str) -> Any:
    if method == "morris" and not kind.bounded:
        u = OUTSIDE + (1.0 - 2.0 * OUTSIDE) * u
    return _column(kind.quantile(u))


def _column(values: Any) -> Any:
    """Objects as numbers where they all are."""
    if values.dtype.kind != "O":
        return values
    kinds = {type(v) for v in values}
    if kinds <= {int}:
        return values.astype(np.int64)
    return values.astype(np.float64) if kinds <= {int, float} else values


def _grid(kinds: dict[str, Distribution], count: Any, pairs: Mapping[Any, Any]) -> dict[str, Any]:
    if pairs:
        raise ModelError("sample.correlations", "have no effect on a grid", "leave them out")
    if count is not None:
        raise ModelError(
            "sample.count", "has no effect on a grid, which has all combinations", "leave it out"
        )
    levels: list[Sequence[Any]] = []
    total = 1
    for name, kind in kinds.items():
        if not isinstance(kind, Discrete) or kind.weights is not None:
            raise ModelError(f"sample.{name}", "must be a list of values: a grid has no distributions")
        levels.append(kind.values)
        total *= len(kind.values)
    if total > MOST:
        raise ModelError("sample.method", f"the grid has {total} cases, at most {MOST}")
    rows = [*itertools.product(*levels)]
    columns = {}
    for k, name in enumerate(kinds):
        column = np.empty(len(rows), dtype=object)
        column[:] = [row[k] for row in rows]
        columns[name] = _column(column)
    return columns


def _correlated(u: FloatArray, names: list[str], pairs: Mapping[Any, float], method: str) -> FloatArray:
    """Probabilities whose normal scores have these correlations."""
    if not pairs:
        return u
    if method not in DRAWN:
        raise ModelError("sample.correlations", f"{method} is for parameters that vary independently")
    from scipy.special import ndtr

    matrix = np.eye(len(names))
    for pair, value in pairs.items():
        where = f"sample.correlations {pair}"
        if not isinstance(pair, tuple | list) or len(pair) != 2 or pair[0] == pair[1]:
            raise ModelError(where, "must be between two parameters")
        for name in pair:
            if name not in names:
                raise ModelError(where, f'there is no parameter "{name}"', checks.nearest(name, names))
        if pair[::-1] in pairs:
            raise ModelError(where, "stands there the other way round too", "give one of both")
        i, j = (names.index(name) for name in pair)
        matrix[i, j] = matrix[j, i] = checks.between(value, where, -1.0, 1.0)
    try:
        factor = np.linalg.cholesky(matrix)
    except np.linalg.LinAlgError:
        what = "contradict each other: their matrix is not positive definite"
        raise ModelError("sample.correlations", what) from None
    return np.asarray(ndtr(standard(u) @ factor.T), dtype=np.float64)
