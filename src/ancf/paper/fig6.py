"""Fig. 6: Jacobians of the pendulum (7.2) against Young's modulus, four elements, 0.5 s."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import jacobians, kinds, pendulum
from .table import Table

if TYPE_CHECKING:
    from ancf import Result

KINDS = kinds.KINDS
SIZE = jacobians.SIZE
draw = jacobians.draw


def data(short: bool = False) -> Table:
    """Counts for f from 10 to 0.1; the short form has fewer f and a shorter run."""
    factors = jacobians.factors(0.1, 10.0, 3 if short else 25)
    t_end = 0.02 if short else 0.5

    def run(element: str, f: float) -> Result:
        model = pendulum.build(jacobians.ELEMENTS, f, element)
        return pendulum.run(model, t_end, newton=jacobians.plain_newton())

    notes = [*pendulum.NOTES, *jacobians.rule(t_end)]
    return jacobians.Sweep("fig6", KINDS, factors, pendulum.youngs_modulus, run, notes).table()
