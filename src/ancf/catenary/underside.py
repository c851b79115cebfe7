"""The underside of a contact wire, on which strips run: waves by a spectrum, and wear as it was measured."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..model import checks
from .assemble import Assembled
from .forms.irregular import random_waves
from .lines.csv_table import read_table
from .lines.line import Line
from .lines.route import Route

#: Rows of a random underside for each of its shortest waves.
ROWS = 16
MOST_ROWS = 2_000_000
#: Height of an underside beyond which it is a slip of units, m: more than a wire is thick.
THICKEST = 0.02
COLUMNS = ("position", "height_mm")


def random_underside(
    line: Line | Route,
    spectrum: Callable[[FloatArray], FloatArray],
    wavelengths: tuple[float, float],
    seed: int,
) -> FloatArray:
    """Random heights of the underside of a line's contact wire, for ``run(underside=...)``.

    Parameters
    ----------
    line : Line or Route
    spectrum : callable
        One-sided power spectral density of the height in m^2/(1/m), of spatial frequencies (n,) in 1/m; its
        integral over the band is the mean square.
    wavelengths : (float, float), m
        Shortest and longest waves.
    seed : int
        The same gives the same underside.

    Returns
    -------
    (n, 2) array
        Track positions and heights, m.

    Raises
    ------
    ModelError
        A number is wrong, or the spectrum has values that are no finite numbers >= 0.

    """
    if not hasattr(line, "begin") or not hasattr(line, "parts"):
        what = f"must be a Line or a Route, is {checks.shown(line)}"
        raise ModelError("random_underside.line", what, "ancf.catenary.read_line reads one")
    shortest = float(checks.array(wavelengths, "random_underside.wavelengths", (2,))[0])
    count = int(min(ROWS * line.length / max(shortest, 1e-9), 2.0 * MOST_ROWS)) + 2
    if count > MOST_ROWS:
        what = f"begin at {shortest:g} m, which takes {count} rows along {line.length:g} m"
        raise ModelError("random_underside.wavelengths", what, f"at most {MOST_ROWS}; units are m")
    x = np.linspace(line.begin, line.end, count)
    return np.column_stack([x, random_waves(spectrum, wavelengths, seed, x, "random_underside")])


def read_underside(path: str | Path) -> FloatArray:
    """Rows (n, 2) in m from a CSV file with the columns ``position`` in m and ``height_mm``.

    Raises
    ------
    ModelError
        The file cannot be read, a column is missing or a cell is no number.

    """
    rows = read_table(checks.path(path, "read_underside.path"), COLUMNS, COLUMNS)
    x, height = (np.array([row[key] for row in rows], dtype=np.float64) for key in COLUMNS)
    late = np.flatnonzero(np.diff(x) <= 0.0)
    if late.size:
        k = int(late[0]) + 1
        where = f"{path}, row {k + 1}, column position"
        raise ModelError(where, f"is {x[k]:g} m, behind one at {x[k - 1]:g} m", "sort the rows")
    return np.column_stack([x, 1e-3 * height])


def checked_underside(given: Any) -> FloatArray | None:
    """Rows (n, 2) of track position and height in m, from rows or a CSV file; None for none."""
    if given is None:
        return None
    of_file = isinstance(given, str | Path)
    rows = checks.curve(read_underside(given) if of_file else given, "run.underside")
    high = int(np.argmax(np.abs(rows[:, 1])))
    if abs(rows[high, 1]) > THICKEST:
        unit = "height_mm is in mm" if of_file else "units are m"
        what = f"is {rows[high, 1]:g} m at {rows[high, 0]:g} m, more than a wire is thick"
        raise ModelError(f"{given}" if of_file else f"run.underside[{high}][1]", what, unit)
    return rows


def profiles(overhead: Assembled, rows: FloatArray | None) -> list[FloatArray] | None:
    """Profiles of all contact wires over their natural arc lengths; worn is up, away from the strip."""
    if rows is None:
        return None
    made = []
    for wire in overhead.strung_contacts:
        shape = wire.shape
        x = shape.position[:, 0]
        level = np.concatenate([[rows[0, 1]], rows[:, 1], [rows[-1, 1]]])  # as at its ends beyond them
        place = np.concatenate([[min(x[0], rows[0, 0]) - 1.0], rows[:, 0], [max(x[-1], rows[-1, 0]) + 1.0]])
        arc = np.interp(place, x, shape.arc)
        arc[place < x[0]] = shape.arc[0] - (x[0] - place[place < x[0]])
        arc[place > x[-1]] = shape.arc[-1] + (place[place > x[-1]] - x[-1])
        made.append(np.column_stack([arc, -level]))
    return made
