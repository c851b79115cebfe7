"""Time stepping: compiled blocks of steps, retries with smaller steps, outputs to a recorder."""

from __future__ import annotations

import time as clock
from collections.abc import Callable
from functools import cached_property
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..errors import ModelError, SolveError
from ..model.integrators import Integrator
from ..records import place
from ..system.consistency import open_contacts
from ..system.core import Core, Tables, first_event
from ..system.energy import energies
from ..system.system import System
from . import failures
from .apart import Apart
from .block import implicit_block, kernels_of
from .bridge import Bridge
from .checkpoint import Snapshot, Watched, copies
from .control import Control
from .events import happen
from .formulations import FORMULATIONS
from .newmark import Rule
from .quick import Direct, Implicit, shared
from .record import Progress, Recorder, Stats
from .sampling import Output, note_now, resample, sampling_of
from .sleeping.asleep import Asleep
from .span import Span
from .start import consistent_start
from .status import EVENT, INVERTED, OK, SLOW, TURN
from .step.balance import begin_account
from .step.corotation import flies, turning_nodes
from .step.corrections import UNLIMITED
from .step.low_rank import room_for_patches
from .step.memory import H_FACTOR, H_PREV, KNOWN, WORST, Memory, allocate
from .step.scheme import Scheme

BLOCK_SECONDS = 0.1  # between two looks at the keyboard, the progress and the file
#: So many times longer than telling what a block has done take its steps, but so many seconds at most.
WORTH, LONGEST_BLOCK = 9.0, 0.5
BLOCK_BYTES = 32e6  # of stored states, and of samples
#: Steps before the first look at the energy, the factor by which the next ones are further apart, and how
#: far at most: so many steps, and so many unknowns times steps.  A look costs as much as a few steps.
FIRST_LOOK, NEXT_LOOK, FAR_LOOK, WIDE_LOOK = 8, 4, 64, 2**17
MOST_MADE = 0.5  # energy from nowhere, as a share of the energy exchanged


