"""Derivatives of the forces of the two beams along changes of their constants, for LANES elements at a time.

Forces are linear in stiffnesses, dampings and masses: they are those of elements whose constants are the
change.  The length acts through d = (r_2 - r_1)/L, bx = L r_yx and cx = L r_zx of the shape and the rates,
which move along themselves, and through the factors of the forces on these.
"""

from __future__ import annotations

import numpy as np

from ..compiled import formula, inline_kernel
from ..simd import LANES, every, load, store
from ..vectors import dot
from .cable_changes import both, inertia_longer
from .solid_force import (
    ACCELERATION,
    AXIAL,
    B1,
    BENDING,
    BX,
    C1,
    CONSTANTS,
    CX,
    D_A,
    DB,
    DC,
    FORCE,
    INV_L,
    LENGTH,
    MASS,
    MASS_Y,
    R2,
    RATE,
    T1,
    T2,
    TANGENT,
    VECTORS,
    VISCOUS,
    D,
    damping_force,
    elastic_force,
    inertia_force,
    point,
    spread,
    vectors,
)
from .solid_numbers import nodal
from .solid_rows import clear_unused, load_constants, load_natural, store_nodal, take, take_vectors
from .solid_tangent_work import elastic_slopes
from .workspace import add_rows, clear, row, rows, set_rows

#: Bits of the kinds of a change.
STIFF, DAMPED, HEAVY, LONGER = 1, 2, 4, 8
#: Rows of the constants of each.
KINDS = {STIFF: (D_A, AXIAL), DAMPED: (AXIAL, MASS), HEAVY: (MASS, LENGTH + CONSTANTS), LONGER: (LENGTH, D_A)}
#: Rows of what the length does to the vectors of the shape and of the rates; of rates and accelerations of
#: the unknowns.
MOVED, FASTER, NODAL_V, NODAL_A = ACCELERATION, TANGENT, TANGENT + 30, TANGENT + 60
#: Rows of the unknowns of the centreline, and of those of the section.
CENTRE, SECTION = (D, T1, R2, T2), (B1, C1, DB, DC, BX, CX)


def kinds_of(batch, rates):
    """Which constants of each chunk a change has, as bits; see :class:`ancf.compiled.Traits`."""
    has = rates.reshape(len(batch.lane_data), CONSTANTS, LANES).any(axis=2)
    kinds = np.zeros(len(has), dtype=np.int64)
    for bit, (first, end) in KINDS.items():
        kinds |= np.where(has[:, first - LENGTH : end - LENGTH].any(axis=1), bit, 0)
    return kinds


@formula
def rate(rates, chunk, k):
    """A change of the constants in row k of the workspace."""
    return load(rates, LANES * (CONSTANTS * chunk + k - LENGTH))


@formula
def take_rates(rates, chunk, ws, first, end):
    """Let the change be the constants in these rows of the workspace."""
    for k in range(first, end):
        store(rate(rates, chunk, k), ws, k * LANES)


@inline_kernel
def damping_along(ws, gp, g):
    """Add what the force of the dampers of Gauss point g changes by along MOVED and FASTER to FORCE."""
    at = point(gp, g)
    a, _, B, _, C = vectors(ws, at, D)
    da, _, dB, _, dC = vectors(ws, at, RATE)
    ya, _, yB, _, yC = vectors(ws, at, np.int64(MOVED))
    za, _, zB, _, zC = vectors(ws, at, np.int64(FASTER))
    axial, bending = at[7] * row(ws, AXIAL), at[7] * row(ws, BENDING)
    f0, c0 = axial * dot(a, da), axial * (dot(ya, da) + dot(a, za))
    f1, f2 = bending * (dot(a, dB) + dot(B, da)), bending * (dot(a, dC) + dot(C, da))
    c1 = bending * (dot(ya, dB) + dot(a, zB) + dot(yB, da) + dot(B, za))
    c2 = bending * (dot(ya, dC) + dot(a, zC) + dot(yC, da) + dot(C, za))
    by_a = c0 * a + f0 * ya + c1 * B + f1 * yB + c2 * C + f2 * yC
    none = 0.0 * a
    spread(ws, at, by_a, none, c1 * a + f1 * ya, none, c2 * a + f2 * ya)


@formula
def moved_by(ws, first, along, inner, outer):
    """Fill the rows ``along`` with what the length does to vectors from a row on, or to forces on them."""
    d, bx, cx = rows(ws, first + D), rows(ws, first + BX), rows(ws, first + CX)
    clear(ws, along, VECTORS)
    set_rows(ws, along + D, inner * d)
    set_rows(ws, along + BX, outer * bx)
    set_rows(ws, along + CX, outer * cx)


