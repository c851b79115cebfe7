"""What the systems at values around a parameter's own are asked."""

from __future__ import annotations

import warnings
from typing import Any, NamedTuple

import numpy as np

from ..arrays import FloatArray, IntArray
from ..batches import Batches
from ..compiled import traits
from ..solvers.radau.stages import stage_residuals
from ..system.system import System
from .alike import OWN


class Push(NamedTuple):
    """What a parameter does to states at fixed free unknowns, per unit of it."""

    push: FloatArray  # (n, size) to the residual, as the solve wants it, zero at held unknowns
    gap: FloatArray  # (n, size) to C of joints, in the rows of the multipliers
    held: FloatArray  # (3, n, size) to held unknowns and shadows of q, v and a


def quiet_state(system: System) -> tuple[FloatArray, FloatArray]:
    """The initial state; what holds against a given motion was said of the model itself."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return system.initial_state()


def gaps_of(system: System, tables: Any, states: Any) -> FloatArray:
    """C in the rows of the multipliers of states."""
    level = system.level.copy()
    system.level[:] = 1.0, 0.0, 0.0
    core = system.core._replace(batches=system.core.joints.batches)
    r = np.empty_like(states[0])
    q, v, a = (x.copy() for x in states)
    stage_residuals(core, tables, q, v, a, np.empty(system.size), r)
    system.level[:] = level
    rows: FloatArray = r * system.core.joints.mask
    return rows


def few_of(systems: list[System], names: set[str]) -> list[Batches]:
    """Batches by these names of each system; of springs and the like the parts that differ somewhere."""
    rows = {name: _differing([system.parts[name] for system in systems]) for name in names}
    return [
        Batches(_some(batch, rows[name]) for name, batch in system.parts.items() if name in names)
        for system in systems
    ]


def fed_alike(batches: list[Batches]) -> list[Batches]:
    """The same, loads with the inputs of the last ones, which are those of a model that runs."""
    last = list(batches[-1])

    def fed(batch: Any, other: Any) -> Any:
        return batch._replace(value=other.value) if hasattr(batch, "value") and batch is not other else batch

    return [Batches(fed(x, y) for x, y in zip(own, last, strict=True)) for own in batches[:-1]] + batches[-1:]


def _some(batch: Any, rows: IntArray | None) -> Any:
    own = traits(batch).some
    return batch if own is None or rows is None else own(batch, rows)


def _differing(batches: list[Any]) -> IntArray | None:
    """Parts that differ, of batches that can be taken apart; None for all."""
    first, n = batches[0], len(batches[0][0])
    if traits(first).some is None:
        return None
    differ = np.zeros(n, dtype=bool)
    for other in batches[1:]:
        for name, mine, theirs in zip(first._fields, first, other, strict=True):
            if name in OWN or np.array_equal(mine, theirs):
                continue
            if mine.shape != theirs.shape or len(mine) != n:
                return None
            differ |= np.any((mine != theirs).reshape(n, -1), axis=1)
    rows: IntArray = np.flatnonzero(differ)
    return rows
