"""How systems around the value of a parameter differ from that of the model."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar
from weakref import WeakKeyDictionary, ref

import numpy as np

from ..arrays import FloatArray
from ..batches import Batches
from ..compiled import Role, traits
from ..model.bodies.rigid import PointMass
from ..model.joints.basic import Slide
from ..system.core import Tables
from ..system.initial_motion import at_rest
from ..system.system import System

#: Component of a slope, in the size of this, up to which it is zero.
NONE = 1e-9
#: Times at which motions of supports are compared, s.
TIMES = 0.0, 0.137, 1.713
#: What runs and searches change in a batch: it does not depend on a parameter.
OWN = (
    "value",
    "level",
    "found",
    "alpha",
    "scale",
    "inside",
    "measured",
    "mode",
    "open",
    "kept",
    "felt",
    "asked",
    "said",
    "angle",
    "numbers",
)
#: How far the mean of two values may be from that between them, relative to their difference, up to which a
#: parameter is linear; round-off of the residuals.
LINEAR, ROUND_OFF = 1e-10, 1e-14


class Known:
    """What all parameters of a model ask of its system, computed once.

    Parameters
    ----------
    system : System
    """

    _all: ClassVar[WeakKeyDictionary[System, Known]] = WeakKeyDictionary()

    def __init__(self, system: System) -> None:
        self.tables = _tables(system)
        self.size = float(system.model.size)
        bodies, turned = system.model.bodies.values(), system.inputs.rotations
        self.rests = not turned and all(map(at_rest, bodies))
        self.glides = not (turned or system.constraints.rotations) and all(map(_glides, bodies))
        self._system = ref(system)
        self._states: dict[float, tuple[FloatArray, FloatArray]] = {}
        self._shape: FloatArray | None = None
        self._axes: FloatArray | None = None

    def initial_state(self, time: float) -> tuple[FloatArray, FloatArray]:
        """See :meth:`ancf.system.system.System.initial_state`; arrays that all share."""
        if time not in self._states:
            self._states[time] = self._there.initial_state(time)
        return self._states[time]

    def initial_shape(self) -> FloatArray:
        """See :meth:`ancf.system.system.System.initial_shape`."""
        if self._shape is None:
            self._shape = self._there.initial_shape()
        return self._shape

    def moving_axes(self) -> FloatArray:
        """1 for local axes of supports, (k, 1, 3); 0 where they hold components along them that are zero."""
        if self._axes is None:
            supports, held = self._there.supports, np.zeros(self._there.size, dtype=bool)
            held[supports.held] = True
            slots = supports.rot_slot[:, None] + np.arange(3)
            y = np.abs(self.initial_shape()[slots])
            idle = held[slots] & (y <= NONE * np.max(y, axis=1, keepdims=True))
            self._axes = np.where(idle, 0.0, 1.0)[:, None, :]
        return self._axes

    @property
    def _there(self) -> System:
        system = self._system()
        assert system is not None
        return system

    @classmethod
    def of(cls, system: System) -> Known:
        """Of a system, which may have been asked before; inputs of the model must not change meanwhile."""
        if system not in cls._all:
            cls._all[system] = cls(system)
        return cls._all[system]


def _tables(system: System) -> list[Tables]:
    return [system.inputs.tables(time, 1e-3, 1, time, np.inf) for time in TIMES]


def differ(mine: Any, other: Any, key: str = "") -> bool:
    """Whether arrays of two batches, or of fields of them, that may depend on a parameter are others."""
    if mine is other or key in OWN:
        return False
    if isinstance(mine, np.ndarray):
        return not np.array_equal(mine, other, equal_nan=True)
    return any(differ(a, b, name) for name, a, b in _pairs(mine, other))


def _pairs(mine: Any, other: Any) -> list[tuple[str, Any, Any]]:
    """What two collections of the same kind have in common, by the names of fields."""
    if isinstance(mine, Mapping):
        return [(name, mine[name], other[name]) for name in mine]
    if not isinstance(mine, tuple | list):
        return []
    names = [""] * len(mine) if isinstance(mine, Batches) else getattr(mine, "_fields", [""] * len(mine))
    return list(zip(names, mine, other, strict=True))


def changed(base: System, system: System) -> set[str]:
    """Names of the batches that differ."""
    found: set[str] = set()
    if system is base:
        return found
    same = _same_functions(base, system)
    for name, batch in system.parts.items():
        mine = base.parts[name]
        if batch is mine:
            continue
        if differ(mine, batch) or (Role.EXTERNAL in traits(batch).role and not same):
            found.add(name)
    return found


def _same_functions(a: System, b: System) -> bool:
    return all(x is y for x, y in zip(a.inputs.loads, b.inputs.loads, strict=True))


def on_a_line(middle: FloatArray, low: FloatArray, high: FloatArray) -> bool:
    """Whether a vector at the middle of two values is their mean."""
    width = LINEAR * float(np.max(np.abs(high - low), initial=0.0))
    width += ROUND_OFF * float(np.max(np.abs(middle), initial=0.0))
    return float(np.max(np.abs(0.5 * (high + low) - middle), initial=0.0)) <= width


def same_inputs(base: System, system: System) -> tuple[bool, bool]:
    """Whether supports move alike, and loads have the same inputs, as they do at some odd times."""
    motions = values = True
    if system.inputs is base.inputs or (_unmoved(base, system) and _same_functions(base, system)):
        return True, True
    for mine, other in zip(Known.of(base).tables, _tables(system), strict=True):
        motions = motions and np.array_equal(mine.motion, other.motion)
        motions = motions and np.array_equal(mine.rotation, other.rotation)
        values = values and np.array_equal(mine.value, other.value)
    return motions, values


def _unmoved(a: System, b: System) -> bool:
    """Whether no support of two systems moves."""
    return not any(one.motions or one.rotations for one in (a.inputs, b.inputs))


def same_patterns(a: System, b: System) -> bool:
    """Whether dead loads are the same but for weights, and what they are fed with."""
    names = ("slot", "factor", "grows")
    return a.dead is b.dead or all(np.array_equal(getattr(a.dead, x), getattr(b.dead, x)) for x in names)


def same_loads(a: System, b: System) -> bool:
    """Whether dead loads are the same numbers and functions."""
    names = ("still", "hung", "slot", "factor")
    same = a.dead is b.dead or all(np.array_equal(getattr(a.dead, x), getattr(b.dead, x)) for x in names)
    return same and _same_functions(a, b)


def _begins_as(body: Any, other: Any) -> bool:
    """Whether bodies begin alike: the same ones, or masses at the same place."""
    if body is other or not (isinstance(body, PointMass) and isinstance(other, PointMass)):
        return body is other
    return np.array_equal(body.position, other.position) and np.array_equal(body.velocity, other.velocity)


def begins_alike(a: System, b: System) -> bool:
    """Whether all on which the initial shape and motion depend is the same."""
    mine, other = a.model, b.model
    same = a.inputs is b.inputs or (_unmoved(a, b) and mine.inputs is other.inputs)
    same = same and all(_begins_as(body, other.bodies[name]) for name, body in mine.bodies.items())
    same = same and all(x is y for x, y in zip(mine.supports, other.supports, strict=True))
    pairs = zip(mine.connections, other.connections, strict=True)
    return same and all(x is y for x, y in pairs if isinstance(x, Slide))


def stays_at_rest(base: System, system: System) -> bool:
    """Whether no body of either has an initial velocity, and no local axes turn."""
    own = base.model.bodies
    changed = (body for name, body in system.model.bodies.items() if body is not own[name])
    return Known.of(base).rests and all(map(at_rest, changed))


def _glides(body: Any) -> bool:
    """Whether the initial velocity is the same whatever the shape."""
    return isinstance(body, PointMass) or at_rest(body)


def moves_alike(base: System, system: System) -> bool:
    """Whether both begin with the same velocities, or at rest, whatever their shapes are."""
    return stays_at_rest(base, system) or (Known.of(base).glides and begins_alike(base, system))


def alike(a: System, b: System) -> bool:
    """Whether two systems have the same unknowns in the same order."""
    same = a.size == b.size and a.n == b.n and a.parts.keys() == b.parts.keys()
    if same and a.slots is not b.slots:
        same = a.slots.keys() == b.slots.keys()
        same = same and all(np.array_equal(a.slots[key], b.slots[key]) for key in a.slots)
    same = same and (a.held is b.held or np.array_equal(a.held, b.held))
    return same and all(batch is b.parts[key] or fit(batch, b.parts[key]) for key, batch in a.parts.items())


def fit(mine: Any, other: Any) -> bool:
    """Whether the arrays of two batches have the same shapes."""
    if mine is other:
        return True
    if isinstance(mine, np.ndarray):
        return bool(mine.shape == other.shape)
    if isinstance(mine, tuple | list) and len(mine) != len(other):
        return False
    return all(fit(x, y) for _, x, y in _pairs(mine, other))
