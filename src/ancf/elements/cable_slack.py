"""Slack cables: what an equilibrium changes for a while, the axial stiffness and the natural lengths."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from .cable import CableBatch
from .cable_columns import AXIAL, BEGIN, CURVED, EA_L, END, LENGTH, PAPER
from .chunks import in_lanes


class Slack:
    """The cables of a batch, whose stiffness may be lowered and whose compression taken away.

    Parameters
    ----------
    batch : CableBatch or WinchedBatch
        Changed in place.
    q : ndarray
        State vector of the initial shape: where a chord is shorter than its element, it is pressed.
    grown : ndarray, optional
        Lengths of the elements as multiples of those of the batch.
    """

    def __init__(self, batch: Any, q: FloatArray, grown: Any = 1.0) -> None:
        self._batch = batch
        self._stiffness = batch.lane_data[:, EA_L]
        self._natural = self._stiffness.copy(), batch.lane_reference.copy(), batch.groups[:, CURVED].copy()
        self._strain = compression(batch, q, grown)

    @property
    def stiffest(self) -> float:
        """Largest EA, N."""
        return float(np.max(self._natural[0] / self._batch.lane_data[:, LENGTH]))

    def set(self, factor: float, held: float) -> None:
        """EA times a factor, and no forces from this share of the initial compression; (1, 0): as it was."""
        stiffness, reference, curved = self._natural
        self._stiffness[:] = stiffness * factor
        self._batch.lane_reference[:] = reference + held * self._strain
        self._batch.groups[:, CURVED] = curved if held == 0.0 else 1


def slack(batch: CableBatch, q: FloatArray) -> Slack:
    """See :class:`ancf.elements.registry.Element`."""
    return Slack(batch, q)


def compression(batch: Any, q: FloatArray, grown: Any = 1.0) -> FloatArray:
    """Axial strain of the chords that are shorter than their element, in the form of lane_reference."""
    counts = np.diff(batch.first)
    lane = np.arange(len(batch.base)) - np.repeat(batch.first[:-1], counts)
    h = grown * batch.lane_data[np.repeat(np.arange(len(counts)), counts), LENGTH, lane]
    first, second = (q[batch.base[:, k, None] + np.arange(3)] for k in (0, 2))
    stretch = np.minimum(np.linalg.norm(second - first, axis=1) / h, 1.0)
    strain = np.zeros((len(batch.base), 20))
    for group in batch.groups:
        rows = slice(batch.first[group[BEGIN]], batch.first[group[END]])
        s = stretch[rows, None]
        strain[rows, : group[AXIAL]] = 0.5 * (s**2 - 1.0) if group[PAPER] else s - 1.0
    return in_lanes(strain, batch.first)
