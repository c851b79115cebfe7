"""Trapezoidal rule.

Order 2, A-stable, no numerical damping (spectral radius 1 at all frequencies); constraints of index 2 or
1, by default index 2 with the positions held as well (GGL).  Reference: Newmark (1959) with beta = 1/4,
gamma = 1/2; the rule that the paper uses throughout section 7.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from ...errors import ModelError
from ...model import checks
from ..newmark import Scheme
from ..newton import Newton
from .base import NewmarkFamily


@dataclass(frozen=True)
class Trapezoidal(NewmarkFamily):
    """Trapezoidal rule, order 2.

    Parameters
    ----------
    newton : Newton
        Settings of Newton's method.
    formulation : {"index1", "index2", "ggl"}
        How constraints with multipliers enter, see :mod:`ancf.solvers.formulations`.
    """

    newton: Newton = field(default_factory=Newton)
    formulation: str = "ggl"
    name = "trapezoidal"

    def __post_init__(self) -> None:
        if self.formulation == "index3":
            raise ModelError(
                "Trapezoidal.formulation",
                "the trapezoidal rule does not take index 3, its multipliers oscillate",
                'take "ggl", which holds the positions as well, or GeneralizedAlpha',
            )
        checks.choice(self.formulation, "Trapezoidal.formulation", ("index1", "index2", "ggl"))

    def scheme(self) -> Scheme:
        """Coefficients of the Newmark family."""
        return Scheme(beta=0.25, gamma=0.5, alpha_m=0.0, alpha_f=0.0)
