"""What parameters do to the residuals of the steps of a block, at fixed states: dR/dp.

The batches that a parameter changes have been compiled at values around its own.  R_p is the sum of their
forces with the weights of a difference formula; batches that serve several parameters, as those of the model
itself, are evaluated once.
"""

from __future__ import annotations

from typing import NamedTuple

from ..arrays import FloatArray, IntArray
from ..batches import Batches, add_force_of
from ..compiled import kernel
from ..system.core import drive, external_force, to_local


class Uses(NamedTuple):
    """Batches around the values of parameters, and what their forces count for which of these."""

    batches: Batches
    start: IntArray  # (batches + 1,) first use of each
    of: IntArray  # row of the pushes
    weight: FloatArray  # per unit of the parameter


@kernel
def add_pushes(core, uses, tables, way, work, push):
    """Add the forces of the batches to the pushes, and bring these into the form that the solve wants.

    Parameters
    ----------
    core : Core
        Of the model itself; its supports and inputs are those of all.
    uses : Uses
    tables : Tables
        At the ends of the steps.
    way : Way
        States there.
    work : (size,)
    push : (rows, steps, size)
        What loads do already, in physical components.
    """
    n, size = core.weight.shape[0], work.shape[0]
    for step in range(way.q.shape[0]):
        q, v, a = way.q[step], way.v[step], way.a[step]
        drive(core.supports, core.loads.value, tables, step, q, v, a)
        for k in range(uses.start.shape[0] - 1):
            for i in range(size):
                work[i] = 0.0
            add_force_of(uses.batches, k, q, v, a, work, core.ws)
            for m in range(uses.start[k], uses.start[k + 1]):
                row, weight = push[uses.of[m], step], uses.weight[m]
                for i in range(size):
                    row[i] += weight * work[i]
        for p in range(push.shape[0]):
            row = push[p, step]
            to_local(core.supports, row)
            for i in range(n, size):
                row[i] = 0.0


@kernel
def add_loads(loads, value, weight, work, push):
    """Subtract the weighted dead loads with these inputs, (steps or 1, n, 3), from the pushes of a row."""
    for step in range(push.shape[0]):
        if step < value.shape[0]:
            external_force(loads, value[step], work)
        for i in range(work.shape[0]):
            push[step, i] -= weight * work[i]
