"""How local axes of supports turn with a parameter, as those of a clamp do whose beam points elsewhere."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..model.bodies.beam import Beam
from ..model.model import Model
from ..system.beside import Acts
from ..system.initial_motion import at_rest, spin_of, spun
from ..system.nodes import start_vectors
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


def ends_rates(base: System, model: Model, offset: float) -> tuple[FloatArray, FloatArray] | None:
    """Derivatives of the initial state, (size,) each, by an end of a straight cable, without a system for it.

    Parameters
    ----------
    base : System
        That stands, see :func:`stands`.
    model : Model
        Of which the end is elsewhere, by ``offset``, m.

    Returns
    -------
    Of q and v; None if these are not known without one: bodies move, and local axes turn, or there are
    velocities along a body.
    """
    dq, dv, moves = np.zeros(base.size), np.zeros(base.size), False
    for name, body in model.bodies.items():
        mine = base.model.bodies[name]
        moves = moves or not at_rest(body)
        if body is mine:
            continue
        if not isinstance(body, Beam) or not isinstance(mine, Beam):
            return None
        change = (start_vectors(body) - start_vectors(mine)) / offset
        slots, own = base.slots[name], base.numbering.slots[name]
        shape = change.copy()
        if not at_rest(body):
            if body.along.size:
                return None
            change[:, 0] -= (body.about - mine.about) / offset
        for k in range(slots.shape[1]):
            rate = spun(spin_of(body), change[:, k])
            for c in range(3):
                dq[slots[:, k] + c], dv[own[:, k] + c] = shape[:, k, c], rate[:, c]
    if base.constraints.rotations:
        dq = slopes_local(base, dq)
        if moves:
            return None
    dv[base.held] = 0.0
    return dq, dv


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
