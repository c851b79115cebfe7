"""Closed forms of connections, of what turns, of loads that follow and of starts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .closed import joined, led
from .closed_forms import COLUMNS, checks, draw, table_of

if TYPE_CHECKING:
    from .table import Table

__all__ = ["COLUMNS", "checks", "data", "draw"]

TITLE = "Closed forms: connections, rotation, loads that follow, starts"
EXAMPLE = ""
CLAIM = (
    "Not in the paper. Welds, guided ends, rotary inertia, joints, torsion springs, loops whose joints hold "
    "the same motion twice, complex modes, whirl, loads that follow, initial velocities of any shape and the "
    'number of elements that elements="auto" takes, beside their formulas.'
)
SIZE = (170.0, 112.0)  # mm

NOTES = [
    "deviation: value over reference, less one; tolerance: the largest one that is accepted.",
    "Cables: EA = 1e5 N, EI = 3 N m^2, rhoA = 0.6 kg/m, 2 m, 8 or 16 elements, unless the case needs others; "
    "forces of 1e-4 N, so that the formulas of small deflections hold to 5e-5.",
    "Rigid bodies: trapezoidal rule, steps of 0.5 and 1 ms. The shaft of 100 mm has 4 nonlocking elements on "
    "2 m and turns at 500 rad/s; its formula leaves out shear.",
]


def data(short: bool = False) -> Table:
    """All cases; the short form leaves out the shaft, which takes the longest to compile."""
    found = [*joined.statics(), *joined.motions(), *led.cases(), *([] if short else led.turning())]
    return table_of("connections", found, NOTES)
