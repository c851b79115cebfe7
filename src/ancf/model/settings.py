"""What to compute with a model: settings of a simulation or of an equilibrium, as a model file gives them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from ancf.errors import ModelError
from ancf.model import checks

#: Integrators by the name that a model file uses, with the keys that each one has.
KEYS: dict[str, tuple[str, ...]] = {
    "trapezoidal": ("formulation",),
    "generalized_alpha": ("rho_inf", "formulation"),
    "radau": ("stages", "tolerance", "adaptive", "min_step", "max_step"),
    "explicit": ("safety", "check"),
}
INTEGRATORS = tuple(KEYS)
FORMULATIONS = ("index1", "index2", "ggl", "index3")
STARTS = ("reference", "equilibrium")
MOST_STEPS = 1e9
MOST_LOAD_STEPS = 100_000


@dataclass(frozen=True, slots=True)
class IntegratorSettings:
    """Choice of a time integrator; None stands for the default of a setting.

    Parameters
    ----------
    type : str
        One of INTEGRATORS.
    rho_inf : float, optional
        Spectral radius at infinite frequency of generalized_alpha, 0 to 1.
    formulation : str, optional
        How joints with multipliers are kept: "index1" by their second derivatives, "index2" by their
        first ones, "ggl" by the first ones with the positions corrected (Gear, Gupta, Leimkuhler),
        "index3" by the positions; trapezoidal has no "index3".
    stages : int, optional
        Stages of radau, 2 or 3.
    tolerance : float, optional
        Error of a step of radau, 1e-12 to 0.1.
    adaptive : bool, optional
        Whether radau chooses the step size.
    min_step, max_step : float, optional
        Smallest and largest step of radau, s.
    safety : float, optional
        Part of the stable step that explicit may take, above 0 to 1.
    check : bool, optional
        Whether explicit refuses a step that is not stable.

    """

    type: str = "trapezoidal"
    rho_inf: float | None = None
    formulation: str | None = None
    stages: int | None = None
    tolerance: float | None = None
    adaptive: bool | None = None
    min_step: float | None = None
    max_step: float | None = None
    safety: float | None = None
    check: bool | None = None

    def __post_init__(self) -> None:
        checks.choice(self.type, "integrator.type", INTEGRATORS)
        for key in self.options():
            if key not in KEYS[self.type]:
                owners = " and ".join(name for name, keys in KEYS.items() if key in keys)
                raise ModelError(f"integrator.{key}", f"is a setting of {owners}, not of {self.type}")
        self._check_values()
        if self.formulation is not None:
            checks.choice(self.formulation, "integrator.formulation", FORMULATIONS)
            self._check_index()

    def options(self) -> dict[str, Any]:
        """Settings that are given, but the type."""
        given = {key: getattr(self, key) for keys in KEYS.values() for key in keys}
        return {key: value for key, value in given.items() if value is not None}

    def _check_index(self) -> None:
        if self.type == "trapezoidal" and self.formulation == "index3":
            what = 'is "index3": the trapezoidal rule damps no error of the multipliers, which oscillate'
            raise ModelError("integrator.formulation", what, 'give "ggl", or type = "generalized_alpha"')

    def _check_values(self) -> None:
        _within(self.rho_inf, "rho_inf", 0.0, 1.0)
        _within(self.tolerance, "tolerance", 1e-12, 0.1)
        if self.stages is not None:
            checks.integer(self.stages, "integrator.stages", 2, 3)
        if self.safety is not None and checks.positive(self.safety, "integrator.safety") > 1.0:
            raise ModelError("integrator.safety", f"must be at most 1, is {self.safety:g}")
        for key in ("adaptive", "check"):
            if getattr(self, key) is not None:
                checks.flag(getattr(self, key), f"integrator.{key}")
        for key in ("min_step", "max_step"):
            if getattr(self, key) is not None:
                checks.positive(getattr(self, key), f"integrator.{key}")
                if self.adaptive is False:
                    raise ModelError(f"integrator.{key}", "is not used with adaptive = false", "leave it out")
        if self.min_step is not None and self.max_step is not None and self.min_step > self.max_step:
            what = f"is {self.min_step:g} s, larger than max_step = {self.max_step:g} s"
            raise ModelError("integrator.min_step", what)

    @classmethod
    def of(cls, given: Any) -> IntegratorSettings:
        """From a name alone or a table with the key ``type``."""
        if isinstance(given, str):
            return cls(checks.choice(given, "integrator", INTEGRATORS))
        if not isinstance(given, dict):
            what = f"must be a name or a table with type, is {checks.shown(given)}"
            raise ModelError("integrator", what)
        allowed = ["type", *dict.fromkeys(key for keys in KEYS.values() for key in keys)]
        for key in given:
            if key not in allowed:
                what = f"unknown key, allowed: {checks.listed(allowed)}"
                raise ModelError(f"integrator.{key}", what, checks.nearest(key, allowed))
        if "type" not in given:
            raise ModelError("integrator.type", f"is missing, must be one of {checks.listed(INTEGRATORS)}")
        return cls(**given)


def _within(value: float | None, key: str, low: float, high: float) -> None:
    where = f"integrator.{key}"
    if value is not None and not low <= checks.number(value, where) <= high:
        raise ModelError(where, f"must be between {low:g} and {high:g}, is {value:g}")


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
    sensors : tuple of str
        Points, springs and joints that are recorded at every step.

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
