"""Index 3: the constraints hold as they stand, C(q, t) = 0 (paper, eq. 29).

No drift.  The trapezoidal rule is weakly unstable in the multipliers here; generalised-alpha with
rho_inf < 1 and RadauIIA are not.  Reference: Arnold & Bruels (2007).
"""

from __future__ import annotations

from typing import ClassVar


class Index3:
    """Positions."""

    name: ClassVar[str] = "index3"
    projects: ClassVar[bool] = False

    @staticmethod
    def weights(B: float, G: float, h: float) -> tuple[float, float, float]:
        """C alone."""
        return 1.0, 0.0, 0.0
