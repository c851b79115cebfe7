"""The Joints of a Core, and the mass and stiffness of their rows."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray, IntArray
from ..batches import Batches
from ..compiled import Role, with_role
from ..linalg.border import room_for_border
from .core import Joints, Supports, assemble
from .matrix import Places

#: Least mass and stiffness of a row, as a share of the largest of its joint.
FLOOR = 1e-2


def core_joints(batches: list[Any], system: Any, supports: Supports) -> Joints:
    """Joints of the Core of a system."""
    mask = np.zeros(system.size)
    mask[system.multipliers] = 1.0
    first = min(system.numbering.sliding, default=system.numbering.blocks)
    constrained = with_role(batches, Role.CONSTRAINS)
    tail = with_role(constrained, Role.SLIDES)
    return Joints(
        multipliers=system.multipliers,
        mask=mask,
        level=system.level,
        batches=Batches(constrained),
        tail=Batches(tail),
        first=first,
        lowest=int(np.min(system.multipliers, initial=system.n)) // 6,
        supports=tail_supports(supports, system.places, first) if tail else supports,
        border=room_for_border(first, system.numbering.blocks - first, widest_row(tail, system.n)),
    )


def widest_row(tail: tuple[Any, ...], n: int) -> int:
    """Blocks of six of the n unknowns on which a sliding joint depends at most at a time.

    A vector along local axes, which is seen by its shadow, counts as a block of its own.
    """
    most = 0
    for batch in tail:
        blocks = [np.where(slot < n, slot // 6, slot) for slot in (batch.slot, batch.line_slot)]
        for j in range(len(batch.unknown)):
            for line in blocks[1][batch.first[j] : batch.first[j + 1]]:
                found = np.concatenate([blocks[0][j], line])
                most = max(most, len(np.unique(found[found >= 0])))
    return most


def tail_supports(supports: Supports, places: Places, first: int) -> Supports:
    """What of the supports concerns the rows from block ``first`` on."""
    low, high = 36 * first, 36 * (places.n + int(places.row_start[first]))

    def mine(place: IntArray) -> NDArray[np.bool_]:
        return ((place >= low) & (place < 36 * places.n)) | (place >= high)

    rows, cols = mine(supports.rot_rows), mine(supports.rot_cols)
    return supports._replace(
        held_zero=supports.held_zero[mine(supports.held_zero)],
        held_one=supports.held_one[mine(supports.held_one)],
        rot_rows=supports.rot_rows[rows],
        rot_rows_of=supports.rot_rows_of[rows],
        rot_cols=supports.rot_cols[cols],
        rot_cols_of=supports.rot_cols_of[cols],
    )


def share_scales(system: Any, like: Any) -> bool:
    """Take over masses and stiffnesses of rows from a system with the same rows; whether there is one."""
    mine, other = system.parts.get("joints"), like.parts.get("joints")
    if mine is None or other is None or mine.scale.shape != other.scale.shape:
        return mine is None
    mine.scale[...] = other.scale
    return True


def fastest(mass: FloatArray, stiffness: FloatArray) -> float:
    """Largest ratio of the diagonal entries of two matrices, 1/s^2; without limit if there is none."""
    both = (mass > 0.0) & (stiffness > 0.0)
    return float(np.max(stiffness[both] / mass[both])) if np.any(both) else np.inf


def set_scales(system: Any) -> None:
    """Give each row the mass and the stiffness of what it holds, to be multiplied with C_q^T C_q.

    Rows that hold nothing stiff, such as those that keep a rigid body rigid, have masses to be solved with in
    motion. A stiffness from elsewhere, or one of 1, would leave of the inertia of a small body nothing but
    round-off: they take it at rest alone. There it makes nothing faster than what is fastest: directors have
    no length, and a stiffness in N/m is too much for a body of millimetres.
    """
    core, batch = system.core, system.parts.get("joints")
    if batch is None:
        return
    q = system.initial_shape()
    entries, columns = np.arange(system.n // 6)[:, None], 7 * np.arange(6)
    row = np.repeat(np.arange(len(batch.unknown)), np.diff(batch.start))
    slot = np.where(batch.slot < system.n, batch.slot, 0)
    largest: list[float] = []
    diagonals = []
    for k, (c_mass, c_stiffness) in enumerate(((1.0, 0.0), (0.0, 1.0))):
        system.level[:] = 0.0
        assemble(core.batches, core.ws, q, np.zeros_like(q), core.A, c_mass, 0.0, c_stiffness)
        diagonal = np.abs(core.A[36 * entries + columns].ravel())
        diagonals.append(diagonal)
        found = batch.factor**2 * diagonal[slot[:, None] + np.arange(3)].max(axis=1)
        np.maximum.at(batch.scale[:, k], row, found)
        for unknowns in system.numbering.multipliers.values():  # a director may have no mass of its own
            mine = np.isin(batch.unknown, unknowns)
            if mine.any():
                least = FLOOR * float(batch.scale[mine, k].max())
                batch.scale[mine, k] = np.maximum(batch.scale[mine, k], least)
        largest.append(float(batch.scale[:, k].max()) or float(diagonal.max()))
    mass, held, at_rest = batch.scale.T
    mass[mass == 0.0] = largest[0] or 1.0
    elsewhere = np.minimum(largest[1], fastest(*diagonals) * mass) if largest[1] > 0.0 else mass
    at_rest[:] = np.where(held > 0.0, held, elsewhere)
    system.level[:] = 1.0, 0.0, 0.0
