"""A model at values of a parameter around its own: what the residual of a fixed state changes by.

All that a parameter does is in the arrays of a compiled model.  The residual of a *fixed* state is a smooth
function of them, linear or rational in most parameters, and has no dynamics in it: differences of order four
or six give its derivative to round-off, for every kind of parameter and every kind of load or connection
alike.  Where it is found to be linear, two values are enough; where that is known, one and the model's own.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..batches import Batches
from ..compiled import Role, traits
from ..errors import ModelError
from ..solvers.stages import place_rows, stage_residuals
from ..system.beside import SLIDES, beside
from ..system.core import Core, Tables, apply_load, apply_supports, place_supports, residual
from ..system.system import System
from .alike import Known, alike, changed, same_inputs, same_loads
from .parameters import Parameter
from .trial import Trial
from .turns import axes_rates, moves_ends, slopes_local, slopes_rates, stands
from .values import Push, few_of, gaps_of, quiet_state

#: Step of the differences, relative, and of a parameter that is zero, in its unit or the size of the model.
STEP = 1e-3
#: Places of the values in steps, and weights of the derivative of order six: on both sides, on one.
BOTH = ((-3.0, -2.0, -1.0, 1.0, 2.0, 3.0), (-1 / 60, 9 / 60, -45 / 60, 45 / 60, -9 / 60, 1 / 60))
#: The same of order four, where that is seen to do.
FOUR = (-3.0, -1.5, 1.5, 3.0), (1 / 18, -8 / 18, 8 / 18, -1 / 18)
ABOVE = (
    (0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0),
    (-147 / 60, 360 / 60, -450 / 60, 400 / 60, -225 / 60, 72 / 60, -10 / 60),
)
#: The step where forces have kinks, which no value may reach: a taut dropper is stretched by 0.1 mm.
TINY = 1e-7
KINKED = {"springs", "contacts", "pressing", "rubbing", "crossing", "gripping", "bumping", "rolling"}
#: The same where all is linear; energies are quadratic then.
PAIR = ((-3.0, 3.0), (-1 / 6, 1 / 6))


class Family:
    """The systems of a model at values of a parameter around its own.

    Parameters
    ----------
    parameter : Parameter
    base : System
        Of the model itself.
    thorough : bool
        Take all values also of a parameter in which the residual is linear, for what is asked of matrices.
    shifts : bool
        What supports hold is not moved in residuals where it shifts.

    Attributes
    ----------
    plain : bool
        No support depends on the parameter, and no load that depends on the state or row of a joint does.
    shift, turn : ndarray
        Derivatives of the state where it is held, (size,), and of the local axes of supports, (k, 3, 3), if
        these are all that keeps it from being plain; else, and where they are zero, empty.
    joined : bool
        It is plain but for rows of joints that depend on the parameter.
    constant : bool
        No dead load of the model changes with time.

    Raises
    ------
    ModelError
        The parameter changes which unknowns there are, or the model cannot be built around its value.
    """

    def __init__(
        self, parameter: Parameter, base: System, thorough: bool = False, shifts: bool = False
    ) -> None:
        self.parameter, self.base, self.shifts = parameter, base, shifts
        p = parameter.value
        size = Known.of(base).size
        unit = abs(p) if p != 0.0 else min(1.0, size)
        self._unit = unit = min(unit, size) if moves_ends(parameter.acts) else unit
        self._wide: list[tuple[System, float]] = []
        self._made: dict[float, System] = {}
        self._differ: dict[int, set[str]] = {}  # names of batches by system
        self._begun: dict[int, tuple[FloatArray, FloatArray]] = {}  # initial states by system
        self.straight = shifts and not thorough and moves_ends(parameter.acts) and stands(base)
        self.linear = self.straight  # but for axes, see _look
        if self.linear:
            self._take_line(3.0 * STEP * unit)
        elif parameter.quadratic:
            self._take(TINY, *PAIR)
        else:
            self._choose(STEP * unit, TINY * unit, thorough)
        self._look()
        self._forget()

    def _choose(self, h: float, tiny: float, thorough: bool) -> None:
        """Take values h apart, two or six, or two that are tiny steps apart where forces have kinks."""
        p = self.parameter.value
        if self.parameter.linear and not thorough:
            step = tiny if self.parameter.kinked else h
            return self._take_line(3.0 * step if p >= 0.0 else -3.0 * step)
        acts = self.parameter.acts
        known = acts is not None and (acts.moves or acts.shapes)  # not to be linear
        steep = acts is not None and SLIDES in acts.parts  # powers of lengths whose effects nearly cancel
        try:
            self._take(h, *(BOTH if steep else FOUR if known else PAIR))
            if p != 0.0 and not thorough and (self._names() & KINKED or self._moves_kinks()):
                self._forget()
                return self._take(tiny, *PAIR)
            if not thorough and not known and self._trial().linear():
                self.linear = True
                return None
            if not (thorough or steep) and self._steady_inputs() == (True, True):
                self._take(h, *FOUR)
                if (acts is not None and acts.shapes) or self._trial().smooth():  # powers of a length are
                    return None
            return self._take(h, *BOTH)
        except ModelError:
            if p != 0.0:
                raise
        return self._take(h, *ABOVE)  # it may not be negative

    def _forget(self) -> None:
        """Of systems that are not needed any more."""
        for kept in (self._made, self._differ, self._begun):
            kept.clear()

    def _trial(self) -> Trial:
        """In which it is tried how many values the parameter needs."""
        self.know(self.base)
        still = self.shifts and not self._names()
        still = still and all(same_loads(self.base, system) for system in self.systems)
        return Trial(self.base, self.systems, self._states, still)

    def _steady_inputs(self) -> tuple[bool, bool]:
        """Whether no motion of a support depends on the parameter, and no input of a load."""
        found = [same_inputs(self.base, system) for system in self.systems]
        return all(motions for motions, _ in found), all(values for _, values in found)

    def _names(self) -> set[str]:
        """Of the batches on which the parameter acts."""
        for system in self.systems:
            if id(system) not in self._differ:
                self._differ[id(system)] = changed(self.base, system)
        return set().union(*(self._differ[id(system)] for system in self.systems))

    def _moves_kinks(self) -> bool:
        """Whether supports are moved where something has kinks, whose numbers stay as they are."""
        base = self.base
        held, kinked = base.held, (base.parts[name] for name in KINKED & set(base.parts))
        return any(len(b[0]) for b in kinked) and any(np.any(shape[held]) for shape in self._shape)

    def _take_line(self, offset: float) -> None:
        """Let the systems be one at this offset and the model's own: all is linear between them."""
        self._put([self._compiled(offset), self.base], [offset, 0.0], [1.0 / offset, -1.0 / offset])

    def _take(self, h: float, places: tuple[float, ...], weights: tuple[float, ...]) -> None:
        """Let the systems be those at these places, in steps h."""
        for x in places:
            if x not in self._made:
                self._made[x] = self._compiled(h * x)
        systems = [self._made[x] for x in places]
        self._put(systems, [h * x for x in places], [w / h for w in weights])

    def _put(self, systems: list[System], offsets: list[float], weights: list[float]) -> None:
        self.systems, self.offsets, self.weights = systems, offsets, weights
        base = self.base
        if self.parameter.linear:  # in it nothing but forces changes
            self._shape = [np.zeros(base.size)] * len(systems)
        else:
            self._begun[id(base)] = Known.of(base).initial_state(0.0)
            shape = self._begun[id(base)][0]
            for system in systems:
                if id(system) not in self._begun:
                    self._begun[id(system)] = quiet_state(system)
            self._states = [self._begun[id(system)] for system in systems]
            self._shape = [q - shape for q, _ in self._states]
        self._flags = [
            (getattr(s.parts[name], key), name, key)
            for s in self.systems
            for name in base.parts
            for key in ("mode", "open")
            if hasattr(base.parts[name], key)
        ]

    def around(self) -> list[tuple[System, float]]:
        """Systems and weights with which any smooth function is differentiated, linear in forces or not."""
        if not (self.parameter.linear or self.linear):
            return list(zip(self.systems, self.weights, strict=True))
        if not self._wide:
            h = (TINY if self.parameter.kinked else STEP) * self._unit
            places, weights = FOUR if self.parameter.value != 0.0 else ABOVE
            systems = [self._compiled(h * x) if x != 0.0 else self.base for x in places]
            self._wide = [(system, w / h) for system, w in zip(systems, weights, strict=True)]
        return self._wide

    def _look(self) -> None:
        """See what of the model depends on the parameter."""
        base = self.base
        self.changed = self._names()
        still, self._fed = self._steady_inputs()
        plain = still and all(self._has_own(system) for system in self.systems)
        rows = any(Role.CONSTRAINS in traits(base.parts[name]).role for name in self.changed)
        moved = np.zeros(base.size)
        for weight, shape in zip(self.weights, self._shape, strict=True):
            moved += weight * shape
        shift = np.zeros(base.size)
        shift[base.held] = moved[base.held]
        own = self.systems, self.weights
        turn: Any = slopes_rates(base, moved) if self.straight else axes_rates(base, *own)
        if turn is None or (np.any(turn) and len(base.multipliers)):
            plain, turn = False, np.zeros((0, 3, 3))
        moves = bool(np.any(shift) or np.any(turn))
        self.plain, self.joined = plain and not (moves or rows), plain and rows and not moves
        self.shift = shift if plain and not rows and np.any(shift) else shift[:0]
        self.turn = turn if plain and not rows and np.any(turn) else turn[:0]
        self._loads = any(not same_loads(base, s) for s in self.systems)
        self._steady: list[FloatArray] | None = None
        self.constant = all(f.constant for s in self.systems for f in s.inputs.loads)

    @cached_property
    def _batches(self) -> list[Batches]:
        """Those that the parameter changes, of each system and of the model itself."""
        return few_of([*self.systems, self.base], self.changed)

    def _has_own(self, system: System) -> bool:
        """Whether no batch that the parameter changes has inputs of the system's."""
        few = [batch for name, batch in system.parts.items() if name in self.changed]
        shared = (
            np.may_share_memory(x, system.value)
            for b in few
            for x in b
            if isinstance(x, np.ndarray) and x.size
        )
        return not any(shared)

    def used(self, names: set[str] | None = None) -> list[tuple[float, Batches]]:
        """Weights and the batches that the parameter changes at each value, or those of them by these names.

        Where two values do, one of them and that of the model, which all parameters share.
        """
        batches = self._batches if names is None else few_of([*self.systems, self.base], names)
        if not self.linear or self.systems[-1] is self.base:
            return list(zip(self.weights, batches[:-1], strict=True))
        last, own = batches[-2:]
        return [(1.0 / self.offsets[-1], last), (-1.0 / self.offsets[-1], own)]

    def loads_used(
        self, when: tuple[float, float, float, float], tables: Tables
    ) -> Iterator[tuple[float, Any, Any]]:
        """Weights, dead loads at each value and their inputs (steps or 1, n, 3), if they depend on it.

        ``tables`` are those of the model itself.
        """
        if not self._loads:
            return
        if self._steady is None:
            self._steady = (
                [self._value(k, when, 1) for k in range(len(self.systems))] if self.constant else []
            )
        for k, (system, weight) in enumerate(zip(self.systems, self.weights, strict=True)):
            value = tables.value
            if not self._fed:
                value = self._steady[k] if self.constant else self._value(k, when, len(value))
            yield weight, system.dead, value

    def _value(self, k: int, when: tuple[float, float, float, float], count: int) -> FloatArray:
        """Inputs of the loads at value k of the parameter at the ends of steps, (count, n, 3)."""
        value: FloatArray = self.systems[k].inputs.tables(*when[:2], count, *when[2:]).value
        return value

    @property
    def name(self) -> str:
        """Of the parameter."""
        return self.parameter.name

    def _compiled(self, offset: float) -> System:
        value, acts = self.parameter.value + offset, self.parameter.acts
        if acts is not None:
            system = beside(self.base, self.parameter.at(value), acts)
        else:
            system = System(self.parameter.at(value), like=self.base)
        if not alike(self.base, system):
            if self.parameter.value == 0.0 and system.size == self.base.size:
                what = f"with {value:.3g} the elements of the model are in other groups than with 0"
                raise ModelError(self.name, what, "take a small number in place of 0")
            what = f"with {value:.8g} the model has other unknowns than with {self.parameter.value:.8g}"
            raise ModelError(self.name, what, "the number of elements, nodes and joints has to stay")
        return system

    def know(self, system: System) -> None:
        """Let all systems be as one that runs: its joints, and the weights of their rows."""
        for own in self.systems:
            own.level[:] = system.level
            if len(system.measured):
                own.measured[...] = system.measured
        for mine, name, key in self._flags:
            mine[...] = getattr(system.parts[name], key)

    def at_steps(
        self, q: FloatArray, v: FloatArray, a: FloatArray, when: tuple[float, float, float, float], gaps: bool
    ) -> Push:
        """What the parameter does to states (n, size) at the ends of steps.

        ``when``: start, step, first and last time, as ``Inputs.tables`` takes them.
        """
        start, step, first, last = when
        made = Push(np.zeros_like(q), np.zeros_like(q), np.zeros((3, *q.shape)))
        for k, weight in enumerate(self.weights):
            system = self.systems[k]
            tables = system.inputs.tables(start, step, len(q), first, last)
            states = self._moved(k, q), v.copy(), a.copy()
            place_rows(system.core, tables, *states)
            moved = any(not np.array_equal(x, y) for x, y in zip(states, (q, v, a), strict=True))
            core = system.core if moved else system.core._replace(batches=self._batches[k])
            r = np.empty_like(q)
            stage_residuals(core, tables, *states, np.empty(system.size), r)
            made.push[...] += weight * r
            for x, y, here in zip(made.held, states, (q, v, a), strict=True):
                x += weight * (y - here)
            if gaps:
                made.gap[...] += weight * gaps_of(system, tables, states)
        self._finish(made)
        return made

    def at_rest(self, core: Core, q: FloatArray, when: tuple[float, float]) -> Push:
        """The same of one state (size,) without motion at a time, of ``core`` what is held.

        ``when``: time and a step with which rates of given motions are found.
        """
        time, h = when
        made = Push(np.zeros((1, q.size)), np.zeros((1, q.size)), np.zeros((3, 1, q.size)))
        for k, weight in enumerate(self.weights):
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
        if self.parameter.linear:
            return np.zeros(self.base.size), np.zeros(self.base.size)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what holds against a given motion was said of the model itself
            here = Known.of(self.base).initial_state(time)
            both = self._states if time == 0.0 else [system.initial_state(time) for system in self.systems]
        q, v = np.zeros(self.base.size), np.zeros(self.base.size)
        for weight, state in zip(self.weights, both, strict=True):
            q += weight * (state[0] - here[0])  # what does not change leaves no round-off
            v += weight * (state[1] - here[1])
        if self.straight:  # the lengths of slopes are not linear
            q[: self.base.n] = slopes_local(self.base, q)[: self.base.n]
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
        held = self.base.held
        moved = q.copy()
        moved[:, held] += self._shape[k][held]
        return moved

    def _finish(self, made: Push) -> None:
        n = self.base.n
        made.push[:, n:] = made.gap[:, n:] = 0.0
        free = np.ones(made.push.shape[1], dtype=bool)
        free[self.base.held], free[n:] = False, False
        made.held[..., free] = 0.0
