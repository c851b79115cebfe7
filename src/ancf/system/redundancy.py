"""Joints of which others hold a part already: rows that may be left out, and those that may not."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray, IntArray
from ..errors import ModelError
from ..later import null_space, qr
from ..model.model import Model
from .consistency import GAP, Rows, held_rows, surely_independent
from .system import System

#: Rank of the rows of the joints, relative to the largest.
INDEPENDENT = 1e-9
#: Rows up to which their rank is found by dense algebra at once.
FEW = 200
#: Share of a row in a dependent combination from which on its joint is named.
NAMED = 0.05
#: What is left of a row of length 1 beside those before it, below which they hold it already.
HELD = 1e-8
#: Distance in sizes of the model by which a mechanism is moved to see whether rows stay redundant, how often
#: and by how many corrections it is brought back onto the other rows.
MOVE, MOVES, CORRECTIONS = 0.03, 2, 12


def spare_multipliers(system: System) -> IntArray:
    """Multipliers of rows that others hold already, in every position: a run needs no force of theirs.

    Those of the joints added last; rows of rigid bodies and of sliding joints always stay.

    Raises
    ------
    ModelError
        Joints contradict each other, or hold the same motion twice in the initial shape alone, as in a
        singular position of a loop, or sliding joints hold what others hold.
    """
    none = np.zeros(0, dtype=np.int64)
    if not len(system.multipliers) or not len(np.setdiff1d(system.multipliers, system.held)):
        return none
    rows = held_rows(system, system.initial_shape())
    size = np.linalg.norm(rows.C, axis=1)
    _refuse_immovable(rows.owner, size > 1e-12 * size.max())
    C, gap = rows.C / size[:, None], rows.gap / size
    if len(C) > FEW and surely_independent(C):
        return none
    _, R, order = qr(C.T, mode="economic", pivoting=True)
    diagonal = np.abs(np.diag(R))
    rank = int(np.sum(diagonal > INDEPENDENT * max(float(diagonal.max()), 1e-300)))
    if rank == len(C):
        return none
    combinations = np.zeros((len(C) - rank, len(C)))  # each row times C is zero
    combinations[:, order[:rank]] = np.linalg.solve(R[:rank, :rank], R[:rank, rank:]).T
    combinations[np.arange(len(C) - rank), order[rank:]] = -1.0
    combinations /= np.abs(combinations).max(axis=1)[:, None]
    mismatch = np.abs(combinations @ gap)
    worst = int(np.argmax(mismatch)) if mismatch.max() > GAP * system.model.size else 0
    names = list(dict.fromkeys(rows.owner[np.abs(combinations[worst]) > NAMED].tolist()))
    if mismatch[worst] > GAP * system.model.size:
        what = f"{_listed(names)} contradict each other: they cannot all hold, by {mismatch[worst]:.3g} m"
        raise ModelError("connections", what, "remove one of them, or let it hold less")
    return _left_out(system, rows, C, len(C) - rank, names)


def notes(system: System) -> list[str]:
    """What to know of rows that were left out, a line for each joint."""
    found = []
    for name, unknowns in system.numbering.multipliers.items():
        left = int(np.sum(np.isin(unknowns, system.spare)))
        if left:
            what = f'{left} of the {len(unknowns)} conditions of "{name}" are held by other joints already'
            found.append(f"{what} and carry nothing: how such joints share their forces is not determined")
    return found


def independent(model: Model) -> System:
    """A model compiled, without the rows that others hold already; ModelError as for them."""
    system = System(model)
    spare = spare_multipliers(system)
    return System(model, spare) if len(spare) else system


def _left_out(system: System, rows: Rows, C: FloatArray, count: int, names: list[str]) -> IntArray:
    """Multipliers of `count` rows that depend on others."""
    joints = [c.name for c in system.model.connections if c.name in system.numbering.multipliers]
    sliding = set(system.numbering.arcs)
    rank = {name: k for k, name in enumerate(joints) if name not in sliding}
    first = np.array([rank.get(name, -1) for name in rows.owner.tolist()])
    left = _dependent(C, np.argsort(first, kind="stable"))
    what = f"{_listed(names)} are redundant: they, or they and the supports, hold the same motion twice"
    if len(left) != count or np.any(first[left] < 0):
        raise ModelError("connections", what, "remove one of them, or let it hold less")
    if not _stays(system, rows, left):
        where = f"{what} in the initial shape, but not beside it"
        raise ModelError("connections", where, "start from another position of the mechanism")
    return np.sort(rows.unknown[left])


def _dependent(C: FloatArray, order: IntArray) -> IntArray:
    """Rows of unit length that depend on those before them in this order (Gram-Schmidt, twice)."""
    basis, left = np.zeros((0, C.shape[1])), []
    for i in order.tolist():
        rest = C[i].copy()
        for _ in range(2):
            rest -= basis.T @ (basis @ rest)
        size = float(np.linalg.norm(rest))
        if size < HELD:
            left.append(i)
        else:
            basis = np.vstack([basis, rest / size])
    return np.array(left, dtype=np.int64)


def _stays(system: System, rows: Rows, left: IntArray) -> bool:
    """Whether rows that are left out hold where the mechanism is moved on the others."""
    weight = system.core.weight[rows.moving]
    kept = np.setdiff1d(np.arange(len(rows.C)), left)
    touched = np.flatnonzero(np.any(rows.C != 0.0, axis=0))
    free = null_space(rows.C[kept][:, touched] / weight[touched])
    if not free.shape[1]:
        return True
    random = np.random.default_rng(0)
    for _ in range(MOVES):
        step = free @ random.standard_normal(free.shape[1])
        q = system.initial_shape()
        q[rows.moving[touched]] += MOVE * step / np.abs(step).max() / weight[touched]
        moved = _brought_back(system, q, kept, touched)
        if moved is None:
            return False
        size = np.linalg.norm(moved.C[left], axis=1)
        if np.any(np.abs(moved.gap[left]) > GAP * system.model.size * size):
            return False
    return True


def _brought_back(system: System, q: FloatArray, kept: IntArray, touched: IntArray) -> Rows | None:
    """Rows where q has been brought back onto those that are kept, by short ways; None if it is lost."""
    still = np.zeros(system.size)
    for _ in range(CORRECTIONS):
        system.place(0.0, q, still.copy(), still.copy())
        rows = held_rows(system, q)
        size = np.linalg.norm(rows.C, axis=1)
        if np.all(np.abs(rows.gap[kept]) < 1e-3 * GAP * system.model.size * size[kept]):
            return rows
        weight = system.core.weight[rows.moving[touched]]
        step = np.linalg.lstsq(rows.C[kept][:, touched] / weight, rows.gap[kept], rcond=None)[0]
        q[rows.moving[touched]] -= step / weight
    return None


def _refuse_immovable(owner: NDArray[np.str_], moves: NDArray[np.bool_]) -> None:
    """Rows without an unknown that moves."""
    if np.all(moves):
        return
    name = owner[~moves][0]
    if np.any(moves[owner == name]):
        what = f'"{name}" joins what supports hold already, in some direction'
        raise ModelError("connections", what, "remove that from the support, or let the joint hold less")
    what = f'"{name}" joins what supports hold already: it has nothing to do'
    raise ModelError("connections", what, "remove the joint or the support")


def _listed(names: list[str]) -> str:
    return " and ".join(f'"{n}"' for n in names)
