"""Run pantographs along a line, from the form that it has at rest."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

import ancf

from ..arrays import FloatArray
from ..control.delay import Delayed
from ..model import checks
from . import cautions, sleeping
from .assemble import Assembled
from .collectors import Collector, Touch, put_pantograph
from .derivatives import check_run, parameters, records
from .line import Line
from .mesh import Mesh
from .pantograph import Pantograph
from .plan import Door, Plan, formed, make_plan
from .rest import form
from .route import Route
from .route_form import AnyForm
from .run_data import Recording, Run
from .travel import make_travel
from .travelling import level_of, lifted_heights
from .underside import profiles

STEP = 1e-3
#: Newton's tolerance at a step of 1 ms; it grows with the square of the step, up to the second number. Where
#: spans sleep it is so many times larger: 0.005 N of a contact, of which modes that are left out take 0.2 N.
TOLERANCE, LOOSEST, WITH_SLEEP = 1e-8, 1e-7, 10.0
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
        is ``run.contact_force("pantograph contact")``, that of several ``"pantograph 1 contact"``.
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
        (Craig and Bampton 1968), which long lines gain time by. Not with a `controller`, `sensitivities`,
        sliding joints, or an `integrator` that makes a matrix in each iteration or lets it turn.

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
        chatters.
    """
    plan = make_plan(
        formed(line, mesh),
        make_travel(speed),
        pantograph,
        spacing,
        start,
        window,
        until,
        Touch(contact, contact_stiffness, contact_damping),
        step,
        Door(line if isinstance(line, Assembled) else None, modify),
        roof,
        underside,
    )
    sleeps = sleeping.allowed(
        reduce, integrator, touch=plan.touch.kind, led=controller is not None, derived=bool(sensitivities)
    )
    _warn(cautions.before(plan))
    if any(unit.relaxed_at == "mean" for unit in plan.pantographs):
        plan = _relaxed(plan, sleeps)
    if sensitivities:
        check_run(plan, sensitivities, controller)
    if controller is not None and checks.non_negative(control_delay, "run.control_delay"):
        controller = Delayed(controller, control_delay)
    led: dict[str, Any] = (
        {} if controller is None else {"controller": controller, "control_step": control_step}
    )
    stored: dict[str, Any] = {"output_step": output_step, "file": file}
    done = _simulated(plan, integrator, progress, sensitivities=sensitivities, sleeps=sleeps, **stored, **led)
    _warn(cautions.after(done))
    return done


def _warn(texts: Iterator[str]) -> None:
    """Warnings at the line that called :func:`run`."""
    for text in texts:
        warnings.warn(text, UserWarning, stacklevel=3)


def _relaxed(plan: Plan, sleeps: bool) -> Plan:
    """The plan with springs relaxed at the mean heights over the window, from a trial run on a coarse mesh.

    They take nothing from the mean of the contact force: what is missing there in the trial run, to the
    mean over the window of what lifts the pantograph at its speeds, is how much higher they have to be.
    """
    mesh = plan.form if plan.door.given is not None else form(plan.form.line, TRIAL)
    trial = replace(plan, form=mesh, step=TRIAL_STEP)
    done = _simulated(trial, None, None, sleeps=sleeps)
    raised = []
    for k, (unit, recording) in enumerate(zip(plan.pantographs, done.recordings, strict=True)):
        passing = (recording.position >= plan.window[0]) & (recording.position <= plan.window[1])
        missing = float(np.mean(plan.lift(k, done.t[passing]) - recording.force[passing]))
        stiffness = unit.slopes()[0]
        wanted = unit.relaxed_at == "mean" and stiffness > 0.0
        raised.append(missing / stiffness if wanted else 0.0)
    return replace(plan, raised=raised, spent=done.cpu_seconds)


