"""How far round-off reaches: the unknowns of a state changed by what their last digits do not hold.

A state vector holds positions to the last digit of the model's coordinates, slopes to that of 1 and
multipliers to that of the largest, or of the forces of strains, which they balance.  What changes when these
digits do is not known: forces, stiffnesses, and what follows from them.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray
from ...system.core import follow_supports
from ...system.reactions import largest_stiffness
from ...system.system import System

#: Changes of a state, and their size in units of the last digit.
TIMES, DIGITS = 4, 2.0


def shaken(system: System, q: FloatArray, strained: bool = False) -> Iterator[FloatArray]:
    """State vectors beside q (size,), equal to it but for the last digits of the unknowns that are free.

    ``strained``: those of multipliers are at least the last digits of the forces of strains.
    """
    n, weight = system.n, system.core.weight
    free, carried = system.free, np.intersect1d(system.free, system.multipliers)
    places = np.flatnonzero(np.isin(np.arange(n), _positions(system)))
    unit = np.where(weight > 0.0, 1.0 / np.where(weight > 0.0, weight, 1.0), 0.0)
    unit[places] = np.maximum(unit[places], np.max(np.abs(q[places]), initial=0.0))
    least = _stiffest(system, unit[places]) if strained else 0.0
    unit[carried] = max(float(np.max(np.abs(q[carried]), initial=0.0)), least)
    rng = np.random.default_rng(1)
    for _ in range(TIMES):
        near = q.copy()
        near[free] += DIGITS * np.finfo(float).eps * unit[free] * rng.uniform(-1.0, 1.0, len(free))
        follow_supports(system.core.supports, near, np.zeros_like(near), np.zeros_like(near))
        yield near


def _stiffest(system: System, unit: FloatArray) -> float:
    """Forces whose last digit is that of a strain, N: multipliers balance them."""
    shortest = min((beam.length / beam.elements for beam in system.model.beams.values()), default=np.inf)
    return largest_stiffness(system) * max(1.0, float(np.max(unit, initial=0.0)) / shortest)


def _positions(system: System) -> NDArray[np.int64]:
    first = [slots[:, 0] for slots in system.numbering.slots.values()]
    return (np.concatenate(first)[:, None] + np.arange(3)).ravel()
