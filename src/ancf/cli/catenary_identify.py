"""``ancf catenary identify``: a pantograph from its measured frequency response."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..files import beside
from .screen import console, table


def identify(
    response: Path,
    output: Path,
    kind: str = "apparent_mass",
    masses: int | None = None,
    static_force: float = 70.0,
    aerodynamic: float = 0.0,
    quiet: bool = False,
) -> None:
    """Fit, print and write.

    Raises
    ------
    ModelError
        The table is wrong, or an option.

    """
    from ..catenary.vehicles.identify import KINDS, identify_pantograph
    from ..catenary.vehicles.response_file import read_response, write_pantograph
    from ..model import checks

    checks.choice(kind, "--kind", tuple(KINDS))
    beside(output, response)
    frequency, measured = read_response(response)
    checks.non_negative(aerodynamic, "--aerodynamic")
    found = identify_pantograph(
        frequency, measured, kind=kind, masses=masses, static_force=static_force, aerodynamic=aerodynamic
    )
    unit, error = found.pantograph, f"{100 * found.error:.2g} %"
    worst = float(found.frequency[int(np.argmax(np.abs(found.errors)))])
    largest = f"{100 * found.largest:.2g} % at {worst:g} Hz"
    text = f"fitted to {response.name}, {found.frequency[0]:g} to {found.frequency[-1]:g} Hz: "
    path = write_pantograph(unit, output, f"{text}error {error} in the mean, {largest}")
    if quiet:
        return
    made = table("mass", "kg", "stiffness below [N/m]", "damping below [N s/m]")
    rows = zip(unit.masses, unit.slopes(), unit.stages, strict=True)
    for k, (mass, stiffness, stage) in enumerate(rows):
        name = "head" if k == len(unit.masses) - 1 else str(k + 1)
        made.add_row(name, f"{mass:.4g}", f"{stiffness:.4g}", f"{stage.damping_at_rest:.4g}")
    console().print(made)
    console().print(f"relative error of the response: {error} in the mean, {largest}", soft_wrap=True)
    console().print(f"written: {path}", soft_wrap=True)
    lift = f"{unit.force(0.0):g} N at standstill, {unit.force(250.0 / 3.6):.1f} N at 250 km/h"
    if aerodynamic == 0.0:
        lift = f"{unit.force(0.0):g} N at every speed: a response does not tell the aerodynamic force; "
        lift += "--aerodynamic K gives K v^2, v in m/s (0.01257 for the law of the mean force, AC)"
    console().print(f"force: {lift}", soft_wrap=True)
