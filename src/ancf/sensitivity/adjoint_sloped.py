"""The adjoint of a simulation with forces that know the slopes of their work, as fluids and contacts."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..solvers.derivatives.adjoint_sloped import ROOM, back_sloped_start, back_sloped_steps
from ..solvers.derivatives.sensitivity import Way
from ..solvers.status import OK
from ..solvers.step.low_rank import room_for_patches
from .adjoint import Adjoint, UnsolvedError
from .start import Start


class SlopedAdjoint(Adjoint):
    """A simulation with such forces and without joints that is gone through forwards and backwards."""

    def _prepare(self) -> None:
        self._room, self._corrections = np.zeros((ROOM, self.system.size)), np.zeros(1)
        self._patches = room_for_patches(self.system) if "contacts" in self.system.parts else ()

    def _back(self, way: Way, h: float, tables: Any, wanted: FloatArray, sums: Any) -> int:
        core, m = self.system.core, self.m
        given = core, m, (self._patches, self.ahead, self.back), tables, way, wanted, self.unknowns
        own = *sums, self._corrections, self._room
        _, status = back_sloped_steps(*given, h, self.run.scheme, *own)
        return int(status)

    def _through_start(self, begin: Start, wanted: FloatArray, mu: FloatArray, sums: Any) -> None:
        friction = self.ahead.friction, self.back
        given = self.system.core, self.m, *friction, (begin.q, begin.v, begin.a), wanted[0], self.unknowns
        own = *sums, self._corrections, self._room
        if back_sloped_start(*given, mu, *own) != OK:
            raise UnsolvedError
