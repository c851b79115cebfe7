"""The curves beside the moving picture: energies, traced points, joints, springs, sensors."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ..scene import Scene
from .curve import Curve, decimated, within
from .histories import Histories
from .traces import Trace, short_label

#: Curves of a panel at most.
MOST = 6
#: A component that changes by less than this part of the largest one is not drawn.
STILL = 1e-6
#: A component that changes by less than this part of the largest one would look constant beside it.
SMALL = 0.02
#: A point that goes farther than this part of the model's size travels.
FAR = 0.3


def curves(result: Any, states: Histories, traced: Sequence[Trace], scene: Scene) -> list[Curve]:
    """All curves of a result over a scene's time, panel by panel; what tells most comes first."""
    contacts, springs, points = _sensors(result, {trace.name for trace in traced})
    paths = [_position(trace, scene.size) for trace in traced]
    found = contacts + _energies(result)
    for first, _ in paths:
        found += first
    found += points + _joints(states)
    found += springs or _springs(states.t, states, states.springs, "spring force")
    for _, last in paths:
        found += last
    span = float(scene.t[0]), float(scene.t[-1])
    shortened = [_shortened(curve, span) for curve in found]
    return [curve for curve in shortened if len(curve.t)]


def _shortened(curve: Curve, span: tuple[float, float]) -> Curve:
    inside = within(curve.t, span)
    t, values = decimated(curve.t[inside], curve.values[inside])
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

    First are the large ones; but of a point that travels through the model the small ones.
    """
    ranges = np.ptp(trace.position, axis=0)
    small = ranges < SMALL * ranges.max()
    moving = ranges > STILL * ranges.max()
    large, rest = _components(trace, ~small & moving), _components(trace, small & moving)
    travels = ranges.max() > FAR * size and rest
    return (rest, large) if travels else (large, rest)


def _components(trace: Trace, mask: Any) -> list[Curve]:
    axes = [k for k in range(3) if mask[k]]
    panel = f"{', '.join('xyz'[k] for k in axes)} of {trace.name}"
    return [_curve("xyz"[k], "m", trace.t, trace.position[:, k], panel) for k in axes]


def _joints(states: Histories) -> list[Curve]:
    """Arc lengths of sliding joints and forces of all joints; rigid bodies' own multipliers are none."""
    found = [_curve(name, "m", states.t, states.arc_length(name), "arc length") for name in states.arcs]
    forces = {}
    for name in states.joints:
        if name not in states.bodies:
            forces[name] = np.linalg.norm(states.multiplier(name)[..., :3], axis=-1)
    return found[:MOST] + _most_varied(states.t, forces, "N", "joint force")


def _springs(t: FloatArray, source: Any, names: Iterable[str], panel: str) -> list[Curve]:
    return _most_varied(t, {name: source.spring_force(name) for name in names}, "N", panel)


def _sensors(result: Any, traced: set[str]) -> tuple[list[Curve], list[Curve], list[Curve]]:
    """Contact forces, spring forces and displacements of points that were recorded at every step."""
    try:
        sensors = result.sensors
    except ModelError:
        return [], [], []
    t, columns = sensors.t, sensors.listing.columns
    contacts = {
        name: sensors.contact_force(name) for name in columns if _answers(sensors.contact_force, name)
    }
    springs = _springs(t, sensors, sensors.springs, "spring force")
    moved = {short_label(p): sensors.position(p) for p in sensors.listing.points if str(p) not in traced}
    return _most_varied(t, contacts, "N", "contact force"), springs, _displacements(t, moved)


def _answers(question: Callable[[str], Any], name: str) -> bool:
    try:
        question(name)
    except ModelError:
        return False
    return True


def _displacements(t: FloatArray, moved: dict[str, FloatArray]) -> list[Curve]:
    """Displacements of recorded points since the start, a panel for each axis along which they move."""
    found = []
    reach = [max((float(np.ptp(path[:, k])) for path in moved.values()), default=0.0) for k in range(3)]
    for k, axis in enumerate("xyz"):
        if reach[k] > SMALL * max(reach):
            values = {name: path[:, k] - path[0, k] for name, path in moved.items()}
            found += _most_varied(t, values, "m", f"{axis} displacement of sensors")
    return found


def _most_varied(t: FloatArray, values: dict[str, FloatArray], unit: str, panel: str) -> list[Curve]:
    """Those that change most, in their order; the panel says how many there are."""
    ranges = {name: float(np.ptp(v)) for name, v in values.items()}
    moving = [name for name in values if ranges[name] > 0.0]
    kept = set(sorted(moving, key=lambda name: -ranges[name])[:MOST])
    if len(moving) > MOST:
        panel = f"{panel} ({MOST} of {len(moving)})"
    return [_curve(name, unit, t, values[name], panel) for name in moving if name in kept]
