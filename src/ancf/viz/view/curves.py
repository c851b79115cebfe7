"""The curves beside the moving picture: energies, traced points, joints, springs, sensors.

What matters comes first: contact forces, tensions of sensors where they change by a part of their size, then
what moves little beside what only travels, and of displacements those along gravity.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...model.bodies.beam import Beam
from ..scene import Scene
from . import wire_ends
from .curve import POINTS, Curve, decimated, within
from .histories import Histories
from .traces import Trace, short_label

#: Curves of a panel at most; panels of one quantity at most.
MOST, PANELS = 6, 20
#: Points of all curves together, about, and of one of many.
ALL_POINTS, FEW = 400_000, 300
#: A component that changes by less than this part of the largest one is not drawn.
STILL = 1e-6
#: What changes by less than this part of the largest component, or of where a point is, would look constant.
SMALL = 0.02
#: Tensions that change by less than this part of the largest one matter less than what moves.
EVEN = 0.1
#: A point that goes farther than this part of the model's size travels.
FAR = 0.3


def curves(result: Any, states: Histories, traced: Sequence[Trace], scene: Scene) -> list[Curve]:
    """All curves of a result over a scene's time, panel by panel; what tells most comes first."""
    recorded = _sensors(result, states, {trace.name for trace in traced})
    paths = [_position(trace, scene.size) for trace in traced]
    lively = _lively(recorded.tensions)
    found = recorded.contacts + (recorded.tensions if lively else []) + _energies(result)
    for first, _ in paths:
        found += first
    found += recorded.moved + _joints(states)
    found += recorded.springs or _springs(states.t, states, states.springs, "spring force")
    found += recorded.joints + ([] if lively else recorded.tensions) + recorded.bends
    for _, last in paths:
        found += last
    found += _inputs(result)
    span = float(scene.t[0]), float(scene.t[-1])
    most = int(np.clip(ALL_POINTS // max(len(found), 1), FEW, POINTS))
    shortened = [_shortened(curve, span, most) for curve in found]
    return [curve for curve in shortened if len(curve.t)]


def _lively(tensions: Sequence[Curve]) -> bool:
    """Whether one of them changes much beside the largest."""
    largest = max((float(np.max(np.abs(c.values))) for c in tensions), default=0.0)
    return any(float(np.ptp(c.values)) > EVEN * largest for c in tensions)


def _shortened(curve: Curve, span: tuple[float, float], most: int) -> Curve:
    inside = within(curve.t, span)
    t, values = decimated(curve.t[inside], curve.values[inside], most)
    return replace(curve, t=t, values=values)


def _curve(name: str, unit: str, t: FloatArray, values: FloatArray, panel: str) -> Curve:
    return Curve(name, unit, t, np.asarray(values, dtype=np.float64), panel)


def _energies(result: Any) -> list[Curve]:
    """Energies, if they were accounted for; the potential from its start, for its zero is arbitrary."""
    try:
        energy = result.energy
    except ModelError:
        return []
    potential = energy.potential - energy.potential[0]
    total = energy.kinetic + energy.strain + potential
    parts = {"kinetic": energy.kinetic, "strain": energy.strain, "potential": potential, "total": total}
    panel = "energy, potential from the start"
    return [_curve(name, "J", result.t, values, panel) for name, values in parts.items()]


def _position(trace: Trace, size: float) -> tuple[list[Curve], list[Curve]]:
    """Components of a traced point that change, in two panels if some are small beside others.

    First are the large ones; but of a point that travels through the model the small ones. Of one that stays
    near its place they count from there.
    """
    ranges = np.ptp(trace.position, axis=0)
    small = ranges < SMALL * ranges.max()
    moving = ranges > STILL * ranges.max()
    large, rest = _components(trace, ~small & moving), _components(trace, small & moving)
    travels = ranges.max() > FAR * size and rest
    return (rest, large) if travels else (large, rest)


def _components(trace: Trace, mask: Any) -> list[Curve]:
    axes = [k for k in range(3) if mask[k]]
    near = np.ptp(trace.position, axis=0).max() < SMALL * np.abs(trace.position).max()
    since = trace.position[0] if near else np.zeros(3)
    panel = f"{', '.join('xyz'[k] for k in axes)} {'displacement ' if near else ''}of {trace.name}"
    return [_curve("xyz"[k], "m", trace.t, trace.position[:, k] - since[k], panel) for k in axes]


def _joints(states: Any, said: str = "") -> list[Curve]:
    """Arc lengths, ways, angles and forces of joints; rigid bodies' own multipliers are none."""
    angles = {name: states.joint_angle(name) for name in states.joints if states.has_angle(name)}
    for name in states.joints:
        if states.has_angles(name):
            both = states.joint_angles(name)
            angles |= {f"{name}, {k + 1}": both[:, k] for k in range(2)}
    ways = {name: states.joint_displacement(name) for name in states.joints if states.has_travel(name)}
    arcs = {name: states.arc_length(name) for name in states.arcs}
    carry = [name for name in states.joints if states.has_force(name)]
    forces = {name: np.linalg.norm(states.joint_force(name), axis=-1) for name in carry}
    found = _most_varied(states.t, arcs, "m", f"arc length{said}")
    found += _most_varied(states.t, ways, "m", f"joint displacement{said}")
    found += _most_varied(states.t, angles, "rad", f"joint angle{said}")
    return found + _most_varied(states.t, forces, "N", f"joint force{said}")


def _springs(t: FloatArray, source: Any, names: Iterable[str], panel: str) -> list[Curve]:
    return _most_varied(t, {name: source.spring_force(name) for name in names}, "N", panel)


def _inputs(result: Any) -> list[Curve]:
    """What a controller gave, a panel for each unit."""
    if not result._led():
        return []
    by_unit: dict[str, dict[str, FloatArray]] = {}
    for name, item in result.model.inputs.items():
        by_unit.setdefault(item.unit, {})[name] = result.input(name)
    found = []
    for unit, values in by_unit.items():
        found += _most_varied(result.t, values, unit, f"inputs, {unit}" if unit else "inputs")
    return found


class _Recorded(NamedTuple):
    """Curves of what sensors recorded at every step."""

    contacts: list[Curve]
    springs: list[Curve]
    moved: list[Curve]
    joints: list[Curve]
    tensions: list[Curve]
    bends: list[Curve]


def _sensors(result: Any, states: Any, traced: set[str]) -> _Recorded:
    """Forces, displacements, tensions and curvatures of all that was recorded at every step."""
    try:
        sensors = result.sensors
    except ModelError:
        return _Recorded([], [], [], [], [], [])
    t, columns = sensors.t, sensors.listing.columns
    contacts = {
        name: sensors.contact_force(name) for name in columns if _answers(sensors.contact_force, name)
    }
    springs = _springs(t, sensors, sensors.springs, "spring force")
    places = {short_label(point): point for point in sensors.listing.points}
    moved = {name: sensors.position(p) for name, p in places.items() if str(p) not in traced}
    along = {name: point for name, point in places.items() if isinstance(point.body, Beam)}
    tensions = _most_varied(t, {n: sensors.tension(p) for n, p in along.items()}, "N", "tension of sensors")
    bent = {name: sensors.curvature(point) for name, point in along.items()}
    bends = _most_varied(t, bent, "1/m", "curvature of sensors")
    down = np.abs(np.asarray(result.model.gravity, dtype=np.float64))
    forces = [
        replace(curve, scale=wire_ends.scale(result, states, curve.name, curve.values))
        for curve in _most_varied(t, contacts, "N", "contact force")
    ]
    joints = _joints(sensors, " of sensors")
    return _Recorded(forces, springs, _displacements(t, moved, down), joints, tensions, bends)


def _answers(question: Callable[[str], Any], name: str) -> bool:
    try:
        question(name)
    except ModelError:
        return False
    return True


def _displacements(t: FloatArray, moved: dict[str, FloatArray], down: FloatArray) -> list[Curve]:
    """Displacements of recorded points since the start, a panel for each axis along which they move.

    The axis of gravity `down` (3,) comes first, then the one along which they move most.
    """
    found = []
    reach = [max((float(np.ptp(path[:, k])) for path in moved.values()), default=0.0) for k in range(3)]
    for k in sorted(range(3), key=lambda k: (-down[k], -reach[k])):
        if reach[k] > SMALL * max(reach):
            values = {name: path[:, k] - path[0, k] for name, path in moved.items()}
            found += _most_varied(t, values, "m", f"{'xyz'[k]} displacement of sensors")
    return found


def _most_varied(t: FloatArray, values: dict[str, FloatArray], unit: str, panel: str) -> list[Curve]:
    """Those that change, in their order; of many six a panel, and those that change most first."""
    ranges = {name: float(np.ptp(v)) for name, v in values.items()}
    moving = [name for name in values if ranges[name] > 0.0]
    if len(moving) <= MOST:
        return [_curve(name, unit, t, values[name], panel) for name in moving]
    moving.sort(key=lambda name: -ranges[name])
    found = []
    for first in range(0, min(len(moving), MOST * PANELS), MOST):
        some = moving[first : first + MOST]
        said = f"{panel} ({first + 1} to {first + len(some)} of {len(moving)})"
        found += [_curve(name, unit, t, values[name], said) for name in values if name in some]
    return found
