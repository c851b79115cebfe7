"""A result as CSV tables."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from ...errors import ModelError
from ...files import writing
from ...model import checks
from ...model.bodies.beam import Beam
from ...model.bodies.rigid import PointMass
from ...results.result import Result
from . import tables

#: Bodies whose points are written when none are named and there were no sensors.
MOST_BODIES = 12


def write_csv(result: Result, folder: str | Path, points: Sequence[str] | None = None) -> list[Path]:
    """Write what a result knows as tables: time in the first column, names with units in the first row.

    ``sensors.csv`` holds what sensors recorded at every step. At the stored times: ``points.csv``. Both have
    the motion of points, and on beams and cables tension and curvature; ``springs.csv`` the forces of all
    springs; ``joints.csv`` the forces of joints and arc lengths of sliding joints; ``energies.csv``;
    ``inputs.csv`` what a controller gave. No table is empty.

    Parameters
    ----------
    result : Result
    folder : path
        Made when it does not exist.
    points : sequence of str, optional
        Such as ``["beam.end", "beam.at(0.5)"]``. Without them, and without sensors: start, middle and end of
        the first beams, and the first masses.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    ModelError
        There is no such point, nothing was stored, or a file cannot be written; then nothing was written.
    """
    if Path(folder).suffix.lower() == ".csv" and not Path(folder).is_dir():
        what = f"writes several tables into a folder, and {str(folder)!r} is the name of one"
        raise ModelError("write_csv", what, 'to_csv("tables"), or to_pandas().to_csv("table.csv") for one')
    place, found = all_tables(result, folder, points, "write_csv")
    with writing(place, place):
        return [tables.write_table(place / f"{name}.csv", columns) for name, columns in found]


def all_tables(
    result: Result, folder: str | Path, points: Sequence[str] | None, method: str
) -> tuple[Path, list[tuple[str, list[tables.Column]]]]:
    """Folder and tables by name, checked; for errors the name of the function that was called."""
    place = _checked(result, folder, method)
    named = None if points is None else _named(points, method)
    return place, list(_tables(result, named))


def default_points(result: Result) -> list[str]:
    """Start, middle and end of the first beams, and the first masses."""
    labels: list[str] = []
    for name, body in list(result.bodies.items())[:MOST_BODIES]:
        if isinstance(body, Beam):
            labels += [f"{name}.start", f"{name}.at({0.5 * body.length:.6g})", f"{name}.end"]
        else:
            labels.append(name if isinstance(body, PointMass) else f"{name}.centre")
    return labels


def has_sensors(result: Result) -> bool:
    """Whether something was recorded at every step."""
    try:
        return bool(result.sensors.names)
    except ModelError:
        return False


def _named(points: Sequence[str], method: str) -> list[str]:
    listed = [points] if isinstance(points, str) else list(points)
    return [checks.text(point, f"{method}.points[{k}]") for k, point in enumerate(listed)]


def _tables(result: Result, points: Sequence[str] | None) -> Iterator[tuple[str, list[tables.Column]]]:
    recorded = has_sensors(result)
    if recorded:
        yield "sensors", list(tables.sensor_columns(result.sensors))
    labels = points or ([] if recorded else default_points(result))
    if labels:
        yield "points", list(tables.point_columns(result, labels))
    if result.springs:
        yield "springs", list(tables.spring_columns(result))
    if result._led():
        yield "inputs", [("t [s]", result.t), *tables.input_columns(result)]
    if joints := _joints(result):
        yield "joints", list(tables.joint_columns(result, joints))
    if result.provenance["settings"].get("energy", True):
        yield "energies", list(tables.energy_columns(result))


def _joints(result: Result) -> list[str]:
    """Joints with multipliers; the unknowns of rigid bodies are no joints."""
    return [name for name in result.joints if name not in result.bodies]


def _checked(result: Result, folder: str | Path, method: str) -> Path:
    if not isinstance(result, Result):
        raise ModelError(f"{method}.result", f"must be a Result, is {checks.shown(result)}")
    if not len(result.t):
        raise ModelError(f"{method}.result", "nothing was stored", "wait for the first states")
    if not isinstance(folder, str | Path):
        raise ModelError(f"{method}.folder", f"must be a path, is {checks.shown(folder)}")
    return Path(folder)
