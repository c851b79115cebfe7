"""Sensitivities that follow a simulation, block of steps by block of steps."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import garbage
from ..arrays import BoolArray, FloatArray
from ..errors import ModelError, SolveError
from ..model.integrators.base import NewmarkFamily
from ..preparation import Prepared, adopted
from ..results.state import State
from ..results.store import FileStore
from ..simd import LANES
from ..solvers.checkpoint import Snapshot
from ..solvers.derivatives.abreast import follow_steps
from ..solvers.derivatives.abreast_room import abreast, room_for
from ..solvers.derivatives.ahead import ahead_of
from ..solvers.derivatives.edge import edge_for
from ..solvers.derivatives.sensitivity import Constraining, Matrices, Way, accelerations
from ..solvers.record import Stats
from ..solvers.status import OK
from ..system.system import System
from .base import check_differentiable, matrices_of, moved_with
from .family import Family
from .histories import Histories
from .jumps import Anew, Jump, note_jumps
from .memory import Memory
from .memory_abreast import memory_abreast
from .nearby import Nearby
from .parameters import Parameter, check_known
from .samples import Samples
from .start import starts

#: Change of the initial motion by joints, in sizes of the model, that does not count.
SHIFTED = 1e-8
#: Room for what parameters do to the steps of a block, bytes.
ROOM = 16e6


class Trail:
    """States of a run as the steps left them: q, v, a at the ends, with accelerations from the velocities.

    Parameters
    ----------
    run : Run
        Of the Newmark family, at its start.
    """

    def __init__(self, run: Any) -> None:
        self.run, m = run, run.memory
        self.before = np.stack([m.v, m.a, m.abar])

    def accelerations(self, v: FloatArray, h: float, last: bool) -> FloatArray:
        """Accelerations at the ends of the steps of a block, (n, size), of which v are the velocities.

        ``last``: the run stands at the end of the block, and its own are taken from there on.
        """
        made = np.empty_like(v)
        accelerations(v, h, self.run.scheme, self.before, made)
        if last:
            m = self.run.memory
            made[-1] = m.a
            self.before = np.stack([m.v, m.a, m.abar])
        return made

    def begin(self, jump: Jump) -> None:
        """Go on from what a jump has left."""
        self.before = jump.after[[1, 2, 2]]


class Following:
    """Recorder that hands states on to a store and carries sensitivities along.

    Parameters
    ----------
    made : Prepared
        The simulation, which stores every step.
    parameters : list of Parameter
    start : State or None
        Where it starts.
    store : Recorder
        Takes every ``every``-th state.
    every : int

    Raises
    ------
    ModelError
        The model or the method has no sensitivities, or the start does not know its own.
    """

    @garbage.without
    def __init__(
        self, made: Prepared, parameters: list[Parameter], start: State | None, store: Any, every: int
    ) -> None:
        where = "simulate.sensitivities"
        check_method(made, where)
        self.made, self.store, self.every = made, store, every
        self.run: Any = made.run
        self.system = System(made.system.model, like=made.system)
        check_differentiable(self.system, where, follows=True)
        self.shifted = shifted(made, start)
        self.families = [Family(parameter, self.system, shifts=True) for parameter in parameters]
        self.nearby = Nearby(self.families, self.system, shifts=True)
        self.memory = Memory(self.system, self.families)
        self._check_shift(where)
        self.turn = self.nearby.turn_abreast()
        self.abreast = memory_abreast(self.memory, self.nearby)
        self.m = moved_with(self.system, self._matrices())
        self.ahead = ahead_of(self.system.core, self.m, bool(self.nearby.shifts))
        self.room = room_for(self.system.size, self.m.outside)
        self.edge = edge_for(self.system.size, self.m)
        self.given = given_start(self.families, self.run.t_start, self.system, start, where)
        self.memory.take(start, where)
        self.taken, self.done = 0, 0  # steps taken in and followed
        self.handed = 0, 0  # states and samples that a file has
        self.waiting: list[tuple[FloatArray, FloatArray, FloatArray]] = []  # q, v, a of steps to be followed
        run: Any = self.run
        count = 2 + (run.steps - 1) // every
        self.samples = Samples(self.families, self.system, run.system.sensors, run.steps)
        led = every == 1 and not self.samples.sampling.width and self._leads()
        self.histories = Histories(len(self.families), count, self.system.size, led)
        self._kept = np.zeros(0)
        self.jumps = note_jumps(self.run, bool(self.memory))

    def _matrices(self) -> Matrices:
        """Room for the matrices of the steps."""
        marked = self.abreast.marked if self.abreast else {}
        instead = [(self.system.parts[name], batch) for name, batch in marked.items()]
        return matrices_of(self.system.core, self.system.size, moving=True, marked=instead)

    def _check_shift(self, where: str) -> None:
        """Raise an error for a motion that joints change at the start in a way that is not followed."""
        if self.shifted is None:
            return
        if self.memory:
            what = "joints change the initial motion, and friction remembers the way"
            raise ModelError(where, what, "set_motion(...) that fits, or start from an equilibrium")
        self._know_joints()
        m = self.run.memory
        Anew(self.run, self.system, self.shifted, self.run.t_start).check((m.q, m.v))

    def _know_joints(self) -> None:
        """Let joints be as those of the run are at its start."""
        system, run = self.system, self.run
        mine, theirs = system.parts.get("slides"), run.system.parts.get("slides")
        if mine is not None and theirs is not None:
            mine.mode[...], mine.open[...] = theirs.mode, theirs.open
        system.measured[...] = run.system.measured

    def append(self, t: FloatArray, q: FloatArray, v: FloatArray, work: FloatArray) -> None:
        """States of a block, see :class:`ancf.solvers.record.Recorder`."""
        if not self.histories.stored:
            self._begin()
        elif len(t):
            self._take(q, v)
            keep = self._kept_of(self.taken, len(t))
            t, q, v, work = t[keep], q[keep], v[keep], work[keep]
        self.store.append(t, q, v, work)
        self._hand_on()

    def record(self, t: FloatArray, samples: FloatArray) -> None:
        """Samples."""
        self.store.record(t, samples)

    def update(self, stats: Stats, status: str) -> None:
        """Counters."""
        self.store.update(stats, status)

    def _hand_on(self) -> None:
        """Give a file the derivatives by numbers of the model that it lacks."""
        if not isinstance(self.store, FileStore):
            return
        ends = self.histories.stored, self.samples.done
        states, samples = (slice(*own) for own in zip(self.handed, ends, strict=True))
        named = [k for k, family in enumerate(self.families) if family.parameter.named]
        for place, k in enumerate(named):
            dq, dv = np.moveaxis(self.histories.rows[k, states], 1, 0)
            self.store.derive(place, (dq, dv, self.samples.rows[k, samples]))
        self.handed = ends

    def due(self) -> bool:
        """Never: a run that is gone on with would not know them."""
        return False

    def keep(self, snapshot: Snapshot) -> None:
        """Nothing, see :meth:`due`."""

    def _begin(self) -> None:
        """Sensitivities of the consistent start."""
        run, system = self.run, self.system
        self._know_joints()
        when = (run.t_start - run.h, run.h, run.t_start, run.t_end)
        states = run.memory.q.copy(), run.memory.v.copy(), run.memory.a.copy()
        self.memory.start(run.system.memory)
        if self.shifted is not None:
            found = Anew(run, system, self.shifted, run.t_start).derivatives(self.families, self.given)
            held = self._let_go(found)
        else:
            memory = self.abreast or self.memory
            found, held = starts(system, self.m, self.nearby, self.given, states, when, memory)
        self.s = abreast(found)
        if self.abreast:
            self.memory.put_back()
        self.histories.begin(found, held)
        first = found[:, None, :3].copy()
        first[:, 0, :2] += held
        self.samples.take(states[0][None], states[1][None], first)
        self.trail = Trail(run)

    def _leads(self) -> bool:
        """Whether places follow from velocities: of a result in memory, for a file has both."""
        supports = self.system.core.supports
        moves = any(self.families[k].moves for k in self.nearby.others)
        moves = moves or bool(np.any(supports.rot_moving >= 0))
        alone = bool(self.memory) and not self.abreast  # whose steps ask for places
        return not (alone or moves or len(self.system.multipliers) or isinstance(self.store, FileStore))

    def _kept_of(self, done: int, count: int) -> BoolArray:
        """Which of the last steps are stored."""
        numbers = np.arange(done - count + 1, done + 1)
        kept: BoolArray = (numbers % self.every == 0) | (numbers == self.run.steps)
        return kept

    def _take(self, q: FloatArray, v: FloatArray) -> None:
        """Take in the steps of a block, all of one length; follow them when eight matrices can be made."""
        run, h = self.run, self.run.h if self.taken < self.run.full else self.run.rest
        self.taken += len(q)
        when_cut(run, self.taken)
        while self.jumps:
            jump = self.jumps.pop(0)
            count = jump.number - (self.taken - len(q))
            self._take_to(jump, q[:count].copy(), v[:count].copy(), h)
            q, v = q[count:], v[count:]
        if not len(q):
            return
        self.waiting.append((q, v, self.trail.accelerations(v, h, last=True)))
        ready = sum(len(one[0]) for one in self.waiting)
        if ready >= LANES or self.taken in (run.full, run.steps):
            self._follow(*self._waited(), h)
        else:
            self.waiting[-1] = q.copy(), v.copy(), self.waiting[-1][2]

    def _take_to(self, jump: Jump, q: FloatArray, v: FloatArray, h: float) -> None:
        """Take in the steps to a jump, after the last of which is what the jump has left, and follow them."""
        q[-1], v[-1] = jump.before[:2]
        a = self.trail.accelerations(v, h, last=False)
        a[-1] = jump.before[2]
        self.trail.begin(jump)
        self.waiting.append((q, v, a))
        self._follow(*self._waited(), h, jump)

    def _waited(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """The steps that wait, which do no longer."""
        parts, self.waiting = self.waiting, []
        q, v, a = parts[0] if len(parts) == 1 else (np.concatenate(own) for own in zip(*parts, strict=True))
        return q, v, a

    def _follow(
        self, q: FloatArray, v: FloatArray, a: FloatArray, h: float, jump: Jump | None = None
    ) -> None:
        """Carry on over steps of a length, perhaps with a jump after the last, and store those to keep."""
        count = len(q)
        keep = self._kept_of(self.done + count, count)
        numbers = self.system.size * (4 * len(self.families) + 3)
        numbers += len(self.abreast.now) if self.abreast else 0
        most = max(int(ROOM / (8 * numbers)) // LANES, 1) * LANES
        most = 1 if self.memory and not self.abreast else most
        for begin in range(0, count, most):
            rows = slice(begin, min(begin + most, count))
            way = Way(q[rows].copy(), v[rows].copy(), a[rows])
            here = jump if rows.stop == count else None
            if self.every == 1 and not self.samples.sampling.width:
                self._block(way, h, self.done + begin, self.histories.rows, self.histories.stored)
                self.histories.stored += len(way.q)
                if here is not None:
                    self._jump(here, way, self.histories.rows[:, : self.histories.stored])
                continue
            made = self._room(len(way.q))
            self._block(way, h, self.done + begin, made, 0)
            if here is not None:
                self._jump(here, way, made)
            self.histories.keep(made[:, np.flatnonzero(keep[rows]), :2])
            self.samples.take(way.q, way.v, made)
        self.done += count

    def _jump(self, jump: Jump, way: Way, made: FloatArray) -> None:
        """Carry on over a jump: the last state, and the last derivatives ``made``, are what it has left."""
        anew = Anew(self.run, self.system, jump.before[:2], jump.t, jump.code)
        d = anew.derivatives(self.families, made[:, -1, :2])
        made[:, -1] = d[:, : made.shape[2]]
        way.q[-1], way.v[-1], way.a[-1] = jump.after
        self._let_go(d)
        self.s = abreast(d)

    def _let_go(self, d: FloatArray) -> FloatArray:
        """Take from derivatives (p, 4, size) what supports move that is in the pushes; that of q and v."""
        held = np.zeros((len(d), 2, self.system.size))
        for k in self.nearby.others:
            held[k][:, self.system.held] = d[k][:2, self.system.held]
            d[k][:, self.system.held] = 0.0
        return held

    def _room(self, count: int) -> FloatArray:
        """Room for derivatives of q, v and, of sensors, a, (p, count, 2 or 3, size), used again and again."""
        kinds = 3 if self.samples.sampling.width else 2
        wanted = len(self.families) * count * kinds * self.system.size
        if wanted > self._kept.size:
            self._kept = np.zeros(wanted)
        return self._kept[:wanted].reshape(len(self.families), count, kinds, self.system.size)

    def _block(self, way: Way, h: float, done: int, out: FloatArray, place: int) -> None:
        """Carry on over the steps of a block; fill the rows of (p, rows, 2 or 3, size) from a place on."""
        run, system = self.run, self.system
        count = len(way.q)
        rule = run.rule(h)
        joined = Constraining(rule.w0, rule.w1, rule.w2, rule.projects)
        system.level[:] = rule.w0, rule.w1, rule.w2
        when = run.time(done), h, run.t_start, run.t_end
        projects = rule.projects and len(system.multipliers) > 0
        tables = system.inputs.tables(*when[:2], count, *when[2:])
        if self.abreast:
            self.ahead = self.ahead._replace(friction=self.abreast.look(way, tables))
        elif self.memory:
            self.memory.choose(way.q[0], way.v[0])
        found = self.nearby.at_steps(way, when, tables, projects)
        rooms, pushes = (self.m, self.ahead, self.room, self.edge), (found.push, found.gap, self.turn)
        if self.memory and not self.abreast:
            found.push[:, 0] += self.memory.push(way, tables)
        n, status = follow_steps(
            system.core, *rooms, tables, way, *pushes, h, run.scheme, joined, self.s, out, place
        )
        if status != OK:
            t = run.time(done + int(n) + 1)
            what = "the equations of the sensitivities cannot be solved"
            raise SolveError(f"sensitivities at t = {t:.6g} s", what, "take a smaller step")
        for k, held in found.held.items():
            out[k, place : place + count] += np.moveaxis(held[: out.shape[2]], 0, 1)
        if self.memory and not self.abreast:
            self.memory.step(way.q[0], way.v[0], out[:, place, :2])

    def found(self) -> list[tuple[Any, FloatArray]]:
        """Derivatives of q and v at the stored times by parameter, see :meth:`Histories.found`."""
        return self.histories.found(self.run)


def check_method(made: Prepared, where: str) -> None:
    """Raise ModelError for methods whose steps have no sensitivities."""
    if not isinstance(made.method, NewmarkFamily):
        what = f"{type(made.method).__name__} has none"
        raise ModelError(where, what, "take ancf.Trapezoidal or ancf.GeneralizedAlpha")


def given_start(
    families: list[Family], t0: float, system: System, start: State | None, where: str
) -> list[tuple[FloatArray, FloatArray]]:
    """Derivatives of the state from which a run starts, q and v, by family.

    Raises
    ------
    ModelError
        The start does not know its own.
    """
    if start is None:
        return [family.of_states(t0) for family in families]
    check_known(start, [family.parameter for family in families], where)
    if any(not np.array_equal(start.slots[name], system.slots[name]) for name in system.slots):
        what = "the start is a state of a model with other connections or loads"
        raise ModelError(where, what, "compute its equilibrium again")
    found = []
    for family in families:
        own = start.derivatives[family.name]
        found.append((own.dq, own.dv) if own is not None else (np.zeros(system.size),) * 2)
    return found


def when_cut(run: Any, done: int) -> None:
    """Raise SolveError if a step was cut into parts."""
    if run.bridge.parts:
        what = "a step was cut into parts, which sensitivities do not follow"
        raise SolveError(f"sensitivities before t = {run.time(done):.6g} s", what, "take a smaller step")


def shifted(made: Prepared, start: State | None) -> tuple[FloatArray, FloatArray] | None:
    """Initial places and velocities, if joints have changed them."""
    run: Any = made.run
    system = made.system
    if not len(system.multipliers):
        return None
    given = system.initial_state(run.t_start) if start is None else adopted(start, system, "simulate")
    free = np.setdiff1d(system.free, system.multipliers)
    weight = system.core.weight[free]
    for mine, theirs in zip(given, (run.memory.q, run.memory.v), strict=True):
        change, size = (float(np.max(np.abs(x[free]) * weight, initial=0.0)) for x in (mine - theirs, theirs))
        if change > SHIFTED * max(size, 1.0):
            return given
    return None