@inline_kernel
def longer(batch, group, chunk, rates, ws):
    """Fill FORCE with what the length does through strains and dampers; the constants are the batch's."""
    h, il, first, gp = row(ws, LENGTH), row(ws, INV_L), group[2], batch.gp
    inner, outer = h * rate(rates, chunk, INV_L), il * rate(rates, chunk, LENGTH)
    moved_by(ws, D, MOVED, inner, outer)
    moved_by(ws, RATE, FASTER, inner, outer)
    clear(ws, FORCE, VECTORS)
    for g in range(group[3]):
        load_natural(batch, ws, chunk, g, group[6] != 0)
        elastic_force(ws, gp, first + g)
        if group[4] != 0:
            damping_force(ws, gp, first + g, np.int64(RATE))
    moved_by(ws, FORCE, FORCE, inner, outer)
    for g in range(group[3]):
        load_natural(batch, ws, chunk, g, group[6] != 0)
        elastic_slopes(ws, gp, first + g, np.int64(MOVED))
        if group[4] != 0:
            damping_along(ws, gp, first + g)


@inline_kernel
def take_masses(rates, chunk, ws):
    """Let a change be the masses; for that and external damping the rows ACCELERATION."""
    mass, viscous = rate(rates, chunk, MASS), rate(rates, chunk, VISCOUS)
    for k in CENTRE:
        moved = mass * rows(ws, NODAL_A + k) + viscous * rows(ws, NODAL_V + k)
        set_rows(ws, ACCELERATION + k, moved)
    for k in SECTION:
        set_rows(ws, ACCELERATION + k, rows(ws, NODAL_A + k))
    store(every(1.0), ws, MASS * LANES)
    take_rates(rates, chunk, ws, MASS_Y, VISCOUS)


@inline_kernel
def add_longer_masses(batch, group, chunk, rates, ws):
    """Add what the length does to inertia and external damping to FORCE, forces on the unknowns."""
    data, mass, h, dh = batch.lane_data, batch.mass, row(ws, LENGTH), rate(rates, chunk, LENGTH)
    moved, w = nodal(ws, NODAL_A), dh * load(data, chunk, MASS - LENGTH)
    if group[5] != 0:
        moved = both(1.0, moved, load(data, chunk, VISCOUS - LENGTH), nodal(ws, NODAL_V))
    r1, t1, r2, t2 = inertia_longer(moved, h)
    add_rows(ws, FORCE + D, w * r1)
    add_rows(ws, FORCE + T1, w * t1)
    add_rows(ws, FORCE + R2, w * r2)
    add_rows(ws, FORCE + T2, w * t2)
    m13, m23, m33 = mass[2, 8], mass[6, 8], mass[8, 8]
    for axis in range(2):
        o, w = (C1 - B1) * axis, dh * load(data, chunk, MASS_Y - LENGTH + axis)
        x1, x2, x3 = rows(ws, NODAL_A + o + B1), rows(ws, NODAL_A + o + DB), rows(ws, NODAL_A + o + BX)
        add_rows(ws, FORCE + o + B1, w * (m13 * x3))
        add_rows(ws, FORCE + o + DB, w * (m23 * x3))
        add_rows(ws, FORCE + o + BX, w * (m13 * x1 + m23 * x2 + (2.0 * h) * (m33 * x3)))


@inline_kernel
def change_elements(batch, group, chunk, rates, kind, ws):
    """Fill FORCE with what a change of these kinds does, forces on the unknowns."""
    load_constants(batch, ws, chunk)
    if kind & LONGER:
        longer(batch, group, chunk, rates, ws)
    else:
        clear(ws, FORCE, VECTORS)
    if kind & (STIFF | DAMPED):
        take_rates(rates, chunk, ws, D_A, MASS)
        for g in range(group[3]):
            if kind & STIFF:
                load_natural(batch, ws, chunk, g, group[6] != 0)
                elastic_force(ws, batch.gp, group[2] + g)
            if kind & DAMPED:
                damping_force(ws, batch.gp, group[2] + g, np.int64(RATE))
    if kind & HEAVY:
        take_masses(rates, chunk, ws)
    else:
        clear(ws, ACCELERATION, VECTORS)
    inertia_force(ws, batch.mass)
    if kind & LONGER:
        add_longer_masses(batch, group, chunk, rates, ws)


@inline_kernel
def solid_changes(batch, q, v, a, rates, kinds, begin, out, ws):
    """See :func:`ancf.compiled.add_changes`."""
    chunks, count = batch.lane_data.shape[0], begin.shape[0]
    numbers = CONSTANTS * LANES * chunks
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        clear_unused(ws)
        clear(ws, NODAL_V, 2 * VECTORS)
        for chunk in range(group[0], group[1]):
            load_constants(batch, ws, chunk)
            take_vectors(batch, q, ws, chunk, np.int64(D))
            take_vectors(batch, v, ws, chunk, np.int64(RATE))
            take(batch, v, ws, chunk, np.int64(NODAL_V))
            take(batch, a, ws, chunk, np.int64(NODAL_A))
            for p in range(count):
                kind, own = kinds[p * chunks + chunk], rates[p * numbers : (p + 1) * numbers]
                if kind != 0:
                    change_elements(batch, group, chunk, own, kind, ws)
                    store_nodal(batch, out[begin[p] :], ws, chunk)
