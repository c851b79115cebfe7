"""StitchWire: a short wire that hangs below a support from the messenger and carries droppers there."""

from __future__ import annotations

from dataclasses import dataclass

from ..model import checks
from .wire import Wire


@dataclass(frozen=True, slots=True, kw_only=True)
class StitchWire:
    """The stitch wires of a line, one at every support but the first and the last.

    The droppers closer to the support than its ends hang from it instead of the messenger.

    Parameters
    ----------
    wire : Wire
        Its tension is taken off the messenger's between its ends.
    reach : float, m
        Distance of its two ends from the support.

    """

    wire: Wire
    reach: float

    def check(self, where: str) -> None:
        """Raise ModelError if a value is out of range."""
        self.wire.check(where)
        checks.positive(self.reach, f"{where}.reach")
