"""States and samples of a run by Radau steps: interpolated within the steps, at uniform times."""

from __future__ import annotations

import time as clock

import numpy as np

from ...arrays import FloatArray, IntArray
from ..record import Recorder
from ..sampling import Sampling, sample_rows
from .method import Step, Stepper
from .problem import SystemProblem

#: Times of samples at which whole states are interpolated at once.
AT_ONCE = 64
#: Part of a step by which times differ that are the same.
SAME_TIME = 1e-9


class RadauOutput:
    """Part of :class:`ancf.solvers.radau.run.RadauRun`: what it stores."""

    problem: SystemProblem
    stepper: Stepper
    sampling: Sampling
    h: float
    t_start: float
    t_end: float
    steps: int
    every: int
    stored: int
    sampled: int
    seconds: float
    work: FloatArray
    _cpu: float
    _buffer: list[tuple[FloatArray, ...]]
    _samples: list[tuple[FloatArray, FloatArray]]

    def _output(self, step: Step, t: float, power: FloatArray) -> None:
        """States at the output times of a step that ends at t."""
        number, times = self._grid(self.every, self.stored, t)
        states = None
        if len(number):
            tau = self._places(step, t, times)
            states = self._states(step, times, tau)
            once = self.stepper.method.integrals(tau)[1]
            self._buffer.append((times, *states, self.work + step.h * (once @ power)))
            self.stored = int(number[-1])
        if self.sampling.width:
            self._record(step, t, number, states)

    def _grid(self, every: int, done: int, t: float) -> tuple[IntArray, FloatArray]:
        """Numbers after ``done`` and times until t of the multiples of every ``every``-th step."""
        last = -(-self.steps // every)  # number of the last one
        near = int((t - self.t_start) / (every * self.h) * (1 + 1e-12) + 1e-9)
        number = np.arange(done + 1, (last if t >= self.t_end else min(near, last - 1)) + 1)
        return number, np.where(number == last, self.t_end, self.t_start + number * every * self.h)

    def _places(self, step: Step, t: float, times: FloatArray) -> FloatArray:
        """Where times are in a step that ends at t, 0 to 1."""
        tau: FloatArray = np.minimum((times - step.t) / step.h, 1.0)
        tau[np.abs(times - t) < SAME_TIME * step.h] = 1.0
        return tau

    def _states(self, step: Step, times: FloatArray, tau: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Interpolated states."""
        q, v, a = step.at(tau)
        q[tau == 1.0], v[tau == 1.0], a[tau == 1.0] = step.Q[-1], step.V[-1], step.A[-1]
        q, v, _ = self.problem.placed(times, q, v, a)
        return q, v

    def _record(
        self, step: Step, t: float, outputs: IntArray, states: tuple[FloatArray, FloatArray] | None
    ) -> None:
        """Samples of a step that ends at t; at the outputs those of their states, to the last bit."""
        number, times = self._grid(1, self.sampled, t)
        if len(number) == 0:
            return
        tau = self._places(step, t, times)
        rows = []
        for k in range(0, len(number), AT_ONCE):
            part = slice(k, k + AT_ONCE)
            rows.append(self._sample(*self._states(step, times[part], tau[part])))
        samples = np.concatenate(rows)
        if states is not None:
            samples[np.minimum(outputs * self.every, self.steps) - number[0]] = self._sample(*states)
        self._samples.append((times, samples))
        self.sampled = int(number[-1])

    def _sample(self, q: FloatArray, v: FloatArray) -> FloatArray:
        samples = np.empty((len(q), self.sampling.width))
        sample_rows(self.sampling, q, v, samples)
        return samples

    @property
    def _bytes(self) -> int:
        return sum(2 * q.nbytes for _, q, _, _ in self._buffer) + sum(x.nbytes for _, x in self._samples)

    def _flush(self, recorder: Recorder) -> None:
        now = clock.process_time()
        self.seconds += now - self._cpu
        self._cpu = now
        if self._samples:
            recorder.record(*(np.concatenate(c) for c in zip(*self._samples, strict=True)))
            self._samples = []
        if self._buffer:
            recorder.append(*(np.concatenate(c) for c in zip(*self._buffer, strict=True)))
            self._buffer = []
