"""What to compute with a model: settings of a simulation or of an equilibrium, as a model file gives them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from ancf.errors import ModelError
from ancf.model import checks

INTEGRATORS = ("trapezoidal", "generalized_alpha")
STARTS = ("reference", "equilibrium")
MOST_STEPS = 1e9
MOST_LOAD_STEPS = 100_000


@dataclass(frozen=True, slots=True)
class IntegratorSettings:
    """Choice of a time integrator.

    Parameters
    ----------
    type : str
        "trapezoidal" or "generalized_alpha".
    rho_inf : float, optional
        Spectral radius at infinite frequency of generalized_alpha, 0 to 1; None for its default.

    """

    type: str = "trapezoidal"
    rho_inf: float | None = None

    def __post_init__(self) -> None:
        checks.choice(self.type, "integrator.type", INTEGRATORS)
        if self.rho_inf is None:
            return
        if self.type != "generalized_alpha":
            raise ModelError("integrator.rho_inf", f"is a setting of generalized_alpha, not of {self.type}")
        if not 0.0 <= checks.number(self.rho_inf, "integrator.rho_inf") <= 1.0:
            raise ModelError("integrator.rho_inf", f"must be between 0 and 1, is {self.rho_inf:g}")

    @classmethod
    def of(cls, given: Any) -> IntegratorSettings:
        """From a name alone or a table with the key ``type``."""
        if isinstance(given, str):
            return cls(checks.choice(given, "integrator", INTEGRATORS))
        if not isinstance(given, dict):
            what = f"must be a name or a table with type, is {checks.shown(given)}"
            raise ModelError("integrator", what)
        for key in given:
            if key not in ("type", "rho_inf"):
                hint = checks.nearest(key, ("type", "rho_inf"))
                raise ModelError(f"integrator.{key}", 'unknown key, allowed: "type", "rho_inf"', hint)
        if "type" not in given:
            raise ModelError("integrator.type", f"is missing, must be one of {checks.listed(INTEGRATORS)}")
        return cls(**given)


@dataclass(frozen=True, slots=True)
class SimulationSettings:
    """Settings of a simulation.

    Parameters
    ----------
    t_end : float
        End time, s, > 0.
    step : float
        Time step, s, at most `t_end`.
    integrator : IntegratorSettings
    start : str
        "reference" (the initial shapes) or "equilibrium".
    equilibrium_of : tuple of str, optional
        Bodies whose equilibrium is the start; None for all.
    output_step : float, optional
        Time between stored states, s, a multiple of `step`; None stores every step.
    outputs : tuple of str
        Points that the summary prints.

    Raises
    ------
    ModelError
        A setting is out of range; ``where`` is ``simulation.step`` and so on.

    """

    t_end: float
    step: float
    integrator: IntegratorSettings = field(default_factory=IntegratorSettings)
    start: str = "reference"
    equilibrium_of: tuple[str, ...] | None = None
    output_step: float | None = None
    outputs: tuple[str, ...] = ()

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
