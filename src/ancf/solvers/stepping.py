"""Time stepping: compiled blocks of steps, retries with smaller steps, outputs to a recorder."""

from __future__ import annotations

import time as clock
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ..errors import ModelError, SolveError
from ..system.core import apply_load
from ..system.energy import energies
from ..system.system import System
from . import frames
from .integrators.base import Integrator
from .newmark import (
    COUNTS,
    NORM,
    OK,
    RETRIES,
    SINGULAR,
    STEPS,
    WORST,
    Memory,
    Rule,
    advance,
    allocate,
    balance,
)
from .start import initial_acceleration

FloatArray = NDArray[np.float64]

BLOCK_SECONDS = 0.1  # between two looks at the keyboard, the progress and the file
BLOCK_BYTES = 32e6  # of stored states
MOST_HALVINGS = 10
MOST_MADE = 0.5  # energy from nowhere, as a share of the energy exchanged
MOST_RETRIED = 0.2  # share of steps that may need halving


class Recorder(Protocol):
    """Takes the stored states block by block."""

    def append(self, t: FloatArray, q: FloatArray, v: FloatArray, work: FloatArray) -> None:
        """States at the times t, shape (m,), (m, size), (m, size), (m, 2)."""
        ...

    def update(self, stats: Stats, status: str) -> None:
        """Counters so far, and "running", "complete", "failed" or "interrupted"."""
        ...


@dataclass(frozen=True)
class Stats:
    """What a run cost."""

    steps: int = 0
    newton_iterations: int = 0
    jacobians: int = 0
    factorizations: int = 0
    retries: int = 0
    cpu_seconds: float = 0.0

    @classmethod
    def of(cls, counts: Iterable[float], cpu_seconds: float) -> Stats:
        """From counters in the order of COUNTS."""
        values: dict[str, Any] = dict(zip(COUNTS, (int(c) for c in counts), strict=True))
        return cls(**values, cpu_seconds=cpu_seconds)

    def as_dict(self) -> dict[str, float]:
        """Counters by name."""
        return {name: getattr(self, name) for name in (*COUNTS, "cpu_seconds")}


@dataclass(frozen=True)
class Progress:
    """How far a run has got."""

    step: int
    steps: int
    t: float
    t_end: float


