"""Columns of tables, with names and units, and a table as a CSV file."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...files import cell, drafted
from ...model.bodies.beam import Beam
from ...model.points import Point
from ...model.supports.support import Clamp
from ...results.result import Result
from ...results.sensors import Sensors

Column = tuple[str, FloatArray]

ENERGIES = ("kinetic", "strain", "potential", "total", "dissipated", "supplied", "balance", "drift")
MOTION = {"position": "m", "velocity": "m/s"}
#: What the points of beams and cables know beside position and velocity.
INSIDE = {"tension": "N", "curvature": "1/m"}


def write_table(path: Path, columns: Iterable[Column]) -> Path:
    """Write a CSV file with names and units in its first row; numbers read back to the last bit.

    What is not known, or infinite as a gap to what is not near, is an empty cell.
    """
    listed = list(columns)
    with drafted(path) as draft, draft.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow([cell(name) for name, _ in listed])
        writer.writerows(zip(*(_cells(values) for _, values in listed), strict=True))
    return path


def _cells(values: FloatArray) -> list[float | None]:
    """Numbers; None, which is written as nothing, for what is none."""
    known = np.isfinite(values).tolist()
    return [x if there else None for x, there in zip(values.tolist(), known, strict=True)]


def sensor_columns(sensors: Sensors, inside: bool = True) -> Iterator[Column]:
    """Everything that was recorded at every step; without `inside` no tension and curvature of points."""
    yield "t [s]", sensors.t
    for point in sensors.listing.points:
        yield from motion_columns(sensors, point, str(point))
        if inside:
            yield from inside_columns(sensors, str(point))
    for name in sensors.listing.connections:
        if name in sensors.springs:
            yield f"{name} force [N]", sensors.spring_force(name)
            yield f"{name} length [m]", sensors.spring_length(name)
        if name in sensors.torsion_springs:
            yield from torsion_columns(sensors, name)
        if name in sensors.joints:
            yield from joint_parts(sensors, name)
        if name in sensors.listing.held:
            yield from support_columns(sensors, name)
        if name in sensors.listing.columns:
            yield from contact_columns(sensors, name)
    if sensors._led():
        yield from input_columns(sensors)


def support_columns(known: Any, name: str) -> Iterator[Column]:
    """Force of a support, and moment of a clamp."""
    yield from vector_columns(f"{name} reaction", known.reaction(name), "N")
    clamps = {item.name for item in known.model.supports if isinstance(item, Clamp)}
    if name in clamps and (not isinstance(known, Sensors) or name in known.listing.turned):
        yield from vector_columns(f"{name} moment", known.reaction_moment(name), "N m")


def contact_columns(sensors: Sensors, name: str) -> Iterator[Column]:
    """Force and gap of a contact; friction of one that rubs, the place on the wire of a strip."""
    yield f"{name} force [N]", sensors.contact_force(name)
    yield f"{name} gap [m]", sensors.contact_gap(name)
    if sensors.rubs(name):
        yield f"{name} friction [N]", sensors.friction_force(name)
        yield f"{name} slipping [-]", sensors.slipping(name)
    else:
        yield f"{name} s [m]", sensors.arc_length(name)


def input_columns(known: Any) -> Iterator[Column]:
    """What the inputs of a model were."""
    return (input_column(known, name) for name in known.model.inputs)


def input_column(known: Any, name: str) -> Column:
    """An input; without a unit where the model does not say it."""
    unit = known.model.inputs[name].unit
    return f"input {name}" + (f" [{unit}]" if unit else ""), known.input(name)


def torsion_columns(known: Any, name: str) -> Iterator[Column]:
    """Angle and moment of a torsion spring."""
    yield f"{name} angle [rad]", known.torsion_angle(name)
    yield f"{name} moment [N m]", known.torsion_moment(name)


def motion_columns(known: Any, point: Point | str, label: str) -> Iterator[Column]:
    """Position and velocity of a point."""
    for quantity, unit in MOTION.items():
        yield from vector_columns(f"{label} {quantity}", getattr(known, quantity)(point), unit)


def vector_columns(label: str, values: FloatArray, unit: str) -> Iterator[Column]:
    """The components of a vector."""
    yield from ((f"{label} {c} [{unit}]", values[:, k]) for k, c in enumerate("xyz"))


def point_columns(result: Result, labels: Sequence[str]) -> Iterator[Column]:
    """Points at the stored times; those of beams and cables with tension and curvature."""
    yield "t [s]", result.t
    for label in labels:
        yield from motion_columns(result, label, label)
        yield from inside_columns(result, label)


def inside_columns(known: Any, label: str) -> Iterator[Column]:
    """What a point of a beam or cable knows beside its motion."""
    if isinstance(known._probe(label).body, Beam):
        yield from (
            (f"{label} {name} [{unit}]", getattr(known, name)(label)) for name, unit in INSIDE.items()
        )


def spring_columns(result: Result) -> Iterator[Column]:
    """Forces of all springs at the stored times."""
    yield "t [s]", result.t
    yield from ((f"{name} force [N]", result.spring_force(name)) for name in result.springs)


def joint_columns(result: Result, names: Sequence[str]) -> Iterator[Column]:
    """Forces and angles of joints, and arc lengths of sliding joints, at the stored times."""
    yield "t [s]", result.t
    for name in names:
        yield from joint_parts(result, name)


def energy_columns(result: Result) -> Iterator[Column]:
    """Energies at the stored times."""
    energy = result.energy
    yield "t [s]", result.t
    yield from ((f"{name} [J]", getattr(energy, name)) for name in ENERGIES)


def joint_parts(known: Any, name: str) -> Iterator[Column]:
    """Force and moment, s of a sliding joint, angles of one that turns about axes, the way along one."""
    if known.has_force(name):
        yield from vector_columns(f"{name} force", known.joint_force(name), "N")
    if known.has_moment(name):
        yield from vector_columns(f"{name} moment", known.joint_moment(name), "N m")
    if name in known.arcs:
        yield f"{name} s [m]", known.arc_length(name)
    if known.has_angle(name):
        yield f"{name} angle [rad]", known.joint_angle(name)
    if known.has_angles(name):
        angles = known.joint_angles(name)
        yield from ((f"{name} angle {k + 1} [rad]", angles[:, k]) for k in range(2))
    if known.has_travel(name):
        yield f"{name} displacement [m]", known.joint_displacement(name)
