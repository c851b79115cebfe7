"""What every formulation of the constraints offers to a time step."""

from __future__ import annotations

from typing import ClassVar, Protocol


class Formulation(Protocol):
    """Which time derivative of C(q, t) = 0 holds at the end of each step.

    A correction dq of the Newmark family changes v by (G/B) dq and a by dq/B.  The rows of the
    multipliers are weighted such that their derivative with respect to q is C_q in every formulation:
    the iteration matrix stays symmetric and needs no knowledge of the formulation.
    """

    name: ClassVar[str]
    projects: ClassVar[bool]  # positions are corrected onto C = 0 besides

    @staticmethod
    def weights(B: float, G: float, h: float) -> tuple[float, float, float]:
        """Weights of C, dC/dt and d2C/dt2 in the rows of the multipliers."""
        ...