class Run:
    """One simulation of a System from t_start to t_end with output every ``every`` steps."""

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
        span = t_end - t_start
        self.full = int(np.floor(span / step + 1e-9))
        rest = span - self.full * step
        self.rest = rest if rest > 1e-9 * step else 0.0
        self.steps = self.full + (self.rest > 0.0)
        self.scheme = integrator.scheme()
        n = integrator.newton
        self.rule = Rule(n.tolerance, n.contraction, n.max_iterations, n.modified, n.corotate)
        held = system.core.supports.held
        self.memory: Memory = allocate(
            system.size, frames.allocate(list(system.numbering.slots.values()), held)
        )
        self.seconds = 0.0

    @property
    def stats(self) -> Stats:
        """Counters so far."""
        return Stats.of(self.memory.counts, self.seconds)

    def start(self, q: FloatArray, v: FloatArray) -> None:
        """Consistent state at t_start."""
        m, system = self.memory, self.system
        m.q[:], m.v[:] = q, v
        first = system.drive.tables(self.t_start - self.h, self.h, 1, self.t_start, self.t_end)
        m.a[:] = initial_acceleration(system, m.q, m.v, first)
        m.abar[:] = m.a
        apply_load(system.core.loads, first.load[0], m.f)
        balance(system.core, m, 0.0)
        self.energy0 = energies(system, m.q[None], m.v[None])[0]
        none = np.zeros(0, dtype=np.int64)  # no steps yet: this compiles, outside the CPU time of the run
        advance(system.core, m, first, self.h, self.scheme, self.rule, none, *self._nothing())

    def go(self, recorder: Recorder, progress: Callable[[Progress], None] | None) -> None:
        """Take all steps."""
        m = self.memory
        recorder.append(np.array([self.t_start]), m.q[None].copy(), m.v[None].copy(), m.work[None].copy())
        done, size = 0, 8
        most = max(1, int(BLOCK_BYTES / (16 * len(m.q)))) * self.every
        while done < self.steps:
            count = min(size, most, (self.full if done < self.full else self.steps) - done)
            begin = clock.perf_counter()
            self._block(done, count, recorder)
            done += count
            self._check_energy(done)
            seconds = clock.perf_counter() - begin
            size = int(np.clip(count * BLOCK_SECONDS / max(seconds, 1e-6), 1, 4 * size))
            recorder.update(self.stats, "running")
            if progress is not None:
                progress(Progress(done, self.steps, self._time(done), self.t_end))

    def _time(self, done: int) -> float:
        return self.t_start + done * self.h if done < self.steps else self.t_end

    def _block(self, done: int, count: int, recorder: Recorder) -> None:
        """Steps done + 1 ... done + count; a failed one is bridged by smaller steps."""
        h = self.h if done < self.full else self.rest
        number = np.arange(done + 1, done + count + 1)
        keep = (number % self.every == 0) | (number == self.steps)
        row = np.where(keep, np.cumsum(keep) - 1, -1)
        size = self.system.size
        q, v, work = (np.empty((int(keep.sum()), k)) for k in (size, size, 2))
        cpu = clock.process_time()
        first, most = 0, count
        try:
            while first < count:
                t = self._time(done + first)
                try:
                    n, status = self._advance(t, h, row[first : first + most], (q, v, work))
                except ModelError:  # a function of time failed: go as far as it works
                    if most == 1:
                        raise
                    most = 1
                    continue
                first += n
                if status != OK:
                    self._bridge(self._time(done + first), h, done + first + 1)
                    if row[first] >= 0:
                        k, m = row[first], self.memory
                        q[k], v[k], work[k] = m.q, m.v, m.work
                    first += 1
        finally:
            self.seconds += clock.process_time() - cpu
            stored = int(keep[:first].sum())
            times = np.array([self._time(int(k)) for k in number[keep]])
            recorder.append(times[:stored], q[:stored], v[:stored], work[:stored])

    def _advance(
        self, t: float, h: float, row: NDArray[np.int64], out: tuple[FloatArray, FloatArray, FloatArray]
    ) -> tuple[int, int]:
        tables = self.system.drive.tables(t, h, len(row), self.t_start, self.t_end)
        n, status = advance(self.system.core, self.memory, tables, h, self.scheme, self.rule, row, *out)
        return int(n), int(status)

    def _bridge(self, t: float, h: float, number: int) -> None:
        """Step ``number`` from t to t + h in two, four, ... parts."""
        m = self.memory
        m.counts[RETRIES] += 1
        halved, done = int(m.counts[RETRIES]), int(m.counts[STEPS])
        if halved > 2 + MOST_RETRIED * self.steps or (halved > 20 and halved > MOST_RETRIED * done):
            raise self._failure(t, number, f"{halved} of {done + 1} steps had to be halved", h)
        nothing = self._nothing()
        left, part = h, h
        while left > 1e-9 * h:
            _, status = self._advance(t + h - left, part, np.full(1, -1), nothing)
            if status == OK:
                left -= part
                m.counts[STEPS] -= 1  # the parts count as one step
                continue
            part *= 0.5
            if part < h * 0.5**MOST_HALVINGS:
                raise self._failure(t + h - left, number, _REASONS[status], h)
        m.counts[STEPS] += 1

    def _nothing(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Room for no output."""
        size = self.system.size
        return np.empty((0, size)), np.empty((0, size)), np.empty((0, 2))

    def _check_energy(self, done: int) -> None:
        """A step that is far too large can converge to nonsense: it makes energy from nothing."""
        m = self.memory
        now = energies(self.system, m.q[None], m.v[None])[0]
        dissipated, supplied = m.work
        made = float(np.sum(now - self.energy0) + dissipated - supplied)
        exchanged = float(now[0] + now[1] + abs(now[2] - self.energy0[2]) + dissipated + abs(supplied))
        stiff = sum(b.section.EA * b.length for b in self.system.model.bodies.values())  # energy of strain 1
        if made > MOST_MADE * exchanged + 1e-9 * float(np.sum(np.abs(self.energy0))) + 1e-10 * stiff:
            m.memo[WORST] = float(np.argmax(np.abs(m.v[: self.system.n]) * self.system.core.weight))
            raise self._failure(self._time(done), done, f"{made:.3g} J came from nowhere", self.h)

    def _failure(self, t: float, number: int, reason: str, h: float) -> SolveError:
        unknown = int(self.memory.memo[WORST])
        where = f"t = {t:.6g} s, step {number}, {self.system.numbering.describe(unknown)}"
        norm = self.memory.memo[NORM]
        what = f"{reason}; last correction {norm:.3g}, step {h:g} s"
        hint = f"try a step of {h / 10:.2g} s or less, GeneralizedAlpha, more elements, or some damping"
        return SolveError(where, what, hint)


_REASONS = {
    1: "Newton's method diverged, also with full Jacobians and smaller steps",
    2: "the forces are no longer finite, also with smaller steps",
    SINGULAR: "the iteration matrix is singular",
    4: "Newton's method did not converge, also with full Jacobians and smaller steps",
}
