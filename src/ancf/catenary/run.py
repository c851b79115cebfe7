"""Run pantographs along a line, from the form that it has at rest."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import ancf

from ..control.delay import Delayed
from ..errors import ModelError
from ..model import checks
from . import cautions, sleeping
from .answers.run_data import Run
from .assemble import Assembled
from .collectors import Touch
from .derivatives import check_run, records
from .forms.mesh import Mesh
from .forms.route_form import AnyForm
from .lines.line import Line
from .lines.route import Route
from .plan import Door, Plan, formed, make_plan
from .ready import STEP, Ready, ready
from .recorded import recorded
from .rest import form
from .touching import Watched
from .twin import second_supports
from .vehicles.pantograph import Pantograph
from .vehicles.travel import make_travel

#: Mesh and step of the trial run that finds a mean height.
TRIAL, TRIAL_STEP = Mesh(contact=2.0, messenger=3.0), 2e-3

Speed = float | Sequence[Sequence[float]]


def run(
    line: Line | Route | AnyForm | Assembled | str | Path,
    *,
    speed: Speed,
    pantograph: Pantograph | str | Sequence[Pantograph | str] = "benchmark-2015",
    spacing: float | Sequence[float] | None = None,
    start: float | None = None,
    window: tuple[float, float] | None = None,
    until: float | None = None,
    contact: str = "penalty",
    contact_stiffness: float | None = None,
    contact_damping: float = 0.0,
    step: float = STEP,
    mesh: Mesh | None = None,
    integrator: Any = None,
    output_step: float | None = None,
    file: str | Path | None = None,
    progress: Callable[[Any], None] | None = None,
    controller: Callable[[Any], Any] | None = None,
    control_step: float | None = None,
    control_delay: float = 0.0,
    modify: Callable[[Assembled], Any] | None = None,
    sensitivities: Mapping[str, Sequence[str]] | None = None,
    roof: Any = None,
    underside: Any = None,
    reduce: bool = False,
    broken_droppers: Sequence[str] = (),
) -> Run:
    """Run pantographs along a line from its equilibrium.

    Parameters
    ----------
    line : Line, Route, Form, RouteForm, Overhead, str or path
        A line or several tension lengths, the form, the model as :func:`assemble` makes it, perhaps
        changed, the name of a line of the catalogue, or a line file.
    speed : float, m/s, or (n, 2)
        Of the train; or a profile, rows of time in s and speed in m/s, linear between them.
    pantograph : Pantograph, str or a sequence of them
        All alike, or one after the other from the first that passes on.
    spacing : float or sequence, m
        Distance of a second pantograph behind the first; a sequence for more.
    start : float, m
        Track position of the last pantograph at t = 0, default a third of the first span.
    window : (float, float), m
        Track interval that is evaluated; default a third of the spans, in the middle if the train allows.
    until : float, m
        Track position at which the last pantograph stops, default 40 m beyond the window.
    contact : "penalty" or "joint"
        Stiffness of the contact, or the sliding joint, which takes no overlap. Both only push.
    contact_stiffness, contact_damping : float, N/m, N s/m
        Of the penalty, default 50 kN/m; or of a spring between head and strip, on which the strip slides
        in a joint. A joint without them is rigid.
    step : float, s
    mesh : Mesh
        Of a line or its name; a Form has its own.
    integrator : integrator
        Default generalised-alpha with a spectral radius of 0.9, of 0.5 and GGL constraints with the joint.
    output_step : float, s
        Time between stored states of the whole line, a multiple of `step`, for pictures and animations;
        default the first and the last one alone.
    file : path
        HDF5 file that takes the states and what is recorded while it is computed; default in memory.
    progress : callable
        Called with a :class:`ancf.results.Progress` between blocks of steps.
    controller, control_step : callable and float, s
        See :func:`ancf.simulate`; its inputs are forces on the lowest masses of the pantographs, N, upwards:
        ``run.inputs["pantograph_force"]``, of several ``"pantograph_1_force"`` and so on. The contact force
        is ``run.pantograph().force``, of several ``run.pantograph(1).force``, see :class:`Touching`.
    control_delay : float, s
        Time after which what the controller gives takes effect, rounded up to whole control steps.
    modify : callable
        Called with the :class:`Overhead` before pantographs are added: it changes the model, and nothing
        that it returns counts. A trial run for a mean height has another mesh, to which it is applied too.
    sensitivities : mapping
        By the name of a parameter the droppers that it makes longer alike, ``{"first": ["6-1", "7-1"]}``
        (span and number from 1), by which derivatives are wanted: :func:`ancf.catenary.slopes`.
    roof : function of time, m, or CSV file
        Motion of the vehicle's roof upwards: a formula, a Python function, a :class:`ancf.Series`; or
        ``{"up": ..., "side": ...}`` with one to the left, which takes the strip along. A file has the columns
        ``t``, ``up`` and perhaps ``side``, with units in their heads. A list has one for each pantograph.
    underside : (n, 2) m, or CSV file
        Track positions and heights of the underside of the contact wires above that of a new wire: what is
        worn off is positive, so are the crests of waves; see :func:`random_underside`. A file has the columns
        ``position`` in m and ``height_mm``.
    reduce : bool
        Whether spans move by their modes up to 50 Hz while no pantograph is near and their droppers are taut
        (Craig and Bampton 1968), which long lines gain time by. Not with `sensitivities`,
        sliding joints, or an `integrator` that makes a matrix in each iteration or lets it turn. It changes
        standard deviations by less than 0.5 %, or says what may make that more.
    broken_droppers : sequence of str
        Span and number from 1, ``["8-3"]``, of droppers that are gone; their halves stay at the clamps as
        masses. The line is formed with them and comes to rest without them.

    Returns
    -------
    Run
        Recorded at every step.

    Raises
    ------
    ModelError
        What was given is wrong, such as a pantograph outside the line.
    SolveError
        A step failed.

    Warns
    -----
    UserWarning
        Numbers may not mean what they say: a speed near the wave speed of the contact wire or above it,
        elements or steps too long for what is evaluated, a window right behind the start, a contact that
        chatters, and with `reduce` a line that is hardly damped or whose supports are lifted by 0.1 m.
    """
    checks.progress(progress, "run.progress")
    delay = checks.non_negative(control_delay, "run.control_delay")
    hint = 'the droppers of each parameter: {"first": ["6-1", "7-1"]}'
    sensitivities = checks.mapping(sensitivities, "run.sensitivities", hint)
    plan = planned(
        line,
        speed=speed,
        pantograph=pantograph,
        spacing=spacing,
        start=start,
        window=window,
        until=until,
        contact=contact,
        contact_stiffness=contact_stiffness,
        contact_damping=contact_damping,
        step=step,
        mesh=mesh,
        modify=modify,
        roof=roof,
        underside=underside,
        broken_droppers=broken_droppers,
    )
    sleeps = sleeping.allowed(reduce, integrator, touch=plan.touch.kind, derived=bool(sensitivities))
    _warn(cautions.before(plan, sleeps))
    plan = relaxed(plan, sleeps)
    if sensitivities:
        check_run(plan, sensitivities, controller, integrator)
    if controller is None:
        for key, value in (("control_step", control_step), ("control_delay", delay or None)):
            if value is not None:
                raise ModelError(f"run.{key}", "has no effect without controller", "leave it out")
    elif delay:
        controller = Delayed(controller, delay)
    led: dict[str, Any] = (
        {} if controller is None else {"controller": controller, "control_step": control_step}
    )
    stored: dict[str, Any] = {"output_step": output_step, "file": file}
    done = simulated(plan, integrator, progress, sensitivities=sensitivities, sleeps=sleeps, **stored, **led)
    _warn(cautions.after(done))
    return done


def planned(
    line: Line | Route | AnyForm | Assembled | str | Path,
    *,
    speed: Speed,
    pantograph: Any,
    spacing: Any,
    start: float | None,
    window: tuple[float, float] | None,
    until: float | None,
    contact: str,
    contact_stiffness: float | None,
    contact_damping: float,
    step: float,
    mesh: Mesh | None,
    modify: Callable[[Assembled], Any] | None,
    roof: Any,
    underside: Any,
    broken_droppers: Sequence[str],
) -> Plan:
    """What is given to :func:`run`, checked."""
    shape = formed(line, mesh)
    touch = Touch(contact, contact_stiffness, contact_damping)
    door = Door.of(line, shape, modify, broken_droppers, "run")
    travel, own = make_travel(speed), (pantograph, spacing, start, window, until, touch, step, door)
    return make_plan(shape, travel, *own, roof, underside)


def _warn(texts: Iterator[str]) -> None:
    """Warnings at the line that called :func:`run`."""
    for text in texts:
        warnings.warn(text, UserWarning, stacklevel=4)


def relaxed(plan: Plan, sleeps: bool) -> Plan:
    """The plan with springs relaxed at the mean heights over the window, from a trial run on a coarse mesh.

    Where pantographs ask for that. They take nothing from the mean of the contact force: what is missing
    there in the trial run, to the mean over the window of what lifts the pantograph at its speeds, is how
    much higher they have to be.
    """
    if not any(unit.relaxed_at == "mean" for unit in plan.pantographs):
        return plan
    mesh = plan.form if plan.door.given is not None else form(plan.form.line, TRIAL)
    trial = replace(plan, form=mesh, step=TRIAL_STEP)
    done = simulated(trial, None, None, sleeps=sleeps)
    raised = []
    for k, (unit, recording) in enumerate(zip(plan.pantographs, done.recordings, strict=True)):
        passing = (recording.position >= plan.window[0]) & (recording.position <= plan.window[1])
        missing = float(np.mean(plan.lift(k, done.t[passing]) - recording.force[passing]))
        stiffness = unit.slopes()[0]
        wanted = unit.relaxed_at == "mean" and stiffness > 0.0
        raised.append(missing / stiffness if wanted else 0.0)
    return replace(plan, raised=raised, spent=done.cpu_seconds)


def settings_of(begun: Ready, integrator: Any) -> dict[str, Any]:
    """What is given to a simulation of what :func:`recorded` is told."""
    settings = begun.settings(integrator)
    settings["sensors"] = [*settings["sensors"], *second_supports(begun.overhead).values()]
    return settings


def simulated(
    plan: Plan,
    integrator: Any,
    progress: Callable[[Any], None] | None,
    output_step: float | None = None,
    file: str | Path | None = None,
    sensitivities: Mapping[str, Sequence[str]] | None = None,
    sleeps: bool = False,
    **led: Any,
) -> Run:
    """The run of a plan whose springs are relaxed where they have to be; keywords as of :func:`run`."""
    begun = ready(plan, active=bool(led), sleeps=sleeps, sensitivities=sensitivities)
    if callable(led.get("controller")):
        led["controller"] = Watched(led["controller"], begun.collectors)
    given: dict[str, Any] = {
        "t_end": plan.duration,
        "output_step": plan.duration if output_step is None else output_step,
        "file": file,
        "progress": progress,
        **settings_of(begun, integrator),
        **led,
    }
    model, spans = begun.overhead.model, None
    if begun.sleep is None:
        result = ancf.simulate(model, **given, sensitivities=begun.wanted)
    else:
        result, spans = sleeping.simulated(begun.overhead, begun.sleep, **given)
    made = recorded(result, begun, sleeping.said(spans))
    if begun.alone is None:
        return made
    found = {}
    for parameter in begun.wanted:
        name, rest = parameter.name, begun.alone.sensitivity(parameter.name)
        found[name] = records(result.sensors, begun, name, rest, made.uplift)
    return replace(made, slopes=found)
