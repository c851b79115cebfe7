"""What a parameter does to residuals and held places of fixed states: differences over systems around it."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..solvers.radau.stages import place_rows, stage_residuals
from ..system.beside import Acts
from ..system.core import Core, apply_load, apply_supports, place_supports, residual
from .offsets import FOUR, KINKED, PAIR, STEEP, STEP
from .parameters import Parameter
from .values import Push, gaps_of


class Pushing:
    """Base of :class:`ancf.sensitivity.family.Family`, whose attributes it has."""

    base: Any  # the System of the model itself
    systems: Any  # list of System
    weights: list[float]
    _batches: Any  # of each system those that the parameter changes, see Family
    _shape: list[FloatArray]  # changes of the initial shape by system
    parameter: Parameter
    linear: bool
    offsets: list[float]
    _unit: float  # of the parameter
    _compiled: Any  # of an offset: the System there

    def _is_steep(self, acts: Acts) -> bool:
        """Whether forces have high powers of a length, as those of beams with cross-sections."""
        return acts.shapes and any(beam.has_section for beam in self.base.model.beams.values())

    def _moves_kinks(self) -> bool:
        """Whether supports are moved where something has kinks, whose numbers stay as they are."""
        base = self.base
        held, kinked = base.held, (base.parts[name] for name in KINKED & set(base.parts))
        return any(len(b[0]) for b in kinked) and any(np.any(shape[held]) for shape in self._shape)

    @cached_property
    def wider(self) -> tuple[list[Any], list[float]]:
        """Systems and weights of what has no kinks: the same ones, unless these are tiny steps apart."""
        acts = self.parameter.acts
        h = STEP * self._unit * (STEEP if acts is not None and self._is_steep(acts) else 1.0)
        if self.parameter.linear or self.linear or max(map(abs, self.offsets)) >= h:
            return self.systems, self.weights
        places, weights = PAIR if self.parameter.quadratic else FOUR
        try:
            systems = [self._compiled(h * x) for x in places]
        except ModelError:  # so far from its value there is no such model
            return self.systems, self.weights
        return systems, [w / h for w in weights]

    def at_steps(
        self, q: FloatArray, v: FloatArray, a: FloatArray, when: tuple[float, float, float, float], gaps: bool
    ) -> Push:
        """What the parameter does to states (n, size) at the ends of steps.

        ``when``: start, step, first and last time, as ``Inputs.tables`` takes them.
        """
        start, step, first, last = when
        made = Push(np.zeros_like(q), np.zeros_like(q), np.zeros((3, *q.shape)))
        placed = []
        for k, system in enumerate(self.systems):
            tables = system.inputs.tables(start, step, len(q), first, last)
            states = self._moved(k, q), v.copy(), a.copy()
            place_rows(system.core, tables, *states)
            placed.append((system, tables, states))
        # of all systems or of none: what nothing acts on has to cancel
        moved = any(
            not np.array_equal(x, y) for *_, own in placed for x, y in zip(own, (q, v, a), strict=True)
        )
        for k, (weight, (system, tables, states)) in enumerate(zip(self.weights, placed, strict=True)):
            core = system.core if moved else system.core._replace(batches=self._batches[k])
            r = np.empty_like(q)
            stage_residuals(core, tables, *states, np.empty(system.size), r)
            made.push[...] += weight * r
            for x, y, here in zip(made.held, states, (q, v, a), strict=True):
                x += weight * (y - here)
            if gaps:
                made.gap[...] += weight * gaps_of(system, tables, states)
        self._finish(made)
        return made

    def at_rest(self, core: Core, q: FloatArray, when: tuple[float, float]) -> Push:
        """The same of one state (size,) without motion at a time, of ``core`` what is held.

        ``when``: time and a step with which rates of given motions are found.
        """
        time, h = when
        made = Push(np.zeros((1, q.size)), np.zeros((1, q.size)), np.zeros((3, 1, q.size)))
        for k, weight in enumerate(self.weights):
            system = self.systems[k]
            tables = system.inputs.tables(time - h, h, 1, time, np.inf)
            x, zero, force, r = (
                self._moved(k, q[None])[0],
                np.zeros_like(q),
                np.empty_like(q),
                np.empty_like(q),
            )
            place_supports(system.core.supports, system.core.loads.value, tables, 0, x, zero, zero.copy())
            apply_load(system.core.loads, tables.value[0], force)
            still = np.zeros_like(q)
            residual(system.core.batches, system.core.ws, x, still, still, force, r)
            apply_supports(system.core.supports, r)
            r[core.supports.held] = 0.0
            made.push[0] += weight * r
            made.held[0, 0] += weight * (x - q)
        self._finish(made)
        made.held[1:] = 0.0
        return made

    def _moved(self, k: int, q: FloatArray) -> FloatArray:
        """States (n, size) with what supports hold without moving it where it is in system k."""
        held = self.base.held
        moved = q.copy()
        moved[:, held] += self._shape[k][held]
        return moved

    def _finish(self, made: Push) -> None:
        n = self.base.n
        made.push[:, n:] = made.gap[:, n:] = 0.0
        free = np.ones(made.push.shape[1], dtype=bool)
        free[self.base.held], free[n:] = False, False
        made.held[..., free] = 0.0
