"""The mooring lines that are validated, each as its source has it: models, and what is read off them."""

from __future__ import annotations

import math
import warnings
from typing import Any

import numpy as np

from ..analysis import equilibrium, simulate
from ..arrays import FloatArray
from ..model.bodies.beam import Beam
from ..model.integrators import GeneralizedAlpha
from ..model.model import Model
from ..model.sections.section import Section
from ..results.result import Result

GRAVITY = 9.81
#: Cycles of a motion before it is read, and those that are.
RUN_IN, READ = 3, 3


def catenary(friction: float, elements: int = 100, stiffness: float = 1e8) -> dict[str, float]:
    """MoorPy's example of a line on a seabed; H at both ends, N.

    The anchor lies as deep in the ground as the line.
    """
    weight, diameter = 800.0, 0.1
    low = -weight / (stiffness * diameter)
    model = Model(gravity=(0, 0, -GRAVITY))
    section = Section(EA=7.51e12, EI=0.0, rhoA=weight / GRAVITY, diameter=diameter)
    line = model.add_beam(
        "line",
        start=(0, 0, low),
        end=(400.0, 0, 200.0 + low),
        elements=elements,
        section=section,
        length=500.0,
    )
    anchor, fairlead = model.pin(line.start), model.pin(line.end)
    model.add_ground("seabed", 0.0, stiffness=stiffness, friction=friction)
    state = equilibrium(model)
    return {
        "anchor": float(-state.reaction(anchor)[0]),
        "fairlead": float(state.reaction(fairlead)[0]),
    }


#: Nodes of the chain of 320 m with 20 elements: short ones where it touches down.
GRADED = np.concatenate([[0.0, 20.0], np.linspace(40.0, 140.0, 11), np.linspace(140.0, 320.0, 9)[1:]])


def chain(nodes: FloatArray = GRADED, motion: float = 2.0) -> tuple[Model, Beam]:
    """Chain of 320 m in 100 m of water, its fairlead moved by an amplitude, m, in 10 s, or held."""
    model = Model(gravity=(0, 0, -9.80665))
    section = Section(EA=2e8, EI=0.0, rhoA=50.0, diameter=0.1, drag=(1.6, 0.1), added_mass=(1.0, 0.0))
    line = model.add_beam(
        "chain", start=(0, 0, -100.0), end=(290.0, 0, 0), nodes=nodes, section=section, length=320.0
    )
    model.pin(line.start, name="anchor")
    way = [f"{motion}*sin(2*pi*t/10)", 0, 0] if motion else None
    model.pin(line.end, displacement=way, name="fairlead")
    model.add_fluid("water", 1025.0)
    model.add_ground("seabed", -100.0, stiffness=3e6, damping=3e5)
    return model, line


def forces_of_chain() -> dict[str, float]:
    """Static forces of the chain, and the extremes of the moved one from 40 to 60 s, N."""
    still = equilibrium(chain(motion=0.0)[0])
    static = [float(np.linalg.norm(still.reaction(name))) for name in ("fairlead", "anchor")]
    model, line = chain()
    run = simulate(model, t_end=60.0, step=0.05, start=equilibrium(model), integrator=GeneralizedAlpha(0.8))
    found = {"static at the fairlead": static[0], "static at the anchor": static[1]}
    for name, point in (("fairlead", line.end), ("anchor", line.start)):
        force = run.tension(point)[run.t >= 40.0]
        found |= {f"least at the {name}": float(force.min()), f"largest at the {name}": float(force.max())}
    return found


#: Bar of OrcaFlex's studless chain, m, by all three of 1.8 d = 0.252 m, 19900 d^2 = 390 kg/m and 8.54e10 d^2
#: = 1.674e9 N, and the width over its links: its axis lies half of that above the seabed.
BAR = 0.14
WIDTH = 3.35 * BAR


