"""Natural modes about a state, undamped and damped."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..model.bodies.rigid import PointMass, RigidBody
from ..model.points import Point
from ..model.tables import Readable, Sheet
from ..system.fields import Fields
from .overview import line_of_modes, of_damped_modes, of_modes
from .pictures import ModesPlotted
from .sensitivities import sensitivity_of
from .state import State


class _Shapes(Fields):
    """Mode shapes read like states."""

    def __init__(self, state: State, shapes: FloatArray) -> None:
        self._bodies, self._slots = state.bodies, state.slots
        self._q = self._v = shapes


@dataclass(frozen=True)
class Modes(ModesPlotted, Readable):
    """Undamped natural modes about a state.

    Parameters
    ----------
    frequencies : ndarray, shape (count,)
        Angular frequencies, rad/s, ascending.
    shapes : ndarray, shape (count, size)
        State vectors of the shapes, normed to a modal mass of 1 kg.
    about : State
    notes : list of str
        What to know of them that nobody asked for: that the state is no equilibrium, that the model rotates.
    """

    frequencies: FloatArray
    shapes: FloatArray
    about: State
    derivatives: dict[str, Any] = field(default_factory=dict, repr=False)  # by the name of a parameter
    notes: list[str] = field(default_factory=list, repr=False)

    def __repr__(self) -> str:
        return line_of_modes(self)

    def _sheet(self) -> Sheet:
        return of_modes(self)

    @property
    def frequencies_hz(self) -> FloatArray:
        """Frequencies, Hz."""
        return self.frequencies / (2 * np.pi)

    def sensitivity(self, name: str) -> Any:
        """Derivatives by a parameter: ``frequencies``, ``frequencies_hz``, ``shapes``, ``position(point)``.

        Parameters
        ----------
        name : str
            One of ``modes(..., sensitivities=[...])``.

        Raises
        ------
        ModelError
            It was not asked for.
        """
        return sensitivity_of(self.derivatives, name)

    def position(self, point: Point | PointMass | RigidBody | str) -> FloatArray:
        """Displacement of a point in each mode, shape (count, 3), m for a modal mass of 1 kg."""
        return _Shapes(self.about, self.shapes).position(point)


@dataclass(frozen=True)
class DampedModes(Readable):
    """Damped modes about an equilibrium or a steady rotation; they grow and swing as ``exp(eigenvalue t)``.

    Of a pair of conjugate eigenvalues the one with the positive imaginary part is listed. About a rotation
    shapes and frequencies are those that an observer sees who turns with it: a circle with ``whirl`` 1 and
    the angular frequency w is one with w + spin for who stands still, one with -1 has spin - w.

    Parameters
    ----------
    eigenvalues : ndarray of complex, shape (count,)
        1/s, ascending by size; 0 first, once for each neutral motion.
    shapes : ndarray of complex, shape (count, size)
        State vectors of the shapes.
    whirl : ndarray, shape (count,)
        About the axis of the rotation 1 for circles with it, -1 against it, 0 for what swings in a plane, and
        without a rotation.
    spin : ndarray, shape (3,)
        Rate of the steady rotation, rad/s.
    about : State
        The equilibrium, or what was found to turn steadily.
    notes : list of str
        What to know of them that nobody asked for: that the state is no equilibrium.
    """

    eigenvalues: Any
    shapes: Any
    whirl: FloatArray
    spin: FloatArray
    about: State
    notes: list[str] = field(default_factory=list, repr=False)

    def __repr__(self) -> str:
        return line_of_modes(self)

    def _sheet(self) -> Sheet:
        return of_damped_modes(self)

    @property
    def frequencies_hz(self) -> FloatArray:
        """Frequencies of the damped swinging, Hz; 0 of what only decays."""
        found: FloatArray = np.abs(self.eigenvalues.imag) / (2 * np.pi)
        return found

    @property
    def damping_ratios(self) -> FloatArray:
        """Shares of the critical damping; negative of what grows, 0 of what is neutral."""
        size = np.abs(self.eigenvalues)
        found: FloatArray = -self.eigenvalues.real / np.where(size > 0.0, size, 1.0)
        return found

    def position(self, point: Point | PointMass | RigidBody | str) -> Any:
        """Displacement of a point in each mode, complex, shape (count, 3): its size and its phase."""
        real, imaginary = (
            _Shapes(self.about, part).position(point) for part in (self.shapes.real, self.shapes.imag)
        )
        return real + 1j * imaginary
