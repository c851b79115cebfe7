"""A step that has failed: other ways to solve it, and smaller steps that together span it."""

from __future__ import annotations

from typing import Any, NoReturn, Protocol

import numpy as np

from ..arrays import FloatArray, IntArray
from ..system.core import Core, Tables, apply_load
from ..system.energy import energies
from ..system.system import System
from .newmark import FURTHEST, LAST, Rule
from .sampling import Output, Sampling
from .status import EVENT, INVERTED, OK, RETRIES, SINGULAR, STEPS, TOO_MANY, TURN, UNBALANCED
from .step.balance import begin_account
from .step.corrections import UNLIMITED
from .step.memory import H_FACTOR, KNOWN, VECTORS, Memory
from .step.rescue import Rescue
from .step.scheme import Scheme
from .step.unresolved import resolve

#: A step is cut into at most 2 ** MOST_HALVINGS parts.
MOST_HALVINGS = 10
#: Parts of this share of the step or less are taken as they come.
ANYWHERE = 2**-6
#: Parts that a step may take on average of the run, which may begin with so many steps' worth of them.
MOST_PARTS, FREE_STEPS = 4, 20
#: Energy that a longer part may make from nothing, as a share of what was exchanged so far.
MOST_MADE = 0.05
#: Share of what begins to move that a step has to resolve for the accelerations at its start to be replaced
#: before all else is tried: swinging cables with elements of 1 mm to 1 m and steps of 1 to 100 ms have 0.98
#: or more, a cantilever 0.66 with a step of a twelfth of its period.
NEARLY_ALL = 0.95


class Stepping(Protocol):
    """What a bridge asks of a run."""

    system: System
    memory: Memory
    scheme: Scheme
    sampling: Sampling
    t_start: float
    t_end: float
    energy0: FloatArray

    @property
    def keeps_energy(self) -> bool:
        """Whether the method itself takes nothing out."""
        ...

    @property
    def hesitates(self) -> bool:
        """Whether the next step has not been tried by itself."""
        ...

    def rule(self, h: float, first: int = ..., last: int = ..., furthest: float = ...) -> Rule:
        """Newton's rule for a step h and which attempts to make."""
        ...

    def block(
        self, core: Core, tables: Tables, h: float, rule: Rule, row: IntArray, out: Output
    ) -> tuple[int, int]:
        """Steps of a length h: how many were done, and the status of the last one."""
        ...

    def room(self, stored: int, steps: int) -> Output:
        """Room for so many stored states and so many steps with samples."""
        ...

    def stop(self, t: float, number: int, status: int, h: float) -> NoReturn:
        """Step ``number`` of length h fails for good at t."""
        ...

    def happened(self, code: int, t: float, number: int) -> None:
        """What has happened at the end of a step."""
        ...

    def round_off(self) -> float:
        """Energy that may come from round-off, J."""
        ...


