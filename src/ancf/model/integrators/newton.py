"""Settings of Newton's method."""

from __future__ import annotations

from dataclasses import dataclass

from ...errors import ModelError
from .. import checks


@dataclass(frozen=True)
class Newton:
    """Modified Newton method of a time step.

    Parameters
    ----------
    tolerance : float
        Largest error of q left in a step: positions relative to the size of the model, slopes absolute.
    contraction : float
        Ratio of successive corrections above which the Jacobian is renewed.
    max_iterations : int
        Iterations in a step before it is given up and halved.
    modified : bool
        Keep the Jacobian over iterations and steps; False: a new one for every iteration.
    corotate : bool
        Turn a kept Jacobian with the nodes (:mod:`ancf.solvers.step.corotation`); False gives the plain
        modified Newton method, whose Jacobian counts the paper reports.
    """

    tolerance: float = 1e-11
    contraction: float = 0.5
    max_iterations: int = 60
    modified: bool = True
    corotate: bool = True

    def __post_init__(self) -> None:
        checks.between(self.tolerance, "Newton.tolerance", 1e-15, 1e-3)
        if not 0.0 < checks.number(self.contraction, "Newton.contraction") < 1.0:
            raise ModelError("Newton.contraction", f"must be between 0 and 1, is {self.contraction:g}")
        checks.integer(self.max_iterations, "Newton.max_iterations", 2, 10_000)
        checks.flag(self.modified, "Newton.modified")
        checks.flag(self.corotate, "Newton.corotate")
