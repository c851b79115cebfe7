"""State of a system at one time, and its energy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..solvers.stepping import Stats
from ..system.energy import energies
from ..system.fields import Fields
from ..system.joint_fields import JointFields
from ..system.system import System

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Energy:
    """Energies in J; arrays of shape (n_t,) for a history, numbers for a state.

    ``potential`` is that of gravity, zero at the origin; all other loads, moments and moving supports
    count as ``supplied`` work since the start, and ``dissipated`` is what the damping took out.
    """

    kinetic: FloatArray
    strain: FloatArray
    potential: FloatArray
    dissipated: FloatArray
    supplied: FloatArray

    @property
    def total(self) -> FloatArray:
        """Kinetic + strain + potential energy."""
        return self.kinetic + self.strain + self.potential

    @property
    def balance(self) -> FloatArray:
        """Total + dissipated - supplied: constant but for the integration error."""
        return self.total + self.dissipated - self.supplied


class State(Fields, JointFields):
    """Positions and velocities of a model at one time; see :class:`Fields` for what it answers.

    Parameters
    ----------
    system : System
    t : float
        Time, s.
    q, v : ndarray, shape (size,)
        State vectors.
    stats : Stats
        What it cost to compute.
    """

    def __init__(
        self, system: System, t: float, q: FloatArray, v: FloatArray, stats: Stats | None = None
    ) -> None:
        self.system, self.t = system, t
        self.stats = Stats() if stats is None else stats
        self._q, self._v = q, v
        self._bodies, self._slots = system.model.bodies, system.slots
        self._joints, self._arcs = system.joints, system.numbering.arcs

    @property
    def energy(self) -> Energy:
        """Energies; nothing is dissipated or supplied at one time."""
        kinetic, strain, potential = energies(self.system, self.q[None], self.v[None])[0]
        zero = np.float64(0.0)
        return Energy(kinetic, strain, potential, zero, zero)  # type: ignore[arg-type]
