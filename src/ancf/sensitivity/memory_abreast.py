"""What friction remembers in the steps of a block, with its derivatives by eight parameters abreast."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..compiled import (
    add_memory_changes,
    add_memory_slopes,
    choose_memory,
    does_something,
    remember_along,
)
from ..linalg.eight import lane_rows
from ..simd import LANES
from ..solvers.friction import Friction, remember_steps
from ..solvers.rare import knowing
from ..solvers.sensitivity import Way
from .memory import Memory
from .nearby import Nearby, changes_of
from .remembering import Row

#: What a batch does that knows the derivatives of its memory.
KNOWN = add_memory_slopes, remember_along, add_memory_changes
#: Arrays of such a memory with derivatives, in this order, and what follows them.
REMEMBERED, BESIDE = ("anchor", "limit", "before"), ("most",)


class MemoryAbreast:
    """The memory of a run as compiled code follows it: of batches that know its derivatives.

    Parameters
    ----------
    memory : Memory
        At the start of the run, and in the end what it leaves.
    nearby : Nearby
        The parameters; it asks the batches of here from then on.
    """

    def __init__(self, memory: Memory, nearby: Nearby) -> None:
        self.memory, self.nearby, system = memory, nearby, memory.system
        batches = [system.parts[name] for name in memory.names]
        self.first = np.cumsum([0, *(sum(getattr(b, key).size for key in keys_of(b)) for b in batches)])
        self.remembering = knowing(choose_memory, batches)
        self.now = np.zeros(self.first[-1])
        self.marked = {}
        for name, batch, at in zip(memory.names, batches, self.first[:-1].tolist(), strict=True):
            views = {}
            for key in keys_of(batch):
                own = getattr(batch, key)
                views[key] = self.now[at : at + own.size].reshape(own.shape)
                memory.beside[f"{name}.{key}"] = views[key]
                at += own.size
            if hasattr(batch, "lit"):  # any row may have a limit in some step
                views["lit"] = np.array([len(batch.lit) - 1, *range(len(batch.lit) - 1)])
            self.marked[name] = batch._replace(**views)
        self.chosen = np.zeros((1, len(self.now)))
        groups = -(-len(nearby.families) // LANES)
        self.z = lane_rows(groups * len(self.now)).reshape(groups, len(self.now), LANES)
        nearby.marked = self.marked
        self.friction = nearby.friction = self._friction()

    def _friction(self) -> Friction:
        """What kernels ask for."""
        rates, names = self.nearby.rates, self.memory.names
        families = range(len(self.nearby.families))
        each = [{name: x for name, x in rates[k].items() if name in names} for k in families]
        changes = changes_of(self.marked, each, names)
        of = np.repeat(self.first[:-1], np.diff(changes.start))
        begin = ((changes.of // LANES) * len(self.now) + of) * LANES + changes.of % LANES
        batches = knowing(add_memory_slopes, self.marked.values(), remember_along, add_memory_changes)
        own = changes.start, changes.rates, changes.rates_from, changes.kinds, changes.kinds_from
        return Friction(batches, self.first, self.now, self.now[None], self.z, *own, begin)

    def begin(self) -> None:
        """Take the derivatives in which the first step begins."""
        for k, d in enumerate(self.memory.d):
            own = [d.get(key, np.zeros(x.size)).ravel() for key, x in self.memory.beside.items()]
            self.z[k // LANES, :, k % LANES] = np.concatenate(own)

    def look(self, way: Way, tables: Any) -> Friction:
        """Find what is remembered in the steps of a block, which follow the last ones."""
        if len(self.chosen) < len(way.q):
            self.chosen = np.zeros((len(way.q), len(self.now)))
        self.friction = self.nearby.friction = self.friction._replace(chosen=self.chosen)
        remember_steps(self.memory.system.core, self.friction, self.remembering, tables, way)
        return self.friction

    def end(self) -> None:
        """Let the memory know the derivatives that the last step leaves."""
        self.memory.d = [self._row(self.z[k // LANES, :, k % LANES]) for k in range(len(self.memory.d))]

    def _row(self, z: FloatArray) -> Row:
        """The numbers of a memory by the names of their arrays."""
        beside = self.memory.beside
        own = np.split(z, np.cumsum([x.size for x in beside.values()])[:-1])
        return {
            name: x.reshape(like.shape).copy()
            for (name, like), x in zip(beside.items(), own, strict=True)
            if name.split(".")[1] in REMEMBERED
        }


def keys_of(batch: Any) -> list[str]:
    """Arrays of the memory of a batch that compiled code follows, as they lie one after the other."""
    return [key for key in (*REMEMBERED, *BESIDE) if key in batch._fields]


def memory_abreast(memory: Memory, nearby: Nearby) -> MemoryAbreast | None:
    """The memory of a run as compiled code follows it, if all that there is knows the derivatives."""
    parts, names = memory.system.parts, set(memory.names)
    known = all(does_something(type(parts[name]), own) for name in names for own in (choose_memory, *KNOWN))
    if not names or not known or nearby.others:
        return None
    changed = (names & nearby.families[k].changed - found.keys() for k, found in nearby.rates.items())
    return None if any(changed) else MemoryAbreast(memory, nearby)
