"""The nodes of cable elements in vectors of unknowns, for LANES elements at a time."""

from __future__ import annotations

from ..compiled import formula
from ..simd import gather, gather_nodes, scatter, scatter_nodes


@formula
def nodes(batch, x, chunk):
    """Values x of the four slots r, r_x, r, r_x."""
    base = batch.lane_base
    if batch.nodal[chunk]:
        r1, t1 = gather_nodes(x, base, chunk, 0)
        r2, t2 = gather_nodes(x, base, chunk, 2)
    else:
        r1, t1 = gather(x, base, chunk, 0), gather(x, base, chunk, 1)
        r2, t2 = gather(x, base, chunk, 2), gather(x, base, chunk, 3)
    return r1, t1, r2, t2


@formula
def add_to_nodes(batch, r, chunk, value):
    """Add values of the four slots to r."""
    r1, t1, r2, t2 = value
    if batch.nodal[chunk]:
        scatter_nodes(r1, t1, r, batch.lane_base, chunk, 0)
        scatter_nodes(r2, t2, r, batch.lane_base, chunk, 2)
    else:
        scatter(r1, r, batch.lane_base, chunk, 0)
        scatter(t1, r, batch.lane_base, chunk, 1)
        scatter(r2, r, batch.lane_base, chunk, 2)
        scatter(t2, r, batch.lane_base, chunk, 3)
