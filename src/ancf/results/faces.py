"""What the parts that look at a result or a state ask of it, so that they need not know these classes."""

from __future__ import annotations

from typing import Any, Protocol

from ..arrays import FloatArray, IntArray
from ..model.bodies.rigid import Body
from ..model.model import Model
from ..solvers.record import Stats


class Shaped(Protocol):
    """Bodies and state vectors: a State or a Result."""

    @property
    def bodies(self) -> dict[str, Body]:
        """Bodies by name."""
        ...

    @property
    def slots(self) -> dict[str, IntArray]:
        """First unknowns of the nodes' vectors by body."""
        ...

    @property
    def q(self) -> Any:
        """State vectors."""
        ...

    @property
    def v(self) -> Any:
        """Their rates."""
        ...


class History(Shaped, Protocol):
    """What a Result has."""

    model: Model

    @property
    def system(self) -> Any:
        """The compiled model."""
        ...

    @property
    def t(self) -> FloatArray:
        """Stored times."""
        ...

    @property
    def energy(self) -> Any:
        """Energies at these times."""
        ...

    @property
    def stats(self) -> Stats:
        """Counters."""
        ...

    @property
    def status(self) -> str:
        """How it ended."""
        ...

    @property
    def notes(self) -> list[str]:
        """What to know of it."""
        ...

    @property
    def provenance(self) -> dict[str, Any]:
        """Model, settings and versions."""
        ...

    def _inputs_said(self) -> list[str]:
        """What its inputs were, a text for each."""
        ...

    def _end_energies(self) -> tuple[FloatArray, FloatArray]: ...


class Instant(Shaped, Protocol):
    """What a State has."""

    system: Any
    model: Model
    t: float

    @property
    def energy(self) -> Any:
        """Its energies."""
        ...

    @property
    def notes(self) -> list[str]:
        """What to know of it."""
        ...

    def position(self, point: Any) -> FloatArray:
        """Position of a point."""
        ...

    def velocity(self, point: Any) -> FloatArray:
        """Velocity of a point."""
        ...

    def tension(self, point: Any) -> FloatArray:
        """Axial force at a point."""
        ...


class Swinging(Protocol):
    """What Modes and DampedModes have."""

    @property
    def notes(self) -> list[str]:
        """What to know of them."""
        ...

    @property
    def frequencies_hz(self) -> FloatArray:
        """Frequencies."""
        ...

    @property
    def about(self) -> Instant:
        """The state that is vibrated about."""
        ...


class Swung(Swinging, Protocol):
    """What Modes have."""

    @property
    def frequencies(self) -> FloatArray:
        """Angular frequencies."""
        ...


class Whirling(Swinging, Protocol):
    """What DampedModes have."""

    @property
    def eigenvalues(self) -> Any:
        """Complex, 1/s."""
        ...

    @property
    def damping_ratios(self) -> FloatArray:
        """Shares of the critical damping."""
        ...

    @property
    def whirl(self) -> FloatArray:
        """1 and -1 for circles with and against the rotation."""
        ...

    @property
    def spin(self) -> FloatArray:
        """Rate of the rotation."""
        ...
