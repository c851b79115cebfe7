"""A model at values of a parameter around its own: what the residual of a fixed state changes by.

All that a parameter does is in the arrays of a compiled model.  The residual of a *fixed* state is a smooth
function of them, linear or rational in most parameters, and has no dynamics in it: differences of order six
give its derivative to round-off, for every kind of parameter and every kind of load or connection alike.
Where it is found to be linear, two values are enough.
"""

from __future__ import annotations

import warnings
from typing import Any, NamedTuple

import numpy as np

from ..arrays import FloatArray
from ..batches import Batches
from ..errors import ModelError
from ..solvers.checkpoint import distinct
from ..solvers.stages import place_rows, stage_residuals
from ..system.core import Core, apply_load, apply_supports, place_supports, residual
from ..system.system import System
from .parameters import Parameter

#: Step of the differences, relative, and of a parameter that is zero, in its unit.
STEP = 1e-3
#: Places of the values in steps, and weights of the derivative of order six: on both sides, on one.
BOTH = ((-3.0, -2.0, -1.0, 1.0, 2.0, 3.0), (-1 / 60, 9 / 60, -45 / 60, 45 / 60, -9 / 60, 1 / 60))
ABOVE = (
    (0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0),
    (-147 / 60, 360 / 60, -450 / 60, 400 / 60, -225 / 60, 72 / 60, -10 / 60),
)
#: Difference of the derivatives from two and from all values, relative, up to which a parameter is linear,
#: and the size of the changes of the state in which that is tried.
LINEAR, SHAKEN = 1e-11, 0.01
#: What runs and searches change in a batch: it does not depend on a parameter.
OWN = ("value", "level", "found", "alpha", "scale", "inside", "measured", "mode", "open")


class Push(NamedTuple):
    """What a parameter does to states at fixed free unknowns, per unit of it."""

    push: FloatArray  # (n, size) to the residual, as the solve wants it, zero at held unknowns
    gap: FloatArray  # (n, size) to C of joints, in the rows of the multipliers
    held: FloatArray  # (3, n, size) to held unknowns and shadows of q, v and a


