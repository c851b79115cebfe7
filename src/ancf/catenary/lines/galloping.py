"""Galloping: lift on wires over the angle of attack, which a wind can feed into a swing of the wire.

A wire that moves down meets the wind from below. If its lift falls there by more than its drag carries it,
``dCL/da + CD < 0`` (Den Hartog, Transmission line vibration due to sleet, Trans. AIEE 51 (1932) 1074-1076),
the air pushes it on: it damps a metre of wire with ``c = rho D U (dCL/da + CD)/2``, and an amplitude grows as
``exp(s t)`` with ``s = -(c/m + alpha + beta w^2)/2``, m the mass per length with ice, alpha and beta the
damping of the wires. The speed at which s is 0 is the critical one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

import ancf

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks
from .csv_table import read_table

#: Angle of attack up to which a table may reach, rad, and the largest coefficient; more is a slip of units.
STEEPEST, LARGEST = np.pi, 10.0
#: Speed of air beside which the wire takes no lift, m/s.
STILL = 1e-9
#: Of the criterion, which slopes of tables do not know better.
FAINT = 1e-9
DEGREE = np.pi / 180.0
COLUMNS = ("angle_deg", "lift")


@dataclass(frozen=True, slots=True)
class Galloping:
    """Whether one wire of a line gallops in its wind, by Den Hartog's criterion.

    Attributes
    ----------
    wire : str
    slope : float, 1/rad
        dCL/da at the angle at which the wind meets the wire at rest.
    drag : float
    frequency : float, Hz
        Lowest of the longest span, of a stitch wire between its two ends.
    growth : float, 1/s
        Of the amplitude at this frequency in the wind of the conditions; negative where it dies away.
    critical_speed : float, m/s
        Of the wind, from which on it grows; endless for a wire that does not gallop.

    """

    wire: str
    slope: float
    drag: float
    frequency: float
    growth: float
    critical_speed: float

    @property
    def criterion(self) -> float:
        """dCL/da + CD, which is negative for a wire that a fast wind makes gallop."""
        return self.slope + self.drag


def checked_lift(given: Any, where: str) -> tuple[tuple[float, float], ...]:
    """Rows of an angle of attack in rad and a lift coefficient, checked.

    Raises
    ------
    ModelError
        They are no curve, do not reach from below 0 to above it, or are in other units.

    """
    rows = checks.curve(given, where)
    for k, (angle, value) in enumerate(rows.tolist()):
        if abs(angle) > STEEPEST + 1e-9:
            raise ModelError(f"{where}[{k}][0]", f"is {angle:g} rad", "units are rad; in a CSV file degrees")
        if abs(value) > LARGEST:
            raise ModelError(f"{where}[{k}][1]", f"is {value:g}, at most {LARGEST:g} either way")
    if not rows[0, 0] < 0.0 < rows[-1, 0]:
        what = f"reaches from {rows[0, 0]:g} to {rows[-1, 0]:g} rad"
        raise ModelError(where, what, "the wind comes from ahead at 0: give angles on both sides")
    return tuple((float(a), float(c)) for a, c in rows)


def read_lift(path: str | Path) -> list[list[float]]:
    """Rows of an angle in rad and a lift coefficient from a CSV file with ``angle_deg`` and ``lift``.

    Raises
    ------
    ModelError
        The file cannot be read, a column is missing, a cell is no number, or angles do not rise.

    """
    rows = read_table(Path(path), COLUMNS, COLUMNS)
    angle, lift = (np.array([row[key] for row in rows], dtype=np.float64) for key in COLUMNS)
    late = np.flatnonzero(np.diff(angle) <= 0.0)
    if late.size:
        k = int(late[0]) + 1
        where = f"{path}, row {k + 1}, column {COLUMNS[0]}"
        raise ModelError(where, f"is {angle[k]:g} after {angle[k - 1]:g}", "sort the rows, each angle once")
    for k, value in enumerate(angle.tolist()):
        if abs(value) > 180.0:
            raise ModelError(
                f"{path}, row {k + 1}, column {COLUMNS[0]}", f"is {value:g} degrees", "-180 to 180"
            )
    made: list[list[float]] = np.column_stack([DEGREE * angle, lift]).tolist()
    return made


def said(line: Any) -> list[str]:
    """What is to be said of the wires of a line that gallop in its wind; nothing of others."""
    parts = line.parts
    return [
        f"the {found.wire}{f' of section {k + 1}' if len(parts) > 1 else ''} gallops in wind of "
        f"{abs(part.conditions.wind):g} m/s: dCL/da + CD = {found.criterion:.2f}, from "
        f"{found.critical_speed:.1f} m/s on; alone its amplitude grows by exp({found.growth:.3g} t)"
        for k, part in enumerate(parts)
        for found in (galloping(part) if has_lift(part) else [])
        if found.growth > 0.0
    ]


def has_lift(line: Any) -> bool:
    """Whether a wire has a table of lift."""
    return any(
        getattr(wire, "lift", None) is not None for part in line.parts for wire in _wires(part).values()
    )


def _track(line: Any) -> Any:
    """The line; ModelError for what is none."""
    if not hasattr(line, "parts") or not hasattr(line, "spans"):
        what = f"must be a Line or a Route, is {checks.shown(line)}"
        raise ModelError("galloping.line", what, "catenary.read_line reads one, a form has form.line")
    return line


def _wires(part: Any) -> dict[str, Any]:
    """The wires on which the lift of wind acts, by what they are called."""
    auxiliary = getattr(part, "auxiliary", None)
    third = None if auxiliary is None else auxiliary.wire
    stitch = getattr(part, "stitch", None)
    return {
        "contact wire": part.contact_wire,
        "messenger wire": part.messenger_wire,
        "auxiliary": third,
        "stitch wire": None if stitch is None else stitch.wire,
    }


def slope_at(rows: Any, angle: float = 0.0) -> float:
    """dCL/da of a table at an angle, 1/rad: of the rows around it, at a row the mean of both sides."""
    angles, values = np.asarray(rows, dtype=np.float64).T
    slopes = np.concatenate([[0.0], np.diff(values) / np.diff(angles), [0.0]])  # flat beyond the table
    sides = (np.searchsorted(angles, angle, side=side) for side in ("left", "right"))
    return 0.5 * float(sum(slopes[k] for k in sides))


@lru_cache(maxsize=64)  # a law that is the same function again is not compiled again
def lift_law(rows: Any, wind: float, density: float, diameter: float) -> Callable[[float, Any, Any], Any]:
    """Lift per length, N/m, on a wire across the track that moves with v in wind along y, as a law (t, r, v).

    It stands across the wind that the moving wire feels, upwards for a positive coefficient; beyond the
    table the coefficient is that of its end.
    """
    angles, values = (np.ascontiguousarray(column) for column in np.asarray(rows, dtype=np.float64).T)
    size, sense = 0.5 * density * diameter, 1.0 if wind > 0.0 else -1.0

    def lift(t: float, r: FloatArray, v: FloatArray) -> FloatArray:
        across, up = wind - v[1], -v[2]
        speed = np.sqrt(across * across + up * up)
        force = np.zeros(3)
        if speed > STILL:
            coefficient = np.interp(np.arctan2(up, sense * across), angles, values)
            force[1] = -size * speed * coefficient * sense * up
            force[2] = size * speed * coefficient * sense * across
        return force

    return lift


def add_lift(model: ancf.Model, wire: Any, conditions: Any) -> None:
    """Put the lift of the conditions' wind on a Strung wire that has a table of it."""
    given = wire.shape.wire
    if given.lift is None or conditions.wind == 0.0:
        return
    law = lift_law(given.lift, conditions.wind, conditions.air_density, given.diameter)
    for beam in wire.beams:
        model.add_distributed_load(beam, law, name=f"lift on {beam.name}")


