"""Which batches have friction that remembers the way, and of which that is differentiated."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from ..arrays import FloatArray
from ..compiled import traits
from ..errors import ModelError
from ..system.system import System

#: Arrays of a memory, or their derivatives, by "part.array".
Row = dict[str, FloatArray]

#: Batches whose memory is followed from step to step, see :mod:`ancf.sensitivity.memory`.
FOLLOWED = {"ground", "rubbing"}


def friction_of(system: System) -> list[str]:
    """Names of the batches with friction that remembers the way."""
    found = []
    for name, batch in system.parts.items():
        late = traits(batch).late
        if traits(batch).memory and len(batch[0]) and late is not None and late(batch) is not None:
            found.append(name)
    return found


def followed(system: System, name: str) -> bool:
    """Whether the memory of a batch with friction is followed."""
    return name in FOLLOWED and not np.any(system.parts[name].winch >= 0)


def refuse_friction(system: System, question: str) -> None:
    """Raise ModelError for friction itself, which depends on what was remembered before a step."""
    if question in ("friction_force", "slipping") and friction_of(system):
        what = "the derivative of friction is not known"
        raise ModelError(f"sensitivity.{question}", what, "ask for the tension on both sides of the contact")


def with_same_friction(base: System, system: System, name: str) -> System:
    """The system; ModelError where friction is there with this value of a number alone, without a memory."""
    if friction_of(system) != friction_of(base):
        what = "friction that remembers the way is there with other values alone"
        raise ModelError(name, what, "take a small number in place of 0")
    return system


class Resting:
    """What friction remembers in an equilibrium, and its derivatives, for answers that ask for forces there.

    What has slipped is just at its limit and taken to stick: its force has the same derivative.

    Parameters
    ----------
    memory : dict of str to ndarray
        With limits that nothing reaches.
    d : dict of str to ndarray
        Derivatives of places where friction has no force.
    """

    def __init__(self, memory: Row, d: Row) -> None:
        self.memory, self.d = memory, d

    @property
    def size(self) -> float:
        """The largest derivative, m per unit."""
        return max((float(np.max(np.abs(x), initial=0.0)) for x in self.d.values()), default=0.0)

    def bring(self, system: System, x: float = 0.0) -> None:
        """Let a system remember what the equilibrium leaves if the parameter changes by x."""
        system.bring_memory(self.memory | {name: self.memory[name] + x * d for name, d in self.d.items()})

    @contextmanager
    def brought(self, systems: list[System]) -> Iterator[None]:
        """Let systems remember it for a while."""
        before = [system.kept_memory() for system in systems]
        for system in systems:
            self.bring(system)
        try:
            yield
        finally:
            for system, kept in zip(systems, before, strict=True):
                system.bring_memory(kept)
