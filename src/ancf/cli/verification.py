"""``ancf run --verify``: the computation of a model file against two finer ones."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from ..model.file import Study
from .screen import table
from .summary import outputs

if TYPE_CHECKING:
    from rich.console import Console

    from .. import Result, State, Verification
    from ..model.integrators import Integrator
    from ..model.model import Model

#: Rows of the table; all are in the file.
MOST_ROWS = 60


def verified(
    study: Study, result: Result, again: Callable[[Model, float | None, Integrator], Result | State]
) -> Verification:
    """Compare the result of a study with two finer computations, which `again` makes."""
    from ..model.integrators import Trapezoidal
    from ..verification import repeated

    settings = study.simulation
    if settings is None:
        return repeated(study.model, result.state(), again, None, Trapezoidal(), outputs(study))
    method = settings.integrator
    return repeated(study.model, result, again, settings.step, method, outputs(study))


def print_verification(to: Console, found: Verification) -> None:
    """Print what was computed, and how every output changes."""
    from ..verification import COLUMNS

    to.print()
    for run in found.runs:
        step = "" if run["step"] is None else f", {run['steps']} steps of {run['step']:g} s"
        to.print(f"{run['what']}: {run['elements']} elements{step}", soft_wrap=True)
    to.print()
    made = table(*COLUMNS)
    for row in found.rows()[:MOST_ROWS]:
        made.add_row(*row)
    to.print(made)
    if len(found.changes) > MOST_ROWS:
        to.print(f"... {len(found.changes) - MOST_ROWS} more in the file")
