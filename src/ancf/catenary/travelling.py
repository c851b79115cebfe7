"""A pantograph under a line that somebody computes with :func:`ancf.simulate` himself."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import ancf

from ..arrays import FloatArray
from ..model import checks
from .assemble import MADE, Assembled
from .chain import Level
from .collectors import Collector, Touch, put_pantograph
from .lines.line import Line
from .lines.route import Route
from .underside import checked_underside, profiles
from .vehicles.pantograph import Pantograph, find_pantograph
from .vehicles.roof import roofs
from .vehicles.travel import make_travel


def add_pantograph(
    overhead: Assembled,
    pantograph: Pantograph | str | Path,
    speed: Any,
    *,
    start: float,
    height: float | None = None,
    raised: float = 0.0,
    contact: str = "penalty",
    contact_stiffness: float | None = None,
    contact_damping: float = 0.0,
    active: bool = False,
    label: str = "pantograph",
    roof: Any = None,
    underside: Any = None,
) -> Collector:
    """Add a pantograph to the model of a line, where it stands at the start.

    :func:`run` does all of this and evaluates too; this is for models of which it knows nothing.

    Parameters
    ----------
    overhead : Assembled
    pantograph : Pantograph, str or path
    speed : float, m/s, or (n, 2)
        Or a profile of times in s and speeds in m/s.
    start : float, m
        Track position at t = 0.
    height : float, m
        Of the strip there; default where the wire comes to rest on it, for which an equilibrium is found.
    raised : float, m
        By how much the lowest spring is relaxed above the place that the pantograph gives.
    contact, contact_stiffness, contact_damping
        As in :func:`run`.
    active : bool
        It has an input for a force on its lowest mass, ``"pantograph_force"``.
    label : str
        Beginning of the names in the model; a second pantograph needs another one.
    roof, underside
        As in :func:`run`.

    Returns
    -------
    Collector
        Its ``head`` is the strip, ``touch`` the contact, ``sensors()`` what :func:`ancf.simulate` records.

    Raises
    ------
    ModelError
        The pantograph is unknown, or a number is wrong.

    """
    unit, travel = find_pantograph(pantograph), make_travel(speed, "add_pantograph.speed")
    line = checks.kind(overhead, "add_pantograph.overhead", Assembled, MADE, "Overhead").form.line
    place = checks.between(start, "add_pantograph.start", line.begin, line.end)
    touch = Touch(contact, contact_stiffness, contact_damping)
    checks.number(raised, "add_pantograph.raised")
    checks.flag(active, "add_pantograph.active")
    lift = float(unit.force(travel.speed(0.0)))
    rows = checked_underside(underside)
    if height is None:
        height = strip_heights(overhead, [unit], [place], [lift], touch, rows)[0]
    checks.number(height, "add_pantograph.height")
    return put_pantograph(
        overhead.model,
        overhead.contact_wires,
        unit,
        travel,
        label=label,
        start=place,
        height=height,
        raised=raised,
        touch=touch,
        active=active,
        level=level_of(overhead.form.line),
        roof=roofs(roof, 1)[0],
        profiles=profiles(overhead, rows),
    )


def level_of(line: Line | Route) -> Level | None:
    """Nominal height of the contact wire over the track, or None where it is 0 everywhere."""
    return line.height_at if any(line.heights) else None


def strip_heights(
    overhead: Assembled,
    units: Sequence[Pantograph],
    places: Sequence[float],
    lifts: Sequence[float],
    touch: Touch,
    underside: FloatArray | None = None,
) -> list[float]:
    """Heights in m of strips at track positions that lift the wires there with forces in N, at rest.

    Of two strips, and of twin wires, each takes its share. The model is as before afterwards.
    """
    model = overhead.model
    strips = [_strips(unit, place) for unit, place in zip(units, places, strict=True)]
    under = [[point for x in one for point in overhead.contacts_at(x)] for one in strips]
    forces = [
        model.add_force(point, (0.0, 0.0, lift / len(points)))
        for points, lift in zip(under, lifts, strict=True)
        for point in points
    ]
    state = ancf.equilibrium(model)
    for force in forces:
        model.loads.remove(force)
    heights = []
    for points, one, lift in zip(under, strips, lifts, strict=True):
        height = np.mean([state.position(point)[2] for point in points])
        worn = 0.0 if underside is None else np.mean(np.interp(one, underside[:, 0], underside[:, 1]))
        heights.append(float(height + worn) + touch.overlap(lift / len(points)))
    return heights


def _strips(unit: Pantograph, place: float) -> list[float]:
    """Track positions of the strips of a pantograph, m."""
    half = 0.5 * unit.strip_distance
    return [place + half, place - half] if half else [place]
