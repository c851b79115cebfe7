"""Natural modes about a state."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..model.bodies import PointMass, RigidBody
from ..model.points import Point
from ..model.tables import Readable, Sheet
from ..system.fields import Fields
from .overview import line_of_modes, of_modes
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
    """

    frequencies: FloatArray
    shapes: FloatArray
    about: State
    derivatives: dict[str, Any] = field(default_factory=dict, repr=False)  # by the name of a parameter

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
