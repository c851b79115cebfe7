"""The equations of motion of a System as a Radau method sees them."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array

from ...arrays import FloatArray, IntArray
from ...linalg.sparse import to_sparse
from ...system.core import Tables, assemble, restrict
from ...system.system import System
from .method import Matrices
from .stages import place_rows, stage_powers, stage_residuals

#: Steps of the difference formulas for given motions: this part of a step, at least so many seconds.
SPACING, LEAST_SPACING = 0.25, 1e-6


class SystemProblem:
    """Free unknowns of a System; see :class:`ancf.solvers.radau.method.Problem`.

    Parameters
    ----------
    system : System
    first, last : float
        Times between which functions of time may be asked, s.
    """

    def __init__(self, system: System, first: float, last: float) -> None:
        self.system, self.first, self.last = system, first, last
        self.free = system.free
        self.multipliers: IntArray = np.flatnonzero(np.isin(self.free, system.multipliers)).astype(np.int64)
        self.weight: FloatArray = system.core.weight[self.free]
        self.spacing = LEAST_SPACING
        inputs = system.inputs
        self._moving = bool(inputs.motions or inputs.rotations)
        self._driven = self._moving or not all(f.constant for f in inputs.loads)
        self._tables: dict[bytes, Tables] = {}
        self._changes = 0
        self._f, self._push, self._loss, self._r = (np.zeros(system.size) for _ in range(4))
        self.base = np.zeros((2, system.size))  # what is held and never moves
        self._values = np.zeros((3, system.places.size))
        self._pattern()

    def start(self, q: FloatArray, v: FloatArray) -> None:
        """Take what is held from full state vectors."""
        self.base[0], self.base[1] = q, v

    def _pattern(self) -> None:
        """Places in the matrices' data of the entries of the block values."""
        n = self.system.places.size
        whole = to_sparse(np.arange(1.0, n + 1.0), self.system.places)
        part = csc_array(whole[self.free][:, self.free])
        part.sort_indices()
        self._entries = np.round(part.data).astype(np.int64) - 1
        self._shape = (part.indices.astype(np.int32), part.indptr.astype(np.int32), part.shape)

    def tables(self, t: FloatArray) -> Tables:
        """Functions of time at any times."""
        if self._changes != self.system.inputs.changes:  # of what is given from outside
            self._tables.clear()
            self._changes = self.system.inputs.changes
        key = t.tobytes() if self._driven else len(t).to_bytes(4, "little")
        if key not in self._tables:
            if len(self._tables) > 8:
                self._tables.clear()
            inputs, d = self.system.inputs, self.spacing
            rows = [inputs.tables(float(x) - d, d, 1, self.first, self.last) for x in t]
            self._tables[key] = Tables(*(np.concatenate(c) for c in zip(*rows, strict=True)))
        return self._tables[key]

    def step_size(self, h: float) -> None:
        """Set the spacing of difference formulas for a step of size h."""
        spacing = max(SPACING * h, LEAST_SPACING)
        if spacing != self.spacing:
            self.spacing = spacing
            self._tables.clear()

    def full(self, q: FloatArray, v: FloatArray, a: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """State vectors of shape (m, size) from free unknowns; supports are not placed yet."""
        out = np.zeros((3, len(q), self.system.size))
        out[:2] = self.base[:, None]
        out[0][:, self.free], out[1][:, self.free], out[2][:, self.free] = q, v, a
        return out[0], out[1], out[2]

    def residuals(self, t: FloatArray, q: FloatArray, v: FloatArray, a: FloatArray) -> FloatArray:
        """Residuals of the free unknowns at the times t, shape (m, n)."""
        qf, vf, af = self.full(q, v, a)
        r = np.empty_like(qf)
        stage_residuals(self.system.core, self.tables(t), qf, vf, af, self._f, r)
        return r[:, self.free]

    def placed(
        self, t: FloatArray, q: FloatArray, v: FloatArray, a: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """State vectors with everything in place, shape (m, size)."""
        states = self.full(q, v, a)
        if self._moving or len(self.system.core.supports.rot_slot):
            place_rows(self.system.core, self.tables(t), *states)
        return states

    def powers(self, t: FloatArray, q: FloatArray, v: FloatArray, a: FloatArray) -> FloatArray:
        """Power dissipated and supplied, shape (m, 2), W."""
        core, states = self.system.core, self.full(q, v, a)
        power = np.zeros((len(t), 2))
        if core.accounted and (core.damped or core.loaded):
            stage_powers(core, self.tables(t), *states, self._f, self._push, self._loss, self._r, power)
        return power

    def matrices(self, t: float, q: FloatArray, v: FloatArray) -> Matrices:
        """Mass, damping and stiffness of the free unknowns."""
        core = self.system.core
        qf, vf, _ = self.placed(np.array([t]), q[None], v[None], 0.0 * v[None])
        for values, factors in zip(self._values, np.eye(3).tolist(), strict=True):
            assemble(core.batches, core.ws, qf[0], vf[0], values, *factors)
            restrict(core.supports, values)
        indices, indptr, shape = self._shape
        M, D, K = (csc_array((x[self._entries], indices, indptr), shape=shape) for x in self._values)
        return Matrices(M, D, K, alike=True)
