"""The table of what sensors recorded, one row per step."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from ancf.results.sensors import Sensors

FloatArray = NDArray[np.float64]
Column = tuple[str, FloatArray]

#: Components of multipliers by unit: forces come first, what holds axes follows.
FORCES = "xyz"


def write_table(path: Path, sensors: Sensors) -> None:
    """Write a CSV file with names and units in its first row; the file is complete or absent."""
    columns = [("t [s]", sensors.t), *table_columns(sensors)]
    draft = path.with_suffix(".csv.part")
    with draft.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow([name for name, _ in columns])
        writer.writerows(zip(*(values.tolist() for _, values in columns), strict=True))
    draft.replace(path)


def table_columns(sensors: Sensors) -> Iterator[Column]:
    """Names with units, and values, of everything that was recorded."""
    for point in sensors.listing.points:
        for quantity, unit in (("position", "m"), ("velocity", "m/s")):
            values = getattr(sensors, quantity)(point)
            yield from ((f"{point} {quantity} {c} [{unit}]", values[:, k]) for k, c in enumerate("xyz"))
    for name in sensors.listing.connections:
        if name in sensors.springs:
            yield f"{name} force [N]", sensors.spring_force(name)
            yield f"{name} length [m]", sensors.spring_length(name)
        if name in sensors.joints:
            yield from _joint(sensors, name)
        if name in sensors.listing.columns:
            yield f"{name} force [N]", sensors.contact_force(name)
            yield f"{name} gap [m]", sensors.contact_gap(name)
            yield f"{name} s [m]", sensors.arc_length(name)


def _joint(sensors: Sensors, name: str) -> Iterator[Column]:
    """Multipliers, and s of a sliding joint."""
    values = sensors.multiplier(name)
    for k in range(values.shape[1]):
        label = f"force {FORCES[k]} [N]" if k < len(FORCES) else f"moment {k - len(FORCES) + 1} [N m]"
        yield f"{name} {label}", values[:, k]
    if name in sensors.arcs:
        yield f"{name} s [m]", sensors.arc_length(name)
