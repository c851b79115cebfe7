"""What a run knows of its energies besides the account itself: whether they add up, and to what digits."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ..arrays import FloatArray
from ..system.system import System
from .step.memory import Memory

WORTHLESS = 0.2  # energy that does not add up, as the same share, of which a run that ends warns
#: Energy that may come from round-off: shares of the energies at the start, and of what strain 1 and the
#: loads would take; and an energy, J, that is none.
ROUNDED, ROUNDED_FORCES, NOTHING = 1e-9, 1e-10, 1e-15


class Account:
    """Part of :class:`ancf.solvers.stepping.Run`: what its energies tell."""

    system: System
    memory: Memory
    energy0: FloatArray
    astray: float
    exchanged: float

    @property
    def caution(self) -> str:
        """What to tell who did not ask: energies that do not add up by far."""
        floor = ROUNDED * float(np.sum(np.abs(self.energy0))) + NOTHING
        if self.astray <= WORTHLESS * self.exchanged + floor:
            return ""
        share = 100.0 * self.astray / self.exchanged
        return (
            f"energies of the run do not add up: {self.astray:.2g} J came from nowhere or were lost, "
            f"{share:.2g} % of what was exchanged; its result may be worthless, print(result) says why"
        )

    def round_off(self) -> float:
        """Energy that may come from round-off, J."""
        stiff, size = self._extent
        loads = np.sum(np.abs(self.system.core.loads.gravity)) + np.sum(np.abs(self.memory.f))
        weight = float(loads) * size
        at_start = float(np.sum(np.abs(self.energy0)))
        return ROUNDED * at_start + ROUNDED_FORCES * (stiff + weight) + NOTHING

    @cached_property
    def _extent(self) -> tuple[float, float]:
        """Energy of strain 1 in all beams, J, and the size of the model, m."""
        model = self.system.model
        return sum(b.section.EA * b.length for b in model.beams.values()), model.size