def _simulated(
    plan: Plan,
    integrator: Any,
    progress: Callable[[Any], None] | None,
    output_step: float | None = None,
    file: str | Path | None = None,
    sensitivities: Mapping[str, Sequence[str]] | None = None,
    sleeps: bool = False,
    **led: Any,
) -> Run:
    overhead = plan.door.overhead(plan.form)
    rest = _rest(plan)
    alone = _alone(overhead, sensitivities or {})
    sleep = sleeping.Sleep(ancf.equilibrium(overhead.model)) if sleeps else None
    collectors = _collectors(overhead, plan, bool(led))
    model, duration = overhead.model, plan.duration
    wanted = parameters(overhead, model, sensitivities or {})
    droppers = [dropper for dropper in overhead.droppers if dropper is not None]
    given: dict[str, Any] = {
        "t_end": duration,
        "step": plan.step,
        "start": ancf.equilibrium(model, sensitivities=wanted),
        "integrator": _integrator(plan, sleeps) if integrator is None else integrator,
        "output_step": duration if output_step is None else output_step,
        "sensors": [*droppers, *overhead.supports, *(s for c in collectors for s in c.sensors())],
        "energy": False,
        "file": file,
        "progress": progress,
    }
    spans = None
    if sleep is None:
        result = ancf.simulate(model, **given, sensitivities=wanted, **led)
    else:
        result, spans = sleeping.simulated(overhead, sleep, **given)
    made = _recorded(result, overhead, collectors, plan, rest, sleeping.said(spans))
    if alone is None:
        return made
    names = [parameter.name for parameter in wanted]
    found = {n: records(result.sensors, overhead, collectors, n, alone.sensitivity(n)) for n in names}
    return replace(made, slopes=found)


def _alone(overhead: Assembled, sensitivities: Mapping[str, Sequence[str]]) -> ancf.State | None:
    """The line without pantographs with its derivatives, if they are wanted."""
    wanted = parameters(overhead, overhead.model, sensitivities)
    return ancf.equilibrium(overhead.model, sensitivities=wanted) if wanted else None


def _integrator(plan: Plan, sleeps: bool) -> ancf.GeneralizedAlpha:
    """Generalised-alpha; a joint, which has no mass of its own, needs more damping not to chatter."""
    base = TOLERANCE * (WITH_SLEEP if sleeps else 1.0)
    tolerance = min(max(base * (plan.step / STEP) ** 2, 1e-2 * base), LOOSEST)
    newton = ancf.Newton(tolerance=tolerance, corotate=False)
    if plan.touch.kind == "joint":
        return ancf.GeneralizedAlpha(0.5, formulation="ggl", newton=newton)
    return ancf.GeneralizedAlpha(0.9, newton=newton)


def _collectors(overhead: Assembled, plan: Plan, active: bool) -> list[Collector]:
    """Add the pantographs where they come to rest."""
    heights, count = _lifted(overhead, plan), len(plan.places)
    undersides = profiles(overhead, plan.underside)
    collectors = []
    for k, place in enumerate(plan.places):
        collectors.append(
            put_pantograph(
                overhead.model,
                overhead.contact_wires,
                plan.pantographs[k],
                plan.travel,
                label="pantograph" if count == 1 else f"pantograph {k + 1}",
                start=place,
                height=heights[k] + plan.touch.overlap(plan.lift(k)),
                raised=plan.raised[k],
                touch=plan.touch,
                active=active,
                level=level_of(plan.form.line),
                roof=plan.roofs[k],
                profiles=undersides,
            )
        )
    return collectors


def _lifted(overhead: Assembled, plan: Plan) -> list[float]:
    """Heights of the wire at the pantographs' places when it is lifted by their forces."""
    return lifted_heights(overhead, plan.places, [plan.lift(k) for k in range(len(plan.places))])


@dataclass(frozen=True)
class _Rest:
    """A line without pantographs: heights of its supports in m, forces of its droppers in N."""

    height: FloatArray
    load: FloatArray


