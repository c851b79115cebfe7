"""What friction remembers in a run, backwards: see :mod:`ancf.solvers.derivatives.friction_back`."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..compiled import (
    add_number_work,
    add_work_slopes,
    choose_memory,
    does_something,
    take_memory_back,
    take_memory_work,
    traits,
)
from ..results.state import State
from ..solvers.derivatives.friction import Friction, no_friction, remember_steps
from ..solvers.derivatives.friction_back import Forgetting
from ..solvers.derivatives.sensitivity import Way
from ..solvers.rare import knowing
from ..system.system import System
from .family import Family
from .marked import Marked
from .remembering import Row, followed, friction_of
from .weighed import Weighed

#: What a batch does that goes back through its memory.
KNOWN = choose_memory, add_work_slopes, add_number_work, take_memory_work, take_memory_back


def goes_back_through(system: System) -> bool:
    """Whether all friction of a model that remembers the way is gone back through."""
    names = friction_of(system)
    kinds = (type(system.parts[name]) for name in names)
    return all(followed(system, name) for name in names) and all(
        does_something(kind, own) for kind in kinds for own in KNOWN
    )


class MemoryBack:
    """The memory of friction of a run whose adjoint is gone through.

    Parameters
    ----------
    system : System
        On whose arrays it is computed, with friction.
    """

    def __init__(self, system: System) -> None:
        self.system, self.names = system, friction_of(system)
        self.marked = Marked(system, self.names)
        batches, numbers = self.marked.batches.values(), self.marked.now
        self.sizes = [len(traits(batch).numbers(batch)) for batch in batches]  # type: ignore[misc]
        self.begin = np.cumsum([0, *self.sizes])
        self.numbers, self.zeta = np.zeros(self.begin[-1]), np.zeros(len(numbers))
        self.remembering = knowing(choose_memory, [system.parts[name] for name in self.names])
        self.known: list[Row | None] | None = None  # derivatives in which a run begins, if they are given
        of = self.marked.first, self.zeta, self.begin, self.numbers
        self.back = Forgetting(knowing(take_memory_work, batches, take_memory_back), *of, True)

    def allows(self, families: list[Family], weighed: Weighed) -> bool:
        """Whether that is all that parameters do to it, and no axes of supports turn with them."""
        names, nearby = set(self.names), weighed.nearby
        known = {k: found.keys() for k, found in weighed.rates.items()}
        plain = all(not names & families[k].changed - known.get(k, set()) for k in nearby.plain)
        return plain and not nearby.others and not nearby.turns

    def take(self, start: State | None, families: list[Family]) -> bool:
        """Take the derivatives from a state in which a run starts; whether it knows them."""
        if start is None:
            return True
        found = [start.derivatives[family.name] for family in families]
        self.known = [None if one is None else one.memory for one in found]
        self.back = self.back._replace(anew=False)
        return all(one is None or one.memory is not None for one in found)

    def keep(self, run: Any) -> Row:
        """What a run remembers now."""
        memory = run.system.memory
        return {name: memory[name].copy() for name in memory if name.split(".")[0] in self.names}

    def look(self, kept: Row, way: Way, tables: Any) -> Friction:
        """What is remembered in the steps of a block that began with what is kept."""
        self._put(kept)
        friction = self._friction(np.zeros((len(way.q), len(self.marked.now))))
        remember_steps(self.system.core, friction, self.remembering, tables, way)
        return friction

    def start(self, kept: Row, way: Way, tables: Any) -> Friction:
        """The same at the start, and nothing, of which the first memory is made."""
        found = self.look(kept, way, tables)
        return found._replace(chosen=np.concatenate([found.chosen, np.zeros_like(found.chosen)]))

    def _friction(self, chosen: FloatArray) -> Friction:
        batches, first, now = knowing(choose_memory, self.marked.batches.values()), *self._places()
        return no_friction()._replace(batches=batches, first=first, now=now, chosen=chosen)

    def _places(self) -> tuple[Any, FloatArray]:
        return self.marked.first, self.marked.now

    def _put(self, kept: Row) -> None:
        memory = self.system.memory
        for name, x in kept.items():
            memory[name][...] = x

    def hand_to(self, weighed: Weighed) -> None:
        """Add what the numbers of batches do to what is remembered, where parameters change them."""
        for name, begin, size in zip(self.names, self.begin[:-1].tolist(), self.sizes, strict=True):
            if name in weighed.place:
                weighed.numbers[weighed.place[name]] += self.numbers[begin : begin + size]

    def of_start(self, count: int) -> FloatArray:
        """What is due to what is remembered at the start, by parameter, (p,)."""
        if self.known is None:
            return np.zeros(count)
        each = (0.0 if d is None else float(self.zeta @ self.marked.vector(d)) for d in self.known)
        return np.array(list(each))
