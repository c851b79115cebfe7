"""Blocks of steps of a run that an adjoint goes back through, and what they leave."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..arrays import FloatArray
from ..solvers.checkpoint import Snapshot
from ..solvers.record import Stats
from .follow import Trail
from .remembering import Row


class Collector:
    """Recorder that keeps what a block leaves."""

    def __init__(self) -> None:
        self.q: list[FloatArray] = []
        self.v: list[FloatArray] = []
        self.t: list[FloatArray] = []

    def append(self, t: FloatArray, q: FloatArray, v: FloatArray, work: FloatArray) -> None:
        """States."""
        self.t.append(t)
        self.q.append(q)
        self.v.append(v)

    def record(self, t: FloatArray, samples: FloatArray) -> None:
        """Nothing."""

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


@dataclass
class Block:
    """Steps ``done + 1`` to ``done + count`` of one length h, and where they begin.

    Of what is kept of them accelerations follow from velocities when they are asked for.
    """

    done: int
    count: int
    h: float
    snapshot: Snapshot | None
    kept: tuple[FloatArray, FloatArray, Trail, FloatArray] | None = None  # q, v, and a at the end
    memory: Row = field(default_factory=dict)  # what friction remembers where they begin
