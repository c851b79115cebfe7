"""What lambda of an adjoint makes of what parameters do to residuals: lambda . R_p, summed over the steps.

Where a parameter changes nothing of a batch but numbers of which it knows what they do (``Traits.numbers``),
the derivatives by these numbers are summed up, once for all parameters; what the numbers change by is a
difference of arrays.  Forces of other batches are evaluated at the values around a parameter and weighed.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..compiled import add_number_work
from ..solvers.derivatives.friction import no_friction
from ..solvers.derivatives.pushes import weigh_loads, weigh_pushes
from ..solvers.derivatives.sensitivity import Way
from ..solvers.rare import knowing
from .nearby import Nearby, uses_of
from .rates import joined, rates_of


class Weighed:
    """The families of all parameters of an adjoint.

    Parameters
    ----------
    nearby : Nearby
    marked : dict, optional
        Batches by name that are asked in place of those of the model: they remember what steps do.
    """

    def __init__(self, nearby: Nearby, marked: dict[str, Any] | None = None) -> None:
        self.nearby, self.system, self.marked = nearby, nearby.system, marked or {}
        self.friction = no_friction()  # with what the marked ones remember
        families = nearby.families
        rates = {k: rates_of(families[k]) for k in nearby.plain}
        left = {k: families[k].changed - found.keys() for k, found in rates.items()}
        self.rates = {k: found for k, found in rates.items() if found or not left[k]}
        names = sorted({name for found in self.rates.values() for name in found})
        batches = [self._knowing(name) for name in names]
        sizes = [len(next(found[name] for found in self.rates.values() if name in found)) for name in names]
        self.begin = np.cumsum([0, *sizes]).astype(np.int64)
        self.place = {name: slice(*self.begin[k : k + 2]) for k, name in enumerate(names)}
        self.known = knowing(add_number_work, batches)
        self.others = [k for k in nearby.plain if left[k]]
        self.uses = uses_of(families, self.others, left)
        self.work = np.zeros(self.system.size)
        self.turning = len(self.system.core.supports.rot_slot) if nearby.turns else 0  # local axes to look at
        self.turned = np.zeros((self.turning, 3, 3))  # sums over all steps: derivatives by the local axes,
        self.numbers, self.total = (
            np.zeros(self.begin[-1]),
            np.zeros(self.system.size),
        )  # by numbers, of lambda

    def _knowing(self, name: str) -> Any:
        """The batch of the model of this name, which knows of all numbers that a parameter changes."""
        batch = self.marked.get(name, self.system.parts[name])
        for k in (k for k, found in self.rates.items() if name in found):
            for system in self.nearby.families[k].systems:
                if system.parts[name] is not self.system.parts[name]:
                    batch = joined(batch, system.parts[name])
        return batch

    def at_steps(
        self,
        way: Way,
        when: tuple[float, float, float, float],
        tables: Any,
        lam: FloatArray,
        turned: FloatArray,
    ) -> FloatArray:
        """For the steps of a block and their lambda, (p,), without what :meth:`in_all` has of them.

        See ``Nearby.at_steps``; ``turned``: derivatives of lambda . R by the local axes so far, (k, 3, 3).
        """
        families = self.nearby.families
        made, pushed = np.zeros(len(families)), np.zeros(len(self.others))
        core, work, total = self.system.core, self.work, np.zeros(self.system.size)
        sums = pushed, self.numbers, turned, total
        own = self.uses, self.known, self.begin, tables, way, self.friction
        weigh_pushes(core, *own, lam, work, *sums)
        made[self.others] = pushed
        self.turned += turned
        self.total += total
        for k in self.nearby.plain:
            if self.nearby.steady_loads(k, when, tables) is not None:
                continue
            for weight, loads, value in families[k].loads_used(when, tables):
                if len(loads.start) == 1 or len(value) == 1:  # the same at all times
                    made[k] -= weight * weigh_loads(loads, value[:1], total, total[None])
                else:
                    made[k] -= weight * weigh_loads(loads, value, total, lam)
        return made

    def in_all(self, when: tuple[float, float, float, float], tables: Any) -> FloatArray:
        """What is summed up over all steps once for all parameters, (p,); as :meth:`at_steps` after these."""
        made = np.zeros(len(self.nearby.families))
        for k, turn in self.nearby.turns.items():
            made[k] += float(np.sum(turn * self.turned))
        for k, found in self.rates.items():
            made[k] += sum(float(self.numbers[self.place[name]] @ rate) for name, rate in found.items())
        for k in self.nearby.plain:
            steady = self.nearby.steady_loads(k, when, tables)
            if steady is not None:
                made[k] -= float(np.sum(steady * self.total))
        return made
