"""Index 2: the constraints hold for the velocities, dC/dt = 0 (paper, eq. 31).

The rate of the sliding joint's arc length is integrated with the same rule as all velocities; the
constraints for the positions drift with the order of the method.
"""

from __future__ import annotations

from typing import ClassVar


class Index2:
    """Velocities."""

    name: ClassVar[str] = "index2"
    projects: ClassVar[bool] = False

    @staticmethod
    def weights(B: float, G: float, h: float) -> tuple[float, float, float]:
        """dC/dt alone."""
        return 0.0, B / G, 0.0
