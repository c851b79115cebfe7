"""What to compute with a model: settings of a simulation or of an equilibrium, as a model file gives them."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..errors import ModelError
from . import checks
from .integrators import Integrator, Trapezoidal

STARTS = ("reference", "equilibrium")
MOST_STEPS = 1e9
#: Part of a step by which the output step may miss a multiple, and of a run by which one step may be longer.
FITS, ROUND_OFF = 1e-6, 1e-12
MOST_LOAD_STEPS = 100_000


def steps_between(
    where: str, t_end: float, step: float, output_step: float | None, t_start: float = 0.0
) -> int:
    """Check the times of a simulation; number of steps between stored states, at most MOST_STEPS.

    Parameters
    ----------
    where : str
        What has the times, for messages: "simulation" in a model file.
    t_end, step, output_step, t_start : float
        In s; without an output step every step is stored.

    Raises
    ------
    ModelError
        A time is not positive, the step is longer than the run or makes too many steps, or the output step
        is no multiple of it, to a millionth of a step.

    """
    checks.positive(t_end, f"{where}.t_end")
    checks.positive(step, f"{where}.step")
    span = t_end - t_start
    if span <= 0.0:
        raise ModelError(f"{where}.t_end", f"is {t_end:g} s, must be later than the start at {t_start:g} s")
    if step > span * (1 + ROUND_OFF):
        what = f"is {step:g} s, longer than the whole run of {span:g} s"
        raise ModelError(f"{where}.step", what)
    if span > MOST_STEPS * step * (1 + ROUND_OFF):
        raise ModelError(f"{where}.step", f"is {step:g} s, which makes more than {MOST_STEPS:.0e} steps")
    if output_step is None:
        return 1
    ratio = min(checks.positive(output_step, f"{where}.output_step") / step, MOST_STEPS)
    if round(ratio) < 1 or abs(ratio - round(ratio)) > FITS:
        what = f"is {output_step:g} s, must be a multiple of step = {step:g} s"
        raise ModelError(f"{where}.output_step", what)
    return round(ratio)


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
        steps_between("simulation", self.t_end, self.step, self.output_step)
        checks.choice(self.start, "simulation.start", STARTS)
        if self.equilibrium_of is not None and self.start != "equilibrium":
            what = f'is not used with start = "{self.start}"'
            raise ModelError("simulation.equilibrium_of", what, 'give start = "equilibrium"')


@dataclass(frozen=True, slots=True)
class EquilibriumSettings:
    """Settings of a static equilibrium: `load_steps`, the number of steps in which the loads grow."""

    load_steps: int = 1

    def __post_init__(self) -> None:
        checks.integer(self.load_steps, "equilibrium.load_steps", 1, MOST_LOAD_STEPS)
