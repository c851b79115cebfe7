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
from ..solvers.derivatives.abreast_room import abreast
from ..solvers.derivatives.friction import Friction, remember_steps
from ..solvers.derivatives.friction_start import push_start, remember_start
from ..solvers.derivatives.sensitivity import Way
from ..solvers.rare import knowing
from ..system.core import place_supports
from .marked import friction_of_all
from .memory import Memory
from .nearby import Nearby

#: What a batch does that knows the derivatives of its memory.
KNOWN = add_memory_slopes, remember_along, add_memory_changes


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
        own = self.own = memory.marked
        self.first, self.now, self.marked = own.first, own.now, own.batches
        self.remembering = knowing(choose_memory, [system.parts[name] for name in memory.names])
        self.chosen = np.zeros((1, len(self.now)))
        nearby.marked = self.marked
        families = range(len(nearby.families))
        rates = [{name: x for name, x in nearby.rates[k].items() if name in memory.names} for k in families]
        self.friction = nearby.friction = friction_of_all(own, rates)
        self.z = self.friction.z

    def choose(self, q: FloatArray, v: FloatArray) -> None:
        """As :meth:`Memory.choose`."""
        self.memory.choose(q, v)

    def begin(self, q: FloatArray, v: FloatArray, s: FloatArray) -> None:
        """Take the derivatives in which the first step begins from those of a state, (p, 3, size).

        Or from a start that knows its own.
        """
        if self.memory.known:
            self.own.fill(self.z, self.memory.d)
            return
        self.now[:], self.z[...] = 0.0, 0.0
        remember_start(self.memory.system.core, self.friction, q, v, abreast(s))

    def push(self, way: Way, tables: Any) -> FloatArray:
        """What they do to the residual at the start, (p, size), zero where it is held."""
        system, made = self.memory.system, np.zeros((len(self.nearby.families), self.memory.system.size))
        q, v, a = (x[0].copy() for x in way)
        place_supports(system.core.supports, system.core.loads.value, tables, 0, q, v, a)
        push_start(system.core, self.friction, q, v, lane_rows(system.size), made)
        return made

    def look(self, way: Way, tables: Any) -> Friction:
        """Find what is remembered in the steps of a block, which follow the last ones."""
        if len(self.chosen) < len(way.q):
            self.chosen = np.zeros((len(way.q), len(self.now)))
        self.friction = self.nearby.friction = self.friction._replace(chosen=self.chosen)
        remember_steps(self.memory.system.core, self.friction, self.remembering, tables, way)
        return self.friction

    def end(self) -> None:
        """Let the memory know the derivatives that the last step leaves."""
        self.memory.d = self.own.rows(self.z, len(self.memory.d))


def memory_abreast(memory: Memory, nearby: Nearby) -> MemoryAbreast | None:
    """The memory of a run as compiled code follows it, if all that there is knows the derivatives."""
    parts, names = memory.system.parts, set(memory.names)
    known = all(does_something(type(parts[name]), own) for name in names for own in (choose_memory, *KNOWN))
    if not names or not known or nearby.others:
        return None
    changed = (names & nearby.families[k].changed - found.keys() for k, found in nearby.rates.items())
    return None if any(changed) else MemoryAbreast(memory, nearby)