class Family:
    """The systems of a model at values of a parameter around its own.

    Parameters
    ----------
    parameter : Parameter
    base : System
        Of the model itself.

    Raises
    ------
    ModelError
        The parameter changes which unknowns there are, or the model cannot be built around its value.
    """

    def __init__(self, parameter: Parameter, base: System) -> None:
        self.parameter, self.base = parameter, base
        p = parameter.value
        h = STEP * abs(p) if p != 0.0 else STEP
        try:
            self.systems = self._compiled(h, BOTH[0])
            chosen: tuple[tuple[float, ...], tuple[float, ...]] = BOTH
        except ModelError:
            if p != 0.0:
                raise
            self.systems = self._compiled(h, ABOVE[0])  # it may not be negative
            chosen = ABOVE
        self.offsets, self.weights = [h * x for x in chosen[0]], [w / h for w in chosen[1]]
        self._shape = [s.initial_shape() - base.initial_shape() for s in self.systems]
        changed = set().union(*(self._changed(s) for s in self.systems))
        self._few = [Batches(b for name, b in s.parts.items() if name in changed) for s in self.systems]
        self._every = [*zip(range(len(self.systems)), self.weights, strict=True)]
        self._used = self._ends() or self._every

    @property
    def name(self) -> str:
        """Of the parameter."""
        return self.parameter.name

    def _ends(self) -> list[tuple[int, float]]:
        """The first and the last value with their weights, if the residual is linear in the parameter."""
        base, rng = self.base, np.random.default_rng(1)
        n, there = base.n, base.numbering.used()
        q = base.initial_shape()
        v = np.zeros_like(q)
        states = np.stack([q, v, np.zeros_like(q)])[:, None]
        states[:, 0, :n] += SHAKEN * base.model.size * rng.uniform(-1, 1, (3, n)) * there
        before, when = base.level.copy(), (-1e-3, 1e-3, 0.0, np.inf)
        found: list[FloatArray] = []
        last = len(self.systems) - 1
        width = self.offsets[last] - self.offsets[0]
        ends = [(0, -1.0 / width), (last, 1.0 / width)]
        for used in (ends, self._every):
            self._used = used
            base.level[:] = 1.0, 0.0, 0.0
            self.know(base)
            q, v, a = (x.copy() for x in states)
            made = self.at_steps(q, v, a, when, gaps=False)
            if np.any(made.held):
                base.level[:] = before
                return []
            found.append(made.push)
        base.level[:] = before
        two, all_of_it = found
        size = float(np.max(np.abs(all_of_it)))
        if not size > 0.0 or float(np.max(np.abs(two - all_of_it))) > LINEAR * size:
            return []
        return ends

    def _compiled(self, h: float, places: tuple[float, ...]) -> list[System]:
        made = []
        for x in places:
            value = self.parameter.value + h * x
            system = System(self.parameter.at(value))
            if not _alike(self.base, system):
                what = f"with {value:.8g} the model has other unknowns than with {self.parameter.value:.8g}"
                raise ModelError(self.name, what, "the number of elements, nodes and joints has to stay")
            made.append(system)
        return made

    def _changed(self, system: System) -> set[str]:
        """Names of the batches on which the parameter acts."""
        base, found = self.base, set()
        same = all(a is b for a, b in zip(base.inputs.loads, system.inputs.loads, strict=True))
        for name, batch in system.parts.items():
            mine, other = distinct({"b": base.parts[name]}), distinct({"b": batch})
            own = [key for key in mine if key.rsplit(".", 1)[-1] not in OWN]
            differ = any(not np.array_equal(mine[key], other[key], equal_nan=True) for key in own)
            if differ or (batch in system.core.external and not same):
                found.add(name)
        return found

    def know(self, system: System) -> None:
        """Let all systems be as one that runs: its joints, and the weights of their rows."""
        for own in self.systems:
            own.level[:] = system.level
            for name, batch in own.parts.items():
                for key in ("mode", "open"):
                    if hasattr(batch, key):
                        getattr(batch, key)[...] = getattr(system.parts[name], key)
        if len(system.measured):
            for own in self.systems:
                own.measured[...] = system.measured

    def at_steps(
        self, q: FloatArray, v: FloatArray, a: FloatArray, when: tuple[float, float, float, float], gaps: bool
    ) -> Push:
        """What the parameter does to states (n, size) at the ends of steps.

        ``when``: start, step, first and last time, as ``Inputs.tables`` takes them.
        """
        start, step, first, last = when
        made = Push(np.zeros_like(q), np.zeros_like(q), np.zeros((3, *q.shape)))
        for k, weight in self._used:
            system = self.systems[k]
            tables = system.inputs.tables(start, step, len(q), first, last)
            states = self._moved(k, q), v.copy(), a.copy()
            place_rows(system.core, tables, *states)
            moved = any(not np.array_equal(x, y) for x, y in zip(states, (q, v, a), strict=True))
            core = system.core if moved else system.core._replace(batches=self._few[k])
            r = np.empty_like(q)
            stage_residuals(core, tables, *states, np.empty(system.size), r)
            made.push[...] += weight * r
            for x, y, here in zip(made.held, states, (q, v, a), strict=True):
                x += weight * (y - here)
            if gaps:
                made.gap[...] += weight * _gaps(system, tables, states)
        self._finish(made)
        return made

    def at_rest(self, core: Core, q: FloatArray, when: tuple[float, float]) -> Push:
        """The same of one state (size,) without motion at a time, of ``core`` what is held.

        ``when``: time and a step with which rates of given motions are found.
        """
        time, h = when
        made = Push(np.zeros((1, q.size)), np.zeros((1, q.size)), np.zeros((3, 1, q.size)))
        for k, weight in self._every:
            system = self.systems[k]
            tables = system.inputs.tables(time - h, h, 1, time, np.inf)
            x, zero, force, r = (
                self._moved(k, q[None])[0],
                np.zeros_like(q),
                np.empty_like(q),
                np.empty_like(q),
            )
            place_supports(system.core.supports, system.core.loads.value, tables, 0, x, zero, zero.copy())
            apply_load(system.core.loads, tables.value[0], force)
            still = np.zeros_like(q)
            residual(system.core.batches, system.core.ws, x, still, still, force, r)
            apply_supports(system.core.supports, r)
            r[core.supports.held] = 0.0
            made.push[0] += weight * r
            made.held[0, 0] += weight * (x - q)
        self._finish(made)
        made.held[1:] = 0.0
        return made

    def of_states(self, time: float) -> tuple[FloatArray, FloatArray]:
        """Derivatives of the initial shape and motion, (size,) each."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what holds against a given motion was said of the model itself
            here = self.base.initial_state(time)
            both = [system.initial_state(time) for system in self.systems]
        q, v = np.zeros(self.base.size), np.zeros(self.base.size)
        for weight, state in zip(self.weights, both, strict=True):
            q += weight * (state[0] - here[0])  # what does not change leaves no round-off
            v += weight * (state[1] - here[1])
        return q, v

    def of_motion(self, q: FloatArray, dq: FloatArray, time: float) -> FloatArray:
        """Derivative of the velocities of ``set_motion`` at a shape that changes by dq, (size,)."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            each = zip(self.systems, self.offsets, self.weights, strict=True)
            rates = [weight * own.motion(q + offset * dq, time) for own, offset, weight in each]
        found: FloatArray = np.sum(rates, axis=0)
        return found

    def _moved(self, k: int, q: FloatArray) -> FloatArray:
        """States (n, size) with what supports hold without moving it where it is in system k."""
        held = self.base.core.supports.held
        moved = q.copy()
        moved[:, held] += self._shape[k][held]
        return moved

    def _finish(self, made: Push) -> None:
        n = self.base.n
        made.push[:, n:] = made.gap[:, n:] = 0.0
        free = np.ones(made.push.shape[1], dtype=bool)
        free[self.base.core.supports.held], free[n:] = False, False
        made.held[..., free] = 0.0


def _gaps(system: System, tables: Any, states: Any) -> FloatArray:
    """C in the rows of the multipliers of states."""
    level = system.level.copy()
    system.level[:] = 1.0, 0.0, 0.0
    core = system.core._replace(batches=system.core.joints.batches)
    r = np.empty_like(states[0])
    q, v, a = (x.copy() for x in states)
    stage_residuals(core, tables, q, v, a, np.empty(system.size), r)
    system.level[:] = level
    rows: FloatArray = r * system.core.joints.mask
    return rows


def _alike(a: System, b: System) -> bool:
    """Whether two systems have the same unknowns in the same order."""
    same = a.size == b.size and a.n == b.n and a.slots.keys() == b.slots.keys()
    same = same and all(np.array_equal(a.slots[key], b.slots[key]) for key in a.slots)
    same = same and a.parts.keys() == b.parts.keys()
    same = same and np.array_equal(a.core.supports.held, b.core.supports.held)
    return same and all(
        x.shape == y.shape
        for key in a.parts
        for x, y in zip(
            distinct({"b": a.parts[key]}).values(), distinct({"b": b.parts[key]}).values(), strict=False
        )
    )