class Run(Asleep):
    """One simulation of a System from t_start to t_end with output every ``every`` steps."""

    #: Numbers of which a snapshot has the values, besides the arrays of the memory and of the system.
    KEPT: tuple[str, ...] = ("done", "look", "apart", "seconds", "astray", "exchanged")

    explicit = False

    def __init__(
        self,
        system: System,
        integrator: Integrator,
        t_start: float,
        t_end: float,
        step: float,
        every: int,
    ) -> None:
        self.system, self.h, self.every = system, step, every
        self.t_start, self.t_end = t_start, t_end
        self.span = Span(t_start, t_end, step)
        self.full, self.rest, self.steps = self.span.full, self.span.rest, self.span.steps
        self.watched = Watched(system)
        self.begun, self.between = False, False  # the start is stored; all until `done` is, and nothing else
        self.done, self.apart = 0, FIRST_LOOK
        self.look = FIRST_LOOK if system.core.accounted else self.steps
        self.control: Control | None = None
        self.use(integrator)
        self.memory: Memory = allocate(system.size, turning_nodes(system, step), room_for_patches(system))
        self.sampling = sampling_of(system)
        self.bridge = Bridge(self)
        self.tabled: Tables | None = None  # what is left of a block's after parts of a line have turned
        self.seconds = 0.0
        self.astray = self.exchanged = 0.0  # largest so far, J: energy that does not add up, and all of it

    def use(self, integrator: Any) -> None:
        """Take what the steps need from the settings of a method of the Newmark family."""
        self.scheme = Scheme(*integrator.coefficients())
        self.rules: dict[tuple[float, int, int, float], Rule] = {}
        n = integrator.newton
        corotate = n.corotate and not flies(self.system)
        self.newton = (n.tolerance, n.contraction, n.max_iterations, n.modified, corotate)
        self.formulation = FORMULATIONS[integrator.formulation]

    def rule(self, h: float, first: int = 0, last: int = 0, furthest: float = UNLIMITED) -> Rule:
        """Newton's rule, the formulation of the constraints for a step h and which attempts to make."""
        asked = h, first, last, furthest
        if asked not in self.rules:
            weights = self.formulation.weights(*self.scheme.of(h), h)
            self.rules[asked] = Rule(*self.newton, *weights, self.formulation.projects, furthest, first, last)
        return self.rules[asked]

    @property
    def stats(self) -> Stats:
        """Counters so far."""
        return Stats.of(self.memory.counts, self.seconds)

    def start(self, q: FloatArray, v: FloatArray) -> None:
        """Consistent state at t_start."""
        m, system = self.memory, self.system
        m.q[:], m.v[:] = q, v
        open_contacts(system, m.q)
        first = self._restart(self.t_start)
        for _ in range(len(system.numbering.sliding)):  # a contact may be pulled open from the start
            code = first_event(system.core.joints.tail, m.q)
            if code < 0:
                break
            self.happened(int(code), self.t_start, 0)
        self.energy0 = energies(system, m.q[None], m.v[None])[0]
        self._compile(first)

    def _compile(self, tables: Tables) -> None:
        """No steps yet: this compiles, outside the CPU time of the run."""
        if self.kernels and getattr(implicit_block, "overloads", None):  # one for all models
            return
        none, nothing = np.zeros(0, dtype=np.int64), self.room(0, 0)
        self.block(self.system.core, tables, self.h, self.rule(self.h), none, nothing)

    def block(
        self, core: Core, tables: Tables, h: float, rule: Rule, row: NDArray[np.int64], out: Output
    ) -> tuple[int, int]:
        """Steps of a length h with a rule of Newton's: how many were done, and the status of the last one."""
        steps, apart = self.kernels
        where, how = (place(core), place(self.memory)), (place(self.scheme), place(rule))
        n, status = implicit_block(
            steps, *where, tables, h, *how, row, place(self.sampling), out, place(apart)
        )
        return n, status

    def snapshot(self) -> Snapshot:
        """All that decides how the run goes on, copied; of a line as if no part of it slept, and which do."""
        values = {name: getattr(self, name) for name in self.KEPT}
        values |= {"parts": self.bridge.parts, "inputs": dict(self.system.inputs.given)}
        if self.far is not None:
            values["sleep"] = self.far.sleepers()
        if self.control is not None:
            values["controller"] = self.control.kept(self.done)
        with self.awake():
            own = copies({"memory": self.memory, "energy0": self.energy0})
            return Snapshot(self.time(self.done), values, {**self.watched.changed(), **own})

    def restore(self, snapshot: Snapshot) -> None:
        """Go on from a snapshot, in place of :meth:`start`.

        Raises
        ------
        ModelError
            It is of another model, or another method.
        """
        self.energy0 = np.zeros(3)
        self._compile(self.system.inputs.tables(snapshot.t - self.h, self.h, 1, self.t_start, self.t_end))
        self.put_back(snapshot)

    def put_back(self, snapshot: Snapshot) -> None:
        """Be as when a snapshot was taken; one that does not fit is an error, and nothing has changed."""
        pairs = self.watched.fitting({"memory": self.memory, "energy0": self.energy0}, snapshot, self.KEPT)
        if self.far is not None:
            self.far.wake_all()
        self.watched.restore(snapshot.arrays, pairs)
        if self.far is not None:
            self.far.put_back(snapshot.values.get("sleep", {}))
        for name in self.KEPT:
            setattr(self, name, snapshot.values[name])
        self.bridge.parts = snapshot.values["parts"]
        for name, value in snapshot.values["inputs"].items():
            self.system.inputs.give(name, value)
        self.begun = True

    def _restart(self, t: float) -> Tables:
        """Consistent velocities, accelerations and multipliers at t; the memory of earlier steps is lost."""
        m, system = self.memory, self.system
        now = system.inputs.tables(t - self.h, self.h, 1, self.t_start, self.t_end, (m.q, m.v), still=True)
        m.a[:] = consistent_start(system, m.q, m.v, now, m.f)
        m.abar[:] = m.a
        m.memo[H_FACTOR] = m.memo[H_PREV] = m.memo[KNOWN] = 0.0
        begin_account(system.core, m)
        return now

    def go(self, recorder: Recorder, progress: Callable[[Progress], None] | None) -> None:
        """Take all steps.

        How many make a block follows the clock, so that the keyboard, the progress and the file are looked
        at in time.  Nothing that is computed or said may depend on that: states, samples and the energy
        are judged at numbers of steps that the model alone decides.
        """
        if not self.begun:
            self.begin(recorder)
        size = FIRST_LOOK
        most = max(1, int(BLOCK_BYTES / (16 * self.system.size + 8 * self.every * self.sampling.width)))
        while self.done < self.steps:
            count = min(size, most * self.every, self.look - self.done, self.span.room(self.done))
            if self.control is not None:
                count = min(count, self.control.ask(self.done))
            before, stepped = clock.perf_counter(), self.seconds
            self.take(count, recorder)
            self._tell(recorder)
            if progress is not None:
                progress(Progress(self.done, self.steps, self.time(self.done), self.t_end))
            seconds, stepped = clock.perf_counter() - before, self.seconds - stepped
            size = max(1, min(int(count * _worth(seconds - stepped) / max(stepped, 1e-6)), 4 * size))

    def take(self, count: int, recorder: Recorder) -> None:
        """The next steps, no further than to the next look at the energy or the end of the whole steps."""
        self.between = False
        self._block(self.done, count, recorder)
        self.done += count
        self.heed_energy()
        self.between = True

    def heed_energy(self) -> None:
        """Look at the energy after some numbers of steps, which the model alone decides."""
        if self.done in (self.look, self.steps):
            self._check_energy(self.done)
            self.apart = min(NEXT_LOOK * self.apart, FAR_LOOK + WIDE_LOOK // self.system.size)
            self.look += self.apart

    def begin(self, recorder: Recorder) -> None:
        """Store the start."""
        begin, out = np.array([self.t_start]), self.room(1, 1)
        self.store(0, 0, out)
        if self.sampling.width:
            recorder.record(begin, out.samples)
        recorder.append(begin, out.q, out.v, out.work)
        self.begun = self.between = True
        if recorder.due():
            recorder.keep(self.snapshot())

    def _tell(self, recorder: Recorder) -> None:
        """Counters and, now and then, what a run can go on from; nothing of that may know the end."""
        recorder.update(self.stats, "running")
        if self.done == self.span.open or (self.done < self.span.open and recorder.due()):
            recorder.keep(self.snapshot())

    def stopped(self, recorder: Recorder) -> None:
        """Leave a snapshot where the run was stopped, if that was between two steps."""
        if self.between and self.done <= self.span.open:
            recorder.keep(self.snapshot())

    def time(self, done: int) -> float:
        """Time after so many steps, s."""
        return self.t_start + done * self.h if done < self.steps else self.t_end

    def times(self, done: NDArray[np.int64]) -> FloatArray:
        """The same after some numbers of steps."""
        return np.where(done < self.steps, self.t_start + done * self.h, self.t_end)

    def _block(self, done: int, count: int, recorder: Recorder) -> None:
        """Steps done + 1 ... done + count; a failed one is bridged by smaller steps."""
        h = self.h if done < self.full else self.rest
        kept = self.kept(done, count)
        row = np.full(count, -1)
        row[kept - (done + 1)] = np.arange(len(kept))
        out = self.room(len(kept), count)
        cpu = clock.process_time()
        first, most, self.tabled = 0, count, None
        try:
            while first < count:
                t = self.time(done + first)
                try:
                    rest = out._replace(samples=out.samples[first:])
                    n, status = self._advance(t, h, row[first : first + most], rest)
                except ModelError:  # a function of time failed: go as far as it works
                    if most == 1:
                        raise
                    most = 1
                    continue
                first += n
                if status >= EVENT:
                    self.happened(status - EVENT, self.time(done + first), done + first)
                    self.store(row[first - 1], first - 1, out)
                elif status == TURN:
                    self.turn()
                elif status != OK:
                    self.bridged(self.time(done + first), h, done + first + 1, status)
                    self.store(row[first], first, out, self.bridge.sample)
                    first += 1
        finally:
            self.seconds += clock.process_time() - cpu
            if self.sampling.width:
                recorder.record(self.times(np.arange(done + 1, done + first + 1)), out.samples[:first])
            times = self.times(kept[kept <= done + first])
            stored = len(times)
            recorder.append(times, out.q[:stored], out.v[:stored], out.work[:stored])

    def kept(self, done: int, count: int) -> NDArray[np.int64]:
        """Numbers of the steps done + 1 ... done + count whose states are stored."""
        last = done + count
        found = np.arange((done // self.every + 1) * self.every, last + 1, self.every)
        return np.append(found, last) if last == self.steps and last % self.every else found

    def store(self, k: int, n: int, out: Output, sample: FloatArray | None = None) -> None:
        """The state now as row k of the outputs, -1: not wanted, and its samples as row n of theirs.

        ``sample``: those that were taken at the end of the step, before friction was renewed.
        """
        m = self.memory
        if k >= 0:
            out.q[k], out.v[k], out.work[k] = m.q, m.v, m.work
        if sample is not None:
            out.samples[n] = sample
        elif self.sampling.width:
            note_now(self.system.core, m, self.sampling)
            resample(self.system, self.sampling, m.q, m.v, out.samples[n])

    def _advance(self, t: float, h: float, row: NDArray[np.int64], out: Output) -> tuple[int, int]:
        if self.hesitates:
            return 0, SLOW
        tables, here = self.tabled, (self.memory.q, self.memory.v)
        if tables is None or len(tables.value) != len(row):
            tables = self.system.inputs.tables(t, h, len(row), self.t_start, self.t_end, here)
        n, status = self.block(self.system.core, tables, h, self.rule(h), row, out)
        self.tabled = Tables(*(x[n:] for x in tables)) if status == TURN else None
        return n, status

    @cached_property
    def kernels(self) -> tuple[int, Apart]:
        """Addresses of what takes the steps, and of what these call."""
        return kernels_of(self.system.core, self.memory, self.sampling, self.explicit)

    @property
    def hesitates(self) -> bool:
        """Whether the next step is one after a start, perhaps with a jump, which is taken with care."""
        return bool(self.memory.memo[KNOWN] == 0.0 and self.system.core.damped)

    def bundle(self, rows: int) -> Implicit | Direct:
        """All that steps one by one take, with room for so many of them."""
        return Implicit(**shared(self, rows), scheme=self.scheme, rule=self.rule(self.h))

    def stop(self, t: float, number: int, status: int, h: float) -> NoReturn:
        """Step ``number`` of length h fails for good at t.

        Raises
        ------
        SolveError
            Always.
        """
        m = self.memory
        if (error := failures.blamed(self.system, m.q, m.v, t, number, h)) is not None:
            raise error
        self._check_energy(number - 1)  # if energy came from nowhere, that is the reason
        if status == INVERTED:
            raise failures.collapsed(self.system, int(m.memo[WORST]), t, number, h)
        raise self._failure(t, number, failures.REASONS[status], h)

    def happened(self, code: int, t: float, number: int) -> None:
        """What has happened to a sliding joint at the end of a step, and a new start from there."""
        m = self.memory
        before = float(energies(self.system, m.q[None], m.v[None]).sum())
        happen(self.system, m.q, m.v, code, f"t = {t:.6g} s, step {number}")
        self._restart(t)
        m.work[0] += before - float(energies(self.system, m.q[None], m.v[None]).sum())  # an impact

    def room(self, stored: int, steps: int) -> Output:
        """Room for so many stored states and so many steps with samples."""
        return Output.of(stored, self.system.size, steps, self.sampling.width)

    def _check_energy(self, done: int) -> None:
        """A step that is far too large can converge to nonsense: it makes energy from nothing."""
        m = self.memory
        if not self.system.core.accounted:
            return
        now = energies(self.system, m.q[None], m.v[None])[0]
        dissipated, supplied = m.work
        made = float(np.sum(now - self.energy0) + dissipated - supplied)
        exchanged = float(now[0] + now[1] + abs(now[2] - self.energy0[2]) + dissipated + abs(supplied))
        self.exchanged = max(self.exchanged, exchanged)
        self.astray = max(self.astray, abs(made) if self.keeps_energy else made)
        if made > MOST_MADE * exchanged and made > MOST_MADE * exchanged + self.round_off():
            m.memo[WORST] = float(np.argmax(np.abs(m.v[: self.system.n]) * self.system.core.weight))
            raise self._failure(self.time(done), done, f"{made:.3g} J came from nowhere", self.h)

    @property
    def keeps_energy(self) -> bool:
        """Whether the method itself takes nothing out."""
        return self.scheme.gamma <= 0.5

    def _failure(self, t: float, number: int, reason: str, h: float) -> SolveError:
        return failures.failed(self.system, self.memory.memo, t, number, reason, h)


def _worth(told: float) -> float:
    """Seconds of steps that the next block should have, when to tell what the last one did took `told`."""
    return max(BLOCK_SECONDS, min(WORTH * told, LONGEST_BLOCK))
