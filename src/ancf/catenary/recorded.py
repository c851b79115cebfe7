"""From what a simulation along a line has recorded to a run."""

from __future__ import annotations

from typing import Any

import numpy as np

import ancf

from .. import garbage
from ..arrays import FloatArray
from .answers.run_data import Recording, Run
from .assemble import Assembled
from .broken import broken_of
from .collectors import Collector
from .forms.route_form import AnyForm
from .ready import Ready
from .twin import second_supports


def _dropper_forces(sensors: Any, overhead: Assembled) -> FloatArray:
    """Histories (steps, n) in N; a broken dropper carries nothing."""
    forces = np.zeros((sensors.t.size, len(overhead.droppers)))
    for j, dropper in enumerate(overhead.droppers):
        if dropper is not None:
            forces[:, j] = sensors.spring_force(dropper)
    return forces


def _resting(overhead: Assembled, load: FloatArray) -> AnyForm:
    """The form with loads (n,) of the droppers at their lower ends, N, as a changed model rests."""
    found, whole = overhead.form, np.array([d is not None for d in overhead.droppers], dtype=bool)
    half = found.dropper_force - found.dropper_load
    return found.with_forces(np.where(whole, load + half, 0.0), load)


def _lift_second(uplift: FloatArray, sensors: Any, ready: Ready) -> None:
    """At supports of twin contact wires the uplift (steps, supports) is that of the higher one, m."""
    points = second_supports(ready.overhead)
    if not points:
        return
    plan = ready.plan
    places = {k: float(point.initial_position[2]) for k, point in points.items()}
    if plan.door.changed:
        alone = plan.door.overhead(plan.form)
        state = ancf.equilibrium(alone.model)
        places = {k: float(state.position(p)[2]) for k, p in second_supports(alone).items()}
    for k, point in points.items():
        np.maximum(uplift[:, k], sensors.position(point)[:, 2] - places[k], out=uplift[:, k])


@garbage.without
def recorded(result: ancf.Result, ready: Ready, said: dict[str, Any]) -> Run:
    """What a run has recorded; ``said`` joins its settings."""
    overhead, plan, rest = ready.overhead, ready.plan, ready.rest
    sensors, line, collectors = result.sensors, overhead.form.line, ready.collectors
    t: FloatArray = sensors.t
    uplift = np.stack([sensors.position(p)[:, 2] for p in overhead.supports], axis=1) - rest.height
    _lift_second(uplift, sensors, ready)
    simulated = float(t[-1] - t[0])
    broken = broken_of(overhead)
    cpu = plan.spent + result.stats.cpu_seconds
    return Run(
        form=_resting(overhead, rest.load) if plan.door.changed else overhead.form,
        pantographs=[c.pantograph for c in collectors],
        speed=(float(plan.travel.distance(t[-1])) / simulated),
        t=t,
        recordings=[recording(sensors, c) for c in collectors],
        uplift=uplift,
        dropper_force=_dropper_forces(sensors, overhead),
        window=plan.window,
        cpu_seconds=cpu,
        simulated_seconds=simulated,
        result=result,
        real_time_factor=simulated / max(cpu, 1e-9),
        settings={
            "line": line.title,
            **({"model": "changed after it was assembled"} if plan.door.opened else {}),
            **({"broken droppers": ", ".join(broken)} if broken else {}),
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
        broken_droppers=broken,
    )


def recording(sensors: Any, collector: Collector) -> Recording:
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
