"""The adjoint of a simulation whose joints have multipliers, see :mod:`ancf.sensitivity.adjoint`."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..batches import Batches
from ..connections.sliding import SLIDES
from ..preparation import Prepared
from ..results.state import State
from ..solvers.derivatives.adjoint_joints import ROOM, back_joined_steps
from ..solvers.derivatives.adjoint_joints_start import back_joined_start
from ..solvers.derivatives.mixing import ROOM as MIXING
from ..solvers.derivatives.pushes import weigh_pushes
from ..solvers.derivatives.sensitivity import Constraining, Matrices, Way
from ..solvers.status import OK
from ..system.system import System
from .adjoint import Adjoint, UnsolvedError
from .adjoint_sloped import SlopedAdjoint
from .base import matrices_of
from .follow import shifted
from .memory_back import goes_back_through
from .start import Start

#: Weights of the rows for which the positions and the velocities of a start are shifted.
LEVELS = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)

#: Batches whose forces begin from one step to the next, and may be stiff.
SUDDEN = {"contacts", "ground", "pressing"}


class JoinedAdjoint(Adjoint):
    """A simulation with joints that is gone through forwards and backwards; see :class:`Adjoint`."""

    def _check(self, made: Prepared, start: State | None, where: str) -> None:
        if shifted(made, start) is not None:
            raise UnsolvedError
        super()._check(made, start, where)

    def _prepare(self) -> None:
        mine, theirs = self.system.parts.get("slides"), self.run.system.parts.get("slides")
        if mine is not None and theirs is not None:
            mine.mode[...], mine.open[...] = theirs.mode, theirs.open
        self._room, self._rate = np.zeros((ROOM, self.system.size)), np.ones(1)
        self._mix = np.zeros((MIXING if is_sudden(self.system) else 0, self.system.size))

    def _back(self, way: Way, h: float, tables: Any, wanted: FloatArray, sums: Any) -> int:
        mu, lam, still, _ = sums
        rule = self.run.rule(h)
        joined = Constraining(rule.w0, rule.w1, rule.w2, rule.projects)
        rho = np.zeros_like(lam)
        self._shifts = rho if rule.projects else None
        given = self.system.core, self.m, self.ahead, self.back, tables, way, wanted, self.unknowns
        scheme = self.run.scheme
        own = mu, lam, rho, still
        rooms = self._rate, self._room, self._mix
        _, status = back_joined_steps(*given, h, scheme, joined, *own, rooms)
        return int(status)

    def _pushed(
        self, way: Way, when: Any, tables: Any, wanted: FloatArray, lam: FloatArray, turned: FloatArray
    ) -> FloatArray:
        for k in self.nearby.rows:
            self.families[k].know(self.system)
        made = super()._pushed(way, when, tables, wanted, lam, turned)
        if self._shifts is not None:
            made[self.nearby.rows] -= self._of_rows(LEVELS[0], way, tables, self._shifts)
        return made

    def _of_rows(self, level: Any, way: Way, tables: Any, rho: FloatArray) -> FloatArray:
        """What parameters that are plain but for rows of joints do to rho . C, of these weights."""
        system, pushed, size = self.system, np.zeros(len(self.nearby.rows)), self.system.size
        before, nothing, number = system.level.copy(), np.zeros(0), np.zeros(1, dtype=np.int64)
        system.level[:] = level
        for k in self.nearby.rows:
            self.families[k].know(system)
        given = system.core, self.nearby.of_rows, Batches(), number, tables, way, self.weighed.friction
        weigh_pushes(*given, rho, np.zeros(size), pushed, nothing, np.zeros((0, 3, 3)), np.zeros(size))
        system.level[:] = before
        return pushed

    def _back_start(
        self,
        begin: Start,
        when: tuple[float, float, float, float],
        wanted: FloatArray,
        mu: FloatArray,
        still: FloatArray,
    ) -> FloatArray:
        system, lam, lost = self.system, np.zeros((3, self.system.size)), np.zeros(self.system.size)
        y = begin.q, begin.v, begin.a
        given = system.core, self.m, self.ahead.friction, self.back, y, wanted[0], self.unknowns
        if back_joined_start(*given, mu, lam, lost, self._room) != OK:
            raise UnsolvedError
        still -= lost
        way, tables = Way(*(x[None] for x in y)), system.inputs.tables(*when[:2], 1, *when[2:])
        system.level[:] = 0.0, 0.0, 1.0
        self._shifts = None
        made = self._pushed(way, when, tables, wanted, lam[:1], np.zeros((0, 3, 3)))
        for level, rho in zip(LEVELS, lam[1:], strict=True):
            made[self.nearby.rows] -= self._of_rows(level, way, tables, rho[None].copy())
            system.level[:] = level
            for k in self.nearby.others:
                self.families[k].know(system)
                found = self.families[k].at_steps(*way, when, gaps=False)
                made[k] -= float((rho * system.core.joints.mask) @ found.push[0])
        return made


def goes_back(system: System, m: Matrices) -> bool:
    """Whether a model with joints has an adjoint: their rows alone are not in the matrices, and all slide."""
    slides = system.parts.get("slides")
    return not len(m.rough) and (slides is None or bool(np.all(slides.mode == SLIDES)))


def adjoint_of(system: System) -> type[Adjoint] | None:
    """The adjoint of a model, if it has one: what is not exact in its matrices knows its slopes."""
    if not goes_back_through(system):
        return None
    m = matrices_of(system.core, system.size, moving=True, back=True)
    if len(m.lossy) or m.turning:
        return None
    if not len(system.multipliers):
        return None if len(m.rough) else (SlopedAdjoint if len(m.joined) else Adjoint)
    return JoinedAdjoint if goes_back(system, m) else None


def is_sudden(system: System) -> bool:
    """Whether a model has forces that begin from one step to the next."""
    return any(len(system.parts[name][0]) for name in SUDDEN & system.parts.keys())
