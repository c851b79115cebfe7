"""Time integrators, one file per method."""

from .base import Integrator
from .explicit import Explicit
from .generalized_alpha import GeneralizedAlpha
from .radau import Radau
from .trapezoidal import Trapezoidal

#: The integrators by the name that a model file uses.
INTEGRATORS: dict[str, type[Integrator]] = {
    "trapezoidal": Trapezoidal,
    "generalized_alpha": GeneralizedAlpha,
    "radau": Radau,
    "explicit": Explicit,
}

__all__ = ["INTEGRATORS", "Explicit", "GeneralizedAlpha", "Integrator", "Radau", "Trapezoidal"]
