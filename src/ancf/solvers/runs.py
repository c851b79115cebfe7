"""From an integrator's settings to the run that carries it out."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Protocol, cast

from ..arrays import FloatArray
from ..model.integrators import Integrator
from ..system.system import System
from .checkpoint import Snapshot
from .control import Control
from .record import Progress, Recorder, Stats


class AnyRun(Protocol):
    """One simulation of a System."""

    begun: bool  # the start has been handed over
    done: int  # steps of one length
    h: float  # their length, s
    t_start: float
    control: Control | None  # asked between steps

    @property
    def stats(self) -> Stats:
        """Counters so far."""
        ...

    @property
    def caution(self) -> str:
        """What to tell who did not ask, when the run is complete; "": nothing."""
        ...

    def start(self, q: FloatArray, v: FloatArray) -> None:
        """Consistent state at the start time."""
        ...

    def restore(self, snapshot: Snapshot) -> None:
        """Go on from a snapshot, in place of :meth:`start`."""
        ...

    def put_back(self, snapshot: Snapshot) -> None:
        """Be as when a snapshot of this run, or of one that is made alike, was taken."""
        ...

    def go(self, recorder: Recorder, progress: Callable[[Progress], None] | None) -> None:
        """Take all steps that are left."""
        ...

    def begin(self, recorder: Recorder) -> None:
        """Hand over the start."""
        ...

    def snapshot(self) -> Snapshot:
        """All that decides how the run goes on."""
        ...

    def take(self, count: int, recorder: Recorder) -> None:
        """The next steps of one length."""
        ...

    def now(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """State vectors q, v, and work dissipated and supplied."""
        ...

    def stopped(self, recorder: Recorder) -> None:
        """Leave a snapshot where the run was stopped, if that was between two steps."""
        ...


def run_of(
    method: Integrator, system: System, t_start: float, t_end: float, step: float, every: int
) -> AnyRun:
    """Run of a System from t_start to t_end, s, with output every ``every`` steps."""
    module, _, name = method.runner.partition(":")
    kind = getattr(import_module(f".{module}", __package__), name)
    return cast(AnyRun, kind(system, method, t_start, t_end, step, every))
