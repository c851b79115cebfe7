"""A case built and solved with ancf, through its public interface.

The counter ``cpu_seconds`` of a result covers the stepping. The peer's solve contains the initial
accelerations too, so their time is added here: ``Run.start`` gets a clock.
"""

from __future__ import annotations

import time
from itertools import pairwise
from typing import Any

import ancf
import overhead
from ancf.solvers.stepping import Run
from cases import GRAVITY, Beams, Cable, Case, Hanging, Net, Overhead, Sliding

spent = {"start": 0.0}  # CPU seconds of the initial accelerations in the last solve
_start = Run.start


def _timed_start(run: Run, *state: Any) -> None:
    begin = time.process_time()
    _start(run, *state)
    spent["start"] = time.process_time() - begin


Run.start = _timed_start  # type: ignore[method-assign, assignment]


def version() -> str:
    return str(ancf.__version__)


def build(case: Case) -> ancf.Model:
    if isinstance(case, Net):
        return build_net(case)
    assert isinstance(case, Cable | Sliding)
    return build_cable(case) if isinstance(case, Cable) else build_sliding(case)


def build_net(case: Net) -> ancf.Model:
    section = ancf.Section(EA=case.EA, EI=case.EI, rhoA=case.rhoA)
    model = ancf.Model(gravity=(0.0, 0.0, -GRAVITY))
    wires = []
    for k in range(case.cables):
        y, name = k * case.gap, "beam" if k == case.cables - 1 else f"cable {k}"
        ends = {"start": (0, y, 0), "end": (case.length, y, 0)}
        wires.append(model.add_beam(name, **ends, elements=case.count, section=section))
        model.pin(wires[-1].start)
        if k < case.cables - 1:
            model.pin(wires[-1].end)
    for one, two in pairwise(wires):
        for i in range(1, case.count):
            x = case.length * i / case.count
            model.add_spring(one.at(x), two.at(x), stiffness=case.stiffness, damping=case.damping)
    return model


def build_cable(case: Cable) -> ancf.Model:
    section = ancf.Section(EA=case.EA, EI=case.EI, rhoA=case.rhoA)
    kind = {"section": section}
    if isinstance(case, Beams):
        square = ancf.Section.rectangle(width=case.side, height=case.side, E=case.E, rho=case.rho, nu=0.0)
        kind = {"section": square, "element": case.element}
    model = ancf.Model(gravity=(0.0, 0.0, -GRAVITY))
    beam = model.add_beam("beam", start=(0, 0, 0), end=(case.length, 0, 0), elements=case.elements, **kind)
    beam.set_motion(angular_velocity=(0.0, 0.0, case.omega))
    if case.clamped:
        model.clamp(beam.start, **({} if isinstance(case, Beams) else {"stretch": "fixed"}))
    else:
        model.pin(beam.start)
    if isinstance(case, Hanging) and case.held:
        model.pin(beam.end)
    return model


def build_sliding(case: Sliding) -> ancf.Model:
    section = ancf.Section(EA=case.EA, EI=case.EI, rhoA=case.rhoA)
    model = ancf.Model(gravity=(0.0, 0.0, -GRAVITY))
    carrier = model.add_beam(
        "carrier", start=case.start, end=case.joint, elements=case.carrier, section=section
    )
    beam = model.add_beam("beam", start=case.joint, end=case.tip, elements=case.slider, section=section)
    mass = model.add_point_mass("mass", at=case.tip, mass=case.mass)
    model.pin(carrier.start)
    model.pin(carrier.end)
    model.connect(mass, beam.end)
    model.slide(beam.start, along=carrier)
    return model


def solve(case: Case, options: dict[str, Any]) -> dict[str, Any]:
    """Build and solve; CPU seconds of the solve (start and steps) and of everything."""
    if isinstance(case, Overhead):
        return solve_overhead(case, options)
    if case.static:
        return solve_static(case)
    start = time.process_time()
    model = build(case)
    state = ancf.equilibrium(model, of=["carrier"]) if isinstance(case, Sliding) else None
    integrator = ancf.Trapezoidal(newton=ancf.Newton(**options.get("newton", {})))
    result = ancf.simulate(
        model,
        t_end=case.t_end,
        step=case.step,
        start=state,
        integrator=integrator,
        output_step=case.t_end,
    )
    tip = result.position("beam.end")[-1]
    stats = result.stats
    return {
        "cpu": spent["start"] + stats.cpu_seconds,
        "cpu_stepping": stats.cpu_seconds,
        "cpu_whole": time.process_time() - start,
        "steps": stats.steps,
        "newton_iterations": stats.newton_iterations,
        "jacobians": stats.jacobians,
        "tip": [float(x) for x in tip],
    }


def solve_static(case: Case) -> dict[str, Any]:
    """The same for an equilibrium; what is compared is the middle of the cable."""
    start = time.process_time()
    model = build(case)
    state = ancf.equilibrium(model)
    middle = state.position(model.bodies["beam"].at(0.5 * case.length))
    return {
        "cpu": state.stats.cpu_seconds,
        "cpu_whole": time.process_time() - start,
        "steps": 1,
        "newton_iterations": state.stats.newton_iterations,
        "jacobians": state.stats.jacobians,
        "tip": [float(x) for x in middle],
    }


def solve_overhead(case: Overhead, options: dict[str, Any]) -> dict[str, Any]:
    """The same for the overhead line; "cpu_rest" is the time of form finding and equilibria."""
    start = time.process_time()
    run = overhead.run(case, overhead.form(case), options.get("contact", "joint"))
    whole = time.process_time() - start
    recording, settings = run.recordings[0], run.settings
    inside = (recording.position > 20.0) & (recording.position < 220.0)
    force = recording.force[inside]
    return {
        "cpu": spent["start"] + run.cpu_seconds,
        "cpu_stepping": run.cpu_seconds,
        "cpu_whole": whole,
        "steps": settings["steps"],
        "newton_iterations": settings["Newton iterations"],
        "jacobians": settings["factorisations"],
        "tip": [float(recording.position[-1]), 0.0, float(recording.strip[-1])],
        "force": overhead.summary(force),
    }
