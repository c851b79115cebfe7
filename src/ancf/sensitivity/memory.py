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
from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..batches import Batches
from ..compiled import choose_memory, traits
from ..errors import ModelError
from ..solvers.friction import choose_here
from ..solvers.kinks import FORCE, LENGTH, LIMIT, Remembering, add_forces_along, leave_along
from ..solvers.rare import knowing
from ..solvers.sensitivity import Way
from ..system.core import apply_supports, keep_memory, place_supports
from ..system.system import System
from .answers import derivative
from .family import Family
from .marked import keys_of
from .remembering import Resting, Row, friction_of

#: Arrays of a memory that depend smoothly on the state.
LENGTHS, FORCES = ("anchor",), ("limit", "before")
#: A limit that nothing reaches, N/m.
HELD = 1e100

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
        self._lay_out()
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
        self.put(self._now)
        remembering, first, names = self._choosing
        out = np.zeros(first[-1])
        choose_here(remembering, first, q, v, out)
        chosen = split(out, {name: self._now[name] for name in names})
        self.put(self._now | {name: x for name, x in chosen.items() if name.endswith(".limit")})
        self.share()

    @cached_property
    def _choosing(self) -> tuple[Batches, IntArray, list[str]]:
        """The batches as they are asked what points do, and where what they answer lies."""
        parts = [self.system.parts[name] for name in self.names]
        names = [
            f"{name}.{key}" for name, part in zip(self.names, parts, strict=True) for key in keys_of(part)
        ]
        sizes = [sum(getattr(part, key).size for key in keys_of(part)) for part in parts]
        return knowing(choose_memory, parts), np.cumsum([0, *sizes]), names

    def begin(self, q: FloatArray, v: FloatArray, s: FloatArray) -> None:
        """Take the derivatives of that from those of the state at the start, (p, 3, size).

        Those of a start that knows them stay.
        """
        if self.known:
            return
        here = self._now
        self.start(self.none)
        self.step(q, v, s[:, :2])
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
        for x, own in self._shared:
            x[...] = own

    @cached_property
    def _shared(self) -> list[tuple[FloatArray, FloatArray]]:
        """Arrays of the systems of all families, and those of the same in the model itself."""
        systems = [own for family in self.families for own in family.systems]
        return [(x, self._own[name]) for own in systems for name, x in self.arrays_of(own).items()]

    def put_back(self) -> None:
        """Let the system remember what the next step begins with."""
        self.put(self._now)

    def push(self, way: Way, tables: Any) -> FloatArray:
        """What derivatives of the memory do to the residual of a state, (p, size), zero where it is held."""
        made = np.zeros((len(self.families), self.system.size))
        core = self.system.core
        q, v, a = (x[0].copy() for x in way)
        place_supports(core.supports, core.loads.value, tables, 0, q, v, a)
        add_forces_along(self._remembering(self._own), core.ws, self._rows(self.d), q, v, a, made)
        for row in made:
            apply_supports(core.supports, row)
            row[core.supports.held], row[self.system.n :] = 0.0, 0.0
        return made

    def add_push(self, d: Row, state: tuple[FloatArray, FloatArray, FloatArray], r: FloatArray) -> None:
        """Add what derivatives d of the memory do to the residual of a state (q, v, a), before supports."""
        memory, ws = self._remembering(self._own), self.system.core.ws
        add_forces_along(memory, ws, self._rows([d]), *state, r[None])

    def step(self, q: FloatArray, v: FloatArray, s: FloatArray) -> None:
        """Remember an accepted step that ends in a state with these derivatives, (p, 2, size)."""
        kept, rows = self.copy(), self._rows(self.d)
        left, weight = np.zeros_like(rows), self.system.weights()
        leave_along(self._remembering(kept), rows, q, v, np.ascontiguousarray(s), weight, left)
        shapes = {name: (own, self._own[name].shape) for name, own in self._smooth.items()}
        found = [{name: row[own].reshape(x) for name, (own, x) in shapes.items()} for row in left]
        for family, d in zip(self.families, found, strict=True):
            if set(self.names) & family.changed:
                self._add_own(family, kept, q, v, d)
        self.d = found
        self.put(self._now)
        keep_memory(self.batches, q, v)
        self._now = self.copy()
        self.share()

    def _rows(self, d: list[Row]) -> FloatArray:
        """Derivatives of memories, (p, n), zero where they have none."""
        made = np.zeros((len(d), len(self._differences.smooth)))
        for rows, row in zip(made, d, strict=True):
            for name, own in self._smooth.items():
                if name in row:
                    rows[own] = row[name].ravel()
        return made

    def _remembering(self, kept: Row) -> Remembering:
        """What differences begin with, that is kept."""
        self._start[0][:] = np.concatenate([kept[name].ravel() for name in self._floats])
        if len(self._start[1]):
            counts = [x.ravel() for name, x in kept.items() if name not in self._floats]
            self._start[1][:] = np.concatenate(counts)
        return self._differences._replace(limit=self._limit())

    def _lay_out(self) -> None:
        """Make batches whose memory are parts of one array of numbers and one of counts."""
        floats = {name: x for name, x in self._own.items() if x.dtype == np.float64}
        ends = np.cumsum([0, *(x.size for x in floats.values())]).tolist()
        self._floats = {name: slice(*ends[k : k + 2]) for k, name in enumerate(floats)}
        self._numbers = np.zeros(ends[-1])
        counts = {name: x for name, x in self._own.items() if name not in floats}
        last = np.cumsum([0, *(x.size for x in counts.values())]).tolist()
        self._counts = np.zeros(last[-1], dtype=np.int64)
        views = {name: self._numbers[rows].reshape(floats[name].shape) for name, rows in self._floats.items()}
        for k, (name, x) in enumerate(counts.items()):
            views[name] = self._counts[last[k] : last[k + 1]].reshape(x.shape)
        made = []
        for name in self.names:
            own = {key.split(".")[1]: x for key, x in views.items() if key.split(".")[0] == name}
            made.append(self.system.parts[name]._replace(**own))
        names = [name for name in floats if name.split(".")[1] in (*LENGTHS, *FORCES)]
        rows = [np.arange(self._floats[name].start, self._floats[name].stop) for name in names]
        kinds = [np.full(len(own), kind_of(name)) for own, name in zip(rows, names, strict=True)]
        ends = np.cumsum([0, *map(len, rows)]).tolist()
        self._smooth = {name: slice(*ends[k : k + 2]) for k, name in enumerate(names)}
        none = np.zeros(0, dtype=np.int64)
        smooth, size = np.concatenate([none, *rows]), self.system.size
        self._start = np.zeros_like(self._numbers), np.zeros_like(self._counts)
        begins = self._numbers, self._counts, *self._start, smooth, np.concatenate([none, *kinds])
        room = np.zeros_like(self._numbers), np.zeros((6, size)), np.zeros((6, len(smooth)))
        self._differences = Remembering(Batches(made), *begins, *room, np.zeros((2, size)), 1.0)

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

    def put(self, kept: Row) -> None:
        """Let the system remember this."""
        for name, own in self._own.items():
            own[...] = kept[name]

    def _limit(self) -> float:
        """The size of limits."""
        most = (
            np.max(np.abs(x), initial=0.0) for name, x in self._now.items() if name.split(".")[1] in FORCES
        )
        return float(max(most, default=0.0)) or 1.0


def _size(d: Row) -> float:
    return max((float(np.max(np.abs(x), initial=0.0)) for x in d.values()), default=0.0)


def kind_of(name: str) -> int:
    """Of the numbers of an array of a memory."""
    return LENGTH if name.split(".")[1] in LENGTHS else LIMIT if name.endswith(".limit") else FORCE


def split(total: FloatArray, like: Row) -> Row:
    """Arrays like these, which lie one after the other."""
    ends = np.cumsum([x.size for x in like.values()])[:-1]
    return {name: x.reshape(like[name].shape) for name, x in zip(like, np.split(total, ends), strict=True)}


def slope(function: Function, far: float, size: float) -> FloatArray | float:
    """Derivative at 0, by differences over ``far`` of what changes by a size."""
    return derivative(function, 0.5 * far / size) if size > 0.0 else 0.0
