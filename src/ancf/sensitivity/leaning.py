"""Derivatives of friction on grounds and surfaces in an equilibrium.

There it opposes the way from a shape q_0, the initial one or that in which cables lay without friction, with
limits that fit the equilibrium itself,

    R(q, L(q, p); z(q_0, p), p) = 0,

so that (R_q + R_L L_q) s = -R_p - R_L L_p - R_z dz.
"""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..batches import Batches
from ..compiled import traits
from ..errors import SolveError
from ..solvers.statics.equilibrium import Leaned
from ..system.core import Core, keep_memory
from ..system.system import System
from .family import Family
from .memory import FORCES, Memory, slope, split
from .remembering import Row

#: What is remembered of the step before: without it limits are those of a state at rest.
BEFORE = "before"
#: Changes of places by which derivatives of limits are differences, m.
FAR = 1e-6


class Leaning:
    """What friction adds to the derivatives of an equilibrium.

    Parameters
    ----------
    memory : Memory
        Of the system that found it; its derivatives are filled.
    core : Core
    q : (size,)
        The equilibrium.
    leaned : Leaned

    Raises
    ------
    SolveError
        Cables lay without friction on a ground before it acted, and there is friction on surfaces, too.
    """

    def __init__(self, memory: Memory, core: Core, q: FloatArray, leaned: Leaned) -> None:
        self.memory, self.core, self.q = memory, core, q
        self.shape, self.laid = leaned.shape, leaned.laid
        self._kept = {name: leaned.memory[name] for name in memory.copy()}
        self._still = np.zeros_like(q)
        parts = (memory.system.parts[name] for name in memory.names)
        if self.laid and any(traits(batch).laid is None for batch in parts):
            what = "friction on the ground acts from where cables lay without it, that on surfaces does not"
            raise SolveError("equilibrium.sensitivities", what, "start from a path near the equilibrium")

    def leave_out(self) -> None:
        """Let there be no friction."""
        self.memory.start(self.memory.none)

    def begin(self, shapes: FloatArray) -> None:
        """Begin with the derivatives of the shape from which friction acts, (p, 2, size)."""
        memory = self.memory
        memory.start(self._kept)
        memory.begin(self.shape, self._still, shapes)
        memory.choose(self.q, self._still)
        self._kept = memory.copy()
        for d, family in zip(memory.d, memory.families, strict=True):
            for name in d:
                if name.split(".")[1] in FORCES:
                    d[name] = np.zeros_like(d[name])
            if set(memory.names) & family.changed:
                self._add_own(family, d)

    def times(self, s: FloatArray) -> FloatArray:
        """R_L L_q s, (size,), zero where supports hold."""
        return self._pushed(self._along(s))

    def push(self, k: int) -> FloatArray:
        """R_L L_p + R_z dz of a family, (size,)."""
        return self._pushed(self.memory.d[k])

    def end(self, found: FloatArray) -> None:
        """Fill the derivatives of the memory that the equilibrium leaves, whose own are (p, 2, size)."""
        for d, s in zip(self.memory.d, found, strict=True):
            for name, x in self._along(s[0]).items():
                d[name] = d[name] + x
        self.memory.step(self.q, self._still, found)

    def _pushed(self, d: Row) -> FloatArray:
        r = np.zeros_like(self.q)
        self.memory.add_push(d, (self.q, self._still), r)
        r[self.core.supports.held], r[self.memory.system.n :] = 0.0, 0.0
        return r

    def _limits(self, system: System, q: FloatArray) -> Row:
        """Limits of a system in a state at rest."""
        own = self.memory.arrays_of(system)
        for name, x in own.items():
            x[...] = 0.0 if name.split(".")[1] == BEFORE else self._kept[name]
        keep_memory(Batches(system.parts[name] for name in self.memory.names), q, self._still)
        found = {name: x.copy() for name, x in own.items() if name.split(".")[1] in FORCES}
        for name, x in own.items():
            x[...] = self._kept[name]
        return found

    def _along(self, s: FloatArray) -> Row:
        """L_q s."""
        system = self.memory.system
        here = self._limits(system, self.q)

        def limits(x: float) -> FloatArray:
            return np.concatenate([own.ravel() for own in self._limits(system, self.q + x * s).values()])

        size = float(np.max(np.abs(s) * system.weights(), initial=0.0))
        return split(slope(limits, FAR, size) * np.ones(sum(x.size for x in here.values())), here)

    def _add_own(self, family: Family, d: Row) -> None:
        """Add L_p."""
        here = self._limits(self.memory.system, self.q)
        for own, weight in family.around():
            if own is not self.memory.system:
                for name, x in self._limits(own, self.q).items():
                    d[name] += weight * (x - here[name])
