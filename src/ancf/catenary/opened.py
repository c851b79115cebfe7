"""Overhead: the model of a line with what one does with it."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from .answers.run_data import Run
from .assemble import Assembled
from .collectors import Collector
from .forms.mesh import Mesh
from .forms.route_form import AnyForm
from .rest import assemble as assembled
from .run import run
from .travelling import add_pantograph
from .vehicles.pantograph import Pantograph


@dataclass(slots=True)
class Overhead(Assembled):
    """The model of a line, which can be changed and run."""

    def add_pantograph(self, pantograph: Pantograph | str | Path, speed: Any, **options: Any) -> Collector:
        """Add a pantograph to the model, see :func:`ancf.catenary.add_pantograph`."""
        return add_pantograph(self, pantograph, speed, **options)

    def run(self, **options: Any) -> Run:
        """Run pantographs along the line as it is now, see :func:`ancf.catenary.run`.

        The model itself stays as it is: each run computes with a copy.
        """
        return run(self, **options)


def assemble(found: AnyForm, mesh: Mesh | None = None) -> Overhead:
    """Make the model of a line.

    Parameters
    ----------
    found : Form or RouteForm
    mesh : Mesh
        Default that of the form; on another one the form is found again, for each mesh has its own
        lengths of droppers that bring the wires to their heights exactly.

    """
    made = assembled(found, mesh)
    return Overhead(**{item.name: getattr(made, item.name) for item in fields(Assembled)})
