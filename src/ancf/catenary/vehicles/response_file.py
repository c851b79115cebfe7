"""Measured frequency responses from tables, and pantographs as files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ...arrays import FloatArray
from ...columns import read_columns
from ...errors import ModelError
from ...files import write_text
from ...model.checks import listed
from ...model.functions.units import in_plain_units
from .pantograph import Pantograph

FREQUENCY = "frequency"
#: Columns that make a complex number: its parts, or its size and its angle in degrees, or in rad by its unit.
PARTS, POLAR, TURNED = ("real", "imag"), ("magnitude", "phase_deg"), ("magnitude", "phase")
#: Units of the package of what is no answer.
IN = {FREQUENCY: "Hz", TURNED[1]: "rad"}
Response = npt.NDArray[np.complex128]


def read_response(path: str | Path) -> tuple[FloatArray, Response]:
    """Frequencies in Hz and complex responses (n,) of a CSV file.

    Its columns are ``frequency`` and ``real`` and ``imag``, or ``magnitude`` and ``phase_deg``; a head may
    have a unit, ``frequency [Hz]``, ``real [N/m]``, ``phase [deg]``.

    Raises
    ------
    ModelError
        The file cannot be read, a column is missing, or a cell is no number.

    """
    given = read_columns(Path(path), str(path))
    columns = in_plain_units(given, str(path), IN.get)
    angle_in_rad = TURNED[1] in columns and TURNED[1] not in given
    pair = PARTS if POLAR[0] not in columns else TURNED if angle_in_rad else POLAR
    found = []
    for key in (FREQUENCY, *pair):
        if key not in columns:
            hint = f"columns {FREQUENCY}, {' and '.join(PARTS)}, or {FREQUENCY}, {' and '.join(POLAR)}"
            what = f"is missing, the head has {listed(given)}"
            raise ModelError(f"{path}, column {key}", what, hint)
        found.append(
            np.array([_number(v, f"{path}, row {k + 1}, column {key}") for k, v in enumerate(columns[key])])
        )
    frequency, one, other = found
    if pair != PARTS:
        angle = np.radians(other) if pair == POLAR else other
        one, other = one * np.cos(angle), one * np.sin(angle)
    return frequency, one + 1j * other


def _number(value: Any, where: str) -> float:
    try:
        return float(value)
    except ValueError:
        raise ModelError(where, f'is "{value}", must be a number') from None


def write_pantograph(unit: Pantograph, path: str | Path, source: str = "") -> Path:
    """Write a pantograph of plain springs and dampers as a file that runs along lines read again."""
    rows = [
        f"name = {json.dumps(unit.name)}",
        *([f"source = {json.dumps(source, ensure_ascii=False)}"] if source else []),
        f"masses = {_listed(unit.masses)}      # kg, the head last",
        f"stiffness = {_listed(unit.slopes())}   # N/m, each below its mass",
        f"damping = {_listed([stage.damping_at_rest for stage in unit.stages])}     # N s/m",
        f"static_force = {float(unit.static_force)!r}   # N",
        f"aerodynamic = {_listed(unit.aerodynamics)}   # k of the force k v^2, N s^2/m^2",
        f"strip_length = {float(unit.strip_length)!r}   # m",
    ]
    return write_text(Path(path), "\n".join(rows) + "\n")


def _listed(values: npt.ArrayLike) -> str:
    return "[" + ", ".join(repr(float(f"{value:.6g}")) for value in np.atleast_1d(values)) + "]"
