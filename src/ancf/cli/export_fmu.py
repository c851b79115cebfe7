"""``ancf export-fmu``: a unit of co-simulation from a model file."""

from __future__ import annotations

from pathlib import Path

from .screen import Screen, console
from .summary import plural


def export_unit(model: Path, output: Path, version: str) -> None:
    """Write the unit; say what goes in and what comes out.

    Raises
    ------
    ModelError
        See :func:`ancf.cosimulation.fmu.export_fmu`.
    """
    from ..cosimulation.fmu import export_fmu

    Screen(quiet=False).announce_compilation()
    made = export_fmu(model, output, version)
    screen = console()
    screen.print(f"inputs: {', '.join(made.inputs) or 'none'}", soft_wrap=True)
    for output_ in made.outputs:
        screen.print(f"output: {output_.name} [{output_.unit}]", markup=False, soft_wrap=True)
    counts = plural(len(made.inputs), "input"), plural(len(made.outputs), "output")
    screen.print(f"written: {output} (FMI {version}, {', '.join(counts)})", soft_wrap=True)
