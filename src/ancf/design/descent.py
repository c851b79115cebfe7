"""Lengths of droppers with which a number of a run is least: Gauss and Newton within a trusted radius."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..arrays import FloatArray
from .droppers import LineOptimum, LineRuns
from .surface import Surface

#: First radius within which the linearised run is believed; parameters go from 0 to 1.
RADIUS = 0.25
#: Radius below which the search ends: what is left are kinks, where droppers slacken at another step.
SHORTEST = 2e-3
#: Radius with which surfaces begin, and the part to which it shrinks where they promise too much; the
#: promised relative decrease of a linear force that, if it fails, tells of kinks: it would be right without.
WIDE, SHRINK, LITTLE = 0.25, 0.7, 5e-3
#: Relative decrease which, once promised, is not worth another run.
WORTH = 2e-4
#: Weight of limits that are not kept, in units of the objective at the start.
PENALTY = 10.0
#: Parts of the promised decrease below which the radius shrinks and above which it grows.
POOR, GOOD = 0.25, 0.6

Limits = Mapping[str, tuple[float | None, float | None]]


def least(runs: LineRuns, limits: Limits | None = None, most: int = 30) -> LineOptimum:
    """Search for the lengths with which the first formula of the runs is least.

    Each run gives its force with the whole history of the force's derivatives. The next lengths are those
    with which the formula is least within a radius, if the force changed linearly: for a deviation the step
    of Gauss and Newton, as its square is a sum of squares. The radius grows and shrinks with what the next
    run says of that (Levenberg, Marquardt; here as a trust region, Nocedal and Wright, *Numerical
    Optimization*, 2nd edition, chapters 4 and 10).

    Where that promises little and still more than is gained, kinks are the cause: from there on a smooth
    surface through all runs, :class:`ancf.design.surface.Surface`, says what is near.

    Parameters
    ----------
    runs : LineRuns
        The formulas after the first are those of the limits.
    limits : mapping, optional
        Bounds (low, high) of other numbers by their formulas, None for none.
    most : int
        Steps of the search at most, each a run.

    Raises
    ------
    SolveError
        A run failed.
    """
    here = np.array([(p.start - p.low) / (p.high - p.low) for p in runs.parameters.values()])
    task = _Task(runs, [*(limits or {}).values()], abs(float(runs.at(here)[0][0])) or 1.0)
    radius, converged, message = RADIUS, False, f"the limit of {most} steps was reached"
    for _ in range(most):
        there = task.step(here, radius)
        promised = task.merit(runs.at(here)[0]) - task.merit(task.near(there, here)[0])
        worth = WORTH * abs(task.merit(runs.at(here)[0]))
        if promised < worth or radius < SHORTEST:
            converged = True
            message = (
                "no further decrease is promised"
                if radius >= SHORTEST
                else "the radius has shrunk to nothing"
            )
            break
        gained = task.merit(runs.at(here)[0]) - task.merit(runs.at(there)[0])
        length = float(np.linalg.norm(there - here))
        kinked = promised < LITTLE * abs(task.merit(runs.at(here)[0])) and not task.surfaces
        poor = gained < POOR * promised
        if poor and kinked:
            task.believe_all()
            radius = max(radius, WIDE)
        elif poor and task.surfaces:
            radius = SHRINK * min(radius, length)
        elif poor:
            radius = 0.5 * min(radius, length) if gained > 0.0 else 0.35 * min(radius, length)
        elif gained > GOOD * promised and length > 0.9 * radius:
            radius = 2.0 * radius
        if gained > 0.0:
            here = there
        if task.surfaces:
            task.believe_all()
    return _optimum(runs, here, limits or {}, converged, message)


@dataclass
class _Task:
    """What shall be least, and what has to be kept."""

    runs: LineRuns
    bounds: list[tuple[float | None, float | None]]
    first: float
    surfaces: list[Surface] = field(default_factory=list)

    def believe_all(self) -> None:
        """Let surfaces through the numbers of all runs say what is near, no longer a force that is linear."""
        places, numbers, slopes = self.runs.known()
        each = range(numbers.shape[1])
        self.surfaces = [Surface(places, numbers[:, k], slopes[:, k]) for k in each]

    def rows(self) -> list[tuple[int, float, float, float]]:
        """Number of the formula, bound, sign and scale of each limit: sign (x - bound)/scale >= 0."""
        made = []
        for k, (low, high) in enumerate(self.bounds, start=1):
            pairs = ((low, 1.0), (high, -1.0))
            made += [(k, bound, sign, abs(bound) or 1.0) for bound, sign in pairs if bound is not None]
        return made

    def merit(self, numbers: FloatArray) -> float:
        """Objective with what limits are missed by, in units of the objective at the start."""
        missed = sum(max(-s * (float(numbers[k]) - b) / scale, 0.0) for k, b, s, scale in self.rows())
        return float(numbers[0]) / self.first + PENALTY * missed

    def step(self, here: FloatArray, radius: float) -> FloatArray:
        """Parameters within a radius with which the linearised run is best."""
        from scipy import optimize

        conditions: list[dict[str, Any]] = [
            {
                "type": "ineq",
                "fun": lambda u: 1.0 - float((u - here) @ (u - here)) / radius**2,
                "jac": lambda u: -2.0 * (u - here) / radius**2,
            }
        ]
        for k, bound, sign, scale in self.rows():
            conditions.append(
                {
                    "type": "ineq",
                    "fun": lambda u, k=k, b=bound, s=sign / scale: s * (self.near(u, here)[0][k] - b),
                    "jac": lambda u, k=k, s=sign / scale: s * self.near(u, here)[1][k],
                }
            )
        search: Any = optimize.minimize
        found = search(
            lambda u: (self.near(u, here)[0][0] / self.first, self.near(u, here)[1][0] / self.first),
            here,
            jac=True,
            method="SLSQP",
            bounds=[(max(0.0, x - radius), min(1.0, x + radius)) for x in here.tolist()],
            constraints=conditions,
            options={"maxiter": 200, "ftol": 1e-9},
        )
        step: FloatArray = np.clip(found.x, 0.0, 1.0)
        return step

    def near(self, u: FloatArray, here: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Numbers at u and their derivatives, as the search believes: at ``here`` what the run has given."""
        if not self.surfaces:
            return self.runs.predicted(u, here)
        found = [surface.at(u) for surface in self.surfaces]
        numbers = np.array([x for x, _ in found]) - np.array([s.at(here)[0] for s in self.surfaces])
        return numbers + self.runs.at(here)[0], np.stack([slope for _, slope in found])


def _optimum(runs: LineRuns, here: FloatArray, limits: Limits, converged: bool, message: str) -> LineOptimum:
    numbers, slopes = runs.at(here)
    values = runs.values(here)
    return LineOptimum(
        lengths=runs.lengths(values),
        values=values,
        slope=dict(zip(values, (slopes[0] / runs.widths).tolist(), strict=True)),
        objective=float(numbers[0]),
        first=runs.tried[0].objective,
        constraints=dict(zip(limits, numbers[1:].tolist(), strict=True)),
        tried=runs.tried,
        converged=converged,
        message=message,
    )
