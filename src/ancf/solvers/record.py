"""What a run tells: states and samples to a recorder, counters, how far it is."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Protocol

from ..arrays import FloatArray
from .checkpoint import Snapshot
from .status import COUNTS


class Recorder(Protocol):
    """Takes the stored states block by block."""

    def append(self, t: FloatArray, q: FloatArray, v: FloatArray, work: FloatArray) -> None:
        """States at the times t, shape (m,), (m, size), (m, size), (m, 2)."""
        ...

    def record(self, t: FloatArray, samples: FloatArray) -> None:
        """What sensors take at the times t, shape (m,), (m, width); see :mod:`ancf.solvers.sampling`."""
        ...

    def update(self, stats: Stats, status: str) -> None:
        """Counters so far, and "running", "complete", "failed" or "interrupted"."""
        ...

    def due(self) -> bool:
        """Whether it is time for another snapshot."""
        ...

    def keep(self, snapshot: Snapshot) -> None:
        """Take a snapshot that goes with all that was appended and recorded so far."""
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
