"""How local axes of supports turn with a parameter, as those of a clamp do whose beam points elsewhere."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..system.beside import Acts
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


def moves_ends(acts: Acts | None) -> bool:
    """Whether a parameter is known to move the nodes of a straight cable in proportion, and nothing else."""
    return acts is not None and acts.moves and not acts.shapes


def stands(base: System) -> bool:
    """Whether supports of a model do not move, and no joint has rows."""
    return not (base.inputs.motions or base.inputs.rotations or len(base.multipliers))


def slopes_rates(base: System, moved: FloatArray) -> FloatArray:
    """Derivatives of local axes along slopes of cables, (k, 3, 3), whose initial shape changes by ``moved``.

    The others are as in :func:`axes_of`.
    """
    along, change, size = _slopes(base, moved)
    turn = np.zeros((len(along), 3, 3))
    turn[:, :, 0] = (change - along * np.sum(along * change, axis=1, keepdims=True)) / size
    return turn


def slopes_local(base: System, moved: FloatArray) -> FloatArray:
    """The change ``moved`` with that of such slopes along their axes: their lengths change alone."""
    made = moved.copy()
    along, change, _ = _slopes(base, moved)
    slots = base.supports.rot_slot
    made[slots], made[slots + 1], made[slots + 2] = np.sum(along * change, axis=1), 0.0, 0.0
    return made


def _slopes(base: System, moved: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Directions of the slopes in the initial shape, their changes, (k, 3), and sizes, (k, 1)."""
    shadow = base.supports.rot_shadow[:, None] + np.arange(3)
    slope = Known.of(base).initial_shape()[shadow]
    size: FloatArray = np.linalg.norm(slope, axis=1, keepdims=True)
    return slope / size, moved[shadow], size
