"""Which batches have friction that remembers the way, and of which that is differentiated."""

from __future__ import annotations

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
    if question in ("reaction", "reaction_moment") and friction_of(system):
        what = "the derivative of a reaction is not known where there is friction"
        raise ModelError(f"sensitivity.{question}", what, "ask for the tension next to the support")
