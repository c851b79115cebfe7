"""What sensors take from every step: a copy of some entries of the state vectors, made in the compiled loop.

A row of samples holds q of the entries, v of the entries, entries of an array in which batches leave what
they have measured (``System.measured``), accelerations, and forces out of balance of held unknowns, which are
reactions.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..arrays import FloatArray, IntArray
from ..batches import Batches, measure_all
from ..compiled import add_measured_work, does_something, formula, kernel, measure, take_measured_slopes
from ..contact.rubbed import RUBBED
from ..records import recorded
from ..system.core import residual
from ..system.system import System
from .rare import add_measured_work_of, knowing, take_measured_slopes_of


@recorded
class Sampling(NamedTuple):
    """Where the samples come from; all is empty without sensors."""

    unknowns: IntArray  # (k,) entries of q and v
    batches: Batches  # that measure, see ancf.compiled.measure
    measured: FloatArray  # (m,) shared with them
    entries: IntArray  # (j,) entries of measured
    moved: IntArray  # (m,) unknowns whose acceleration is taken
    pushed: IntArray  # (p,) held unknowns whose reaction is taken
    felt: FloatArray  # (2, size) accelerations and forces out of balance at the end of the step

    @property
    def width(self) -> int:
        """Numbers in a row of samples: 2 k + j + m + p."""
        return 2 * len(self.unknowns) + len(self.entries) + len(self.moved) + len(self.pushed)


class Output(NamedTuple):
    """Room for what a block of steps is to leave."""

    q: FloatArray  # (stored, size) states that are kept
    v: FloatArray
    work: FloatArray  # (stored, 2) energy dissipated and supplied, J
    samples: FloatArray  # (steps, width), or no rows where nothing is recorded

    @classmethod
    def of(cls, stored: int, size: int, steps: int, width: int) -> Output:
        """Room that is not filled yet."""
        q, v, work = (np.empty((stored, columns)) for columns in (size, size, 2))
        return cls(q, v, work, np.empty((steps, width)))


def sampling_of(system: System) -> Sampling:
    """Sampling of the sensors of a system."""
    listed = system.sensors
    batches = knowing(measure, system.measuring if len(listed.entries) else ())
    felt = np.zeros((2, system.size))
    return Sampling(listed.index, batches, system.measured, listed.entries, listed.moved, listed.pushed, felt)


@formula
def note(core: Any, s: Any, sampling: Any) -> None:
    """Leave accelerations and forces out of balance at the end of a step, before batches remember it."""
    for k in range(sampling.moved.shape[0]):
        sampling.felt[0, sampling.moved[k]] = s.a[sampling.moved[k]]
    if sampling.pushed.shape[0] > 0:
        residual(core.batches, core.ws, s.q, s.v, s.a, s.f, s.r)
        for i in range(s.a.shape[0]):
            sampling.felt[1, i] = s.r[i]


@kernel
def note_now(core: Any, s: Any, sampling: Any) -> None:
    """See :func:`note`."""
    note(core, s, sampling)


@kernel
def sample(sampling: Sampling, q: FloatArray, v: FloatArray, row: FloatArray) -> None:
    """Fill a row of samples, shape (width,), from the state q, v."""
    measure_all(sampling.batches, q, v)
    k = sampling.unknowns.shape[0]
    for i in range(k):
        row[i], row[k + i] = q[sampling.unknowns[i]], v[sampling.unknowns[i]]
    for i in range(sampling.entries.shape[0]):
        row[2 * k + i] = sampling.measured[sampling.entries[i]]
    k = 2 * k + sampling.entries.shape[0]
    for i in range(sampling.moved.shape[0]):
        row[k + i] = sampling.felt[0, sampling.moved[i]]
    k += sampling.moved.shape[0]
    for i in range(sampling.pushed.shape[0]):
        row[k + i] = sampling.felt[1, sampling.pushed[i]]


def resample(system: System, sampling: Sampling, q: FloatArray, v: FloatArray, row: FloatArray) -> None:
    """The same after batches have remembered the state: the friction that acted is what they remember."""
    acted = [(x, x[:, RUBBED:].copy()) for name, x in system.memory.items() if name.endswith(".found")]
    sample(sampling, q, v, row)
    for found, rubbed in acted:
        found[:, RUBBED:] = rubbed
    first = 2 * len(sampling.unknowns)
    row[first : first + len(sampling.entries)] = sampling.measured[sampling.entries]


@kernel
def sample_rows(sampling: Sampling, q: FloatArray, v: FloatArray, rows: FloatArray) -> None:
    """Fill rows of samples, shape (m, width), from states of shape (m, size)."""
    for n in range(rows.shape[0]):
        sample(sampling, q[n], v[n], rows[n])


@kernel
def sample_slopes(
    sampling: Sampling,
    q: FloatArray,
    v: FloatArray,
    d: FloatArray,
    n: int,
    near: float,
    places: FloatArray,
    room: FloatArray,
    row: FloatArray,
    out: FloatArray,
) -> None:
    """Add to rows of samples, (m, width), their derivatives along changes of states q, v of shape (m, size).

    Differences along s_q, then along s_v, which are d[:, 0] and d[:, 1], by so much that of the first n
    unknowns the one that changes most does by ``near``; ``places``, (k, 2): where they are taken, weights.
    ``room`` and ``row``, (2, size) and (width,), are workspace.
    """
    for m in range(q.shape[0]):
        for part in range(2):
            size = 0.0
            for i in range(n):
                size = max(size, abs(d[m, part, i]))
            e = near / size if size > 0.0 else 1.0
            for k in range(places.shape[0]):
                for i in range(q.shape[1]):
                    room[0, i], room[1, i] = q[m, i], v[m, i]
                    room[part, i] += places[k, 0] * e * d[m, part, i]
                sample(sampling, room[0], room[1], row)
                for i in range(row.shape[0]):
                    out[m, i] += places[k, 1] / e * row[i]


class Measured(NamedTuple):
    """Batches that know the slopes of what they measure, and where in ``measured`` they have it."""

    batches: Batches
    begin: IntArray  # (batches + 1,)
    slopes: FloatArray  # room


def measured_of(sampling: Sampling) -> Measured | None:
    """The batches of a sampling, or None if not all know these slopes."""
    own: tuple[Any, ...] = tuple(sampling.batches)
    if not all(does_something(type(batch), take_measured_slopes) for batch in own):
        return None
    places = [(batch.found.ctypes.data - sampling.measured.ctypes.data) // 8 for batch in own]
    ends = [place + batch.found.size for place, batch in zip(places, own, strict=True)]
    begin = np.array([*places, *ends[-1:]], dtype=np.int64)
    return Measured(knowing(take_measured_slopes, own), begin, np.zeros(len(sampling.measured)))


@kernel
def measured_slopes(
    known: Measured,
    entries: IntArray,
    q: FloatArray,
    v: FloatArray,
    d: FloatArray,
    first: int,
    out: FloatArray,
) -> None:
    """Add to rows of samples, from entry ``first`` on, what is measured, see :func:`sample_slopes`."""
    for m in range(q.shape[0]):
        for k in range(known.begin.shape[0] - 1):
            own = known.slopes[known.begin[k] : known.begin[k + 1]]
            take_measured_slopes_of(known.batches, k, q[m], v[m], d[m, 0], d[m, 1], own)
        for i in range(entries.shape[0]):
            out[m, first + i] += known.slopes[entries[i]]


class Meters(NamedTuple):
    """A batch that knows the slopes of what it measures the other way round."""

    batches: Batches


def meters_of(system: System, name: str) -> Meters:
    """The batch of a system of this name."""
    return Meters(knowing(add_measured_work, [system.parts[name]]))


@kernel
def measured_works(
    meters: Meters,
    q: FloatArray,
    v: FloatArray,
    weights: FloatArray,
    unknowns: IntArray,
    by: FloatArray,
    out: FloatArray,
) -> None:
    """Add the derivatives of weights (n, m) . measured by these entries of states (n, size) to out (n, 2, k).

    ``by``: (2, size), room of zeros.
    """
    for m in range(q.shape[0]):
        add_measured_work_of(meters.batches, 0, q[m], v[m], weights[m], by[0], by[1])
        for k in range(unknowns.shape[0]):
            for i in range(2):
                out[m, i, k] += by[i, unknowns[k]]
                by[i, unknowns[k]] = 0.0
