"""What to compute with a model: settings of a simulation or of an equilibrium, as a model file gives them."""

from __future__ import annotations

from dataclasses import dataclass, field

from ancf.errors import ModelError
from ancf.model import checks
from ancf.model.integrators import Integrator, Trapezoidal

STARTS = ("reference", "equilibrium")
MOST_STEPS = 1e9
MOST_LOAD_STEPS = 100_000


@dataclass(frozen=True, slots=True)
class SimulationSettings:
    """Settings of a simulation.

    Parameters
    ----------
    t_end : float
        End time, s, > 0.
    step : float
        Time step, s, at most `t_end`.
    integrator : Integrator
        Default the trapezoidal rule.
    start : str
        "reference" (the initial shapes) or "equilibrium".
    equilibrium_of : tuple of str, optional
        Bodies whose equilibrium is the start; None for all.
    output_step : float, optional
        Time between stored states, s, a multiple of `step`; None stores every step.
    outputs : tuple of str
        Points that the summary prints.
    sensors : tuple of str
        Points, springs and joints that are recorded at every step.

    Raises
    ------
    ModelError
        A setting is out of range; ``where`` is ``simulation.step`` and so on.

    """

    t_end: float
    step: float
    integrator: Integrator = field(default_factory=Trapezoidal)
    start: str = "reference"
    equilibrium_of: tuple[str, ...] | None = None
    output_step: float | None = None
    outputs: tuple[str, ...] = ()
    sensors: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        checks.positive(self.t_end, "simulation.t_end")
        checks.positive(self.step, "simulation.step")
        checks.choice(self.start, "simulation.start", STARTS)
        if self.step > self.t_end:
            what = f"is {self.step:g} s, must be at most t_end = {self.t_end:g} s"
            raise ModelError("simulation.step", what)
        if self.t_end > MOST_STEPS * self.step:
            what = f"{self.step:g} s makes more than {MOST_STEPS:.0e} steps to t_end = {self.t_end:g} s"
            raise ModelError("simulation.step", what)
        self._check_output_step()
        if self.equilibrium_of is not None and self.start != "equilibrium":
            what = f'is not used with start = "{self.start}"'
            raise ModelError("simulation.equilibrium_of", what, 'give start = "equilibrium"')

    def _check_output_step(self) -> None:
        if self.output_step is None:
            return
        ratio = checks.positive(self.output_step, "simulation.output_step") / self.step
        if round(ratio) < 1 or abs(ratio - round(ratio)) > 1e-6:
            what = f"is {self.output_step:g} s, must be a multiple of step = {self.step:g} s"
            raise ModelError("simulation.output_step", what)


@dataclass(frozen=True, slots=True)
class EquilibriumSettings:
    """Settings of a static equilibrium: `load_steps`, the number of steps in which the loads grow."""

    load_steps: int = 1

    def __post_init__(self) -> None:
        checks.integer(self.load_steps, "equilibrium.load_steps", 1, MOST_LOAD_STEPS)
