"""Fit: parameters that least squares found, how well the data tell them, and what is left."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..model import checks
from ..model.tables import Readable, Sheet, Table, number

#: Standard deviation of a number of which nothing is known but its bounds, in units of their distance.
UNKNOWN = 1.0 / math.sqrt(12.0)
#: Part of the deviation of a prior that is left where the data told a tenth of what is known in the end.
LITTLE = math.sqrt(0.9)
#: Residuals in units of the given deviations from which on a note is made, if chance makes them so rarely.
FAR, CHANCE = 2.0, 1e-4


@dataclass(frozen=True)
class Fit(Readable):
    """What :func:`ancf.calibrate` found; ``print`` shows it as tables.

    Parameters
    ----------
    values : dict of str to float
        The parameters.
    bounds : dict of str to (float, float)
        Between which they were looked for.
    covariance : ndarray, shape (p, p)
        Of the parameters in this order, from the derivatives at the solution and the size of the residuals;
        infinite where the data tell nothing.
    t : dict of str to ndarray
        Times by column of the data, s.
    measured, predicted : dict of str to ndarray
        The data and the model, by column.
    scales : dict of str to float
        By which the residuals of each column were divided.
    evaluations : int
        How often the model was computed, for derivatives as well.
    converged : bool
    message : str
        How the search ended.
    priors : dict of str to (float, float)
        Mean and standard deviation of what was known before.
    given : bool
        Whether the deviations of all columns were given.
    estimated : tuple of str
        Columns whose scales are their noise, from the residuals.
    """

    values: dict[str, float]
    bounds: dict[str, tuple[float, float]]
    covariance: FloatArray
    t: dict[str, FloatArray] = field(repr=False)
    measured: dict[str, FloatArray] = field(repr=False)
    predicted: dict[str, FloatArray] = field(repr=False)
    scales: dict[str, float] = field(repr=False)
    evaluations: int = 0
    converged: bool = True
    message: str = ""
    priors: dict[str, tuple[float, float]] = field(default_factory=dict)
    given: bool = False
    estimated: tuple[str, ...] = ()

    @property
    def excess(self) -> float:
        """Root of the mean square of the residuals by their scales, for the numbers beyond the parameters."""
        sums = [np.sum((r / self.scales[name]) ** 2) for name, r in self.residuals.items()]
        return math.sqrt(float(np.sum(sums)) / max(self.count - len(self.values), 1))

    @property
    def names(self) -> list[str]:
        """Names of the parameters, in the order of the covariance."""
        return [*self.values]

    @property
    def count(self) -> int:
        """Numbers in the data."""
        return sum(len(x) for x in self.measured.values())

    @property
    def freedom(self) -> int:
        """Numbers in the data and priors less parameters."""
        return self.count + len(self.priors) - len(self.values)

    @property
    def deviations(self) -> dict[str, float]:
        """Standard errors of the parameters."""
        return dict(zip(self.values, np.sqrt(np.diag(self.covariance)).tolist(), strict=True))

    @property
    def correlation(self) -> FloatArray:
        """Correlation (p, p) of the parameters; NaN with one of which the data tell nothing."""
        size = np.sqrt(np.diag(self.covariance))
        with np.errstate(invalid="ignore"):
            found: FloatArray = self.covariance / np.outer(size, size)
        return found

    @property
    def residuals(self) -> dict[str, FloatArray]:
        """Model less data by column, in its unit."""
        return {name: self.predicted[name] - self.measured[name] for name in self.measured}

    @property
    def rms(self) -> dict[str, float]:
        """Root mean square of the residuals by column."""
        return {name: float(np.sqrt(np.mean(r**2))) for name, r in self.residuals.items()}

    def confidence(self, level: float = 0.95) -> dict[str, tuple[float, float]]:
        """Intervals of the parameters, from the linearised model and Student's distribution.

        Raises
        ------
        ModelError
            The level is not between 0 and 1.
        """
        from scipy.special import stdtrit

        if not 0.0 < checks.number(level, "Fit.confidence.level") < 1.0:
            raise ModelError("Fit.confidence.level", f"must be between 0 and 1, is {level:g}")
        factor = float(stdtrit(max(self.freedom, 1), 0.5 * (1.0 + level)))
        half = self.deviations
        return {name: (x - factor * half[name], x + factor * half[name]) for name, x in self.values.items()}

    @property
    def untold(self) -> list[str]:
        """Parameters of which the data tell less than their bounds did, or little beside their prior."""
        wide = {name: UNKNOWN * (high - low) for name, (low, high) in self.bounds.items()}
        wide |= {name: min(wide[name], LITTLE * size) for name, (_, size) in self.priors.items()}
        return [name for name, size in self.deviations.items() if not size < wide[name]]

    @property
    def at_bounds(self) -> list[str]:
        """Parameters that ended at one of their bounds: the errors say nothing of what is beyond."""
        found = []
        for name, (low, high) in self.bounds.items():
            margin = 1e-4 * (high - low)
            if not low + margin < self.values[name] < high - margin:
                found.append(name)
        return found

    def notes(self) -> list[str]:
        """What to know before the values are believed, one line each."""
        made = [] if self.converged else [f"the search stopped before it was done: {self.message}"]
        made += [f"{name} ended at a bound" for name in self.at_bounds]
        for name in self.untold:
            before = "prior" if name in self.priors else "bounds"
            made.append(
                f"the data tell less of {name} than its {before} {'does' if before == 'prior' else 'do'}"
            )
        made += self._of_noise()
        matrix = self.correlation
        for i, one in enumerate(self.names):
            for j, other in enumerate(self.names[:i]):
                if abs(matrix[i, j]) > 0.95:
                    made.append(f"{other} and {one} are told together only: correlation {matrix[i, j]:.3f}")
        return made

    def _of_noise(self) -> list[str]:
        """What the size of the residuals says."""
        from scipy.special import chdtrc

        if self.estimated:
            sizes = ", ".join(f"{name} {self.scales[name]:.3g}" for name in self.estimated)
            return [f"the noise of the columns was estimated from the residuals, for their weights: {sizes}"]
        free = max(self.count - len(self.values), 1)
        if not (self.given and self.excess > FAR and chdtrc(free, free * self.excess**2) < CHANCE):
            return []
        return [
            f"the residuals are {self.excess:.2g} times the deviations that were given: the search ended in "
            "another valley, or the model lacks something; begin elsewhere with start"
        ]

    def __repr__(self) -> str:
        found = ", ".join(f"{name}={number(x)}" for name, x in self.values.items())
        return f"Fit({found}; {self.evaluations} evaluations)"

    def _sheet(self) -> Sheet:
        intervals, errors = self.confidence(), self.deviations
        rows = [
            (name, number(x), number(errors[name], 3), f"{number(low)} to {number(high)}")
            for (name, x), (low, high) in zip(self.values.items(), intervals.values(), strict=True)
        ]
        left = [(name, str(len(self.measured[name])), number(size, 3)) for name, size in self.rms.items()]
        facts = [
            ("search", f"{self.message}; {self.evaluations} evaluations"),
            *(("note", text) for text in self.notes()),
        ]
        tables = [
            Table(("parameter", "value", "standard error", "95 % confidence"), rows),
            Table(("column", "numbers", "rms of the residuals"), left),
        ]
        return Sheet("Fit", facts, tables)

    def as_dict(self) -> dict[str, Any]:
        """All but the histories, ready for JSON."""
        intervals = self.confidence()
        rows = {
            name: {
                "value": x,
                "deviation": self.deviations[name],
                "confidence_95": list(intervals[name]),
                "bounds": list(self.bounds[name]),
                **({"prior": list(self.priors[name])} if name in self.priors else {}),
            }
            for name, x in self.values.items()
        }
        return {
            "parameters": rows,
            "correlation": self.correlation.tolist(),
            "covariance": self.covariance.tolist(),
            "rms": self.rms,
            "scales": self.scales,
            "scales_estimated": list(self.estimated),
            "numbers": self.count,
            "evaluations": self.evaluations,
            "converged": self.converged,
            "message": self.message,
            "notes": self.notes(),
        }
