"""Radau IIA methods with 2 or 3 stages.

Order 3 with two and 5 with three stages in the positions, also with constraints, which are taken in the
form of index 3; L-stable: what the step does not resolve is damped away.  Velocities have that order
too, but the order 2 or 3 along constraints, and multipliers the order 1 or 2.  The step size follows the
estimated error.  Reference: Hairer & Wanner, Solving Ordinary Differential Equations II (1996), sections
IV.8 and VII; the method of index 3 that the paper uses for its sliding joint.
"""

from __future__ import annotations

from dataclasses import dataclass

from ...errors import ModelError
from .. import checks
from .base import Integrator, option


@dataclass(frozen=True)
class Radau(Integrator):
    """Radau IIA method, order 5 or 3, with step size control.

    Parameters
    ----------
    stages : int
        3 (order 5) or 2 (order 3).
    tolerance : float
        Error of a step: positions relative to the size of the model, slopes absolute, velocities in the
        mean, weighted with the masses as in the kinetic energy, relative to the largest such mean so far.
    adaptive : bool
        Choose the step size; the ``step`` of the simulation is then the first one, and outputs are
        interpolated.  False: constant steps.
    min_step, max_step : float, optional
        Smallest and largest step, s; default what the digits of the time allow, and a tenth of the run.
        A run that needs a smaller step stops.  What is shorter than a step, say a load of a millisecond
        on a model at rest, is only seen by chance.
    """

    stages: int = option(3, "Stages: order 3 or 5 [-].", enum=[2, 3])
    tolerance: float = option(
        1e-6,
        "Error of a step, relative to the size of the model [-].",
        type="number",
        minimum=1e-12,
        maximum=0.1,
    )
    adaptive: bool = option(True, "Whether it chooses its steps [-].", type="boolean")
    min_step: float | None = option(None, "Smallest step [s].", type="number", exclusiveMinimum=0)
    max_step: float | None = option(None, "Largest step [s].", type="number", exclusiveMinimum=0)
    name = "radau"
    runner = "radau.run:RadauRun"

    def __post_init__(self) -> None:
        checks.integer(self.stages, "Radau.stages", 2, 3)
        checks.between(self.tolerance, "Radau.tolerance", 1e-12, 0.1)
        checks.flag(self.adaptive, "Radau.adaptive")
        for key in ("min_step", "max_step"):
            value = getattr(self, key)
            if value is None:
                continue
            checks.positive(value, f"Radau.{key}")
            if not self.adaptive:
                raise ModelError(f"Radau.{key}", "is not used with adaptive = false", "leave it out")
        if self.min_step is not None and self.max_step is not None and self.min_step > self.max_step:
            what = f"is {self.min_step:g} s, larger than max_step = {self.max_step:g} s"
            raise ModelError("Radau.min_step", what)
