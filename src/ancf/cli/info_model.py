"""``ancf info`` of a model file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..model.bodies.beam import Beam
from ..model.bodies.rigid import RigidBody, kind
from ..model.file import Study, read_study
from ..model.model import Model
from .notes import notes
from .screen import console, table
from .summary import mass, plural, sizes, total_mass

if TYPE_CHECKING:
    from ..system.system import System


def show_model(path: Path) -> None:
    """Print bodies, sizes, how the matrix is ordered, and remarks."""
    study = read_study(path)
    system = compiled(study.model)
    out = console()
    out.print(study.title or str(path), style="bold", soft_wrap=True)
    for key, value in _facts(study, system):
        out.print(f"  {key:<10} {value}", soft_wrap=True)
    out.print()
    for made in (_bodies(study.model), _masses(study.model)):
        if made.row_count:
            out.print(made)
    print_notes(study, system)


def task(study: Study) -> str:
    """What the file asks for."""
    simulation = study.simulation
    if simulation is None:
        return "nothing to compute" if study.equilibrium is None else "an equilibrium"
    start = " from equilibrium" if simulation.start == "equilibrium" else ""
    steps = plural(round(simulation.t_end / simulation.step), "step")
    return f"{steps} of {simulation.step:g} s to t = {simulation.t_end:g} s{start}"


def compiled(model: Model) -> System:
    """System of a model."""
    from ..system.redundancy import independent

    return independent(model)


def _facts(study: Study, system: System) -> list[tuple[str, str]]:
    model = study.model
    free = len(system.free)
    return [
        ("model", counts(model)),
        ("unknowns", f"{free} free of {system.n}"),
        ("matrix", f"ordering: {system.ordering}, half bandwidth {system.half_bandwidth}"),
        ("mass", f"{total_mass(model):.6g} kg"),
        ("gravity", f"{model.gravity.tolist()} m/s^2"),
        ("task", task(study)),
    ]


def counts(model: Model) -> str:
    """How many things of each kind a model has."""
    size = sizes(model)
    return ", ".join(
        [
            plural(size["bodies"], "body", "bodies"),
            plural(size["elements"], "element"),
            plural(size["supports"], "support"),
            plural(size["loads"], "load"),
            plural(size["connections"], "connection"),
        ]
    )


def _bodies(model: Model) -> Any:
    """Sizes and stiffnesses of beams and cables; a cable has one bending stiffness and takes no torque."""
    beams = any(b.has_section for b in model.beams.values())
    stiffnesses = ["EA [N]", *(["EI_y [N m^2]", "EI_z [N m^2]", "GJ [N m^2]"] if beams else ["EI [N m^2]"])]
    made = table("body", "element", "elements", "length [m]", "mass [kg]", *stiffnesses)
    for b in model.beams.values():
        numbers = [b.length, mass(b), b.section.EA, b.section.EI_y]
        numbers += [b.section.EI_z, b.torsional_stiffness] if beams else []
        made.add_row(b.name, b.element, str(b.elements), *[f"{x:.6g}" for x in numbers])
    return made


def _masses(model: Model) -> Any:
    """Kind, mass and principal moments of inertia of point masses and rigid bodies."""
    made = table("body", "kind", "mass [kg]", "principal inertia [kg m^2]")
    for body in model.bodies.values():
        if isinstance(body, Beam):
            continue
        moments = np.linalg.eigvalsh(body.inertia) if isinstance(body, RigidBody) else ()
        made.add_row(body.name, kind(body), f"{body.mass:.6g}", ", ".join(f"{x:.6g}" for x in moments))
    return made


def print_notes(study: Study, system: System) -> None:
    """Print remarks on a model."""
    for note in notes(study, system):
        console().print(f"note: {note}", soft_wrap=True)
