"""Compiled parts of a Radau run: residuals, powers and outputs of several states at once."""

from __future__ import annotations

from ..batches import add_forces
from ..compiled import kernel
from ..system.core import drive, external_force, residual, to_local


@kernel
def stage_residuals(core, tables, q, v, a, f, r):
    """Residuals r, shape (m, size), of states at the times of the tables, as the solve wants them.

    What supports prescribe is put into q, v, a, and the shadows are filled.
    """
    for n in range(q.shape[0]):
        external_force(core.loads, tables.load[n], f)
        drive(core.supports, core.loads.moment, tables, n, q[n], v[n], a[n])
        residual(core.batches, core.ws, q[n], v[n], a[n], f, r[n])
        to_local(core.supports, r[n])


@kernel
def stage_powers(core, tables, q, v, a, f, r, zero, power):
    """Power dissipated and supplied, shape (m, 2), W, in states whose supports have been placed.

    Power is supplied by all loads but gravity and by the reactions of moving supports; damping forces are
    what the residual loses when the velocities are set to zero.
    """
    size = f.shape[0]
    for n in range(q.shape[0]):
        external_force(core.loads, tables.load[n], f)
        drive(core.supports, core.loads.moment, tables, n, q[n], v[n], a[n])
        residual(core.batches, core.ws, q[n], v[n], a[n], f, r[n])
        dissipated, supplied = 0.0, 0.0
        for i in range(size):
            dissipated += v[n, i] * r[n, i]
            supplied += v[n, i] * (f[i] - core.loads.gravity[i])
        for k in range(core.supports.driven.shape[0]):
            for c in range(3):
                i = core.supports.driven[k] + c
                supplied += v[n, i] * r[n, i]
        residual(core.batches, core.ws, q[n], zero, a[n], f, r[n])
        for i in range(size):
            dissipated -= v[n, i] * r[n, i]
            r[n, i] = 0.0
        add_forces(core.followers, q[n], v[n], a[n], r[n], core.ws)
        for i in range(size):
            supplied -= v[n, i] * r[n, i]
        power[n, 0], power[n, 1] = dissipated, supplied


@kernel
def place_rows(core, tables, q, v, a):
    """Supports and shadows of states, shape (m, size), at the times of the tables."""
    for n in range(q.shape[0]):
        drive(core.supports, core.loads.moment, tables, n, q[n], v[n], a[n])
