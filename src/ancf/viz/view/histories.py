"""The stored states of a result in memory, as many as curves and traces need."""

from __future__ import annotations

from copy import copy
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...model.bodies.beam import Beam
from ...results import moments
from ...system.joint_fields import JointFields
from ...system.spring_fields import SpringFields

#: States at most, and numbers of their q and v at most: 64 MB each.
STATES, NUMBERS = 20_000, 8_000_000


class Histories(SpringFields, JointFields):
    """Some of the states of a Result, evenly spaced; it answers as the Result does.

    Parameters
    ----------
    source : Result
    """

    def __init__(self, source: Any) -> None:
        self.model, self._source = source.model, source
        self._bodies, self._slots, self._lengths = source.bodies, source.slots, source.lengths
        self._springs, self._joints, self._arcs = source.springs, source.joints, source.arcs
        count, size = source.q.shape
        most = int(np.clip(NUMBERS // max(size, 1), 2, STATES))
        stride = -(-count // most)
        self.t: FloatArray = source.t[::stride]
        self._q: FloatArray = np.asarray(source.q[::stride])
        self._v: FloatArray = np.asarray(source.v[::stride])

    def joint_force(self, joint: Any) -> FloatArray:
        """See :meth:`ancf.Result.joint_force`; of joints with multipliers."""
        system = self._source.system
        return moments.force_of_joint(system, moments.checked_joint(system, joint, True), self._q)

    def every(self, inside: slice, stride: int) -> Histories:
        """Every so-manieth of a part of the states, the last one included."""
        kept = np.union1d(np.arange(inside.start, inside.stop, stride), [inside.stop - 1])
        some = copy(self)
        some.t, some._q, some._v = self.t[kept], self._q[kept], self._v[kept]
        return some

    def ends(self) -> list[Any]:
        """Starts and ends of the beams and the other bodies: points that are worth a trace."""
        points: list[Any] = []
        for name, body in self._bodies.items():
            points += [body.end, body.start] if isinstance(body, Beam) else [name]
        return points

    def middles(self) -> list[Any]:
        """Middles of the beams: these move when the ends are held."""
        beams = [body for body in self._bodies.values() if isinstance(body, Beam)]
        return [beam.at(0.5 * beam.length) for beam in beams]
