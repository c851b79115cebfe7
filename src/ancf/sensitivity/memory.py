"""Derivatives of what friction on grounds and surfaces remembers of the way, from step to step.

With the memory z_n (anchors and limits) in which step n begins, the step and what it leaves behind are

    R(q, v, a; z_n, p) = 0,     z_{n+1} = g(q, v; z_n, p),

so that R_z dz_n joins what a parameter does to the residual, and

    dz_{n+1} = g_q s_q + g_v s_v + g_z dz_n + g_p.

Both are pointwise: derivatives along directions are differences, lengths, velocities and limits by
themselves. What slips in the state at the end of the step slips in all of theirs, what sticks, sticks. So
does what is just at its limit: as long as nothing moves there, as in an equilibrium to which it has slipped,
both sides of the kink have the same derivative, but only along all changes together.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..batches import Batches
from ..compiled import traits
from ..errors import ModelError
from ..solvers.sensitivity import Way
from ..system.core import apply_supports, keep_memory, place_supports, residual
from ..system.system import System
from .answers import derivative
from .family import Family
from .remembering import Resting, Row, friction_of

#: Arrays of a memory that depend smoothly on the state.
LENGTHS, FORCES = ("anchor",), ("limit", "before")
#: Changes of places, m, of velocities, m/s, and of limits in their size, of the differences.
FAR, FAST, STRONG = 1e-6, 1e-6, 1e-5
#: Part of a limit by which a force is not beyond it, and a limit that nothing reaches, N/m.
JUST, HELD = 1e-7, 1e100

Function = Callable[[float], FloatArray]


class Memory:
    """What friction remembers in a run, with its derivatives by all parameters.

    Parameters
    ----------
    system : System
        On whose arrays sensitivities are computed; its memory is that in which the next step begins.
    families : list of Family

    Attributes
    ----------
    names : list of str
        Batches with such friction; none: there is nothing to follow.
    none : dict of str to ndarray
        What is remembered of no motion.
    """

    def __init__(self, system: System, families: list[Family]) -> None:
        self.system, self.families, self.names = system, families, friction_of(system)
        self.batches = Batches(system.parts[name] for name in self.names)
        self._none = np.zeros(system.size)
        self._own = self.arrays_of(system)
        self._now = self.copy()
        self.none = {name: x if name.endswith(".far") else np.zeros_like(x) for name, x in self._now.items()}
        self.d: list[Row] = [self.zeros() for _ in families]
        self.known = False  # derivatives are given with the start
        self.beside: Row = {}  # arrays of other batches that remember the same

    def __bool__(self) -> bool:
        return bool(self.names)

    def start(self, here: Row) -> None:
        """Remember what a run does at its start, ``here``."""
        for name, own in self._own.items():
            own[...] = here[name]
        self._now = self.copy()
        self.share()

    def choose(self, q: FloatArray, v: FloatArray) -> None:
        """Let points do what they do in the state at the end of a step, stick or slip, until :meth:`step`."""
        chosen = {name: x.copy() for name, x in self._now.items()}
        limits = [name for name in chosen if name.endswith(".limit")]
        self.put(self._now, {name: JUST * self._now[name] for name in limits}, 1.0)
        keep_memory(self.batches, q, v)
        for name in limits:
            anchor, limit = name.replace("limit", "anchor"), chosen[name]
            stays = np.all(self._own[anchor] == self._now[anchor], axis=-1)
            limit[~stays & (self._own[name] > 0.0)] *= -1.0  # what is left moves its anchor as well
            limit[stays & (limit > 0.0)] = HELD
        self.put(chosen)
        self.share()

    def begin(self, q: FloatArray, v: FloatArray, s: FloatArray) -> None:
        """Take the derivatives of that from those of the state at the start, (p, 2, size).

        Those of a start that knows them stay.
        """
        if self.known:
            return
        here = self._now
        self.start(self.none)
        self.step(q, v, s)
        self.start(here)

    def take(self, start: Any, where: str) -> None:
        """Take the derivatives from a state in which a run starts, if there is one.

        Raises
        ------
        ModelError
            The state does not know them.
        """
        if not self.names or start is None:
            return
        for k, family in enumerate(self.families):
            own = start.derivatives[family.name]
            if own is not None and own.memory is None:
                what = "the derivatives of what friction remembers in the state that is given are not known"
                hint = "start from an equilibrium, the last state of a result in memory or the initial shape"
                raise ModelError(where, what, hint)
            self.d[k] = self.zeros() if own is None else own.memory
        self.known = True

    def hand_to(self, sensitivities: list[Any]) -> None:
        """Let sensitivities, one for each family, know those of the last state."""
        for own, d in zip(sensitivities, self.d, strict=True):
            own.memory = d

    def rest(self, sensitivities: list[Any]) -> None:
        """Let those of an equilibrium know the whole."""
        held = {
            name: np.where(x > 0.0, HELD, x) if name.endswith(".limit") else x
            for name, x in self._now.items()
        }
        for own, d in zip(sensitivities, self.d, strict=True):
            anchors = {name: x for name, x in d.items() if name.split(".")[1] in LENGTHS}
            own.resting = Resting(held, anchors)

    def share(self) -> None:
        """Let the systems of all families, and what else there is, remember the same."""
        for name, x in self.beside.items():
            x[...] = self._own[name]
        for family in self.families:
            for own in family.systems:
                for name, x in self.arrays_of(own).items():
                    x[...] = self._own[name]

    def put_back(self) -> None:
        """Let the system remember what the next step begins with."""
        self.put(self._now)

    def push(self, way: Way, tables: Any) -> FloatArray:
        """What derivatives of the memory do to the residual of a state, (p, size), zero where it is held."""
        made = np.zeros((len(self.families), self.system.size))
        core = self.system.core
        q, v, a = (x[0].copy() for x in way)
        place_supports(core.supports, core.loads.value, tables, 0, q, v, a)
        for row, d in zip(made, self.d, strict=True):
            self.add_push(d, (q, v, a), row)
            apply_supports(core.supports, row)
            row[core.supports.held], row[self.system.n :] = 0.0, 0.0
        return made

    def add_push(self, d: Row, state: tuple[FloatArray, FloatArray, FloatArray], r: FloatArray) -> None:
        """Add what derivatives d of the memory do to the residual of a state (q, v, a), before supports."""
        given = self.system.core.ws, *state, self._none
        kept = self.copy()
        for keys, far in ((LENGTHS, FAR), (FORCES, STRONG * self._limit())):
            part = {name: x for name, x in d.items() if name.split(".")[1] in keys}

            def force(x: float, part: Row = part) -> FloatArray:
                self.put(kept, part, x)
                found: FloatArray = np.empty(self.system.size)
                residual(self.batches, *given, found)
                return found

            r += slope(force, far, _size(part))
        self.put(kept)

    def step(self, q: FloatArray, v: FloatArray, s: FloatArray) -> None:
        """Remember an accepted step that ends in a state with these derivatives, (p, 2, size)."""
        kept = self.copy()
        found = [self._along(kept, d, q, v, own) for d, own in zip(self.d, s, strict=True)]
        for family, d in zip(self.families, found, strict=True):
            if set(self.names) & family.changed:
                self._add_own(family, kept, q, v, d)
        self.d = found
        self.put(self._now)
        keep_memory(self.batches, q, v)
        self._now = self.copy()
        self.share()

    def _along(self, kept: Row, d: Row, q: FloatArray, v: FloatArray, s: FloatArray) -> Row:
        """Derivative of what a step leaves along a state and a memory."""
        lengths, forces = (
            {name: d[name] for name in d if name.split(".")[1] in own} for own in (LENGTHS, FORCES)
        )
        weights = self.system.weights()
        size = float(np.max(np.abs(s[0]) * weights, initial=0.0))
        moves: tuple[tuple[Any, Any, Row, float, float], ...] = (
            (s[0], self._none, lengths, FAR, max(size, _size(lengths))),
            (self._none, s[1], {}, FAST, float(np.max(np.abs(s[1]) * weights, initial=0.0))),
            (self._none, self._none, forces, STRONG * self._limit(), _size(forces)),
        )
        total = np.zeros(sum(x.size for x in d.values()))
        for dq, dv, part, far, most in moves:

            def left(x: float, dq: FloatArray = dq, dv: FloatArray = dv, part: Row = part) -> FloatArray:
                self.put(kept, part, x)
                keep_memory(self.batches, q + x * dq, v + x * dv)
                return np.concatenate([self._own[name].ravel() for name in d])

            total += slope(left, far, most)
        return split(total, d)

    def _add_own(self, family: Family, kept: Row, q: FloatArray, v: FloatArray, d: Row) -> None:
        """Add what a parameter itself does to the memory that a step leaves."""
        self.put(kept)
        keep_memory(self.batches, q, v)
        here = {name: self._own[name].copy() for name in d}
        for own, weight in family.around():
            if own is self.system:
                continue
            arrays = self.arrays_of(own)
            for name, x in arrays.items():
                x[...] = kept[name]
            keep_memory(Batches(own.parts[name] for name in self.names), q, v)
            for name, x in d.items():
                x += weight * (arrays[name] - here[name])

    def arrays_of(self, system: System) -> Row:
        """All that these batches remember, by "part.array"."""
        return {
            f"{name}.{key}": getattr(system.parts[name], key)
            for name in self.names
            for key in traits(system.parts[name]).memory
            if getattr(system.parts[name], key).size
        }

    def zeros(self) -> Row:
        """No derivative."""
        return {
            name: np.zeros_like(x)
            for name, x in self._own.items()
            if name.split(".")[1] in (*LENGTHS, *FORCES)
        }

    def copy(self) -> Row:
        """What the system remembers."""
        return {name: x.copy() for name, x in self._own.items()}

    def put(self, kept: Row, d: Row | None = None, x: float = 0.0) -> None:
        """Let the system remember ``kept`` + x d, where limits are negative by their size."""
        for name, own in self._own.items():
            own[...] = kept[name]
            if d and name in d:
                own += np.where(kept[name] < 0.0, -x, x) * d[name] if name.endswith(".limit") else x * d[name]

    def _limit(self) -> float:
        """The size of limits."""
        most = (
            np.max(np.abs(x), initial=0.0) for name, x in self._now.items() if name.split(".")[1] in FORCES
        )
        return float(max(most, default=0.0)) or 1.0


def _size(d: Row) -> float:
    return max((float(np.max(np.abs(x), initial=0.0)) for x in d.values()), default=0.0)


def split(total: FloatArray, like: Row) -> Row:
    """Arrays like these, which lie one after the other."""
    ends = np.cumsum([x.size for x in like.values()])[:-1]
    return {name: x.reshape(like[name].shape) for name, x in zip(like, np.split(total, ends), strict=True)}


def slope(function: Function, far: float, size: float) -> FloatArray | float:
    """Derivative at 0, by differences over ``far`` of what changes by a size."""
    return derivative(function, 0.5 * far / size) if size > 0.0 else 0.0
