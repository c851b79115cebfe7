"""Joints in the matrix: which unknowns they couple, where their pieces stand, and the Joints of a Core."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..batches import Batches
from ..connections.joint import JointBatch
from ..connections.sliding import SlidingBatch
from .core import Joints, Supports, assemble
from .matrix import Places

if TYPE_CHECKING:
    from .system import System

IntArray = NDArray[np.int64]


#: Least mass and stiffness of a row, as a share of the largest of its joint.
FLOOR = 1e-2


def joint_pairs(batch: JointBatch) -> IntArray:
    """Pairs of blocks that the rows couple, shape (m, 2)."""
    pairs = [np.zeros((0, 2), dtype=np.int64)]
    for n, unknown in enumerate(batch.unknown):
        blocks = np.append(batch.slot[batch.start[n] : batch.start[n + 1]], unknown) // 6
        pairs.append(np.stack(np.meshgrid(blocks, blocks), axis=-1).reshape(-1, 2))
    return np.concatenate(pairs)


def sliding_pairs(batch: SlidingBatch) -> IntArray:
    """Pairs of the joints' blocks with those of the point and of all elements of the carrier."""
    pairs = [np.zeros((0, 2), dtype=np.int64)]
    for j, unknown in enumerate(batch.unknown):
        line = batch.line_slot[batch.first[j] : batch.first[j + 1]].ravel()
        slots = np.concatenate([batch.slot[j], line])
        blocks = np.unique(slots[slots >= 0] // 6)
        pairs.append(np.stack([np.full_like(blocks, unknown // 6), blocks], axis=1))
    return np.concatenate(pairs)


def bind_joints(plain: JointBatch, seen: JointBatch, places: Places) -> JointBatch:
    """The batch with its places; ``seen`` reads and writes the shadows where there are local axes."""
    row = np.repeat(np.arange(len(plain.unknown)), np.diff(plain.start))
    pairs = [np.zeros(0, dtype=np.int64)]
    for n in range(len(plain.unknown)):
        slots = plain.slot[plain.start[n] : plain.start[n + 1]]
        pairs.append(places.of(np.repeat(slots, len(slots)), np.tile(slots, len(slots))))
    place = places.of(plain.unknown[row], plain.slot)
    return seen._replace(place=place.astype(np.int64), pair=np.concatenate(pairs).astype(np.int64))


def bind_sliding(plain: SlidingBatch, seen: SlidingBatch, places: Places) -> SlidingBatch:
    """The batch with its places."""
    joint = np.repeat(np.arange(len(plain.unknown)), np.diff(plain.first))
    line_row = np.broadcast_to(plain.unknown[joint][:, None], plain.line_slot.shape)
    row = np.broadcast_to(plain.unknown[:, None], plain.slot.shape)
    return seen._replace(
        own=places.of(plain.unknown, plain.unknown).astype(np.int64),
        place=places.of(row, plain.slot).astype(np.int64),
        line_place=places.of(line_row, plain.line_slot).astype(np.int64),
    )


def core_joints(batches: list[Any], system: System, supports: Supports) -> Joints:
    """Joints of the Core of a system."""
    mask = np.zeros(system.size)
    mask[system.multipliers] = 1.0
    first = min(system.numbering.sliding, default=system.numbering.blocks)
    constrained = [b for b in batches if isinstance(b, JointBatch | SlidingBatch)]
    return Joints(
        multipliers=system.multipliers,
        mask=mask,
        level=system.level,
        batches=Batches(constrained),
        tail=Batches(b for b in constrained if isinstance(b, SlidingBatch)),
        first=first,
        lowest=int(np.min(system.multipliers, initial=system.n)) // 6,
        supports=tail_supports(supports, system.places, first),
    )


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


def set_scales(system: System) -> None:
    """Give each row the mass and the stiffness of what it holds, to be multiplied with C_q^T C_q."""
    batch = next((b for b in system.core.joints.batches if isinstance(b, JointBatch)), None)
    if batch is None:
        return
    core, q = system.core, system.initial_shape()
    entries, columns = np.arange(system.n // 6)[:, None], 7 * np.arange(6)
    row = np.repeat(np.arange(len(batch.unknown)), np.diff(batch.start))
    slot = np.where(batch.slot < system.n, batch.slot, 0)
    for k, (mass, stiffness) in enumerate(((1.0, 0.0), (0.0, 1.0))):
        system.level[:] = 0.0
        assemble(core.batches, core.ws, q, np.zeros_like(q), core.A, mass, 0.0, stiffness)
        diagonal = np.abs(core.A[36 * entries + columns].ravel())
        found = batch.factor**2 * diagonal[slot[:, None] + np.arange(3)].max(axis=1)
        np.maximum.at(batch.scale[:, k], row, found)
        for unknowns in system.numbering.multipliers.values():  # a director may have no mass of its own
            mine = np.isin(batch.unknown, unknowns)
            if mine.any():
                least = FLOOR * float(batch.scale[mine, k].max())
                batch.scale[mine, k] = np.maximum(batch.scale[mine, k], least)
        whole = float(batch.scale[:, k].max()) or float(diagonal.max()) or 1.0
        batch.scale[:, k] = np.where(batch.scale[:, k] > 0.0, batch.scale[:, k], whole)
    system.level[:] = 1.0, 0.0, 0.0
