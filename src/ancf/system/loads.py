"""Loads of the model as patterns of nodal forces, and the batch of moments."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..elements.shapes import gauss, hermite
from ..loads.moment import MomentBatch
from ..model.beam import Beam
from ..model.functions import TimeFunction
from ..model.loads import DistributedLoad, Force, Moment
from ..model.model import Model
from .probe import Probe

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Pattern = tuple[IntArray, FloatArray]  # slots and factors
Locate = Callable[..., Probe]


def patterns(
    model: Model, locate: Locate, slots: dict[str, IntArray]
) -> tuple[list[Pattern], list[TimeFunction]]:
    """Patterns and amplitudes of all loads but gravity and moments."""
    found: list[Pattern] = []
    amplitudes: list[TimeFunction] = []
    for load in model.loads:
        if isinstance(load, Force):
            probe = locate(load.point)
            found.append((probe.slots, probe.S[0]))
            amplitudes.append(load.force)
        elif isinstance(load, DistributedLoad):
            found.append(distributed(load.body, slots[load.body.name], *load.between))
            amplitudes.append(load.load)
    return found, amplitudes


def moments(model: Model, locate: Locate) -> tuple[MomentBatch, list[TimeFunction]]:
    """Batch of all moments and their amplitudes."""
    items = [load for load in model.loads if isinstance(load, Moment)]
    probes = [locate(load.point) for load in items]
    n = len(items)
    batch = MomentBatch(
        base=np.array([p.slots for p in probes], dtype=np.int64).reshape(n, 4),
        dest=np.full((n, 16), -1, dtype=np.int64),
        factor=np.array([p.S[1] for p in probes], dtype=np.float64).reshape(n, 4),
        value=np.zeros((n, 3)),
    )
    return batch, [load.moment for load in items]


def distributed(beam: Beam, slots: IntArray, x0: float, x1: float) -> Pattern:
    """Consistent nodal factors of a unit load per reference length from x0 to x1."""
    xi, weight = gauss(2)  # exact: the integrand is cubic
    factors = np.zeros((beam.elements + 1, 2))
    for e in range(beam.elements):
        a, b = beam.node_x[e], beam.node_x[e + 1]
        lo, hi = max(a, x0), min(b, x1)
        if hi > lo:
            S = hermite((lo + (hi - lo) * xi - a) / (b - a), b - a)
            factors[e : e + 2] += ((hi - lo) * weight @ S).reshape(2, 2)
    return slots[:, :2].ravel(), factors.ravel()


def gravity(model: Model, slots: dict[str, IntArray], size: int) -> FloatArray:
    """Weight of all bodies on a state vector of this size, N."""
    f = np.zeros(size)
    for beam in model.bodies.values():
        at, factor = distributed(beam, slots[beam.name], 0.0, beam.length)
        for c in range(3):
            np.add.at(f, at + c, factor * beam.section.rhoA * model.gravity[c])
    return f