def _rest(plan: Plan) -> _Rest:
    """The line at rest: as its form says, or of a changed model from its equilibrium."""
    found = plan.form
    if not plan.door.changed:
        return _Rest(found.support_height, found.dropper_load)
    overhead = plan.door.overhead(found)
    state = ancf.equilibrium(overhead.model)
    half = found.dropper_force - found.dropper_load
    force = [
        0.0 if d is None else float(state.spring_force(d)) - half[j] for j, d in enumerate(overhead.droppers)
    ]
    height = [float(state.position(point)[2]) for point in overhead.supports]
    return _Rest(np.array(height), np.array(force))


def _dropper_forces(sensors: Any, overhead: Assembled) -> FloatArray:
    """Histories (steps, n) in N; a broken dropper carries nothing."""
    forces = np.zeros((sensors.t.size, len(overhead.droppers)))
    for j, dropper in enumerate(overhead.droppers):
        if dropper is not None:
            forces[:, j] = sensors.spring_force(dropper)
    return forces


def _recorded(
    result: ancf.Result,
    overhead: Assembled,
    collectors: list[Collector],
    plan: Plan,
    rest: _Rest,
    said: dict[str, Any],
) -> Run:
    sensors, line = result.sensors, overhead.form.line
    t: FloatArray = sensors.t
    uplift = np.stack([sensors.position(p)[:, 2] for p in overhead.supports], axis=1) - rest.height
    simulated = float(t[-1] - t[0])
    cpu = plan.spent + result.stats.cpu_seconds
    return Run(
        form=overhead.form.with_loads(rest.load) if plan.door.changed else overhead.form,
        pantographs=[c.pantograph for c in collectors],
        speed=(float(plan.travel.distance(t[-1])) / simulated),
        t=t,
        recordings=[_recording(sensors, c) for c in collectors],
        uplift=uplift,
        dropper_force=_dropper_forces(sensors, overhead),
        window=plan.window,
        cpu_seconds=cpu,
        simulated_seconds=simulated,
        result=result,
        real_time_factor=simulated / max(cpu, 1e-9),
        settings={
            "line": line.title,
            **({"model": "changed after it was assembled"} if plan.door.changed else {}),
            "step [s]": plan.step,
            "steps": result.stats.steps,
            **({"CPU time of the trial run for the mean height [s]": plan.spent} if plan.spent else {}),
            "Newton iterations": result.stats.newton_iterations,
            "factorisations": result.stats.factorizations,
            "elements of the contact wire": sum(b.elements for b in overhead.contact_wires),
            "elements of the messenger wire": sum(
                b.elements for wire in overhead.messengers for b in wire.beams
            ),
            "contact": plan.touch.kind,
            "contact stiffness [N/m]": plan.touch.stiffness,
            "integrator": result.provenance["settings"]["integrator"],
            **said,
        },
    )


def _recording(sensors: Any, collector: Collector) -> Recording:
    """Forces of all contacts together; height and stagger are of the wire that presses most."""
    places = np.stack([sensors.position(head) for head in collector.heads])
    strips, wires = len(collector.heads), len(collector.meters) // len(collector.heads)
    if collector.slides:
        forces = [np.maximum(sensors.multiplier(touch)[:, 2], 0.0) for touch in collector.touches]
    else:
        forces = [sensors.contact_force(meter) for meter in collector.meters]
    shared = np.stack(forces).reshape(strips, wires, -1)
    gaps = np.stack([sensors.contact_gap(meter) for meter in collector.meters])
    asides = np.stack([sensors.contact_offset(meter) for meter in collector.meters])
    known = np.where(np.isfinite(gaps), gaps, np.inf)
    nearest, every = np.argmin(known, axis=0), np.arange(places.shape[1])
    gap, head = known[nearest, every], places[nearest // wires, every]
    return Recording(
        name=collector.name,
        position=np.mean(places[:, :, 0], axis=0),
        force=np.sum(forces, axis=0),
        height=head[:, 2] + np.where(np.isfinite(gap), gap, 0.0),
        stagger=head[:, 1] + asides[nearest, every],
        strip=np.mean(places[:, :, 2], axis=0),
        by_wire=shared.sum(axis=0).T,
        by_strip=shared.sum(axis=1).T,
    )
