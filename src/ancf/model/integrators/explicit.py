"""Central differences (Verlet's method) with the factorised mass matrix.

Order 2, no numerical damping; stable for steps below 2/omega of the fastest vibration, which is an axial
wave across one element, h < 0.2 to 0.3 l sqrt(rhoA/EA) with the length l of an element, or on very fine
meshes a bending wave, h < 0.033 l^2 sqrt(rhoA/EI).  Systems without multipliers.  Reference: Verlet
(1967); Belytschko, Liu & Moran, Nonlinear Finite Elements for Continua and Structures, section 6.2;
coordinates with the identity as mass matrix: reference [4] of the paper.
"""

from __future__ import annotations

from dataclasses import dataclass

from ...errors import ModelError
from .. import checks
from .base import Integrator, option


@dataclass(frozen=True)
class Explicit(Integrator):
    """Central differences, order 2, stable up to :func:`ancf.stable_step`.

    Parameters
    ----------
    safety : float
        Part of the largest stable step that a step may have at the start: cables that are stretched later
        become stiffer.
    check : bool
        Refuse a larger step, and stop when the step is no longer stable; False: go on until the motion
        blows up.
    """

    safety: float = option(
        0.9, "Part of the stable step that a step may take [-].", type="number", exclusiveMinimum=0, maximum=1
    )
    check: bool = option(True, "Whether it refuses unstable steps [-].", type="boolean")
    name = "explicit"
    runner = "explicit.run:ExplicitRun"

    def __post_init__(self) -> None:
        if not 0.0 < checks.number(self.safety, "Explicit.safety") <= 1.0:
            raise ModelError("Explicit.safety", f"must be above 0 and at most 1, is {self.safety:g}")
        checks.flag(self.check, "Explicit.check")
