"""Derivatives of what friction on grounds and surfaces remembers of the way, from step to step.

With the memory z_n (anchors and limits) in which step n begins, the step and what it leaves behind are

    R(q, v, a; z_n, p) = 0,     z_{n+1} = g(q, v; z_n, p),

so that R_z dz_n joins what a parameter does to the residual, and

    dz_{n+1} = g_q s_q + g_v s_v + g_z dz_n + g_p.

Batches know all but the last of it in closed form; what a parameter itself does to the memory are
differences. What slips in the state at the end of the step slips in all of theirs, what sticks, sticks. So
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
from ..linalg.eight import lane_rows
from ..simd import LANES
from ..solvers.derivatives.abreast_room import abreast
from ..solvers.derivatives.friction import Friction, choose_here
from ..solvers.derivatives.friction_start import push_beside, push_start, remember_start
from ..solvers.derivatives.sensitivity import Way
from ..solvers.rare import knowing
from ..system.core import keep_memory, place_supports
from ..system.system import System
from .answers import derivative
from .family import Family
from .marked import Marked, friction_of_all, keys_of
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
        self.marked = Marked(system, self.names)
        self.batches = Batches(system.parts[name] for name in self.names)
        self._none = np.zeros(system.size)
        self._own = self.arrays_of(system)
        self._now = self.copy()
        self.none = {name: x if name.endswith(".far") else np.zeros_like(x) for name, x in self._now.items()}
        self.d: list[Row] = [self.zeros() for _ in families]
        self.known = False  # derivatives are given with the start

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
        for name, x in self.marked.views.items():
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
        push_start(core, self._with(self.d), q, v, lane_rows(self.system.size), made)
        return made

    def add_push(self, d: Row, state: tuple[FloatArray, FloatArray], r: FloatArray) -> None:
        """Add what derivatives d of the memory do to the residual of a state (q, v), before supports."""
        made = lane_rows(self.system.size)
        push_beside(self.system.core, self._with([d]), *state, made)
        r += made[:, 0]

    def step(self, q: FloatArray, v: FloatArray, s: FloatArray) -> None:
        """Remember an accepted step that ends in a state with these derivatives, (p, 2, size)."""
        kept, friction = self.copy(), self._with(self.d)
        remember_start(self.system.core, friction, q, v, abreast(s))
        found = self.marked.rows(friction.z, len(self.families))
        for family, d in zip(self.families, found, strict=True):
            if set(self.names) & family.changed:
                self._add_own(family, kept, q, v, d)
        self.d = found
        self.put(self._now)
        keep_memory(self.batches, q, v)
        self._now = self.copy()
        self.share()

    def _with(self, d: list[Row]) -> Friction:
        """What kernels ask for, with these derivatives of what is remembered now."""
        for name, x in self.marked.views.items():
            x[...] = self._own[name]
        groups = -(-len(d) // LANES)
        z = lane_rows(groups * len(self.marked.now)).reshape(groups, len(self.marked.now), LANES)
        self.marked.fill(z, d)
        return self._friction._replace(z=z)

    @cached_property
    def _friction(self) -> Friction:
        return friction_of_all(self.marked, [{} for _ in self.families])

    def _add_own(self, family: Family, kept: Row, q: FloatArray, v: FloatArray, d: Row) -> None:
        """Add what a parameter itself does to the memory that a step leaves, by differences."""
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
            for name, x in here.items():
                d[name] += weight * (arrays[name] - x)

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


def split(total: FloatArray, like: Row) -> Row:
    """Arrays like these, which lie one after the other."""
    ends = np.cumsum([x.size for x in like.values()])[:-1]
    return {name: x.reshape(like[name].shape) for name, x in zip(like, np.split(total, ends), strict=True)}


def slope(function: Function, far: float, size: float) -> FloatArray | float:
    """Derivative at 0, by differences over ``far`` of what changes by a size."""
    return derivative(function, 0.5 * far / size) if size > 0.0 else 0.0
