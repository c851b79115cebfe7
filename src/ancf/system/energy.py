"""Energies of states of a System."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..elements.winched_build import momenta
from .core import energies_of
from .system import System
from .torsion_fields import angles


def energies(system: System, q: FloatArray, v: FloatArray) -> FloatArray:
    """Kinetic, strain and potential energy of states, J.

    Parameters
    ----------
    system : System
    q, v : ndarray, shape (m, size)
        State vectors and their rates.

    Returns
    -------
    ndarray, shape (m, 3)
    """
    out = np.empty((len(q), 3))
    momentum = np.empty(system.size)
    core, turned = system.core, system.parts.get("torsion springs")
    last = turned.last.copy() if turned else None
    for k in reversed(range(len(q))):  # full turns are counted from the present state backwards
        energies_of(core.batches, core.ws, core.loads.still, q[k], v[k], momentum, out[k])
        if "winched" in system.parts:
            out[k] += _of_winched(system, q[k], v[k])
        if turned:
            turned.last[:] = angles(turned, q[k])
    if turned:
        turned.last[:] = last
    return out


def _of_winched(system: System, q: FloatArray, v: FloatArray) -> tuple[float, float, float]:
    """Kinetic and potential energy of cables with a winch, whose mass goes with their length."""
    _, w, momentum = momenta(system.parts["winched"], q, v)
    loads = system.core.loads
    weight = q[loads.hung_from][:, None] * loads.hung
    return 0.5 * np.sum(w * momentum), 0.0, -np.sum(weight * q[loads.hung_slot[:, None] + np.arange(3)])
