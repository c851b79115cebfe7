"""Trapezoidal rule.

Order 2, A-stable, no numerical damping (spectral radius 1 at all frequencies); constraints of index 2 or
1, by default index 2 with the positions held as well (GGL).  Reference: Newmark (1959) with beta = 1/4,
gamma = 1/2; the rule that the paper uses throughout section 7.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from ...errors import ModelError
from .. import checks
from .base import Coefficients, NewmarkFamily, formulation
from .newton import Newton


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
    formulation: str = formulation("ggl")
    name = "trapezoidal"

    def __post_init__(self) -> None:
        checks.kind(self.newton, "Trapezoidal.newton", Newton, "ancf.Newton(tolerance=1e-10)")
        if isinstance(self.formulation, str) and self.formulation == "index3":
            what = 'is "index3": the trapezoidal rule damps no error of the multipliers, which oscillate'
            hint = 'take "ggl", which holds the positions as well, or the generalised-alpha method'
            raise ModelError("Trapezoidal.formulation", what, hint)
        checks.choice(self.formulation, "Trapezoidal.formulation", ("index1", "index2", "ggl"))

    def coefficients(self) -> Coefficients:
        """Coefficients of the Newmark family."""
        return Coefficients(beta=0.25, gamma=0.5, alpha_m=0.0, alpha_f=0.0)
