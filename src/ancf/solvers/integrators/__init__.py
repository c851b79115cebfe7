"""Time integrators, one file per method."""

from .base import Integrator
from .generalized_alpha import GeneralizedAlpha
from .trapezoidal import Trapezoidal

#: The integrators by the name that a model file uses.
INTEGRATORS: dict[str, type[Integrator]] = {
    "trapezoidal": Trapezoidal,
    "generalized_alpha": GeneralizedAlpha,
}

__all__ = ["INTEGRATORS", "GeneralizedAlpha", "Integrator", "Trapezoidal"]
