"""Trapezoidal rule.

Order 2, A-stable, no numerical damping (spectral radius 1 at all frequencies); systems without
multipliers, or index 2.  Reference: Newmark (1959) with beta = 1/4, gamma = 1/2; the rule that the
paper uses throughout section 7.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from ..newmark import Scheme
from ..newton import Newton


@dataclass(frozen=True)
class Trapezoidal:
    """Trapezoidal rule, order 2.

    Parameters
    ----------
    newton : Newton
        Settings of Newton's method.
    """

    newton: Newton = field(default_factory=Newton)
    name = "trapezoidal"

    def scheme(self) -> Scheme:
        """Coefficients of the Newmark family."""
        return Scheme(beta=0.25, gamma=0.5, alpha_m=0.0, alpha_f=0.0)
