"""A simulation by Radau steps: step control, outputs at uniform times, energies, failures."""

from __future__ import annotations

import time as clock
from collections.abc import Callable

import numpy as np

from ...arrays import FloatArray
from ...errors import SolveError
from ...model.integrators import Radau
from ...system.core import first_event, keep_memory
from ...system.energy import energies
from ...system.system import System
from .. import failures
from ..bridge import MOST_HALVINGS
from ..checkpoint import Snapshot, Watched, copies
from ..control import Control
from ..events import happen
from ..record import Progress, Recorder, Stats
from ..sampling import sampling_of
from ..span import Span
from ..start import consistent_start
from ..status import DIVERGED, NOT_FINITE, OK, SINGULAR
from ..stepping import BLOCK_SECONDS
from .method import Step, Stepper
from .output import SAME_TIME, RadauOutput
from .problem import SystemProblem

BLOCK_BYTES = 32e6  # of stored states, and of samples
#: Least step, in units of the last digit of the time: a load that jumps needs very small ones.
LEAST_STEP = 16.0
#: Error that Newton's method leaves when the steps are constant.
NEWTON_TOLERANCE = 1e-12
#: Share of it where the steps are chosen.
CLOSER = 0.1
#: Share of what is left of a run that a step may be short of and takes it all; from the second share on two
#: steps of one size are taken.
ALL, MORE_THAN_HALF = 0.99, 0.6
#: Share of what is left of a step of constant size above which a part of it is its last one.
LAST_PART = 0.999
#: Longest step, as a part of the run: what happens within a step is not seen.
LONGEST_STEP = 0.1
#: Share of constant steps that may need halving.
MOST_RETRIED = 0.2