def galloping(line: Any) -> list[Galloping]:
    """Den Hartog's criterion for each wire with a table of lift of a Line, or of a Route's first section.

    Contact wire, as it is worn, messenger, auxiliary and stitch wires, with their ice.

    Each wire swings alone, as between its supports; droppers join wires, whose growth is then a mean of both,
    weighted by mass and amplitude.

    Raises
    ------
    ModelError
        No wire has a table of lift.

    """
    part = _track(line).parts[0]
    air, span = part.conditions, max(span.length for span in part.spans)
    found = []
    for name, wire in _wires(part).items():
        if wire is None or wire.lift is None:
            continue
        left = 1.0 - air.wear if name == "contact wire" else 1.0
        pulled = getattr(air, f"{name.removesuffix(' wire')}_tension", None)
        mass, tension = left * wire.mass + wire.count * air.ice, pulled or wire.tension
        w = np.pi / (2.0 * part.stitch.reach if name == "stitch wire" else span) * np.sqrt(tension / mass)
        slope = slope_at(wire.lift)
        damping = wire.damping / mass + part.damping.alpha + part.damping.beta * w**2
        fed = -0.5 * air.air_density * wire.diameter * (slope + wire.drag) / mass
        critical = float(damping / fed) if slope + wire.drag < -FAINT else float("inf")
        growth = float(0.5 * (fed * abs(air.wind) - damping))
        found.append(Galloping(name, slope, wire.drag, float(w / (2.0 * np.pi)), growth, critical))
    if not found:
        hint = "lift in [contact_wire] or another wire: rows of an angle of attack and a coefficient"
        raise ModelError("line.contact_wire.lift", "is missing, no wire has a table of its lift", hint)
    return found
