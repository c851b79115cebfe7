"""Method of Hilber, Hughes and Taylor.

Order 2, unconditionally stable for linear systems, spectral radius (1 - d)/(1 + d) at
infinite frequency; for d = 0 it is the trapezoidal rule. Reference: Hilber, Hughes &
Taylor (1977); in the form of Arnold & Brüls (2007) it is alpha_m = 0, alpha_f = d.
"""

from dataclasses import dataclass, field

from ancf.model import checks
from ancf.model.integrators.base import (
    FORMULATIONS,
    Coefficients,
    NewmarkFamily,
    formulation,
    option,
)
from ancf.model.integrators.newton import Newton


@dataclass(frozen=True)
class HHT(NewmarkFamily):
    """Method of Hilber, Hughes and Taylor, order 2.

    Parameters
    ----------
    dissipation : float
        0 (none) to 1/3 (most); their -alpha.
    newton : Newton
        Settings of Newton's method.
    formulation : {"index1", "index2", "ggl", "index3"}
        How constraints with multipliers enter.
    """

    dissipation: float = option(0.1, "Dissipation [-].", minimum=0, maximum=1 / 3)
    newton: Newton = field(default_factory=Newton)
    formulation: str = formulation("ggl")
    name = "hht"

    def __post_init__(self) -> None:
        checks.between(self.dissipation, "HHT.dissipation", 0.0, 1.0 / 3.0)
        checks.choice(self.formulation, "HHT.formulation", FORMULATIONS)

    def coefficients(self) -> Coefficients:
        """Coefficients of the Newmark family."""
        d = self.dissipation
        return Coefficients(0.25 * (1 + d) ** 2, 0.5 + d, alpha_m=0.0, alpha_f=d)
