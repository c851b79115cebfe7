"""Fluid: what bodies move in."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...errors import ModelError
from ..bodies.beam import Beam
from ..functions.function import TimeFunction
from .gusts import Gusts
from .velocity_field import VelocityField
from .waves import Waves


@dataclass(frozen=True, slots=True, eq=False)
class Fluid:
    """A fluid, made by ``Model.add_fluid``."""

    name: str
    density: float
    velocity: VelocityField
    above: float | None
    below: float | None
    on: tuple[str, ...] | None
    waves: Waves | None = None
    gusts: Gusts | None = None

    @property
    def moves(self) -> bool:
        """Whether it moves at some time and place."""
        return self.velocity.moves or self.waves is not None or self.gusts is not None

    @property
    def heights(self) -> tuple[float, float]:
        """Lowest and highest z, m."""
        low = -math.inf if self.above is None else self.above
        return low, math.inf if self.below is None else self.below

    def functions(self) -> list[TimeFunction]:
        """Inputs of its kernels: velocity and acceleration of the part that is the same everywhere, clock.

        The clock is (t, 1, 0); in the load steps of an equilibrium its second number is the share of the
        loads.
        """
        return self.velocity.functions()

    def acts_on(self, name: str) -> bool:
        """Whether it acts on a body."""
        return self.on is None or name in self.on

    def meets(self, other: Fluid) -> bool:
        """Whether there may be a body on which both act."""
        return self.on is None or other.on is None or bool(set(self.on) & set(other.on))


def require_section(item: Any, beam: Beam, wanted: tuple[str, ...]) -> None:
    """Raise ModelError if a beam cannot be in a fluid or on a ground.

    Its section lacks what they ask for, or it starts below the bottom of the fluid's waves.
    """
    if isinstance(item, Fluid):
        _refuse_deeper(item, beam)
    lacking = [key for key in wanted if getattr(beam.section, key) is None]
    if lacking:
        what = f'its section has no {" and no ".join(lacking)}, which "{item.name}" needs'
        example = ", ".join(f"{key}={_EXAMPLES[key]}" for key in lacking)
        hint = f"give Section(..., {example}), or leave the body out with on=[...]"
        raise ModelError(f'"{beam.name}"', what, hint)


def _refuse_deeper(item: Fluid, beam: Beam) -> None:
    """Raise ModelError if a beam starts below the bottom of the water that waves need."""
    if item.waves is None or item.below is None or math.isinf(item.waves.depth):
        return
    depth = item.waves.depth
    lowest = item.below - float(np.min(beam.node_position[:, 2]))
    if lowest > (1.0 + DEEPER) * depth:
        what = f'have water of {depth:.4g} m depth, and "{beam.name}" starts {lowest:.4g} m below its surface'
        raise ModelError(
            f"{item.name}.waves", what, f"give depth={lowest:.4g} or more, or leave it out: deep"
        )


#: Share of the depth by which bodies may lie below the bottom, sunk into a soft ground.
DEEPER = 0.01
_EXAMPLES = {"diameter": "0.1", "drag": "(1.2, 0.01)"}
