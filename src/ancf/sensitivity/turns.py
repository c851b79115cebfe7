"""How local axes of supports turn with a parameter, as those of a clamp do whose beam points elsewhere."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..system.system import System
from .alike import Known


def axes_of(base: System, system: System) -> FloatArray:
    """Local axes of a system, (k, 3, 3), zero where supports hold components along them that are zero.

    Such axes need not turn smoothly: of a clamped cable any two across it will do.
    """
    R = system.supports.rot_R[:, 0]
    return R * Known.of(base).moving_axes() if len(R) else R


def axes_rates(base: System, systems: list[System], weights: list[float]) -> FloatArray | None:
    """Derivatives of the local axes by a parameter, (k, 3, 3), from systems around its value.

    None where axes turn with time, and not as those of the model.
    """
    mine, moving = base.supports.rot_R, base.supports.rot_moving >= 0
    turn = np.zeros_like(mine[:, 0])
    others = [(s, w) for s, w in zip(systems, weights, strict=True) if s.supports.rot_R is not mine]
    if not others or not len(mine):
        return turn
    if any(not np.array_equal(s.supports.rot_R[moving, 0], mine[moving, 0]) for s, _ in others):
        return None
    here = axes_of(base, base)
    for system, weight in others:
        turn += weight * (axes_of(base, system) - here)
    return turn
