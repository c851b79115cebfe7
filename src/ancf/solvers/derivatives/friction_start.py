"""What friction remembers at a start, and the derivatives of that, see ``friction``."""

from __future__ import annotations

from ...compiled import kernel
from ...simd import LANES, every, store
from .friction import add_remembered, remember_changes, remember_group
from .lacking import to_local_abreast


@kernel
def remember_start(core, friction, q, v, d):
    """Let z be what a start leaves of no memory: derivatives of the state there, d (p/8, 3, size, 8)."""
    for g in range(d.shape[0]):
        remember_group(friction, g, q, v, d[g], core.ws)
    remember_changes(friction, q, v, core.ws)


@kernel
def push_start(core, friction, q, v, r, push):
    """Fill the pushes at a start, (p, size), with R_z dz at the free unknowns; r: room (size, 8)."""
    for g in range(friction.z.shape[0]):
        for i in range(r.shape[0]):
            store(every(0.0), r, i)
        add_remembered(friction, g, q, v, r, core.ws)
        to_local_abreast(core.supports, r)
        for k in range(core.supports.held.shape[0]):
            store(every(0.0), r, core.supports.held[k])
        for k in range(min(LANES, push.shape[0] - LANES * g)):
            for i in range(core.weight.shape[0]):
                push[LANES * g + k, i] = r[i, k]


@kernel
def push_beside(core, friction, q, v, r):
    """Add R_z dz of the first eight parameters to r, (size, 8), also where supports hold."""
    add_remembered(friction, 0, q, v, r, core.ws)
