"""Stabilised index 2: dC/dt = 0 for the velocities and C = 0 for the positions.

Gear, Gupta & Leimkuhler (1985) add C_q^T mu to q' = v with as many multipliers mu as constraints; here
it is S^-1 C_q^T mu with the iteration matrix S = M/B + (G/B) C + K in the place of the identity, so that
the small shift goes where the system is soft and excites no stiff vibration, and so that the factors
that the step has already serve for it.  mu is of the order of the index 2 form's drift in one step.
"""

from __future__ import annotations

from typing import ClassVar


class GGL:
    """Velocities, and positions by a shift."""

    name: ClassVar[str] = "ggl"
    projects: ClassVar[bool] = True

    @staticmethod
    def weights(B: float, G: float, h: float) -> tuple[float, float, float]:
        """dC/dt alone; the shift belongs to the iteration."""
        return 0.0, B / G, 0.0