class RadauRun(RadauOutput):
    """One simulation of a System; outputs at every ``every``-th multiple of ``step`` and at the end.

    Steps have sizes of their own.  Sensors are therefore recorded at every multiple of ``step``, where the
    state is interpolated as it is for the outputs; at the end of a step at which a sliding joint opens,
    closes or ends, both hold the state before that.
    """

    #: Steps whose error is controlled need no look at the energy.
    caution = ""

    def __init__(
        self,
        system: System,
        method: Radau,
        t_start: float,
        t_end: float,
        step: float,
        every: int,
    ) -> None:
        self.system, self.method, self.h, self.every = system, method, step, every
        self.t_start, self.t_end = t_start, t_end
        span = t_end - t_start
        self.steps = int(np.ceil(span / step - 1e-9))  # of the nominal size
        self.open = Span(t_start, t_end, step).open  # constant steps until which the end is not known
        self.watched = Watched(system)
        self.begun, self.between = False, False
        self.control: Control | None = None
        self.done, self.halved = 0, 0  # constant steps, and those of them that were halved
        digit = float(np.spacing(max(abs(t_start), abs(t_end))))
        self.shortest = LEAST_STEP * digit if method.min_step is None else method.min_step
        self.longest = max(LONGEST_STEP * span, step) if method.max_step is None else method.max_step
        self.problem = SystemProblem(system, t_start, t_end)
        newton = CLOSER * NEWTON_TOLERANCE if method.adaptive else NEWTON_TOLERANCE
        self.stepper = Stepper(self.problem, method.stages, method.tolerance, newton, span)
        self.seconds, self.work = 0.0, np.zeros(2)
        self.sampling = sampling_of(system)
        self.stored = self.sampled = 0  # outputs and samples so far, the start not counted
        self._buffer, self._samples = [], []
        self._solids = failures.solids(system)

    @property
    def stats(self) -> Stats:
        """Counters so far."""
        c = self.stepper.counts
        counts = (c.steps, c.newton_iterations, c.jacobians, c.factorizations, c.retries)
        return Stats.of(counts, self.seconds)

    def start(self, q: FloatArray, v: FloatArray) -> None:
        """Consistent state at t_start."""
        q, v, system = q.copy(), v.copy(), self.system
        first = system.inputs.tables(self.t_start - self.h, self.h, 1, self.t_start, self.t_end)
        a = consistent_start(system, q, v, first)
        system.level[:] = 1.0, 0.0, 0.0  # index 3
        self.problem.start(q, v)
        self.problem.step_size(self.h)
        free = self.problem.free
        self.stepper.start(self.t_start, q[free], v[free], a[free])
        self.next = max(min(self.h, self.longest), self.shortest)
        self._compile()

    def _compile(self) -> None:
        """Evaluate everything once, outside the CPU time of the run."""
        s, problem = self.stepper, self.problem
        for evaluate in (problem.residuals, problem.powers, problem.placed):
            evaluate(np.array([s.t]), s.q[None], s.v[None], s.a[None])

    def snapshot(self) -> Snapshot:
        """All that decides how the run goes on, copied."""
        values = {name: getattr(self, name) for name in KEPT} | {"stepper": self.stepper.values()}
        values |= {"spacing": self.problem.spacing, "inputs": dict(self.system.inputs.given)}
        if self.control is not None:
            values["controller"] = self.control.kept(self.done)
        own = copies({"work": self.work, "base": self.problem.base, "stepper": self.stepper.arrays()})
        return Snapshot(self.stepper.t, values, {**self.watched.changed(), **own})

    def restore(self, snapshot: Snapshot) -> None:
        """Go on from a snapshot, in place of :meth:`start`; see :class:`ancf.solvers.stepping.Run`."""
        pairs = self.watched.fitting({"work": self.work, "base": self.problem.base}, snapshot, KEPT)
        self.watched.restore(snapshot.arrays, pairs)
        for name, value in snapshot.values["inputs"].items():
            self.system.inputs.give(name, value)
        for name in KEPT:
            setattr(self, name, snapshot.values[name])
        self.problem.spacing = snapshot.values["spacing"]
        self.stepper.restore(snapshot.values["stepper"], snapshot.arrays)
        self.begun = True
        self._compile()
        self.watched.restore(snapshot.arrays, pairs)  # once more: forces and matrices were evaluated

    put_back = restore

    def go(self, recorder: Recorder, progress: Callable[[Progress], None] | None) -> None:
        """Take all steps that are left."""
        self._looked, self._cpu = clock.perf_counter(), clock.process_time()
        try:
            if not self.begun:
                self.begin(recorder)
            if self.method.adaptive:
                self._adaptive(recorder, progress)
            else:
                self._constant(recorder, progress)
        finally:
            self._flush(recorder)

    def begin(self, recorder: Recorder) -> None:
        """Store the start."""
        begin, (q, v) = np.array([self.t_start]), self.problem.base[:, None]
        if self.sampling.width:
            recorder.record(begin, self._sample(q, v))
        recorder.append(begin, q.copy(), v.copy(), self.work[None].copy())
        self.begun = self.between = True
        if recorder.due():
            recorder.keep(self.snapshot())

    def _adaptive(self, recorder: Recorder, progress: Callable[[Progress], None] | None) -> None:
        stepper, ends = self.stepper, False
        while stepper.t < self.t_end:
            left = self.t_end - stepper.t
            h = min(self.next, self.longest)
            size = left if h > ALL * left else min(h, 0.5 * left) if h > MORE_THAN_HALF * left else h
            if size != h and not ends:  # the last state that does not know the end
                self._leave(recorder)
                ends = True
            t_next = self.t_end if size == left else stepper.t + size
            self.between = False
            status, step = self._solve(size, True)
            if status != OK:
                stepper.failed()
                self.next = 0.5 * size
                self._check_size(self.next, _REASONS[status])
                continue
            error = stepper.error(step)
            self.next = stepper.next_size(size, error)
            if error >= 1.0:
                stepper.counts.retries += 1
                self._check_size(self.next, f"the error stays at {error:.3g} times the tolerance")
                continue
            self._accept(step, t_next)
            self.between = True
            self._look(recorder, progress, not ends)

    def _constant(self, recorder: Recorder, progress: Callable[[Progress], None] | None) -> None:
        while self.done < self.steps:
            if self.control is not None:
                self.control.ask(self.done)
            self._whole(recorder, progress)
            self._look(recorder, progress, self.done < self.open)
            if self.done == self.open:
                self._leave(recorder)

    def take(self, count: int, recorder: Recorder) -> None:
        """The next steps, all of the same length."""
        self._looked, self._cpu = clock.perf_counter(), clock.process_time()
        for _ in range(count):
            self._whole(recorder, None)
        self._flush(recorder)

    def now(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """State vectors q, v, and work dissipated and supplied."""
        s = self.stepper
        q, v, _ = self.problem.placed(np.array([s.t]), s.q[None], s.v[None], s.a[None])
        return q[0], v[0], self.work

    def _whole(self, recorder: Recorder, progress: Callable[[Progress], None] | None) -> None:
        """A step of constant size, in parts where it must be."""
        n = self.done
        end = self.t_end if n == self.steps - 1 else self.t_start + (n + 1) * self.h
        part = end - self.stepper.t
        if abs(part - self.h) < SAME_TIME * self.h:
            part = self.h  # round-off of the times must not renew the matrices
        again, whole = 0, part
        self.between = False
        while self.stepper.t < end:
            left = end - self.stepper.t
            last = part > LAST_PART * left
            status, step = self._solve(part, False)
            if status != OK:
                part *= 0.5
                if part < whole * 0.5**MOST_HALVINGS:
                    raise self._failure(_REASONS[status], part)
                self.halved += 1 - again
                self.stepper.counts.retries, again = self.halved, 1
                if self.halved > 2 + MOST_RETRIED * self.steps:
                    raise self._failure(f"{self.halved} of {n + 1} steps had to be halved", self.h)
                continue
            self._accept(step, end if last else self.stepper.t + part)
            self.stepper.counts.steps -= not last  # the parts count as one step
            if not last:
                self._look(recorder, progress, False)
        self.done += 1
        self.between = True

    def _solve(self, h: float, adaptive: bool) -> tuple[int, Step]:
        self.problem.step_size(h)
        return self.stepper.solve(h, adaptive)

    def _check_size(self, h: float, reason: str) -> None:
        if h < self.shortest:
            raise self._failure(reason, h)

    def _accept(self, step: Step, t: float) -> None:
        """Outputs and energies of a step.

        Raises
        ------
        SolveError
            A cross-section has collapsed or turned inside out at its end.
        """
        if len(self._solids):
            end, number = self._end(step, t)[0], self.stepper.counts.steps + 1
            failures.check_solids(self.system, self._solids, end, t, number, step.h)
        power = self.problem.powers(step.times, step.Q, step.V, step.A)
        self._output(step, t, power)
        self.work += step.h * (self.stepper.method.b @ power)
        self.stepper.accept(step, t)
        if self.system.core.remembering:
            keep_memory(self.system.core.remembering, *self._end(step, t))
        if self.system.core.joints.tail:
            self._look_at_joints(step, t)

    def _look(self, recorder: Recorder, progress: Callable[[Progress], None] | None, snapshots: bool) -> None:
        """Hand over what there is, now and then; with a snapshot where the state may be kept."""
        if clock.perf_counter() - self._looked <= BLOCK_SECONDS and self._bytes <= BLOCK_BYTES:
            return
        t = self.stepper.t
        self._flush(recorder)
        recorder.update(self.stats, "running")
        if snapshots and recorder.due():
            recorder.keep(self.snapshot())
        if progress is not None:
            done = self.steps if t >= self.t_end else int((t - self.t_start) / self.h * (1 + 1e-12))
            progress(Progress(done, self.steps, t, self.t_end))
        self._looked = clock.perf_counter()

    def _leave(self, recorder: Recorder) -> None:
        """A snapshot that goes with all that has been handed over."""
        self._flush(recorder)
        recorder.keep(self.snapshot())

    def stopped(self, recorder: Recorder) -> None:
        """Leave a snapshot where the run was stopped, if that was between two steps."""
        if self.between and (self.method.adaptive or self.done <= self.open):
            recorder.keep(self.snapshot())

    def _end(self, step: Step, t: float) -> tuple[FloatArray, FloatArray]:
        """State vectors at the end of a step."""
        q, v, _ = (x[0] for x in self.problem.placed(np.array([t]), step.Q[-1:], step.V[-1:], step.A[-1:]))
        return q, v

    def _look_at_joints(self, step: Step, t: float) -> None:
        """Start anew if something has happened to a sliding joint at the end of a step."""
        system, free = self.system, self.problem.free
        q, v = self._end(step, t)
        code = first_event(system.core.joints.tail, q)
        if code < 0:
            return
        before = float(energies(system, q[None], v[None]).sum())
        happen(system, q, v, int(code), f"t = {t:.6g} s, step {self.stepper.counts.steps}")
        tables = system.inputs.tables(t - self.h, self.h, 1, self.t_start, self.t_end)
        a = consistent_start(system, q, v, tables)
        system.level[:] = 1.0, 0.0, 0.0
        self.work[0] += before - float(energies(system, q[None], v[None]).sum())  # an impact
        self.problem.start(q, v)
        self.stepper.start(t, q[free], v[free], a[free])

    def _failure(self, reason: str, h: float) -> SolveError:
        s = self.stepper
        q, v, _ = self.now()
        if (error := failures.blamed(self.system, q, v, s.t, s.counts.steps + 1, max(h, self.h))) is not None:
            return error
        name = self.system.numbering.describe(int(self.problem.free[s.worst]))
        where = f"t = {s.t:.6g} s, step {s.counts.steps + 1}, {name}"
        what = f"{reason}; last correction {s.norm:.3g}, step {h:.3g} s"
        hint = "try a larger tolerance, more elements, some damping, or a smaller min_step if one is given"
        if not self.method.adaptive:
            hint = f"try a step of {self.h / 10:.2g} s or less, adaptive=True, or more elements"
        return SolveError(where, what, hint)


#: Of the run: numbers of which a snapshot has the values.
KEPT = ("done", "halved", "stored", "sampled", "next", "seconds", "longest")
_REASONS = {
    DIVERGED: "Newton's method did not converge, also with new matrices and smaller steps",
    NOT_FINITE: "the forces are no longer finite, also with smaller steps",
    SINGULAR: "the iteration matrix is singular",
}
