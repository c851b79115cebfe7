"""Friction that remembers the way in the steps of a block: what it remembers, and the derivatives of that.

With the memory z_n (anchors and limits) in which step n begins, the step and what it leaves behind are

    R(q, v, a; z_n, p) = 0,     z_{n+1} = g(q, v; z_n, p),

so that R_z dz_n joins what a parameter does to the residual, and

    dz_{n+1} = g_q s_q + g_v s_v + g_z dz_n + g_p.

What slips in the state at the end of the step slips in all of theirs, what sticks, sticks.  So does what is
just at its limit: as long as nothing moves there, as in an equilibrium to which it has slipped, both sides of
the kink have the same derivative, but only along all changes together.

The states of a block are known, so its memories are found first, and are brought to the batches step by step.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray, IntArray
from ...batches import Batches, remember_all
from ...compiled import inline_kernel, kernel
from ...linalg.eight import lane_rows
from ...records import recorded
from ...simd import LANES
from ...system.core import drive
from ..rare import add_memory_changes_of, add_memory_slopes_of, choose_memory_of, remember_along_of


@recorded
class Friction(NamedTuple):
    """Batches with friction, what they remember in the steps of a block, and its derivatives."""

    batches: Batches  # whose memory is that of one step
    first: IntArray  # (batches + 1,) where the numbers of each begin
    now: FloatArray  # (numbers,) these memories, which the arrays of the batches are parts of
    chosen: FloatArray  # (steps, numbers) those of all steps
    z: FloatArray  # (p/8 rounded up, numbers, 8) their derivatives in the step that comes
    start: IntArray  # (batches + 1,) first change of the numbers of each, see ``Changes``
    rates: FloatArray
    rates_from: IntArray
    kinds: IntArray
    kinds_from: IntArray
    begin: IntArray  # where in z the rows of each change begin


def no_friction() -> Friction:
    """Of models without."""
    none, one, floats = np.zeros(0, dtype=np.int64), np.zeros(1, dtype=np.int64), np.zeros(0)
    z = lane_rows(0).reshape(0, 0, LANES)
    return Friction(Batches(), one, floats, np.zeros((0, 0)), z, one, floats, one, none, one, none)


@kernel
def choose_here(remembering, first, q, v, out):
    """Fill the memories of batches, one after the other, with what their points do in a state chosen."""
    for k in range(first.shape[0] - 1):
        choose_memory_of(remembering, k, q, v, out[first[k] : first[k + 1]])


@kernel
def remember_steps(core, friction, remembering, tables, way):
    """Fill what is remembered in the steps of a block, from what batches that ``remembering`` has know now.

    These know in the end what the last step leaves.
    """
    for n in range(way.q.shape[0]):
        q, v, a = way.q[n], way.v[n], way.a[n]
        drive(core.supports, core.loads.value, tables, n, q, v, a)
        for k in range(friction.first.shape[0] - 1):
            own = friction.chosen[n, friction.first[k] : friction.first[k + 1]]
            choose_memory_of(remembering, k, q, v, own)
        remember_all(remembering, q, v)


@inline_kernel
def bring(friction, n):
    """Let batches remember what they do in step n of a block."""
    for i in range(friction.now.shape[0]):
        friction.now[i] = friction.chosen[n, i]


@inline_kernel
def add_remembered(friction, group, q, v, r, ws):
    """Add R_z dz of eight parameters to r, (size, 8)."""
    for k in range(friction.first.shape[0] - 1):
        z = friction.z[group, friction.first[k] : friction.first[k + 1]]
        add_memory_slopes_of(friction.batches, k, q, v, z, r, ws)


@inline_kernel
def remember_group(friction, group, q, v, d, ws):
    """Let z of eight parameters be what a step leaves whose sensitivities are d, but for g_p."""
    for k in range(friction.first.shape[0] - 1):
        z = friction.z[group, friction.first[k] : friction.first[k + 1]]
        remember_along_of(friction.batches, k, q, v, d, z, ws)


@inline_kernel
def remember_changes(friction, q, v, ws):
    """Add g_p of all parameters to z."""
    out = friction.z.reshape(-1)
    for k in range(friction.first.shape[0] - 1):
        own = friction.begin[friction.start[k] : friction.start[k + 1]]
        if own.shape[0] > 0:
            rates = friction.rates[friction.rates_from[k] : friction.rates_from[k + 1]]
            kinds = friction.kinds[friction.kinds_from[k] : friction.kinds_from[k + 1]]
            add_memory_changes_of(friction.batches, k, q, v, rates, kinds, own, out, ws)
