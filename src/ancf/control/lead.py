"""Controllers: a function that looks at a run every so often and gives its inputs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..errors import ModelError, SolveError
from ..model import checks
from ..model.settings import FITS, MOST_STEPS
from ..preparation import Prepared
from ..results.given import Given
from ..solvers.control import Control
from .foreseen import Foreseen
from .live import Live
from .memory import Memory
from .stepper import refuse_adaptive

Controller = Callable[[Live], Any]


def check_controller(controller: Any, control_step: Any, step: float, where: str) -> int:
    """Steps between two calls of a controller.

    Raises
    ------
    ModelError
        It is no function, or its step is no multiple of the time step.
    """
    hint = 'such as def f(run): run.inputs["thrust"] = 5.0'
    if isinstance(controller, type):
        hint = f"give an object of it, {controller.__name__}(...), that can be called"
    checks.function(controller, f"{where}.controller", "the run", hint)
    if control_step is None:
        return 1
    ratio = min(checks.positive(control_step, f"{where}.control_step") / step, MOST_STEPS)
    if round(ratio) < 1 or abs(ratio - round(ratio)) > FITS:
        what = f"is {control_step:g} s, must be a multiple of step = {step:g} s"
        raise ModelError(f"{where}.control_step", what)
    return round(ratio)


def name_of(controller: Controller) -> str:
    """What messages and results call a controller."""
    return str(getattr(controller, "__name__", type(controller).__name__))


def led(made: Prepared, controller: Controller, every: int, where: str) -> Prepared:
    """Let a controller be called every so many steps of a simulation; its header says so."""
    settings = made.header["settings"]
    refuse_adaptive(made.method, where)
    made.system.inputs = Foreseen(made.system.inputs)
    if made.given is None:
        made = made._replace(given=Given.begun(made.run.t_start, made.system.inputs.given))
    live, memory = Live(made), Memory(controller, where)
    name = name_of(controller)

    def call(done: int) -> None:
        live.look()
        memory.note(done)
        try:
            found = controller(live)
        except (ModelError, SolveError):
            raise
        except Exception as error:
            what = f"at t = {live.t:.6g} s the controller raised {type(error).__name__}: {error}"
            alone = isinstance(error, TypeError) and error.__traceback__.tb_next is None  # type: ignore[union-attr]
            hint = "it is called with one argument, the run: def controller(run)" if alone else ""
            raise ModelError(f"{where}.controller", what, hint) from error
        if found is not None:
            what = f"returned {checks.shown(found)} at t = {live.t:.6g} s, which nothing takes"
            name = next(iter(live.inputs), "thrust")
            raise ModelError(f"{where}.controller", what, f'give inputs instead: run.inputs["{name}"] = ...')

    made.run.control = Control(every, call, memory.values)
    led_by = {"controller": name, "control_step": every * settings["step"]}
    return made._replace(header={**made.header, "settings": {**settings, **led_by}})
