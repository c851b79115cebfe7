"""A simulation by explicit steps: stability is checked at the start and now and then."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray
from ...compiled import traits
from ...errors import ModelError, SolveError
from ...model.integrators import Explicit
from ...records import place
from ...system.core import Tables
from ...system.energy import energies
from ...system.system import System
from .. import failures
from ..block import explicit_block
from ..quick import Direct, shared
from ..sampling import Output
from ..start import consistent_start
from ..status import DIVERGED, SINGULAR
from ..step.balance import begin_account
from ..step.memory import NORM, WORST
from ..stepping import Run
from .stability import stable_limit

#: A step may be larger than asked for by this: estimates about two states differ a little.
SLACK = 1.01
#: Steps between two estimates, and unknowns times steps: they take about 20 times as long as an estimate.
RARE_STEPS, RARE_WIDE = 8000, 2**21


class ExplicitRun(Run):
    """One simulation of a System by central differences; see :class:`ancf.solvers.stepping.Run`."""

    KEPT = (*Run.KEPT, "limit", "estimated")

    def __init__(
        self, system: System, method: Explicit, t_start: float, t_end: float, step: float, every: int
    ) -> None:
        if len(system.multipliers):
            raise ModelError(
                "simulate.integrator",
                "an Explicit run cannot take constraints with multipliers",
                "use ancf.Radau() or ancf.Trapezoidal()",
            )
        super().__init__(system, method, t_start, t_end, step, every)
        masses = (own(batch) for batch in system.core.batches if (own := traits(batch).turning_mass))
        self.solids = failures.solids(system)
        self.turning = bool(np.any(system.core.supports.rot_moving >= 0)) or any(masses)

    explicit = True

    def use(self, integrator: Explicit) -> None:
        """Keep the settings: there are no iterations and no constraints."""
        self.method = integrator

    @property
    def caution(self) -> str:
        """Nothing: the stable step is what judges explicit steps, whose energy swings near it."""
        return ""

    @property
    def keeps_energy(self) -> bool:
        """Central differences take nothing out."""
        return True

    def start(self, q: FloatArray, v: FloatArray) -> None:
        """Consistent state at t_start; the step must be stable there.

        Raises
        ------
        ModelError
            The step is larger than the stable one.
        """
        m, system = self.memory, self.system
        m.q[:], m.v[:] = q, v
        times = self.t_start - self.h, self.h, 1, self.t_start, self.t_end
        first = system.inputs.tables(*times, (m.q, m.v), still=True)
        m.a[:] = consistent_start(system, m.q, m.v, first, m.f)
        self.limit = stable_limit(system, m.q, m.v)  # leaves the factors of the mass matrix
        stable = self.method.safety * self.limit
        if self.method.check and self.h > SLACK * stable:
            what = f"is {self.h:g} s, the largest stable step {stable:.4g} s (safety {self.method.safety:g})"
            hint = "take that and store less often (output_step), or use an implicit method"
            raise ModelError("simulate.step", what, hint)
        begin_account(system.core, m)
        self.energy0 = energies(system, m.q[None], m.v[None])[0]
        self.estimated = 0  # steps done at the last estimate
        self._compile(first)

    def _compile(self, tables: Tables) -> None:
        none, nothing = np.zeros(0, dtype=np.int64), self.room(0, 0)
        self._take(tables, self.h, none, nothing)

    def _take(self, tables: Tables, h: float, row: NDArray[np.int64], out: Output) -> tuple[int, int]:
        steps, apart = self.kernels
        where, rest = (
            (place(self.system.core), place(self.memory)),
            (row, place(self.sampling), out, place(apart)),
        )
        n, status = explicit_block(steps, *where, tables, h, self.turning, *rest)
        return n, status

    @property
    def hesitates(self) -> bool:
        """Never: an explicit step is taken or fails."""
        return False

    def bundle(self, rows: int) -> Direct:
        """See :class:`ancf.solvers.stepping.Run`."""
        return Direct(**shared(self, rows), turning=self.turning)

    def _advance(self, t: float, h: float, row: NDArray[np.int64], out: Output) -> tuple[int, int]:
        here = self.memory.q, self.memory.v
        tables = self.system.inputs.tables(t, h, len(row), self.t_start, self.t_end, here)
        return self._take(tables, h, row, out)

    def bridged(self, t: float, h: float, number: int, status: int) -> None:
        """Nothing helps a step that has failed."""
        m = self.memory
        if (error := failures.blamed(self.system, m.q, m.v, t, number, h)) is not None:
            raise error
        raise self._failure(t, number, _REASONS.get(status, "the forces are no longer finite"), h)

    def _check_energy(self, done: int) -> None:
        failures.check_solids(self.system, self.solids, self.memory.q, self.time(done), done, self.h)
        super()._check_energy(done)
        if not self.method.check or done < self.estimated + RARE_STEPS + RARE_WIDE // self.system.size:
            return
        self.limit = stable_limit(self.system, self.memory.q, self.memory.v)
        self.estimated = done
        if self.h > self.limit:
            raise self._failure(self.time(done), done, "the step is no longer stable", self.h)

    def _failure(self, t: float, number: int, reason: str, h: float) -> SolveError:
        memo = self.memory.memo
        where = f"t = {t:.6g} s, step {number}, {self.system.numbering.describe(int(memo[WORST]))}"
        what = f"{reason}; largest motion in a step {memo[NORM]:.3g} sizes of the model, "
        what += f"step {h:g} s, largest stable one {self.limit:.4g} s when last estimated"
        return SolveError(where, what, "try a smaller step, see ancf.stable_step, or an implicit method")


_REASONS = {DIVERGED: "the motion has blown up", SINGULAR: "the mass matrix is singular"}
