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
        weight=_row_weights(system),
        mask=mask,
        level=system.level,
        batches=Batches(constrained),
        tail=Batches(tail),
        first=first,
        lowest=int(np.min(system.multipliers, initial=system.n)) // 6,
        supports=tail_supports(supports, system.places, first) if tail else supports,
        border=room_for_border(first, system.numbering.blocks - first, widest_row(tail, system.n)),
    )


def _row_weights(system: Any) -> FloatArray:
    """Of the rows of all multipliers: one over the size of the model, 1 where they hold directions.

    A share of the length of a line would be a gap that is seen: what is longer than a metre counts as one.
    """
    weight, batch = np.full(system.size, 1.0 / min(system.model.size, 1.0)), system.parts.get("joints")
    if batch is not None:
        weight[np.setdiff1d(batch.unknown, rows_of_places(system))] = 1.0
    found: FloatArray = weight[system.multipliers]
    return found


def rows_of_places(system: Any) -> IntArray:
    """Multipliers of the rows of fixed joints that hold places, and not directions alone."""
    batch = system.parts["joints"]
    found: IntArray = batch.unknown[_entries(system, batch, _place_unknowns(system))[-1]]
    return found


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


def set_scales(system: Any) -> None:
    """Give each row the mass and the stiffness of what it holds, to be multiplied with C_q^T C_q.

    Rows that hold nothing stiff, such as those that keep a rigid body rigid, have masses to be solved with in
    motion. A stiffness from elsewhere, or one of 1, would leave of the inertia of a small body nothing but
    round-off: they take it at rest alone. Rows of places have theirs in kg and N/m, those of directions in
    kg m^2 and N m: what the one kind has is too much for the other in a body of millimetres.
    """
    core, batch = system.core, system.parts.get("joints")
    if batch is None:
        return
    q, is_place = system.initial_shape(), _place_unknowns(system)
    row, slot, own, of_places = _entries(system, batch, is_place)
    groups = _alike(system, batch, of_places)
    entries, columns = np.arange(system.n // 6)[:, None], 7 * np.arange(6)
    largest = []
    for k, (c_mass, c_stiffness) in enumerate(((1.0, 0.0), (0.0, 1.0))):
        system.level[:] = 0.0
        assemble(core.batches, core.ws, q, np.zeros_like(q), core.A, c_mass, 0.0, c_stiffness)
        diagonal = np.abs(core.A[36 * entries + columns].ravel())
        found = batch.factor[own] ** 2 * diagonal[slot[own, None] + np.arange(3)].max(axis=1)
        np.maximum.at(batch.scale[:, k], row[own], found)
        for mine in groups:  # a director may have no mass of its own
            batch.scale[mine, k] = np.maximum(batch.scale[mine, k], FLOOR * batch.scale[mine, k].max())
        there = (
            (batch.scale[of_places, k], diagonal[is_place]),
            (batch.scale[~of_places, k], diagonal[~is_place]),
        )
        places, directions = _of_both(
            _first_positive(*there[0]), _first_positive(*there[1]), system.model.size
        )
        largest.append(np.where(of_places, places, directions))
    mass, held, at_rest = batch.scale.T
    mass[mass == 0.0] = np.where(largest[0] > 0.0, largest[0], 1.0)[mass == 0.0]
    at_rest[:] = np.where(held > 0.0, held, np.where(largest[1] > 0.0, largest[1], mass))
    system.level[:] = 1.0, 0.0, 0.0


def _place_unknowns(system: Any) -> NDArray[np.bool_]:
    """Mask of the unknowns that are components of places, (n,)."""
    first = np.concatenate([slots[:, 0] for slots in system.numbering.slots.values()])
    mask = np.zeros(system.n, dtype=bool)
    mask[first[:, None] + np.arange(3)] = True
    return mask


def _entries(
    system: Any, batch: Any, is_place: NDArray[np.bool_]
) -> tuple[IntArray, IntArray, NDArray[np.bool_], NDArray[np.bool_]]:
    """Rows and unknowns of all entries, which of them tell a row's mass, and which rows hold places.

    A row that holds a place, in m, has the mass of places: directors on arms to it have moments of inertia,
    and what is large of these depends on the unit of lengths.
    """
    row = np.repeat(np.arange(len(batch.unknown)), np.diff(batch.start))
    turned = np.array([r.slot for r in system.constraints.rotations], dtype=np.int64)
    slot = batch.slot.copy()
    slot[slot >= system.n] = turned[(slot[slot >= system.n] - system.n) // 3]
    of_places = np.zeros(len(batch.unknown), dtype=bool)
    of_places[row[is_place[slot]]] = True
    return row, slot, is_place[slot] | ~of_places[row], of_places


def _alike(system: Any, batch: Any, of_places: NDArray[np.bool_]) -> list[NDArray[np.bool_]]:
    """Rows of each joint that hold places, and those that hold directions: only such can be compared."""
    whole = [np.isin(batch.unknown, unknowns) for unknowns in system.numbering.multipliers.values()]
    parts = [mine & kind for mine in whole for kind in (of_places, ~of_places)]
    return [mine for mine in parts if mine.any()]


def _first_positive(*given: FloatArray) -> float:
    """The largest of the first array of which something is positive, 0 if there is none."""
    return next((float(x.max()) for x in given if x.max(initial=0.0) > 0.0), 0.0)


def _of_both(places: float, directions: float, size: float) -> tuple[float, float]:
    """Masses or stiffnesses of places and of directions; one that is missing by the other and a length."""
    return places or directions / size**2, directions or places * size**2
