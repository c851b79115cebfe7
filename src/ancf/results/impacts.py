"""What falls on a ground that is too hard for the steps of a run; said before it falls."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..model.integrators import NewmarkFamily
from ..model.surroundings.grounds import Ground
from ..system.system import System

#: Angle of the bounce of a cable on a ground in a step, rad, above which impacts make energy.
RESOLVED = 0.5


def unresolved(
    system: System, q: FloatArray, method: Any, step: float, *, at_rest: bool = False
) -> list[str]:
    """What is said of cables and beams that will fall on grounds, from above them in the state q.

    On a spring of the stiffness k d a cable of the mass rhoA bounces with sqrt(k d/rhoA).  A step in which
    that is a radian or more finds it deep in the ground and throws it out with more than it had, damped or
    not; `GeneralizedAlpha(rho_inf=0)` alone does not.  What lies there from the start does not fall, nor
    does what hangs ``at_rest`` farther above than it is long.
    """
    if not isinstance(method, NewmarkFamily) or getattr(method, "rho_inf", 1.0) == 0.0:
        return []
    found = [_said(ground, system, q, step, at_rest) for ground in system.model.grounds]
    return [text for text in found if text]


def _said(ground: Ground, system: System, q: FloatArray, step: float, at_rest: bool) -> str:
    rates = {}
    for name, beam in system.model.beams.items():
        if ground.acts_on(name) and beam.section.diameter:
            places = q[system.slots[name][:, :1] + np.arange(3)]
            farthest = -beam.length if at_rest else -math.inf
            if farthest < max(ground.depth(place) for place in places) < 0.0:
                rates[name] = math.sqrt(ground.stiffness * beam.section.diameter / beam.section.rhoA)
    name = max(rates, key=rates.__getitem__, default="")
    if not name or rates[name] * step <= RESOLVED:
        return ""
    rate = rates[name]
    softer = ground.stiffness * (RESOLVED / (rate * step)) ** 2
    return (
        f'"{name}" would bounce on the ground "{ground.name}" with {rate:.3g} rad/s, which steps of '
        f"{step:g} s do not follow: an impact may make energy from nothing; take {RESOLVED / rate:.2g} s, "
        f"a stiffness of {softer:.2g} Pa/m, or GeneralizedAlpha(rho_inf=0.0)"
    )
