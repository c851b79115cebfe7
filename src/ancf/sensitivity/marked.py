"""Batches with friction as kernels ask them about a step: what they remember is part of one vector."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..compiled import add_memory_changes, add_memory_slopes, remember_along
from ..linalg.eight import lane_rows
from ..simd import LANES
from ..solvers.derivatives.friction import Friction
from ..solvers.rare import knowing
from ..system.system import System
from .nearby import changes_of

#: Arrays of such a memory with derivatives, in this order, and what follows them.
REMEMBERED, BESIDE = ("anchor", "limit", "before"), ("most",)


class Marked:
    """Batches of a system whose memory is that of one step, until it is brought another one.

    Parameters
    ----------
    system : System
    names : list of str

    Attributes
    ----------
    first : (batches + 1,) array
        Where the numbers of each begin.
    now : (numbers,) array
    batches : dict of str to batch
    views : dict of str to array
        The parts of ``now`` by "part.array".
    """

    def __init__(self, system: System, names: list[str]) -> None:
        own = [system.parts[name] for name in names]
        self.first = np.cumsum([0, *(sum(getattr(b, key).size for key in keys_of(b)) for b in own)])
        self.now = np.zeros(self.first[-1])
        self.batches: dict[str, Any] = {}
        self.views: dict[str, FloatArray] = {}
        for name, batch, at in zip(names, own, self.first[:-1].tolist(), strict=True):
            views = {}
            for key in keys_of(batch):
                x = getattr(batch, key)
                views[key] = self.now[at : at + x.size].reshape(x.shape)
                self.views[f"{name}.{key}"] = views[key]
                at += x.size
            if hasattr(batch, "lit"):  # any row may have a limit in some step
                views["lit"] = np.array([len(batch.lit) - 1, *range(len(batch.lit) - 1)])
            self.batches[name] = batch._replace(**views)

    def vector(self, d: dict[str, FloatArray]) -> FloatArray:
        """Derivatives by "part.array" as they lie in ``now``."""
        parts = [d.get(name, np.zeros(x.size)).ravel() for name, x in self.views.items()]
        return np.concatenate([np.zeros(0), *parts])

    def row(self, z: FloatArray) -> dict[str, FloatArray]:
        """The other way round."""
        parts = np.split(z, np.cumsum([x.size for x in self.views.values()])[:-1])
        return {
            name: x.reshape(like.shape).copy()
            for (name, like), x in zip(self.views.items(), parts, strict=True)
            if name.split(".")[1] in REMEMBERED
        }

    def fill(self, z: FloatArray, rows: list[dict[str, FloatArray]]) -> None:
        """Put derivatives by each parameter into its lane of z, (p/8 rounded up, numbers, 8)."""
        for k, row in enumerate(rows):
            z[k // LANES, :, k % LANES] = self.vector(row)

    def rows(self, z: FloatArray, count: int) -> list[dict[str, FloatArray]]:
        """Those of as many parameters."""
        return [self.row(z[k // LANES, :, k % LANES]) for k in range(count)]

    def instead(self, system: System) -> Iterable[tuple[Any, Any]]:
        """Batches of the system and these."""
        return [(system.parts[name], batch) for name, batch in self.batches.items()]


def friction_of_all(marked: Marked, rates: list[dict[str, FloatArray]]) -> Friction:
    """What kernels ask for of all batches, whose numbers parameters change by these rates.

    Derivatives are zero.
    """
    groups, numbers = -(-len(rates) // LANES), len(marked.now)
    z = lane_rows(groups * numbers).reshape(groups, numbers, LANES)
    changes = changes_of(marked.batches, rates, list(marked.batches))
    of = np.repeat(marked.first[:-1], np.diff(changes.start))
    begin = ((changes.of // LANES) * numbers + of) * LANES + changes.of % LANES
    batches = knowing(add_memory_slopes, marked.batches.values(), remember_along, add_memory_changes)
    own = changes.start, changes.rates, changes.rates_from, changes.kinds, changes.kinds_from
    return Friction(batches, marked.first, marked.now, marked.now[None], z, *own, begin)


def keys_of(batch: Any) -> list[str]:
    """Arrays of the memory of a batch that compiled code follows, as they lie one after the other."""
    return [key for key in (*REMEMBERED, *BESIDE) if key in batch._fields]
