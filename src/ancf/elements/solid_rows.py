"""What kernels of the two fully parameterised beams take into the workspace for a chunk, and give back."""

from __future__ import annotations

from ..compiled import inline_kernel
from ..simd import LANES, gather, load, scatter, store
from .solid_force import (
    ACCELERATION,
    B1,
    BX,
    C1,
    CONSTANTS,
    CX,
    DB,
    DC,
    FORCE,
    INV_L,
    LENGTH,
    NATURAL,
    R2,
    RATE,
    VECTORS,
    VISCOUS,
    D,
    inertia_force,
)
from .workspace import add_rows, clear, row, rows, set_rows


@inline_kernel
def take(batch, x, ws, chunk, first):
    """Rows from ``first`` on: the unknowns of all columns of base.

    ``first`` comes as np.int64(...): numba would compile a version of its own for each literal.
    """
    for slot in range(batch.base.shape[1]):
        set_rows(ws, first + 3 * slot, gather(x, batch.lane_base, chunk, slot))


@inline_kernel
def take_vectors(batch, x, ws, chunk, first):
    """Rows from ``first`` on: the element's vectors."""
    take(batch, x, ws, chunk, first)
    h, il = row(ws, LENGTH), row(ws, INV_L)
    set_rows(ws, first + D, il * (rows(ws, first + R2) - rows(ws, first + D)))
    set_rows(ws, first + DB, rows(ws, first + DB) - rows(ws, first + B1))
    set_rows(ws, first + DC, rows(ws, first + DC) - rows(ws, first + C1))
    set_rows(ws, first + BX, h * rows(ws, first + BX))
    set_rows(ws, first + CX, h * rows(ws, first + CX))


@inline_kernel
def add_viscous(batch, v, ws, chunk):
    """Rows ACCELERATION of the centreline: add (damping / rhoA) velocity, the external damping."""
    for slot in (0, 1, 4, 5):
        add_rows(ws, ACCELERATION + 3 * slot, row(ws, VISCOUS) * gather(v, batch.lane_base, chunk, slot))


@inline_kernel
def load_constants(batch, ws, chunk):
    """Rows LENGTH ... VISCOUS."""
    for k in range(CONSTANTS):
        store(load(batch.lane_data, chunk, k), ws, (LENGTH + k) * LANES)


@inline_kernel
def load_natural(batch, ws, chunk, g, curved):
    """Rows NATURAL at a Gauss point; they stay zero for a straight natural shape."""
    if curved:
        for k in range(15):
            store(load(batch.lane_reference, chunk, 15 * g + k), ws, (NATURAL + k) * LANES)


@inline_kernel
def store_nodal(batch, r, ws, chunk):
    """Add the rows FORCE of a chunk to the residual."""
    for slot in range(batch.base.shape[1]):
        scatter(rows(ws, FORCE + 3 * slot), r, batch.lane_base, chunk, slot)


@inline_kernel
def clear_unused(ws):
    """Rows that the original element does not fill, and those of a straight natural shape."""
    clear(ws, BX, 6)
    clear(ws, RATE + BX, 6)
    clear(ws, ACCELERATION + BX, 6)
    clear(ws, NATURAL, 15)


@inline_kernel
def store_forces(batch, out, ws, chunk):
    """Add the rows FORCE of a chunk, forces on the element's vectors, to ``out``."""
    clear(ws, ACCELERATION, VECTORS)
    inertia_force(ws, batch.mass)
    store_nodal(batch, out, ws, chunk)
