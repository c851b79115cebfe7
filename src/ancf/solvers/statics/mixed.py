"""Stresses that fit the correction, for the matrix of an equilibrium iteration with thin beams.

The strains of the two beams are quadratic in the unknowns, e(q + dq) = e(q) + De dq + e2(dq).  After a large
correction of a thin beam, e2 times the stiffness against stretch or thickness is a stress that the next
correction takes away again, but until then it stands in the geometric part of the matrix and spoils it.
There the stress of the linear part, e(q + dq) - e2(dq), is taken instead: it is what Newton's method finds
if the stresses are unknowns of their own, and converges in far fewer and longer steps.  Where the iteration
settles both are the same.  Source: Magisano, Leonetti & Garcea (2017), "mixed integration point" strategy.
"""

from __future__ import annotations

from typing import Any

from ...arrays import FloatArray
from ...batches import Batches
from ...elements.registry import offered


class Mixed:
    """Batches of a System for the matrix; the residual takes those of the System."""

    def __init__(self, batches: tuple[Any, ...]) -> None:
        self._parts, mine = [], []
        for batch in batches:
            quadratic_strains = offered(batch, "quadratic_strains")
            if quadratic_strains is not None:
                self._parts.append(quadratic_strains(batch))
            mine.append(batch if quadratic_strains is None else self._parts[-1].batch)
        self.batches = Batches(mine)

    def correct(self, change: FloatArray) -> None:
        """Take the stresses that are linear in the last change of the state vector; zero: the true ones."""
        for part in self._parts:
            part.leave_out(change)
