"""The softest mode of a stiffness, whether its stiffness is anything but round-off, and sections that spin.

A beam whose ends turn freely about its axis may spin: its sections turn about their normals against nothing.
Round-off decides then whether the matrix is positive definite, and what the correction is along that mode.
A torsional stiffness against the spin since the last iteration makes the mode harmless; it is in the matrix
alone, not in the forces, and leaves bending as it is.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...arrays import FloatArray, IntArray
from ...later import csc_array
from ...model.bodies.axes import cross
from ...system.system import System

Solve = Callable[[FloatArray], FloatArray]

#: Stiffness of a mode, as a share of the sum of the sizes of its terms, that counts as zero.
ROUND_OFF = 1e-13
#: Stiffness of a spin, as a share of G J/L, that counts as zero.
FREE_SPIN = 1e-5
_ROUNDS = 4  # of inverse iterations


def softest_mode(solve: Solve, n: int, held: IntArray) -> FloatArray:
    """Mode (n,) of the lowest stiffness by inverse iteration, of length 1."""
    return lowest_square(solve, csc_array((np.ones(n), np.arange(n), np.arange(n + 1))), held)[1]


def is_neutral(K: csc_array, x: FloatArray) -> bool:
    """Whether the mode x of the stiffness K has none but what round-off leaves of it."""
    terms = np.abs(x) @ (abs(K) @ np.abs(x))
    return bool(abs(x @ (K @ x)) <= ROUND_OFF * terms)


def lowest_square(solve: Solve, M: csc_array, held: IntArray) -> tuple[float, FloatArray]:
    """Least w of A x = w M x, 1/s^2, and x, (n,), by inverse iteration; ``solve`` has the factors of A."""
    x = np.random.default_rng(1).standard_normal(M.shape[0])
    x[held] = 0.0
    square = 0.0
    for _ in range(_ROUNDS):
        b = M @ x
        x = solve(b)
        square = float(x @ b) / float(x @ (M @ x))
        x /= np.linalg.norm(x)
    return square, x


class Spin:
    """Stiffness G J/L of each beam against a common spin of its sections.

    Nodes whose r_y or r_z has unknowns in ``held`` are left out.
    """

    def __init__(self, system: System, held: IntArray) -> None:
        self._n = system.n
        self._parts: list[tuple[IntArray, float]] = []  # slots of r_y and r_z of the nodes, stiffness
        for name, beam in system.model.beams.items():
            if not beam.has_section:
                continue
            section, slots = beam.section, system.numbering.each(name)[:, 2:4]
            assert section.G is not None  # the model has checked that there is a material
            assert section.J is not None
            free = ~np.isin(slots[:, :, None] + np.arange(3), held).any(axis=(1, 2))
            stiffness = section.G * section.J / (beam.length * len(slots))
            self._parts.append((slots[free], stiffness))

    def __bool__(self) -> bool:
        return bool(self._parts)

    def add(self, A: FloatArray, q: FloatArray) -> None:
        """Add the stiffness at the state q to the block values A."""
        blocks = A.reshape(-1, 36)
        for slots, mode, stiffness in self._modes(q):
            blocks[slots[:, 0] // 6] += stiffness * (mode[:, :, None] * mode[:, None, :]).reshape(-1, 36)

    def is_free(self, solve: Solve, q: FloatArray, added: bool, residual: float) -> bool:
        """Whether the softest spin has no stiffness but for round-off and the largest residual.

        ``solve`` belongs to the stiffness K, with the spin S ``added`` or without; inverse iteration finds
        the mode of the least K/S.  Out of balance, a rotation that costs no energy has a stiffness of the
        size of the residual.
        """
        b = self.times(np.ones(self._n), q)
        for _ in range(_ROUNDS):
            x = solve(b)
            energy, last = float(x @ b), self.times(x, q)
            own = float(x @ last)
            if not own > 0.0:
                return False
            ratio, share = energy / own - float(added), float(x @ x) / own
            b = last / np.sqrt(own)
        return abs(ratio) <= FREE_SPIN + 3.0 * residual * share

    def times(self, x: FloatArray, q: FloatArray) -> FloatArray:
        """Stiffness times x, both (n,)."""
        b = np.zeros(self._n)
        for slots, mode, stiffness in self._modes(q):
            at = slots[:, :1] + np.arange(6)
            b[at] = stiffness * np.sum(mode * x[at], axis=1, keepdims=True) * mode
        return b

    def _modes(self, q: FloatArray) -> list[tuple[IntArray, FloatArray, float]]:
        """Slots, changes of (r_y, r_z) of the nodes (n, 6) by half a unit of spin, stiffness."""
        found = []
        for slots, stiffness in self._parts:
            y, z = (q[slots[:, k, None] + np.arange(3)] for k in range(2))
            t = cross(y, z)
            t /= np.linalg.norm(t, axis=1, keepdims=True)
            found.append((slots, 0.5 * np.hstack([cross(t, y), cross(t, z)]), stiffness))
        return found