def heaving_chain(elements: int = 40) -> dict[str, float]:
    """Chain of 410 m in 50 m of water whose upper end heaves by 2 m in 10 s, as in OrcaFlex's list, N.

    Its axis and its anchor are half of the width over the links above the seabed. The drag along it is one
    on d, here on pi d.
    """
    model = Model(gravity=(0, 0, -GRAVITY))
    drag = 1.37, 0.64 / math.pi
    section = Section(EA=1.674e9, EI=0.0, rhoA=390.0, diameter=1.8 * BAR, drag=drag, added_mass=(1.0, 0.0))
    low = -50.0 + 0.5 * WIDTH
    line = model.add_beam(
        "chain", start=(0, 0, low), end=(400.0, 0, 0), elements=elements, section=section, length=410.0
    )
    model.pin(line.start, name="anchor")
    model.pin(line.end, displacement=[0, 0, "2*ramp(t,0,10)*sin(2*pi*t/10)"], name="fairlead")
    model.add_fluid("water", 1025.0)
    model.add_ground("seabed", low, stiffness=1e6, damping=1e5)
    state = equilibrium(model)
    run = simulate(model, t_end=60.0, step=0.05, start=state, integrator=GeneralizedAlpha(0.8))
    force = run.tension(line.end)[run.t >= 40.0]
    return {
        "static at the fairlead": float(np.linalg.norm(state.reaction("fairlead"))),
        "static at the anchor": float(np.linalg.norm(state.reaction("anchor"))),
        "least at the fairlead": float(force.min()),
        "largest at the fairlead": float(force.max()),
    }


def measured_chain(
    radius: float, period: float, elements: int = 40, stiffness: float = 1e7
) -> tuple[Model, Beam]:
    """The chain of Bergdahl et al. (2016), its upper end on a circle.

    Its volume is that of its mass in steel; the coefficients of drag, of the diameter 2.2 mm, are scaled to
    the circle of that volume. The ground is critically damped; friction sticks with a stiffness that lets it
    move by less than 0.1 mm. With the 3 GPa/m of the source instead of 10 MPa/m, on which the chain sinks in
    by a hundredth of its diameter, the peaks change by less than 0.1 N and cost ten times as much.
    """
    bar, mass = 2.2e-3, 0.0818
    diameter = math.sqrt(4.0 * mass / 7800.0 / math.pi)
    scale = bar / diameter
    drag = 2.5 * scale, 0.5 * scale
    section = Section(EA=1e4, EI=0.0, rhoA=mass, diameter=diameter, drag=drag, added_mass=(3.8, 0.0))
    model = Model(gravity=(0, 0, -GRAVITY))
    line = model.add_beam(
        "chain", start=(0, 0, -3.0), end=(32.554, 0, 0.3), elements=elements, section=section, length=33.0
    )
    model.pin(line.start, name="anchor")
    grown = f"{radius}*ramp(t,0,{2 * period})"
    angle = f"2*pi*t/{period}"
    model.pin(line.end, displacement=[f"{grown}*sin({angle})", 0, f"{grown}*cos({angle})"], name="fairlead")
    model.add_fluid("water", 1000.0, below=0.0)
    model.add_ground(
        "bottom",
        -3.0,
        stiffness=stiffness * scale,
        damping=2.0 * math.sqrt(stiffness * bar * mass) / diameter,
        friction=0.3,
        stick=1e6,
    )
    return model, line


def peaks(run: Result, line: Beam, period: float) -> FloatArray:
    """Largest force at the upper end in each cycle that is read, N."""
    force = run.tension(line.end)
    cycle = np.floor(run.t / period + 1e-9)
    return np.array([force[cycle == k].max() for k in range(RUN_IN, RUN_IN + READ)])


def mean_peak(radius: float, period: float, steps: int = 1000, **given: Any) -> float:
    """Mean of the largest force in a cycle of so many steps at the upper end of the measured chain, N."""
    model, line = measured_chain(radius, period, **given)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of energies at a hard ground
        run = simulate(
            model,
            t_end=(RUN_IN + READ) * period,
            step=period / steps,
            start=equilibrium(model),
            integrator=GeneralizedAlpha(0.8),
        )
    return float(peaks(run, line, period).mean())
