"""Fig. 3: Jacobians of the cantilever (7.1) against Young's modulus, four elements.

The paper leaves the original element out: with a smaller f it would need more elements.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import cantilever, jacobians, kinds
from .check import Check
from .table import Table

if TYPE_CHECKING:
    from .. import Result

TITLE = "Fig. 3: Jacobians of the cantilever against Young's modulus"
EXAMPLE = "7.1"
CLAIM = (
    "With four elements both models need the more Jacobians the stiffer the beam is, at the same bending and "
    "weight; the cable a little fewer than the nonlocking element."
)
KINDS = (kinds.CABLE, kinds.NONLOCKING)
SIZE = jacobians.SIZE
draw = jacobians.draw


def data(short: bool = False) -> Table:
    """Counts for f from 1 to 0.1; the short form has fewer f."""
    factors = jacobians.factors(0.1, 1.0, 3 if short else 13)

    def run(element: str, f: float) -> Result:
        model = cantilever.build(jacobians.ELEMENTS, f, element)
        return cantilever.run(model, newton=jacobians.plain_newton())

    notes = [*cantilever.NOTES, *jacobians.rule(cantilever.T_END)]
    return jacobians.Sweep("fig3", KINDS, factors, cantilever.youngs_modulus, run, notes).table()


def checks(table: Table) -> list[Check]:
    """Counts within a factor of 3 of the reference's, and the two trends."""
    cases = [(element, f) for element in KINDS for f in (1.0, 0.1)]
    return [*jacobians.counts(table, "7.1", cases), *map(_growth, KINDS, [table] * 2), _compared(table)]


def _growth(element: str, table: Table) -> Check:
    """The reference's counts grow by 24 and 14; two rules differ by up to a factor of 3."""
    count = {f: jacobians.count(table, element, f) for f in (1.0, 0.1)}
    bound = {kinds.CABLE: 8.0, kinds.NONLOCKING: 5.0}[element]
    name = f"7.1 {element}: Jacobians at f = 0.1 over those at f = 1"
    said = "the paper, section 7.1: strong growth; bound: a third of that of the independent implementation"
    return Check(name, count[0.1] / count[1.0], bound, 0.0, "", said, "at least")


def _compared(table: Table) -> Check:
    cable, nonlocking = (table.values("jacobians", element=element) for element in KINDS)
    said = "the paper, section 7.1: the cable needs somewhat fewer"
    largest = float((cable / nonlocking).max())
    return Check("7.1, any f: Jacobians, cable over nonlocking", largest, 1.0, 0.0, "", said, "at most")
