"""The detour by which slack cables come to their equilibrium.

A cable that is longer than its initial shape (slack) would start strongly compressed and crumple.  Its
axial stiffness is first lowered until the load alone stretches it by a good part of its length, its
loads come on at the length of the initial shape, and only then does the natural length take effect
and the stiffness rise to its value: the cable comes to its length from above, always in tension.
"""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ...elements.registry import offered, offers
from ...system.system import System

#: Share of its length by which a cable must be longer than its initial shape to hang slack.
TIGHT = 1e-9
#: Factor by which the stiffness rises in a step, at most.
STIFFER = 6.0
#: Steps in which the natural length takes effect.
LET_OUT = 4
#: Load over axial stiffness, below which strains of the load are lost in round-off of an iteration.
LOST = 1e-9


class Slack:
    """The detour by which slack cables come to their equilibrium; nothing if no cable is slack."""

    def __init__(self, system: System, q: FloatArray, force: FloatArray) -> None:
        load = float(np.sum(np.abs(force)))
        self._beams = hang = [b for b in system.model.beams.values() if offers(b.element, "slack")]
        sizes = {name: float(q[unknown]) for name, (unknown, _) in system.lengths.items()}
        drawn = (b.stretch * b.length / sizes.get(b.name, b.length) for b in hang)
        self.found = load > 0.0 and any(stretch < 1.0 - TIGHT for stretch in drawn)
        ways = [(batch, offered(batch, "slack")) for batch in system.core.batches] if self.found else []
        self._cables = [slack(batch, q) for batch, slack in ways if slack is not None]
        stiffest = max((cables.stiffest for cables in self._cables), default=1.0)
        self.factor = min(1.0, load / stiffest) if self.found else 1.0
        self.steps = max(1, int(np.ceil(np.log(1.0 / self.factor) / np.log(STIFFER))))

    def too_stiff(self) -> str:
        """What to do where round-off takes the strains of the load, "" where it does not."""
        if not self._cables or self.factor > LOST:
            return ""
        found = max(self._beams, key=lambda beam: beam.section.EA)
        much = f"EA = {found.section.EA:.3g} N, {1.0 / self.factor:.1g} times the whole load"
        lost = f'"{found.name}" has {much}: round-off takes strains of that size'
        return f"{lost}; give less, 1e6 times the load stretches a cable by a millionth of its length"

    def set(self, soft: float, held: float) -> None:
        """Lower EA by a share of the factor's logarithm and free the forces of a share of the compression."""
        for cables in self._cables:
            cables.set(self.factor**soft, held)

    def let_out(self, share: float) -> float:
        """Put the compression back, at low stiffness; the loads stay whole."""
        self.set(1.0, 1.0 - share)
        return 1.0

    def stiffen(self, share: float) -> float:
        """Raise the stiffness to a share of the logarithm; the loads stay whole."""
        self.set(1.0 - share, 0.0)
        return 1.0
