"""Blocks of steps of a run that an adjoint goes back through, and what they leave."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..solvers.checkpoint import Snapshot
from ..solvers.derivatives.sensitivity import places
from ..solvers.record import Stats
from ..system.system import System
from .follow import Trail
from .remembering import Row

#: Bytes of states up to which all are kept and no step is taken again, and those of a block; of one of
#: others, as snapshots are as large as some steps.
KEPT, BLOCK, LARGEST = 320e6, 16e6, 128e6


class Collector:
    """Recorder that keeps what a block leaves.

    Parameters
    ----------
    others : Recorder, optional
        Takes samples of sensors, the first state and the last one.
    """

    def __init__(self, others: Any = None) -> None:
        self.others = others
        self._last: tuple[FloatArray, ...] | None = None
        self.q: list[FloatArray] = []
        self.v: list[FloatArray] = []
        self.t: list[FloatArray] = []

    def append(self, t: FloatArray, q: FloatArray, v: FloatArray, work: FloatArray) -> None:
        """States."""
        if self.others is not None and len(t):
            if self._last is None:
                self.others.append(t[:1], q[:1], v[:1], work[:1])
            self._last = t[-1:].copy(), q[-1:].copy(), v[-1:].copy(), work[-1:].copy()
        self.t.append(t)
        self.q.append(q)
        self.v.append(v)

    def end(self) -> None:
        """Hand over the last state."""
        if self.others is not None and self._last is not None:
            self.others.append(*self._last)

    def record(self, t: FloatArray, samples: FloatArray) -> None:
        """Samples."""
        if self.others is not None:
            self.others.record(t, samples)

    def update(self, stats: Stats, status: str) -> None:
        """Nothing."""

    def due(self) -> bool:
        """Never."""
        return False

    def keep(self, snapshot: Snapshot) -> None:
        """Nothing."""

    def taken(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Times and states since the last time."""
        made = tuple(
            np.concatenate(parts) if len(parts) > 1 else parts[0] for parts in (self.t, self.q, self.v)
        )
        self.t, self.q, self.v = [], [], []
        return made  # type: ignore[return-value]


@dataclass(frozen=True)
class Kept:
    """What is kept of the states of a block: of positions perhaps those alone that velocities do not give.

    Parameters
    ----------
    q : (steps, size) or (steps, k)
    at : (k,) or none
        The columns that they are, if not all.
    before : (size,)
        Positions at the start of the block.
    v : (steps, size)
    trail : Trail
    end : (size,)
        Accelerations at its end.
    """

    q: FloatArray
    at: IntArray | None
    before: FloatArray
    v: FloatArray
    trail: Trail
    end: FloatArray

    def states(self, h: float, scheme: Any) -> tuple[FloatArray, FloatArray, Trail, FloatArray]:
        """Positions, velocities, what accelerations follow from, and the last of them."""
        if self.at is None:
            return self.q, self.v, self.trail, self.end
        steps, made = len(self.v), np.empty((len(self.v) + 1, self.v.shape[1]))
        made[0] = self.before
        v = np.concatenate([self.trail.before[:1], self.v])
        places(v, h, h, steps, scheme, self.trail.before[2].copy(), made)
        made[1:, self.at] = self.q
        return made[1:], self.v, self.trail, self.end


class Keeping:
    """Whether the states of a run are kept, all or as far as no others follow from them.

    Parameters
    ----------
    system : System
    steps : int
    remembers : bool
        What friction remembers follows from the states to the last bit.
    """

    def __init__(self, system: System, steps: int, remembers: bool) -> None:
        self.all = 24.0 * system.size * steps <= KEPT
        given = [system.held, system.multipliers, np.arange(system.n, system.size)]
        at = np.unique(np.concatenate(given)).astype(np.int64)
        few = 8.0 * (system.size + len(at)) * steps <= KEPT
        self.some = self.all or (few and not remembers)
        self.at = None if self.all else at

    def most(self, each: float, steps: int) -> int:
        """Steps of a block at most, of so many bytes each.

        With snapshots as many as there are blocks, as far as they have room.
        """
        most = BLOCK / each if self.all else min(LARGEST / each, max(16, np.sqrt(steps)))
        return max(1, min(int(most), steps))

    def keep(self, before: FloatArray, q: FloatArray, v: FloatArray, trail: Trail, end: FloatArray) -> Kept:
        """What is kept of a block that began at ``before``."""
        return Kept(q if self.at is None else q[:, self.at], self.at, before, v, trail, end)


@dataclass
class Block:
    """Steps ``done + 1`` to ``done + count`` of one length h, and where they begin.

    Of what is kept of them accelerations follow from velocities when they are asked for.
    """

    done: int
    count: int
    h: float
    snapshot: Snapshot | None
    kept: Kept | None = None
    memory: Row = field(default_factory=dict)  # what friction remembers where they begin
