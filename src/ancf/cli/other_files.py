"""What is in files beside models, lines and results: pantographs, measuring pantographs, studies."""

from __future__ import annotations

from pathlib import Path

from ..model.file.kinds import CALIBRATION, HEAD, OPTIMISATION, PANTOGRAPH, READ_BY
from .summary import plural

#: Speed at which the lift of a pantograph is told, km/h.
FAST = 200.0


def described(path: Path, kind: str) -> str:
    """Read a file of a kind, and say in a line what it has and which command takes it.

    Raises
    ------
    ModelError
        Something in it is wrong.

    """
    name, command = READ_BY[kind]
    return f"{name}: {_said(path, kind)}; {command.replace('FILE', str(path))}"


def _said(path: Path, kind: str) -> str:
    if kind == PANTOGRAPH:
        return _pantograph(path)
    if kind == HEAD:
        return _head(path)
    if kind == CALIBRATION:
        from ..design.calibration_file import read_calibration

        return plural(len(read_calibration(path).bounds), "parameter")
    if kind == OPTIMISATION:
        from ..design.optimisation_file import read_optimisation

        return plural(len(read_optimisation(path).parameters), "parameter")
    from ..design.file import read_study_file

    study = read_study_file(path)
    outputs = len(study.case.inner.outputs)
    parameters = plural(len(study.samples.columns), "parameter")
    return f"{plural(len(study.samples), 'case')}, {parameters}, {plural(outputs, 'output')}"


def _pantograph(path: Path) -> str:
    from ..catenary.vehicles.pantograph import read_pantograph

    unit = read_pantograph(path)
    masses = "a mass" if len(unit.masses) == 1 else f"{len(unit.masses)} masses"
    lift = f"{unit.force(0.0):g} N at standstill, {unit.force(FAST / 3.6):.4g} N at {FAST:g} km/h"
    return f"{unit.name}, {masses}, {sum(unit.masses):g} kg, {lift}"


def _head(path: Path) -> str:
    from ..catenary.answers.measuring_file import read_measuring_head

    head = read_measuring_head(path)
    rate = "those of the run" if head.rate is None else f"{head.rate:g} in a second"
    own = "what moves above its sensors" if head.corrected_mass is None else f"{head.corrected_mass:g} kg"
    return f"samples {rate}, corrected for the inertia of {own}"
