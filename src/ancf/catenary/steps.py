"""Pantographs along a line in steps one by one, as hardware in the loop takes them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from ..control.stepper import Stepper, refuse_adaptive
from ..errors import ModelError
from ..model.settings import MOST_STEPS
from ..preparation import method_of, prepared
from . import sleeping
from .assemble import Assembled
from .collectors import Touch
from .forms.mesh import Mesh
from .forms.route_form import AnyForm
from .lines.line import Line
from .lines.route import Route
from .plan import Door, formed, make_plan
from .ready import STEP, Ready, ready
from .run import Speed, relaxed
from .touching import Touching, touching
from .vehicles.pantograph import Pantograph
from .vehicles.travel import make_travel

WHERE = "catenary.stepper"


class LineStepper(Stepper):
    """A line with pantographs that takes steps when it is asked to; see :func:`ancf.catenary.stepper`.

    Attributes
    ----------
    overhead : Overhead
        Its model with wires, droppers and supports, of which questions may be asked.
    collectors : list of Collector
        The pantographs in it, the first ahead.
    """

    def __init__(self, begun: Ready, made: Any) -> None:
        super().__init__(made)
        self.overhead, self.collectors = begun.overhead, begun.collectors
        plan = begun.plan
        self._end = plan.form.line.end
        self._last = int(plan.travel.time(self._end - max(plan.places)) / plan.step)

    def advance(self, steps: int = 1) -> None:
        """Take some steps with the inputs as they are; see :meth:`ancf.Stepper.advance`.

        Raises
        ------
        SolveError
            A step failed.
        ModelError
            The first pantograph would leave the line.
        """
        if self._run.done + (steps if isinstance(steps, int) else 0) > self._last:
            left = self._last - self._run.done
            what = f"the first pantograph reaches the end of the line, {self._end:g} m, after {left} steps"
            raise ModelError("advance.steps", what, "stop there")
        super().advance(steps)

    def pantograph(self, number: int = 0) -> Touching:
        """A pantograph at the wire now; 0 is the first.

        Raises
        ------
        ModelError
            There is no such pantograph.
        """
        return touching(self, self.collectors, number)


def stepper(
    line: Line | Route | AnyForm | Assembled | str | Path,
    *,
    speed: Speed,
    pantograph: Pantograph | str | Sequence[Pantograph | str] = "benchmark-2015",
    spacing: float | Sequence[float] | None = None,
    start: float | None = None,
    window: tuple[float, float] | None = None,
    contact: str = "penalty",
    contact_stiffness: float | None = None,
    contact_damping: float = 0.0,
    step: float = STEP,
    mesh: Mesh | None = None,
    integrator: Any = None,
    modify: Callable[[Assembled], Any] | None = None,
    roof: Any = None,
    underside: Any = None,
    reduce: bool = False,
    broken_droppers: Sequence[str] = (),
) -> LineStepper:
    """Pantographs along a line from its equilibrium, step by step.

    What a step takes follows the pantographs and not the line with `reduce`: hardware and controllers that
    wait for it in real time get their answer in less than a millisecond.

    Each pantograph has an input, a force on its lowest mass upwards in N: ``"pantograph_force"``, of several
    ``"pantograph_1_force"`` and so on.

    Parameters
    ----------
    line, speed, pantograph, spacing, start, window, contact, contact_stiffness, contact_damping
        As of :func:`run`; a window is needed for springs that are relaxed at a mean height alone.
    step, mesh, integrator, modify, roof, underside, broken_droppers
        As of :func:`run`.
    reduce : bool
        Whether spans move by their modes while no pantograph is near, see :func:`run`. A question about one
        of them is answered from these.

    Returns
    -------
    LineStepper

    Raises
    ------
    ModelError
        What was given is wrong.
    SolveError
        There is no equilibrium.

    See Also
    --------
    ancf.stepper : of any model.

    """
    touch = Touch(contact, contact_stiffness, contact_damping)
    shape, travel = formed(line, mesh), make_travel(speed)
    door = Door.of(line, shape, modify, broken_droppers, WHERE)
    plan = make_plan(
        shape,
        travel,
        pantograph,
        spacing,
        start,
        window,
        None,
        touch,
        step,
        door,
        roof,
        underside,
        evaluated=False,
    )
    where = f"{WHERE}.reduce"
    sleeps = sleeping.allowed(reduce, integrator, touch=touch.kind, derived=False, where=where)
    begun = ready(relaxed(plan, sleeps), active=True, sleeps=sleeps)
    settings = begun.settings(integrator)
    method = method_of(settings.pop("integrator"), WHERE)
    refuse_adaptive(method, WHERE)
    made = prepared(
        begun.overhead.model,
        method=method,
        t_end=MOST_STEPS * plan.step,
        output_step=None,
        where=WHERE,
        **settings,
    )
    if begun.sleep is not None:
        sleeping.reduced(made, begun.overhead, begun.sleep)
    return LineStepper(begun, made)
