"""Fig. 3: Jacobians of the cantilever (7.1) against Young's modulus, four elements.

The paper leaves the original element out: with a smaller f it would need more elements.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import cantilever, jacobians, kinds
from .table import Table

if TYPE_CHECKING:
    from ancf import Result

KINDS = (kinds.CABLE, kinds.NONLOCKING)
SIZE = jacobians.SIZE
draw = jacobians.draw


def data(short: bool = False) -> Table:
    """Counts for f from 1 to 0.1; the short form has fewer f and a shorter run."""
    factors = jacobians.factors(0.1, 1.0, 3 if short else 13)
    t_end = 0.02 if short else cantilever.T_END

    def run(element: str, f: float) -> Result:
        return cantilever.run(
            cantilever.build(jacobians.ELEMENTS, f, element), t_end, newton=jacobians.plain_newton()
        )

    notes = [*cantilever.NOTES, *jacobians.rule(t_end)]
    return jacobians.Sweep("fig3", KINDS, factors, cantilever.youngs_modulus, run, notes).table()
