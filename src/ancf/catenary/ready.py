"""A line with pantographs at the beginning of a run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

import ancf

from .. import garbage
from ..arrays import FloatArray
from ..sensitivity.parameters import Parameter
from .assemble import Assembled
from .collectors import Collector, put_pantograph
from .derivatives import parameters
from .plan import Plan
from .sleeping import Sleep
from .travelling import level_of, strip_heights
from .underside import profiles

STEP = 1e-3
#: Newton's tolerance at a step of 1 ms; it grows with the square of the step, up to the second number. Where
#: spans sleep it is so many times larger: 0.005 N of a contact, of which modes that are left out take 0.2 N.
TOLERANCE, LOOSEST, WITH_SLEEP = 1e-8, 1e-7, 10.0


@dataclass(frozen=True)
class Rest:
    """A line without pantographs: heights of its supports in m, forces of its droppers in N."""

    height: FloatArray
    load: FloatArray


@dataclass(frozen=True)
class Ready:
    """The model of a run, and what its evaluation needs.

    Attributes
    ----------
    plan : Plan
    overhead : Assembled
        With the pantographs.
    collectors : list of Collector
    rest : Rest
        Of the line without pantographs.
    sleep : Sleep or None
        What spans need that are to sleep.
    wanted : list of Parameter
        By which derivatives are wanted.
    droppers : mapping
        The droppers that these lengthen, by name.

    """

    plan: Plan
    overhead: Assembled
    collectors: list[Collector]
    rest: Rest
    sleep: Sleep | None
    wanted: list[Parameter]
    droppers: Mapping[str, Sequence[str]]

    @cached_property
    @garbage.without
    def alone(self) -> ancf.State | None:
        """The line without pantographs with its derivatives, if they are wanted."""
        if not self.wanted:
            return None
        overhead = self.plan.door.overhead(self.plan.form)
        wanted = parameters(overhead, overhead.model, self.droppers)
        return ancf.equilibrium(overhead.model, sensitivities=wanted)

    @garbage.without
    def settings(self, integrator: Any) -> dict[str, Any]:
        """What is given to a simulation or to steps one by one; an integrator of None is the default."""
        model = self.overhead.model
        droppers = [dropper for dropper in self.overhead.droppers if dropper is not None]
        own = [sensor for collector in self.collectors for sensor in collector.sensors()]
        if integrator is None:
            integrator = integrator_of(self.plan, self.sleep is not None)
        return {
            "step": self.plan.step,
            "start": ancf.equilibrium(model, sensitivities=self.wanted),
            "integrator": integrator,
            "sensors": [*droppers, *self.overhead.supports, *own],
            "energy": False,
        }


@garbage.without
def ready(
    plan: Plan, *, active: bool, sleeps: bool, sensitivities: Mapping[str, Sequence[str]] | None = None
) -> Ready:
    """Make the model of a plan, with inputs for forces on the pantographs if they are ``active``."""
    overhead, given = plan.door.overhead(plan.form), sensitivities or {}
    rest = _rest(plan)
    sleep = Sleep(ancf.equilibrium(overhead.model)) if sleeps else None
    collectors = _collectors(overhead, plan, active)
    wanted = parameters(overhead, overhead.model, given)
    return Ready(plan, overhead, collectors, rest, sleep, wanted, given)


def integrator_of(plan: Plan, sleeps: bool) -> ancf.GeneralizedAlpha:
    """Generalised-alpha; a joint, which has no mass of its own, needs more damping not to chatter.

    What a matrix that turns with the wires saves of a joint's iterations is more than what it costs.
    """
    base = TOLERANCE * (WITH_SLEEP if sleeps else 1.0)
    tolerance = min(max(base * (plan.step / STEP) ** 2, 1e-2 * base), LOOSEST)
    joint = plan.touch.kind == "joint"
    newton = ancf.Newton(tolerance=tolerance, corotate=joint)
    if joint:
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
                height=heights[k],
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
    """Heights of the strips where the pantographs stand, on a line that is lifted by their forces."""
    lifts = [plan.lift(k) for k in range(len(plan.places))]
    return strip_heights(overhead, plan.pantographs, plan.places, lifts, plan.touch, plan.underside)


def _rest(plan: Plan) -> Rest:
    """The line at rest: as its form says, or of a changed model from its equilibrium."""
    found = plan.form
    if not plan.door.changed:
        return Rest(found.support_height, found.dropper_load)
    overhead = plan.door.overhead(found)
    state = ancf.equilibrium(overhead.model)
    half = found.dropper_force - found.dropper_load
    force = [
        0.0 if d is None else float(state.spring_force(d)) - half[j] for j, d in enumerate(overhead.droppers)
    ]
    height = [float(state.position(point)[2]) for point in overhead.supports]
    return Rest(np.array(height), np.array(force))
