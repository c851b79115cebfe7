"""StitchWire: a short wire that hangs below a support from the messenger and carries droppers there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...errors import ModelError
from ...model import checks
from .wire import WIRE, Wire

#: Of the ends of a stitch wire from its support, m; less is a slip of units.
SHORTEST = 0.1


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
        checks.kind(self.wire, f"{where}.wire", Wire, WIRE).check(where)
        if checks.positive(self.reach, f"{where}.reach") < SHORTEST:
            what = f"is {self.reach:g} m, at least {SHORTEST:g} m"
            raise ModelError(f"{where}.reach", what, "units are m: 9.0")

    def check_in(self, line: Any) -> None:
        """Raise ModelError if it does not fit a Line."""
        self.check("line.stitch")
        if line.messenger_wire is None:
            raise ModelError("line.stitch", "has no messenger to hang from", "leave it out")
        if self.wire.tension >= line.messenger_wire.tension:
            what = f"is {self.wire.tension:g} N, the messenger has {line.messenger_wire.tension:g} N only"
            raise ModelError("line.stitch.tension", what)
        shortest = min(span.length for span in line.spans)
        if self.reach >= 0.5 * shortest:
            what = f"is {self.reach:g} m, must be less than half of the shortest span, {shortest:g} m"
            raise ModelError("line.stitch.reach", what)
