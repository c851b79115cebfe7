"""A model at values of a parameter around its own: what the residual of a fixed state changes by.

All that a parameter does is in the arrays of a compiled model.  The residual of a *fixed* state is a smooth
function of them, linear or rational in most parameters, and has no dynamics in it: differences of order four
or six give its derivative to round-off, for every kind of parameter and every kind of load or connection
alike.  Where it is found to be linear, two values are enough; where that is known, one and the model's own.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..batches import Batches
from ..compiled import Role, traits
from ..errors import ModelError
from ..system.beside import SLIDES, beside
from ..system.core import Tables
from ..system.system import System
from .alike import Known, alike, begins_alike, changed, moves_alike, same_inputs, same_loads
from .offsets import ABOVE, BENT, BOTH, FOUR, KINKED, PAIR, STEEP, STEP, TINY
from .parameters import Parameter
from .pushing import Pushing
from .remembering import friction_of, with_same_friction
from .trial import Trial
from .turns import axes_rates, ends_rates, moves_ends, slopes_local, slopes_rates, stands
from .values import fed_alike, few_of, quiet_state


class Family(Pushing):
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
    branches : function, optional
        ``branches(system)``: which slack springs are tight in the one state of which derivatives are asked.

    Attributes
    ----------
    plain : bool
        No support depends on the parameter, no row of a joint, and no input of a load that depends on the
        state.
    shift, turn : ndarray
        Derivatives of the state where it is held, (size,), and of the local axes of supports, (k, 3, 3), if
        these are all that keeps it from being plain; else, and where they are zero, empty.
    moves : bool
        What supports hold depends on the parameter.
    joined : bool
        It is plain but for rows of joints that depend on the parameter.
    constant : bool
        No dead load of the model changes with time.
    fed : bool
        Loads have the same inputs at all values.

    Raises
    ------
    ModelError
        The parameter changes which unknowns there are, or the model cannot be built around its value.
    """

    def __init__(
        self,
        parameter: Parameter,
        base: System,
        thorough: bool = False,
        shifts: bool = False,
        branches: Callable[[System], tuple[bool, ...]] | None = None,
    ) -> None:
        self.parameter, self.base, self.shifts, self._branches = parameter, base, shifts, branches
        p = parameter.value
        size = Known.of(base).size
        unit = abs(p) if p != 0.0 else min(1.0, size)
        self._unit = unit = min(unit, size) if moves_ends(parameter.acts) else unit
        self._wide: list[tuple[System, float]] = []
        self._made: dict[float, System] = {}
        self._differ: dict[int, set[str]] = {}  # names of batches by system
        self._begun: dict[int, tuple[FloatArray, FloatArray]] = {}  # initial states by system
        self._steady: list[FloatArray] | None = None
        self._flags: list[tuple[Any, str, str]] = []
        self.changed: set[str] = set()
        self.straight = shifts and not thorough and moves_ends(parameter.acts) and stands(base)
        self.linear = self.straight  # but for axes, see _look
        self._ends = self._ends_at(3.0 * STEP * unit) if self.straight else None
        if self._ends is not None:
            return self._see_ends(self._ends[0])
        if self.linear:
            self._take_line(3.0 * STEP * unit)
        elif parameter.quadratic:
            self._take(TINY, *PAIR)
        else:
            self._choose(STEP * unit, TINY * unit, thorough)
        self._look()
        self._forget()

    @cached_property
    def systems(self) -> list[System]:
        """Of the model at the values; where all that they are asked is known, they are made when needed."""
        return [self._compiled(self.offsets[0]), self.base]

    def _ends_at(self, offset: float) -> tuple[FloatArray, FloatArray] | None:
        """Derivatives of the initial state from an end at this offset, see :func:`ends_rates`, or None."""
        self.offsets, self.weights = [offset, 0.0], [1.0 / offset, -1.0 / offset]
        return ends_rates(self.base, self.parameter.at(self.parameter.value + offset), offset)

    def _see_ends(self, moved: FloatArray) -> None:
        """An end of a cable moves what supports hold, and no number of a batch and no load."""
        self.fed, self._loads, self.moves = True, False, True
        self.constant = all(f.constant for f in self.base.inputs.loads)
        self._see_held(moved, slopes_rates(self.base, moved), True)

    def _choose(self, h: float, tiny: float, thorough: bool) -> None:
        """Take values h apart, two or six, or two that are tiny steps apart where forces have kinks."""
        p = self.parameter.value
        if self.parameter.linear and not thorough:
            step = tiny if self.parameter.kinked else h
            return self._take_line(3.0 * step if p >= 0.0 else -3.0 * step)
        acts = self.parameter.acts
        known = acts is not None and (acts.moves or acts.shapes)  # not to be linear
        h *= STEEP if acts is not None and (SLIDES in acts.parts or self._is_steep(acts)) else 1.0
        try:
            self._take(h, *(FOUR if known else PAIR))
            if self._bends_damped():
                h *= BENT
                self._take(h, *(FOUR if known else PAIR))
            if p != 0.0 and not thorough and not self._stays():
                self._forget()
                return self._take(tiny, *PAIR)
            if not thorough and not known and self._trial().linear():
                self.linear = True
                return None
            if not thorough and self._steady_inputs() == (True, True):
                self._take(h, *FOUR)
                if (acts is not None and acts.shapes) or self._trial().smooth():  # powers of a length are
                    return None
            return self._take(h, *BOTH)
        except ModelError:
            if p != 0.0:
                self._forget()
                return self._take(tiny, *PAIR)  # so far from its value there is no such model
        return self._take(h, *ABOVE)  # it may not be negative

    def _bends_damped(self) -> bool:
        """Whether supports are moved or turn where something dissipates; the systems are forgotten then."""
        base = self.base
        given = np.append(base.held, base.supports.rot_shadow[:, None] + np.arange(3))
        if not base.core.damped or not any(np.any(shape[given]) for shape in self._shape):
            return False
        self._forget()
        return True

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

    def _stays(self) -> bool:
        """Whether nothing comes to a kink between the values."""
        kinked = self._names() & KINKED.union(friction_of(self.base))
        if self._moves_kinks():
            return False
        if self._branches is None or kinked != {"springs"}:
            return not kinked
        return len({self._branches(system) for system in (self.base, *self.systems)}) == 1

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
        self.__dict__.pop("wider", None)
        base = self.base
        if self.parameter.linear:  # in it nothing but forces changes
            self._shape = [np.zeros(base.size)] * len(systems)
        else:
            begun = self._begun
            begun[id(base)] = Known.of(base).initial_state(0.0)
            shape = begun[id(base)][0]
            for system in systems:
                if id(system) not in begun:
                    begun[id(system)] = begun[id(base)] if begins_alike(base, system) else quiet_state(system)
            self._states = [begun[id(system)] for system in systems]
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
            kinked = self.parameter.kinked or bool(self.changed.intersection(friction_of(self.base)))
            h = (TINY if kinked else STEP) * self._unit
            places, weights = FOUR if self.parameter.value != 0.0 else ABOVE
            systems = [self._compiled(h * x) if x != 0.0 else self.base for x in places]
            self._wide = [(system, w / h) for system, w in zip(systems, weights, strict=True)]
        return self._wide

    def _look(self) -> None:
        """See what of the model depends on the parameter."""
        base = self.base
        self.changed = self._names()
        still, self.fed = self._steady_inputs()
        self.moves = not still
        plain = still and (self.fed or all(self._has_own(system) for system in self.systems))
        rows = any(Role.CONSTRAINS in traits(base.parts[name]).role for name in self.changed)
        self._see_supports(plain, rows)
        self._loads = any(not same_loads(base, s) for s in self.systems)
        self.constant = all(f.constant for s in self.systems for f in s.inputs.loads)

    def _see_supports(self, plain: bool, rows: bool) -> None:
        """See whether what supports hold shifts or turns with the parameter; or ``rows`` of joints change."""
        base, none = self.base, np.zeros((0, 3, 3))
        if self.parameter.linear and all(system.supports is base.supports for system in self.systems):
            self._see_held(np.zeros(base.size), none, plain, rows)
            return
        moved = np.zeros(base.size)
        for weight, shape in zip(self.weights, self._shape, strict=True):
            moved += weight * shape
        own = self.systems, self.weights
        turn: Any = slopes_rates(base, moved) if self.straight else axes_rates(base, *own)
        if turn is None or (np.any(turn) and len(base.multipliers)):
            plain, turn, self.moves = False, none, True
        self._see_held(moved, turn, plain, rows)

    def _see_held(self, moved: FloatArray, turn: FloatArray, plain: bool, rows: bool = False) -> None:
        """Keep what is held that shifts, as the state is ``moved``, and turns."""
        shift = np.zeros(self.base.size)
        shift[self.base.held] = moved[self.base.held]
        moves = bool(np.any(shift) or np.any(turn))
        self.moves = self.moves or moves
        self.plain, self.joined = plain and not (moves or rows), plain and rows and not moves
        self.shift = shift if plain and not rows and np.any(shift) else shift[:0]
        self.turn = turn if plain and not rows and np.any(turn) else turn[:0]

    @cached_property
    def _batches(self) -> list[Batches]:
        """Those that the parameter changes, of each system and of the model itself."""
        return few_of([*self.systems, self.base], self.changed)

    def _has_own(self, system: System) -> bool:
        """Whether no batch that the parameter changes has inputs of the system's."""
        few = [batch for name, batch in system.parts.items() if name in self.changed]
        arrays = (x for b in few for x in b) if system.value.size else ()
        own = (x for x in arrays if isinstance(x, np.ndarray) and x.size)
        return not any(np.may_share_memory(x, system.value) for x in own)

    def used(self, names: set[str] | None = None) -> list[tuple[float, Batches]]:
        """Weights and the batches that the parameter changes at each value, or those of them by these names.

        Where two values do, one of them and that of the model, which all parameters share.
        """
        names = self.changed if names is None else names
        roles = {name: traits(part).role for name, part in self.base.parts.items()}
        jointed = {name for name, role in roles.items() if Role.CONSTRAINS in role}  # and events
        kinked = names & KINKED.union(friction_of(self.base), jointed)
        if names != kinked and self.wider[0] is not self.systems:
            systems, weights = self.wider
            batches = fed_alike(few_of([*systems, self.base], names - kinked))
            smooth = list(zip(weights, batches[:-1], strict=True))
            return smooth + self._used(kinked)
        return self._used(names)

    def _used(self, names: set[str]) -> list[tuple[float, Batches]]:
        if not names:
            return []
        batches = fed_alike(few_of([*self.systems, self.base], names))
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
            if not self.fed:
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
        return with_same_friction(self.base, system, self.name)

    def know(self, system: System) -> None:
        """Let all systems be as one that runs: its joints, and the weights of their rows."""
        known = self.__dict__
        others = known["wider"][0] if "wider" in known else ()
        for own in (*self.systems, *others) if "systems" in known else ():
            own.level[:] = system.level
            if len(system.measured):
                own.measured[...] = system.measured
        for mine, name, key in self._flags:
            mine[...] = getattr(system.parts[name], key)

    def of_states(self, time: float) -> tuple[FloatArray, FloatArray]:
        """Derivatives of the initial shape and motion, (size,) each."""
        if self._ends is not None:
            return self._ends
        if self.parameter.linear or all(begins_alike(self.base, system) for system in self.systems):
            return np.zeros(self.base.size), np.zeros(self.base.size)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what holds against a given motion was said of the model itself
            here = Known.of(self.base).initial_state(time)
            systems, weights = self.wider
            states = self._states if systems is self.systems and time == 0.0 else None
            both = states or [system.initial_state(time) for system in systems]
        q, v = np.zeros(self.base.size), np.zeros(self.base.size)
        for weight, state in zip(weights, both, strict=True):
            q += weight * (state[0] - here[0])  # what does not change leaves no round-off
            v += weight * (state[1] - here[1])
        if self.straight:  # the lengths of slopes are not linear
            q[: self.base.n] = slopes_local(self.base, q)[: self.base.n]
        return q, v

    def of_motion(self, q: FloatArray, dq: FloatArray, time: float) -> FloatArray:
        """Derivative of the velocities of ``set_motion`` at a shape that changes by dq, (size,)."""
        if self.plain and all(moves_alike(self.base, system) for system in self.systems):
            return np.zeros(self.base.size)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            each = zip(self.systems, self.offsets, self.weights, strict=True)
            rates = [weight * own.motion(q + offset * dq, time) for own, offset, weight in each]
        found: FloatArray = np.sum(rates, axis=0)
        return found
