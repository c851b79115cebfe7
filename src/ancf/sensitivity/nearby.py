"""What all parameters of a run do to its states, block of steps by block of steps."""

from __future__ import annotations

from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..batches import Batches
from ..compiled import Role, add_changes, traits
from ..simd import LANES
from ..solvers.derivatives.friction import no_friction
from ..solvers.derivatives.pushes import Changes, Uses, add_loads, add_pushes
from ..solvers.derivatives.sensitivity import Way
from ..solvers.rare import knowing
from ..system.core import apply_load
from ..system.system import System
from .alike import same_patterns
from .family import Family
from .rates import rates_of


class Pushes(NamedTuple):
    """What the parameters do to states at fixed free unknowns, per unit of each; see ``Push``."""

    push: FloatArray  # (p, n, size)
    gap: FloatArray  # (p, n, size), or the push again where it was not asked for
    held: dict[int, FloatArray]  # (3, n, size) of the parameters that move what is held


class Nearby:
    """The families of all parameters of a run.

    Those that change no load that depends on the state and no motion of a support are differentiated in
    compiled code, each batch once for all of them.

    Parameters
    ----------
    families : list of Family
    system : System
        On whose arrays the sensitivities are computed.
    shifts : bool
        Places of supports that shift, and local axes that turn, are part of the sensitivities themselves,
        and not of the pushes.

    Attributes
    ----------
    plain, others : list of int
        Which families are differentiated so, and which by themselves.
    rows : list of int
        The plain ones on which rows of joints depend.
    """

    def __init__(self, families: list[Family], system: System, shifts: bool = False) -> None:
        self.families, self.system = families, system
        self.shifts = {k: family.shift for k, family in enumerate(families) if shifts and family.shift.size}
        self.turns = {k: family.turn for k, family in enumerate(families) if shifts and family.turn.size}
        own = self.shifts.keys() | self.turns.keys()
        self.rows = [k for k, family in enumerate(families) if family.joined and k not in own]
        self.plain = [k for k, family in enumerate(families) if family.plain or family.joined or k in own]
        self.others = [k for k in range(len(families)) if k not in self.plain]
        self.friction = no_friction()  # that remembers the way, see MemoryAbreast
        self.marked: dict[str, Any] = {}  # batches that know what it does in a step
        self._work, self._kept = np.zeros(system.size), [np.zeros(0), np.zeros(0)]
        self._weights: dict[int, Any] = {}  # derivatives of steady loads
        self._first: tuple[FloatArray, BoolArray] | None = None  # the same of all plain ones

    @cached_property
    def rates(self) -> dict[int, dict[str, FloatArray]]:
        """Changes of numbers by plain parameter and batch, where these are all and known."""
        return {k: rates_of(self.families[k], forces=True) for k in self.plain}

    @cached_property
    def _plainly(self) -> tuple[Uses, Changes, FloatArray]:
        """What the plain ones ask for, see :func:`ancf.solvers.derivatives.pushes.add_pushes`."""
        rates = self.rates
        left = {k: self.families[k].changed - rates[k].keys() for k in self.plain}
        parts = self.system.parts | self.marked
        changes = changes_of(parts, [rates[k] for k in self.plain])
        return uses_of(self.families, self.plain, left), changes, self._turns_of(self.plain)

    def _turns_of(self, chosen: list[int]) -> FloatArray:
        """Derivatives of the local axes by the chosen parameters, (p, k, 3, 3), if any turns; else none."""
        count = len(self.system.core.supports.rot_slot) if self.turns else 0
        turn = np.zeros((len(chosen) if count else 0, count, 3, 3))
        for row, k in enumerate(chosen):
            if k in self.turns:
                turn[row] = self.turns[k]
        return turn

    @cached_property
    def turn(self) -> FloatArray:
        """Derivatives of the local axes by all parameters, (p, k, 3, 3), or (p, 0, 3, 3) if none turns."""
        if self.turns:
            return self._turns_of(list(range(len(self.families))))
        return np.zeros((len(self.families), 0, 3, 3))

    def turn_abreast(self) -> FloatArray:
        """The same of all parameters as their sensitivities lie, (p/8 rounded up, k, 3, 3, 8)."""
        turn, groups = self._turns_of(list(range(len(self.families)))), -(-len(self.families) // LANES)
        lanes = np.zeros((groups * LANES, *turn.shape[1:]))
        lanes[: len(turn)] = turn
        return np.ascontiguousarray(np.moveaxis(lanes.reshape(groups, LANES, *turn.shape[1:]), 1, -1))

    def _room(self, count: int, which: int = 0) -> FloatArray:
        """Room (p, count, size), in the memory of the block before: pages that are new cost time."""
        wanted = len(self.families) * count * self.system.size
        if wanted > self._kept[which].size:
            self._kept[which] = np.zeros(wanted)
        return self._kept[which][:wanted].reshape(len(self.families), count, self.system.size)

    def at_steps(self, way: Way, when: tuple[float, float, float, float], tables: Any, gaps: bool) -> Pushes:
        """Of the states at the ends of the steps of a block.

        ``when``: start, step, first and last time, as ``Inputs.tables`` takes them, and these tables.
        """
        self.know()
        push = self._room(len(way.q))
        if not self.others:
            self._add_plain(way, when, tables, push)
        elif self.plain:
            push[self.plain] = self.plain_at_steps(way, when, tables)
        gap = self._room(len(way.q), 1) if gaps else push
        if gaps:
            gap[self.plain] = 0.0
            gap[self.rows] = self.rows_at((1.0, 0.0, 0.0), way, tables)
        held = {}
        for k in self.others:
            found = self.families[k].at_steps(*way, when, gaps=gaps)
            push[k], held[k] = found.push, found.held
            if gaps:
                gap[k] = found.gap
        return Pushes(push, gap, held)

    def know(self) -> None:
        """Let systems of families be as the model's: places of contacts, joints, weights of their rows."""
        asked = range(len(self.families)) if len(self.system.measured) else (*self.rows, *self.others)
        for k in asked:
            self.families[k].know(self.system)

    @cached_property
    def of_rows(self) -> Uses:
        """Batches with rows of joints that parameters change."""
        return uses_of(self.families, self.rows, {k: constraining(self.families[k]) for k in self.rows})

    def rows_at(self, level: tuple[float, float, float], way: Way, tables: Any) -> FloatArray:
        """What parameters do to rows of joints with these weights, (rows, n, size), zero elsewhere."""
        system, before = self.system, self.system.level.copy()
        found = np.empty((len(self.rows), *way.q.shape))
        if self.rows:
            none = np.zeros((len(found), system.size)), np.zeros(len(found), dtype=bool)
            system.level[:] = level
            self.know()
            given = system.core, self.of_rows, changes_of(system.parts, []), np.zeros((0, 0, 3, 3)), *none
            add_pushes(*given, tables, way, self.friction, self._work, found)
            system.level[:] = before
            self.know()
            found *= system.core.joints.mask
        return found

    def plain_at_steps(self, way: Way, when: tuple[float, float, float, float], tables: Any) -> FloatArray:
        """Pushes of the plain families, (p, n, size)."""
        rows = np.empty((len(self.plain), *way.q.shape))
        self._add_plain(way, when, tables, rows)
        return rows

    def _add_plain(
        self, way: Way, when: tuple[float, float, float, float], tables: Any, rows: FloatArray
    ) -> None:
        first, loaded = self._steadily(when, tables)
        for row in np.flatnonzero(loaded).tolist():
            rows[row] = 0.0
            for weight, loads, value in self.families[self.plain[row]].loads_used(when, tables):
                add_loads(loads, value, weight, self._work, rows[row])
        if self.plain:
            given = *self._plainly, first, loaded, tables, way, self.friction
            add_pushes(self.system.core, *given, self._work, rows)

    def _steadily(self, when: tuple[float, float, float, float], tables: Any) -> tuple[FloatArray, BoolArray]:
        """What steady loads do to the residual by plain parameter, (p, size), and which have others, (p,)."""
        if self._first is None:
            each = [self.steady_loads(k, when, tables) for k in self.plain]
            first = np.zeros((len(each), self.system.size))
            for row, steady in zip(first, each, strict=True):
                row -= 0.0 if steady is None else steady
            self._first = first, np.array([steady is None for steady in each], dtype=bool)
        return self._first

    def steady_loads(self, k: int, when: tuple[float, float, float, float], tables: Any) -> Any:
        """Derivative of dead loads by a parameter, (size,) or 0, if it is the same at all times, or None."""
        if k not in self._weights:
            self._weights[k] = self._loads(k, when, tables)
        return self._weights[k]

    def _loads(self, k: int, when: tuple[float, float, float, float], tables: Any) -> Any:
        total: Any = 0.0
        family = self.families[k]
        alone = family.fed and all(same_patterns(family.base, system) for system in family.systems)
        for weight, loads, value in family.loads_used(when, tables):
            if len(loads.hung_slot) or not (alone or len(loads.start) == 1 or family.constant):
                return None
            if alone or len(loads.start) == 1:
                total = total + weight * loads.gravity
                continue
            apply_load(loads, value[0], self._work)
            total = total + weight * self._work
        return total


def constraining(family: Family) -> set[str]:
    """Names of the batches with rows of joints that a parameter changes."""
    parts = family.base.parts
    return {name for name in family.changed if Role.CONSTRAINS in traits(parts[name]).role}


def uses_of(families: list[Family], chosen: list[int], names: dict[int, set[str]] | None = None) -> Uses:
    """Batches around the values of the chosen parameters, whose rows are counted among these.

    ``names``: of the batches, where not all that a parameter changes are asked for.
    """
    found: dict[int, tuple[Any, list[tuple[int, float]]]] = {}
    for row, k in enumerate(chosen):
        for weight, changed in families[k].used(names[k] if names else None):
            for batch in changed:
                found.setdefault(id(batch), (batch, []))[1].append((row, weight))
    uses = [use for _, own in found.values() for use in own]
    return Uses(
        Batches(batch for batch, _ in found.values()),
        np.cumsum([0] + [len(own) for _, own in found.values()]),
        np.array([row for row, _ in uses], dtype=np.int64),
        np.array([weight for _, weight in uses], dtype=np.float64),
    )


def changes_of(
    parts: dict[str, Any], rates: list[dict[str, FloatArray]], names: list[str] | None = None
) -> Changes:
    """Of the numbers of all batches, or of these: by parameter what :func:`rates_of` finds."""
    names = sorted({name for found in rates for name in found}) if names is None else names
    rows = [[k for k, found in enumerate(rates) if name in found and np.any(found[name])] for name in names]
    each = [[rates[k][name] for k in own] for name, own in zip(names, rows, strict=True)]
    batches = [parts[name] for name in names]
    kinds = [
        [np.asarray(traits(batch).kinds(batch, rate), dtype=np.int64) for rate in own]  # type: ignore[misc]
        for batch, own in zip(batches, each, strict=True)
    ]
    none = np.zeros(0, dtype=np.int64)
    return Changes(
        knowing(add_changes, batches),
        np.cumsum([0, *map(len, rows)]),
        np.array([k for own in rows for k in own], dtype=np.int64),
        np.concatenate([np.zeros(0), *(rate for own in each for rate in own)]),
        np.cumsum([0, *(sum(map(len, own)) for own in each)]),
        np.concatenate([none, *(kind for own in kinds for kind in own)]),
        np.cumsum([0, *(sum(map(len, own)) for own in kinds)]),
        np.zeros(sum(map(len, rows)), dtype=np.int64),
    )
