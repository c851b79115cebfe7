"""Derivatives of the forces of some batches as differences, along global axes.

What has no matrix that is its derivative, as what is not symmetric or the friction of a contact, has forces;
of a state at rest, of which modes are wanted, a few hundred of them cost nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from ...arrays import FloatArray, IntArray
from ...batches import Batches
from ...compiled import Role, traits
from ...later import coo_array, csc_array
from ...system.core import residual
from ...system.system import System

DIFFERENCE, ROUND_OFF = 1e-6, 1e-8  # of positions in sizes of the model; of derivatives, what is none


class Differences:
    """Derivatives of the forces of batches, of which some may be loads."""

    def __init__(self, system: System, batches: Iterable[Any]) -> None:
        self.system, self.batches = system, Batches(batches)
        self.place = np.arange(system.n)
        supports = system.core.supports
        for c in range(3):
            self.place[supports.rot_slot + c] = supports.rot_shadow + c
        touched = np.isin(self.place, _touched(self.batches)) & (system.core.weight > 0.0)
        self.moved = np.flatnonzero(touched)

    def at(
        self, q: FloatArray, velocity: Callable[[FloatArray], FloatArray], rate: float = 1.0
    ) -> tuple[FloatArray, FloatArray]:
        """By positions, velocities following them, and by velocities alone, each (n, n).

        ``rate``: size of velocities beside that of positions, 1/s.
        """
        n = self.system.n
        by_place, by_rate = np.zeros((n, n)), np.zeros((n, n))
        v = velocity(q)
        for i in self.moved.tolist():
            weight = self.system.core.weight[i]
            near, far = (self._nudged(q, i, s * DIFFERENCE / weight) for s in (1.0, -1.0))
            difference = self._forces(near, velocity(near)) - self._forces(far, velocity(far))
            by_place[:, i] = difference * weight / (2.0 * DIFFERENCE)
            step = rate * DIFFERENCE
            near, far = (self._nudged(v, i, s * step / weight) for s in (1.0, -1.0))
            by_rate[:, i] = (self._forces(q, near) - self._forces(q, far)) * weight / (2.0 * step)
        return by_place, by_rate

    def among(self, q: FloatArray) -> FloatArray:
        """At rest by positions, of the forces on what the batches touch: rows and columns as in ``moved``."""
        found, still = np.zeros((len(self.moved), len(self.moved))), np.zeros_like(q)
        for k, i in enumerate(self.moved.tolist()):
            by = DIFFERENCE / self.system.core.weight[i]
            near, far = (self._forces(self._nudged(q, i, s * by), still) for s in (1.0, -1.0))
            found[:, k] = (near - far)[self.moved] / (2.0 * by)
        return np.where(np.abs(found) < ROUND_OFF * np.max(np.abs(found), initial=0.0), 0.0, found)

    def _nudged(self, x: FloatArray, i: int, by: float) -> FloatArray:
        near = x.copy()
        near[self.place[i]] += by
        return near

    def _forces(self, q: FloatArray, v: FloatArray) -> FloatArray:
        """In global components, (n,)."""
        none, r = np.zeros_like(q), np.zeros_like(q)
        residual(self.batches, self.system.core.ws, q, v, none, none, r)
        found: FloatArray = r[self.place]
        return found


def contacts_of(system: System) -> list[Any]:
    """Batches of contacts, whose matrices take normals as they are, or the friction that was."""
    kinds = ((batch, traits(batch)) for batch in system.core.remembering)
    return [batch for batch, own in kinds if own.row is None and Role.EXTERNAL not in own.role]


def without_noise(found: csc_array, known: csc_array) -> csc_array:
    """How differences, which have noise, differ from a matrix."""
    left = csc_array(found - known)
    left.data[np.abs(left.data) < ROUND_OFF * np.max(np.abs(found.data), initial=0.0)] = 0.0
    return left


def axes_of(system: System) -> csc_array:
    """Global components of all unknowns."""
    supports = system.core.supports
    whole = np.ones(system.n)
    rows, columns, values = [], [], []
    for k, slot in enumerate(supports.rot_slot.tolist()):
        whole[slot : slot + 3] = 0.0
        rows += np.repeat(slot + np.arange(3), 3).tolist()
        columns += np.tile(slot + np.arange(3), 3).tolist()
        values += supports.rot_R[k, 0].ravel().tolist()
    each = np.flatnonzero(whole)
    i, j = np.concatenate([each, rows]).astype(int), np.concatenate([each, columns]).astype(int)
    given = np.concatenate([np.ones(len(each)), values])
    return csc_array(coo_array((given, (i, j)), shape=(system.n, system.n)))


def _touched(batches: Iterable[Any]) -> IntArray:
    """Entries of the state vector of all slots of batches."""
    slots = [np.ravel(getattr(b, name)) for b in batches for name in traits(b).slots]
    found = np.concatenate([np.zeros(0, dtype=np.int64), *slots])
    found = np.unique(found[found >= 0])
    return np.ravel(found[:, None] + np.arange(3))
