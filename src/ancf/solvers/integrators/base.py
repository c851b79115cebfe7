"""What every integrator offers to the stepping."""

from __future__ import annotations

from typing import Protocol

from ..newmark import Scheme
from ..newton import Newton


class Integrator(Protocol):
    """A method of the Newmark family with its Newton settings."""

    @property
    def newton(self) -> Newton:
        """Settings of Newton's method."""
        ...

    @property
    def name(self) -> str:
        """Name in a model file."""
        ...

    def scheme(self) -> Scheme:
        """Coefficients of the method."""
        ...
