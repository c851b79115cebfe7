"""Generalised-alpha method.

Order 2, unconditionally stable for linear systems, spectral radius rho_inf at infinite frequency: it
damps what the mesh cannot resolve.  Constraints of index 3 (by default), 2 or 1.  References: Chung &
Hulbert (1993) for the coefficients; Arnold & Brüls (2007) for the form with an algorithmic
acceleration, in which the equations of motion hold at the end of each step.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from .. import checks
from .base import FORMULATIONS, Coefficients, NewmarkFamily, formulation, option
from .newton import Newton


@dataclass(frozen=True)
class GeneralizedAlpha(NewmarkFamily):
    """Generalised-alpha method, order 2.

    Parameters
    ----------
    rho_inf : float
        Spectral radius at infinite frequency, 0 (strongest damping) to 1 (none).
    newton : Newton
        Settings of Newton's method.
    formulation : {"index1", "index2", "ggl", "index3"}
        How constraints with multipliers enter, see :mod:`ancf.solvers.formulations`.
    """

    rho_inf: float = option(
        0.9, "Spectral radius at infinite frequency [-].", type="number", minimum=0, maximum=1
    )
    newton: Newton = field(default_factory=Newton)
    formulation: str = formulation("index3")
    name = "generalized_alpha"

    def __post_init__(self) -> None:
        checks.kind(self.newton, "GeneralizedAlpha.newton", Newton, "ancf.Newton(tolerance=1e-10)")
        checks.between(self.rho_inf, "GeneralizedAlpha.rho_inf", 0.0, 1.0)
        checks.choice(self.formulation, "GeneralizedAlpha.formulation", FORMULATIONS)

    def coefficients(self) -> Coefficients:
        """Coefficients of the Newmark family."""
        alpha_m = (2 * self.rho_inf - 1) / (self.rho_inf + 1)
        alpha_f = self.rho_inf / (self.rho_inf + 1)
        gamma = 0.5 + alpha_f - alpha_m
        return Coefficients(beta=0.25 * (gamma + 0.5) ** 2, gamma=gamma, alpha_m=alpha_m, alpha_f=alpha_f)
