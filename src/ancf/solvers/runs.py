"""From an integrator's settings to the run that carries it out."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Protocol, cast

from ..arrays import FloatArray
from ..model.integrators import Integrator
from ..system.system import System
from .record import Progress, Recorder, Stats


class AnyRun(Protocol):
    """One simulation of a System."""

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

    def go(self, recorder: Recorder, progress: Callable[[Progress], None] | None) -> None:
        """Take all steps."""
        ...


def run_of(
    method: Integrator, system: System, t_start: float, t_end: float, step: float, every: int
) -> AnyRun:
    """Run of a System from t_start to t_end, s, with output every ``every`` steps."""
    module, _, name = method.runner.partition(":")
    kind = getattr(import_module(f".{module}", __package__), name)
    return cast(AnyRun, kind(system, method, t_start, t_end, step, every))
