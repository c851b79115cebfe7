"""Compiled parts of a Radau run: residuals, powers and outputs of several states at once."""

from __future__ import annotations

from ...compiled import kernel
from ...system.core import drive, external_force, residual, to_local
from ...system.powers import powers


@kernel
def stage_residuals(core, tables, q, v, a, f, r):
    """Residuals r, shape (m, size), of states at the times of the tables, as the solve wants them.

    What supports prescribe is put into q, v, a, and the shadows are filled.
    """
    for n in range(q.shape[0]):
        external_force(core.loads, tables.value[n], f)
        drive(core.supports, core.loads.value, tables, n, q[n], v[n], a[n])
        residual(core.batches, core.ws, q[n], v[n], a[n], f, r[n])
        to_local(core.supports, r[n])


@kernel
def stage_powers(core, tables, q, v, a, f, push, loss, r, power):
    """Power dissipated and supplied, shape (m, 2), W, in states (m, size) whose supports are placed."""
    for n in range(q.shape[0]):
        external_force(core.loads, tables.value[n], f)
        drive(core.supports, core.loads.value, tables, n, q[n], v[n], a[n])
        power[n, 0] = powers(core, q[n], v[n], a[n], f, push, loss, r)
        supplied = 0.0
        for i in range(f.shape[0]):
            supplied += v[n, i] * push[i]
        power[n, 1] = supplied


@kernel
def place_rows(core, tables, q, v, a):
    """Supports and shadows of states, shape (m, size), at the times of the tables."""
    for n in range(q.shape[0]):
        drive(core.supports, core.loads.value, tables, n, q[n], v[n], a[n])
