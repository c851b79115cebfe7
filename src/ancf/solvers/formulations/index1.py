"""Index 1 with Baumgarte's damping: d2C/dt2 + 2 omega dC/dt + omega^2 C = 0.

For the sliding joint the second derivative is eq. 32 of the paper with the term -r_xx s'^2 that it
lacks.  What violates the constraints decays within about ten steps, omega = 1/(10 h), so that the damping
stays of the order of the method.  Reference: Baumgarte (1972).
"""

from __future__ import annotations

from typing import ClassVar

#: Steps in which a violation decays to 1/e.
STEPS = 10.0


class Index1:
    """Accelerations, critically damped."""

    name: ClassVar[str] = "index1"
    projects: ClassVar[bool] = False

    @staticmethod
    def weights(B: float, G: float, h: float) -> tuple[float, float, float]:
        """All three, scaled such that they add to C_q."""
        omega = 1.0 / (STEPS * h)
        total = 1.0 / B + 2.0 * omega * G / B + omega**2
        return omega**2 / total, 2.0 * omega / total, 1.0 / total
