"""Kernels of :mod:`ancf.solvers.step.rescue`, compiled when a run first needs them."""

from __future__ import annotations

from ...batches import remember_all
from ...compiled import kernel
from ...system.core import follow, residual, to_local
from ..status import OK
from .balance import balance
from .checks import check_sections, check_way
from .scheme import finish, restore, show_bars


@kernel
def differences(core, base, moved, f, r, step, rated, gb, ib, start, unknown, out):
    """Differences of the residual, one row of ``out`` for each group of unknowns.

    ``base`` and ``moved`` hold q, v, a in three rows; rates follow where ``rated`` is 1.
    """
    q, v, a = moved[0], moved[1], moved[2]
    for g in range(start.shape[0] - 1):
        for side in range(2):
            for i in range(q.shape[0]):
                q[i], v[i], a[i] = base[0, i], base[1, i], base[2, i]
            for k in range(start[g], start[g + 1]):
                i = unknown[k]
                d = step[i] if side == 0 else -step[i]
                q[i] += d
                v[i] += gb * rated[i] * d
                a[i] += ib * rated[i] * d
            follow(core.supports, q, v, a)
            residual(core.batches, core.ws, q, v, a, f, r)
            to_local(core.supports, r)
            for i in range(out.shape[1]):
                out[g, i] = r[i] if side == 0 else out[g, i] - r[i]


@kernel
def accept(core, s, h, scheme, furthest):
    """Judge the step that is in s and finish it, or go back to its start; returns its status."""
    status = check_sections(core, s)
    if status == OK:
        status = check_way(core, s, furthest)
    if status != OK:
        restore(s)
        return status
    finish(s, h, scheme)
    show_bars(s, scheme)
    if core.accounted and (core.damped or core.loaded):
        balance(core, s, h)
    remember_all(core.remembering, s.q, s.v)
    return status
