"""Rows of joints in the matrix: which blocks of unknowns they couple, and where their pieces stand."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import IntArray


def no_pairs(batch: Any) -> IntArray:
    """Of a batch that does not enter the matrix."""
    return np.zeros((0, 2), dtype=np.int64)


def no_places(plain: Any, seen: Any, places: Any) -> Any:
    """The same: it reads and writes the shadows, and has no places."""
    return seen


def joint_pairs(batch: Any) -> IntArray:
    """Pairs of blocks that the rows couple, shape (m, 2)."""
    pairs = [np.zeros((0, 2), dtype=np.int64)]
    for n, unknown in enumerate(batch.unknown):
        blocks = np.append(batch.slot[batch.start[n] : batch.start[n + 1]], unknown) // 6
        pairs.append(np.stack(np.meshgrid(blocks, blocks), axis=-1).reshape(-1, 2))
    return np.concatenate(pairs)


def sliding_pairs(batch: Any) -> IntArray:
    """Pairs of the joints' blocks with those of the point and of all elements of the carrier."""
    pairs = [np.zeros((0, 2), dtype=np.int64)]
    for j, unknown in enumerate(batch.unknown):
        line = batch.line_slot[batch.first[j] : batch.first[j + 1]].ravel()
        slots = np.concatenate([batch.slot[j], line])
        blocks = np.unique(slots[slots >= 0] // 6)
        pairs.append(np.stack([np.full_like(blocks, unknown // 6), blocks], axis=1))
    return np.concatenate(pairs)


def bind_joints(plain: Any, seen: Any, places: Any) -> Any:
    """The batch with its places; ``seen`` reads and writes the shadows where there are local axes."""
    row = np.repeat(np.arange(len(plain.unknown)), np.diff(plain.start))
    pairs = [np.zeros(0, dtype=np.int64)]
    for n in range(len(plain.unknown)):
        slots = plain.slot[plain.start[n] : plain.start[n + 1]]
        pairs.append(places.of(np.repeat(slots, len(slots)), np.tile(slots, len(slots))))
    place = places.of(plain.unknown[row], plain.slot)
    return seen._replace(place=place.astype(np.int64), pair=np.concatenate(pairs).astype(np.int64))


def bind_sliding(plain: Any, seen: Any, places: Any) -> Any:
    """The batch with its places."""
    joint = np.repeat(np.arange(len(plain.unknown)), np.diff(plain.first))
    line_row = np.broadcast_to(plain.unknown[joint][:, None], plain.line_slot.shape)
    row = np.broadcast_to(plain.unknown[:, None], plain.slot.shape)
    return seen._replace(
        own=places.of(plain.unknown, plain.unknown).astype(np.int64),
        place=places.of(row, plain.slot).astype(np.int64),
        line_place=places.of(line_row, plain.line_slot).astype(np.int64),
    )
