"""Auxiliary: the wire of a compound catenary between messenger and contact wire."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks
from .fittings import Droppers
from .span import DropperRule
from .wire import WIRE, Wire


@dataclass(frozen=True, slots=True, kw_only=True)
class Auxiliary:
    """An auxiliary messenger: it hangs from the messenger, and the contact wire's droppers hang from it.

    At the supports it is held sideways above the contact wire and free upwards; its ends are anchored as
    those of the other wires.

    Parameters
    ----------
    wire : Wire
    height : float, m
        Of the auxiliary over the nominal height of the contact wire, at its own droppers and its ends.
    droppers : Droppers
        The long ones between messenger and auxiliary; ``clamp_contact`` is the clamp on the auxiliary.
    places : DropperRule
        Where they are in spans that do not list ``long_droppers``.

    """

    wire: Wire
    height: float
    droppers: Droppers
    places: DropperRule | None = None

    def check(self, where: str) -> None:
        """Raise ModelError if a value is out of range."""
        checks.kind(self.wire, f"{where}.wire", Wire, WIRE).check(where)
        checks.positive(self.height, f"{where}.height")
        droppers = checks.kind(self.droppers, f"{where}.droppers", Droppers, "catenary.Droppers(EA=1e5)")
        droppers.check(f"{where}.droppers")
        if self.places is not None:
            checks.kind(self.places, f"{where}.places", DropperRule, "first and pitch_max")

    def check_in(self, line: Any) -> None:
        """Raise ModelError if it does not fit a Line."""
        self.check("line.auxiliary")
        if line.messenger_wire is None or line.stitch is not None:
            alone = line.messenger_wire is None
            what = "has no messenger to hang from" if alone else "and stitch are given both"
            raise ModelError("line.auxiliary", what, "leave it out")
        lowest = min(line.system_height)
        if self.height >= lowest:
            what = f"is {self.height:g} m, the messenger is {lowest:g} m over the contact wire"
            raise ModelError("line.auxiliary.height", what)
        for k, span in enumerate(line.spans):
            if span.long_droppers is None and self.places is None:
                where, what = f"line.spans[{k}].long_droppers", "is missing, nothing carries the auxiliary"
                raise ModelError(where, what, "or give a rule, first and pitch_max")


def check_auxiliary(line: Any) -> None:
    """Raise ModelError if the auxiliary does not fit a Line, or spans have droppers of none."""
    if line.auxiliary is not None:
        line.auxiliary.check_in(line)
        return
    for k, span in enumerate(line.spans):
        if span.long_droppers is not None:
            key = "long_droppers"
            where = line.place_of_support(key, k) if line.rows else f"line.spans[{k}].{key}"
            raise ModelError(where, "has no effect without an auxiliary wire", "add it, or leave them out")


@dataclass(frozen=True, slots=True)
class LongDroppers:
    """The droppers between messenger and auxiliary at rest.

    Attributes
    ----------
    force : (m,) N
        Between their clamps; half of the weight is at each.
    length, natural : (m,) m
        From clamp to clamp under this force, and without force.
    stiffness : (m,) N/m
    give : (m,) m/N
        What both wires give too little at the clamps on their meshes.
    side : (supports,) N
        Sideways forces of the supports on the auxiliary.

    """

    force: FloatArray
    length: FloatArray
    natural: FloatArray
    stiffness: FloatArray
    give: FloatArray
    side: FloatArray

    @property
    def spring_stiffness(self) -> FloatArray:
        """Between the nodes, N/m: with the give of their clamps."""
        stiffness: FloatArray = self.stiffness / (1.0 + self.give * self.stiffness)
        return stiffness
