"""How many values of a parameter its derivative needs: what residuals and initial states do there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..batches import Batches
from ..system.core import apply_load, place_supports, residual
from ..system.system import System
from .alike import TIMES, Known, on_a_line
from .turns import axes_of

#: Size of the changes of the state in which it is tried whether a parameter is linear.
SHAKEN = 0.01
#: What order two may lack of a derivative, relative, up to which order four is as good as six.
SMOOTH = 3e-5
#: Accelerations where that is tried once more, in these per square second.
PUSHED = 1e3


@dataclass
class Trial:
    """Systems at values of a parameter.

    Parameters
    ----------
    base : System
        Of the model itself.
    systems : list of System
        Two on both sides of it, or four.
    states : list of (q, v)
        Their initial states.
    still : bool
        Residuals are known not to depend on the parameter.
    """

    base: System
    systems: list[System]
    states: list[tuple[FloatArray, FloatArray]]
    still: bool

    def linear(self) -> bool:
        """Whether residual and initial state are linear in the parameter, which two values tell then."""
        first = [Known.of(self.base).initial_state(0.0), *self.states]
        axes = [axes_of(self.base, system) for system in (self.base, *self.systems)]
        if not all(on_a_line(*x) for x in (*zip(*first, strict=True), axes)):
            return False
        found = self._residuals([self.base, *self.systems])
        changes = self.still or any(np.any(low != high) for _, low, high in found)
        return changes and all(on_a_line(*x) for x in found)

    def smooth(self) -> bool:
        """Whether four values are enough: what order two lacks of the derivative is small."""
        states = list(zip(*self.states, strict=True))
        axes = [axes_of(self.base, system) for system in self.systems]
        for far_low, low, high, far_high in (*self._residuals(self.systems), *states, axes):
            near, far = (high - low) / 3.0, (far_high - far_low) / 6.0
            size = float(np.max(np.abs(near), initial=0.0))
            if float(np.max(np.abs(far - near), initial=0.0)) > SMOOTH * size:
                return False
        return True

    def _residuals(self, systems: list[System]) -> list[list[FloatArray]]:
        """Of systems in a strained state, and in one with accelerations."""
        if self.still:
            return []
        base, rng = self.base, np.random.default_rng(1)
        n, q = base.n, Known.of(base).initial_state(0.0)[0]
        rest, shake = np.zeros_like(q), np.zeros((3, base.size))
        shake[:, :n] = SHAKEN * base.model.size * rng.uniform(-1, 1, (3, n)) * base.numbering.used()
        before = base.level.copy()
        base.level[:] = 1.0, 0.0, 0.0
        for system in systems:
            system.level[:] = base.level
        strained, pushed = (q + shake[0], shake[1], rest), (q, rest, PUSHED * shake[2])
        found = [[self._residual(s, pushed, 0.0) for s in systems]]
        for time in TIMES:  # at the first one waves with a ramp are still
            found.append([self._residual(s, strained, time) for s in systems])
        base.level[:] = before
        return found

    def _residual(self, system: System, states: tuple[FloatArray, ...], time: float) -> FloatArray:
        """Of a system at states q, v, a, of which it keeps nothing."""
        (q, v, a), core, loads = (x.copy() for x in states), self.base.core, system.dead
        tables = system.inputs.tables(time - 1e-3, 1e-3, 1, 0.0, np.inf)
        value, r, force = loads.value.copy(), np.empty_like(q), np.empty_like(q)
        place_supports(system.supports, loads.value, tables, 0, q, v, a)
        apply_load(loads, tables.value[0], force)
        residual(Batches(system.parts.values()), core.ws, q, v, a, force, r)
        loads.value[...] = value
        return r
