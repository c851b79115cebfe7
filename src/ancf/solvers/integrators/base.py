"""What every integrator offers, and what the methods of the Newmark family share."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

from ..newmark import Scheme
from ..newton import Newton

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ...system.system import System
    from ..stepping import Progress, Recorder, Stats

    FloatArray = NDArray[np.float64]


class AnyRun(Protocol):
    """One simulation of a System."""

    @property
    def stats(self) -> Stats:
        """Counters so far."""
        ...

    def start(self, q: FloatArray, v: FloatArray) -> None:
        """Consistent state at the start time."""
        ...

    def go(self, recorder: Recorder, progress: Callable[[Progress], None] | None) -> None:
        """Take all steps."""
        ...


class Integrator(Protocol):
    """A method with its settings."""

    @property
    def name(self) -> str:
        """Name in a model file."""
        ...

    def settings(self) -> dict[str, Any]:
        """All that a result keeps of the method, plain values by name."""
        ...

    def run(self, system: System, t_start: float, t_end: float, step: float, every: int) -> AnyRun:
        """Run of a System with output every ``every`` steps."""
        ...


class NewmarkFamily:
    """A method of the Newmark family with its Newton settings and its formulation of constraints."""

    newton: Newton
    formulation: str

    def scheme(self) -> Scheme:
        """Coefficients of the method."""
        raise NotImplementedError

    def settings(self) -> dict[str, Any]:
        """Coefficients and Newton's settings."""
        n = self.newton
        newton = {k: getattr(n, k) for k in n.__dataclass_fields__}
        return {"scheme": self.scheme()._asdict(), "newton": newton, "formulation": self.formulation}

    def run(self, system: System, t_start: float, t_end: float, step: float, every: int) -> AnyRun:
        """Run of a System with output every ``every`` steps."""
        from ..stepping import Run  # it knows this module

        return Run(system, self, t_start, t_end, step, every)
