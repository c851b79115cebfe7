"""A calibration as a function of numbers from 0 to 1: what is left between model, data and priors."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..model import checks
from ..model.file import Study
from ..model.model import Model
from ..model.settings import SimulationSettings
from .calibration_data import is_logarithmic, numbers_of
from .cases import OF_MODEL, histories
from .fit import Fit
from .formulas import Formula
from .weights import FLOOR, noise_of

#: Singular values of the derivatives below this part of the largest tell nothing.
NOTHING = 1e-9
#: How a search of SciPy ends, by its number.
ENDS = {
    0: "the largest number of computations is reached",
    1: "no direction improves it",
    2: "another step does not improve it",
    3: "the parameters do not change any more",
    4: "neither the parameters change any more nor does another step improve it",
}


@dataclass
class Computed:
    """Residuals (n,) at a point, and the derivatives (n,) that the model gave with them, by number."""

    residuals: FloatArray
    derivatives: dict[int, FloatArray] = field(default_factory=dict)


@dataclass
class Problem:
    """The model as a function of numbers from 0 to 1."""

    build: Callable[..., Any]
    bounds: dict[str, tuple[float, float]]
    times: FloatArray
    columns: dict[str, FloatArray]
    settings: SimulationSettings | None
    priors: dict[str, tuple[float, float]]
    scales: dict[str, float] = field(default_factory=dict)
    given: frozenset[str] = frozenset()
    estimated: tuple[str, ...] = ()
    taken: dict[str, float] = field(default_factory=dict)

    def scale(self, given: Any) -> None:
        """Take what the residuals are divided by."""
        if self.priors and given is None:
            hint = "say how large the noise of each column is: a prior weighs as much as data of its size"
            raise ModelError("calibrate.deviations", "are missing: there are priors", hint)
        for name, column in self.columns.items():
            here = given.get(name) if isinstance(given, Mapping) else given
            spread = float(np.nanstd(column)) if here is None else here
            if here is None and (spread == 0.0 or self.priors):
                what = "has no deviation: there are priors" if self.priors else "is constant"
                raise ModelError(f'calibrate.data["{name}"]', what, "give its deviation")
            self.scales[name] = checks.positive(spread, f"calibrate.deviations: {name}")
            self.given |= {name} if here is not None else frozenset()
        if isinstance(given, Mapping):
            for name in given:
                if name not in self.columns:
                    what = "is the deviation of no column"
                    raise ModelError(
                        f"calibrate.deviations: {name}", what, checks.nearest(name, self.columns)
                    )

    def rows(self) -> dict[str, slice]:
        """Where the residuals of each column stand."""
        ends = np.cumsum([int(np.sum(np.isfinite(x))) for x in self.columns.values()]).tolist()
        return {name: slice(a, b) for name, a, b in zip(self.columns, [0, *ends[:-1]], ends, strict=True)}

    def noise(self, found: Any) -> dict[str, float]:
        """Noise of the columns in units of their scales; nothing to ask where all deviations are given."""
        if len(self.given) == len(self.columns) or self.priors:
            return {}
        return noise_of(self.rows(), found.fun, np.asarray(found.jac), self.given)

    def weigh(self, noise: Mapping[str, float]) -> FloatArray:
        """Take this noise, in units of what was taken before; weights (n,) of the computed residuals.

        Processes that compute keep the scales with which they began.
        """
        before = self.taken or self.scales
        self.taken = dict(before)
        for name, size in noise.items():
            least = FLOOR * float(np.nanstd(self.columns[name]))
            self.taken[name] = max(before[name] * size, least)
        self.estimated = tuple(name for name in noise if name not in self.given)
        parts = self.rows().items()
        sizes = [np.full(part.stop - part.start, self.scales[n] / self.taken[n]) for n, part in parts]
        return np.concatenate(sizes)

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

    def predicted(self, u: FloatArray) -> tuple[dict[str, FloatArray], Mapping[str, Any]]:
        """The model at the times of the data (n,), by column, and the derivatives that it gave."""
        made = self.build(**self.values(u))
        known: Mapping[str, Any] = {}
        if isinstance(made, tuple) and len(made) == 2:
            made, known = made
        if isinstance(made, Model):
            made = self._simulated(made)
        if not isinstance(made, Mapping) or not set(self.columns) <= set(made):
            given = checks.listed(made) if isinstance(made, Mapping) else checks.shown(made)
            what = f"must return a Model, or numbers for {checks.listed(self.columns)}; returned {given}"
            raise ModelError("calibrate.build", what)
        self._check_known(known)
        return {name: numbers_of(made[name], self.times, name) for name in self.columns}, known

    def _check_known(self, known: Any) -> None:
        if not isinstance(known, Mapping):
            what = f"must return derivatives by parameter beside its numbers; returned {checks.shown(known)}"
            raise ModelError("calibrate.build", what)
        for name in known:
            if name not in self.bounds:
                what = f'returned derivatives by "{name}", which is no parameter'
                raise ModelError("calibrate.build", what, checks.nearest(name, self.bounds))

    def _simulated(self, model: Model) -> dict[str, FloatArray]:
        if self.settings is None:
            raise ModelError("calibrate.step", "is missing: the time step of the model's simulation")
        formulas = {name: Formula(name, f'calibrate.data["{name}"]', OF_MODEL) for name in self.columns}
        return histories(Study(model, self.settings, None), formulas, self.times)

    def computed(self, u: FloatArray) -> Computed:
        """Model less data, scaled, of all entries that are there, then parameters less their priors."""
        found, known = self.predicted(u)
        there = {name: np.isfinite(x) for name, x in self.columns.items()}
        rows = [((found[name] - x) / self.scales[name])[there[name]] for name, x in self.columns.items()]
        values, slopes = self.values(u), self.slopes(u)
        rows.append(np.array([(values[name] - mean) / size for name, (mean, size) in self.priors.items()]))
        derivatives = {}
        for k, name in enumerate(self.bounds):
            if name not in known:
                continue
            parts = [self._known_part(known[name], column, name)[there[column]] for column in self.columns]
            parts.append(np.array([(other == name) / size for other, (_, size) in self.priors.items()]))
            derivatives[k] = slopes[k] * np.concatenate(parts)
        return Computed(np.concatenate(rows), derivatives)

    def _known_part(self, given: Any, column: str, name: str) -> FloatArray:
        """Derivative (n,) of a column by a parameter, scaled; a column that is left out does not change."""
        if not isinstance(given, Mapping):
            what = f'must return derivatives by "{name}" for columns; returned {checks.shown(given)}'
            raise ModelError("calibrate.build", what)
        if column not in given:
            return np.zeros(len(self.times))
        return numbers_of(given[column], self.times, column) / self.scales[column]

    def covariance(self, u: FloatArray, jacobian: Any, residuals: FloatArray) -> FloatArray:
        """Of the parameters: that of least squares with the noise that the residuals tell.

        With priors the noise is known, and only enlarged where the residuals are larger.
        """
        count = len(residuals) - len(self.priors)
        data = residuals[:count]
        noise = float(data @ data) / max(count - len(u), 1)
        if self.priors:
            noise = max(noise, 1.0)
        _, singular, rows = np.linalg.svd(np.asarray(jacobian), full_matrices=False)
        told = singular > NOTHING * max(float(singular[0]), 1e-300)
        weights = np.where(told, 1.0 / np.where(told, singular, 1.0) ** 2, 0.0)
        made = noise * (rows.T * weights) @ rows
        blind = np.sqrt(np.sum(rows[~told] ** 2, axis=0)) > 1e-6
        made[np.ix_(blind, blind)] = 0.0
        made[blind, blind] = np.inf
        slope = self.slopes(u)
        return np.asarray(made * np.outer(slope, slope))

    def fit(self, found: Any, covariance: FloatArray, evaluations: int) -> Fit:
        """The answer."""
        predicted, _ = self.predicted(found.x)
        good = {name: np.isfinite(x) for name, x in self.columns.items()}
        return Fit(
            values=self.values(found.x),
            bounds=self.bounds,
            covariance=covariance,
            t={name: self.times[rows] for name, rows in good.items()},
            measured={name: x[good[name]] for name, x in self.columns.items()},
            predicted={name: predicted[name][rows] for name, rows in good.items()},
            scales=self.taken or self.scales,
            evaluations=evaluations + 2,
            converged=bool(found.success),
            message=ENDS[found.status],
            priors=self.priors,
            given=len(self.given) == len(self.columns),
            estimated=self.estimated,
        )