class Bridge:
    """How a run gets over the steps that fail.

    Parameters
    ----------
    run : Stepping
    """

    def __init__(self, run: Stepping) -> None:
        self.run, self.parts = run, 0
        self.sample: FloatArray | None = None
        self._rescue: Rescue | None = None

    @property
    def rescue(self) -> Rescue:
        """Newton's method for what the fast iteration does not manage; most runs never need it."""
        if self._rescue is None:
            self._rescue = Rescue(self.run.system, self.run.memory)
        return self._rescue

    def cross(self, t: float, h: float, number: int) -> None:
        """Step ``number`` from t to t + h, in one part or in many; the fast iteration has failed once.

        The parts are halves of halves; two that succeed make room for one of twice their size.  ``sample`` is
        then what sensors record at the end, if that is known from before friction was renewed.
        """
        run, m = self.run, self.run.memory
        self.sample = None
        core = run.system.core._replace(accounted=True)
        now = run.system.inputs.tables(t - h, h, 1, run.t_start, run.t_end, (m.q, m.v), still=True)
        if not run.system.core.accounted:  # what is judged here must not depend on what is recorded
            apply_load(core.loads, now.value[0], m.f)
            begin_account(core, m)
        units = 2**MOST_HALVINGS
        started = m.memo[KNOWN] == 0.0 and not core.damped  # damping ends what shorter steps begin with
        done, part, calm = 0, units, 0
        first = 0 if run.hesitates else 1  # the first attempt has been made already
        if started and self._resolved(core, now, t, h, number, NEARLY_ALL):
            return
        while done < units:
            status = self._part(core, t + h * (done / units), h * (part / units), h, first)
            first = 0
            if status != OK and status < EVENT:
                if part == units and started and self._resolved(core, now, t, h, number, 0.0):
                    return
                if part == 1:
                    run.stop(t + h * (done / units), number, status, h)
                m.counts[RETRIES] += part == units
                part, calm = part // 2, 0
                continue
            done += part
            if status >= EVENT:
                run.happened(status - EVENT, t + h * (done / units), number)
            m.counts[STEPS] -= 1  # the parts count as one step
            self.parts, calm = self.parts + (part < units), calm + 1
            if self.parts > MOST_PARTS * (m.counts[STEPS] + FREE_STEPS):
                run.stop(t + h * (done / units), number, TOO_MANY, h)
            if calm >= 2 and part < units and done % (2 * part) == 0:
                part, calm = 2 * part, 0
        m.counts[STEPS] += 1

    def _resolved(self, core: Core, now: Tables, t: float, h: float, number: int, least: float) -> bool:
        """The whole step with those accelerations at its start that it can resolve; whether that succeeds.

        ``least``: the share of what begins to move that has to be left.
        """
        run, m = self.run, self.run.memory
        before = self._save()
        if resolve(run.system, core, m, now, h, run.scheme, least):
            status = self._part(core, t, h, h, 0)
            if status >= EVENT:
                run.happened(status - EVENT, t + h, number)
            if status == OK or status >= EVENT:
                return True
        self._put_back(before)
        return False

    def _part(self, core: Core, t: float, part: float, h: float, first: int) -> int:
        """One step from t to t + part by the fast iteration or, if that fails, by the other one.

        ``first``: of the attempts at a step the first to be made.
        """
        run, m = self.run, self.run.memory
        short = part <= ANYWHERE * h
        rule = run.rule(part, first, LAST, UNLIMITED if short else FURTHEST)
        tables = run.system.inputs.tables(t, part, 1, run.t_start, run.t_end, (m.q, m.v))
        before, energy = self._save(), self._energy()[0]
        row, room = np.full(1, -1), run.room(0, 1)
        status = run.block(core, tables, part, rule, row, room)[1]
        if status == TURN:  # what may sleep waits for a whole step
            status = OK
        self.sample = room.samples[0] if status == OK else None
        if core.damped and status not in (OK, SINGULAR) and status < EVENT:
            other = self.rescue.take(core, tables, part, run.scheme, rule)
            status = other if other in (OK, INVERTED) or other >= EVENT else status
        if not short and (status == OK or status >= EVENT):
            now, exchanged = self._energy()
            made = now - energy
            if run.keeps_energy:
                made = abs(made)
            if made > MOST_MADE * exchanged + run.round_off():
                self._put_back(before)
                m.counts[STEPS] -= 1
                return UNBALANCED
        return status

    def _save(self) -> list[FloatArray]:
        return [x.copy() for x in self._kept()]

    def _put_back(self, saved: list[FloatArray]) -> None:
        for x, old in zip(self._kept(), saved, strict=True):
            x[:] = old
        self.run.memory.memo[H_FACTOR] = 0.0

    def _kept(self) -> list[FloatArray]:
        """All that a step changes but the counters."""
        return [*_state(self.run.memory), *self.run.system.memory.values()]

    def _energy(self) -> tuple[float, float]:
        """Energy now less what came in, and all that has been exchanged so far."""
        m, system = self.run.memory, self.run.system
        now = energies(system, m.q[None], m.v[None])[0]
        dissipated, supplied = m.work
        exchanged = now[0] + now[1] + abs(now[2] - self.run.energy0[2]) + dissipated + abs(supplied)
        return float(np.sum(now) + dissipated - supplied), float(exchanged)


def _state(memory: Memory) -> list[FloatArray]:
    """What of it a step changes but the counters."""
    vectors: tuple[Any, ...] = memory[:VECTORS]
    return [*vectors, memory.memo, memory.work]
