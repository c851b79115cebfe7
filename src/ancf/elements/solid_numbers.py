"""Derivatives of x . force by the constants of the two beams, for LANES elements at a time.

Forces are linear in stiffnesses, dampings and masses: x . force is the sum of each times what the scalars and
their changes along x make of it.  The length acts through d = (r_2 - r_1)/L, bx = L r_yx and cx = L r_zx of
the shape, of the rates and of x: its derivatives are those by these vectors, times the vectors themselves.
"""

from __future__ import annotations

import numpy as np

from ..compiled import formula, inline_kernel
from ..simd import LANES, load, store
from ..vectors import dot
from .cable_numbers import inertia_work
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
    FORCE,
    G_BB,
    G_BC,
    G_CB,
    G_CC,
    G_XY,
    G_XZ,
    G_YZ,
    INV_L,
    L_Y,
    L_Z,
    LAM_A,
    LENGTH,
    M_Y,
    M_YY,
    M_YZ,
    M_Z,
    M_ZZ,
    MASS,
    MASS_Y,
    MASS_Z,
    R2,
    RATE,
    T1,
    T2,
    VECTORS,
    VISCOUS,
    D,
    damping_force,
    elastic_force,
    point,
    strains,
    vectors,
)
from .solid_rate_work import damping_slopes
from .solid_rows import load_constants, load_natural, take, take_vectors
from .solid_tangent_work import elastic_slopes, strain_slopes
from .workspace import clear, row, rows


def numbers(batch):
    """The constants, lane by lane; external damping as damping L/420."""
    data = batch.lane_data.copy()
    data[:, VISCOUS - LENGTH] *= data[:, MASS - LENGTH]
    return data.ravel()


def joined(batch, other):
    """The batch with the kinds of damping that it or another one has, see :class:`ancf.compiled.Traits`."""
    if batch.groups.shape != other.groups.shape:
        return batch
    groups = batch.groups.copy()
    groups[:, 4:6] |= other.groups[:, 4:6]
    return batch._replace(groups=groups)


@formula
def add_number(out, chunk, k, value):
    """Add to the derivatives by the constants of a chunk in row k of the workspace."""
    at = LANES * (CONSTANTS * chunk + k - LENGTH)
    store(load(out, at) + value, out, at)


@inline_kernel
def elastic_numbers(ws, gp, g, out, chunk):
    """Add what the stiffnesses do at Gauss point g; x is in the rows ACCELERATION."""
    at = point(gp, g)
    shape, w = vectors(ws, at, D), at[7]
    e, x = strains(ws, shape), strain_slopes(shape, vectors(ws, at, ACCELERATION))
    thick, wide = e[1] + e[2], x[1] + x[2]
    add_number(out, chunk, D_A, w * (e[0] * x[0] + e[1] * x[1] + e[2] * x[2]))
    add_number(out, chunk, LAM_A, w * (thick * x[0] + (e[0] + e[2]) * x[1] + (e[0] + e[1]) * x[2]))
    add_number(out, chunk, M_Y, w * (0.5 * (e[3] * x[0] + e[0] * x[3]) + e[6] * x[6]))
    add_number(out, chunk, M_Z, w * (0.5 * (e[4] * x[0] + e[0] * x[4]) + e[7] * x[7]))
    add_number(out, chunk, M_YY, (0.25 * w) * e[3] * x[3])
    add_number(out, chunk, M_ZZ, (0.25 * w) * e[4] * x[4])
    add_number(out, chunk, M_YZ, w * (0.25 * (e[4] * x[3] + e[3] * x[4]) + e[5] * x[5]))
    add_number(out, chunk, L_Y, (0.5 * w) * (e[3] * wide + thick * x[3]))
    add_number(out, chunk, L_Z, (0.5 * w) * (e[4] * wide + thick * x[4]))
    add_number(out, chunk, G_XY, w * e[8] * x[8])
    add_number(out, chunk, G_XZ, w * e[9] * x[9])
    add_number(out, chunk, G_YZ, w * e[10] * x[10])
    add_number(out, chunk, G_BB, w * e[11] * x[11])
    add_number(out, chunk, G_CC, w * e[12] * x[12])
    add_number(out, chunk, G_BC, w * e[13] * x[13])
    add_number(out, chunk, G_CB, w * e[14] * x[14])


@inline_kernel
def damping_numbers(ws, gp, g, out, chunk):
    """The same of the dampers."""
    at = point(gp, g)
    a, _, B, _, C = vectors(ws, at, D)
    da, _, dB, _, dC = vectors(ws, at, RATE)
    xa, _, xB, _, xC = vectors(ws, at, ACCELERATION)
    add_number(out, chunk, AXIAL, at[7] * dot(a, da) * dot(a, xa))
    one = (dot(a, dB) + dot(B, da)) * (dot(a, xB) + dot(B, xa))
    two = (dot(a, dC) + dot(C, da)) * (dot(a, xC) + dot(C, xa))
    add_number(out, chunk, BENDING, at[7] * (one + two))


@formula
def add_longer(ws, first, out, chunk):
    """Add what the length does through the vectors from a row on, of which FORCE has the derivatives."""
    h, il = row(ws, LENGTH), row(ws, INV_L)
    add_number(out, chunk, INV_L, h * dot(rows(ws, FORCE + D), rows(ws, first + D)))
    thin = dot(rows(ws, FORCE + BX), rows(ws, first + BX)) + dot(rows(ws, FORCE + CX), rows(ws, first + CX))
    add_number(out, chunk, LENGTH, il * thin)


@inline_kernel
def shape_numbers(batch, group, chunk, out, ws):
    """Add what the constants of strains and dampers, and the length in these, do."""
    first, last, gp = group[2], group[2] + group[3], batch.gp
    clear(ws, FORCE, VECTORS)
    for g in range(first, last):
        load_natural(batch, ws, chunk, g - first, group[6] != 0)
        elastic_numbers(ws, gp, g, out, chunk)
        elastic_force(ws, gp, g)
        if group[4] != 0:
            damping_numbers(ws, gp, g, out, chunk)
            damping_force(ws, gp, g, np.int64(RATE))
    add_longer(ws, np.int64(ACCELERATION), out, chunk)
    clear(ws, FORCE, VECTORS)
    for g in range(first, last):
        load_natural(batch, ws, chunk, g - first, group[6] != 0)
        elastic_slopes(ws, gp, g, np.int64(ACCELERATION))
        if group[4] != 0:
            damping_slopes(ws, gp, g)
    add_longer(ws, np.int64(D), out, chunk)
    if group[4] != 0:
        clear(ws, FORCE, VECTORS)
        for g in range(first, last):
            damping_force(ws, gp, g, np.int64(ACCELERATION))
        add_longer(ws, np.int64(RATE), out, chunk)


@formula
def nodal(ws, first):
    """The four slots of the centreline, of unknowns from a row on."""
    return rows(ws, first + D), rows(ws, first + T1), rows(ws, first + R2), rows(ws, first + T2)


@formula
def section_work(ws, mass, o, h):
    """x . mass matrix . a of r_y, or of r_z `o` rows behind, per mass, and its derivative by L.

    a is in the rows ACCELERATION and x in RATE.
    """
    a, x = ACCELERATION + o, RATE + o
    a1, a2, a3 = rows(ws, a + B1), rows(ws, a + DB), rows(ws, a + BX)
    x1, x2, x3 = rows(ws, x + B1), rows(ws, x + DB), rows(ws, x + BX)
    m12, m13, m23 = mass[2, 6], mass[2, 8], mass[6, 8]
    none = dot(x1, mass[2, 2] * a1 + m12 * a2) + dot(x2, m12 * a1 + mass[6, 6] * a2)
    one = dot(x1, m13 * a3) + dot(x2, m23 * a3) + dot(x3, m13 * a1 + m23 * a2)
    two = mass[8, 8] * dot(x3, a3)
    return none + h * (one + h * two), one + 2.0 * h * two


@inline_kernel
def mass_numbers(batch, group, chunk, v, out, ws):
    """Add what masses, external damping and the length in them do; as :func:`section_work` has a and x."""
    h, mass, x = row(ws, LENGTH), row(ws, MASS), nodal(ws, RATE)
    work, more = inertia_work(nodal(ws, ACCELERATION), x, h)
    add_number(out, chunk, MASS, work)
    more = mass * more
    work, own = section_work(ws, batch.mass, 0, h)
    add_number(out, chunk, MASS_Y, work)
    more = more + row(ws, MASS_Y) * own
    work, own = section_work(ws, batch.mass, C1 - B1, h)
    add_number(out, chunk, MASS_Z, work)
    more = more + row(ws, MASS_Z) * own
    if group[5] != 0:
        take(batch, v, ws, chunk, np.int64(ACCELERATION))
        work, own = inertia_work(nodal(ws, ACCELERATION), x, h)
        add_number(out, chunk, VISCOUS, work)
        more = more + row(ws, VISCOUS) * mass * own
    add_number(out, chunk, LENGTH, more)


@inline_kernel
def elements_numbers(batch, group, chunk, states, x, out, ws):
    """Add the derivatives of a chunk in the states (q, v, a)."""
    q, v, a = states
    load_constants(batch, ws, chunk)
    take_vectors(batch, q, ws, chunk, np.int64(D))
    take_vectors(batch, v, ws, chunk, np.int64(RATE))
    take_vectors(batch, x, ws, chunk, np.int64(ACCELERATION))
    shape_numbers(batch, group, chunk, out, ws)
    take(batch, x, ws, chunk, np.int64(RATE))
    take(batch, a, ws, chunk, np.int64(ACCELERATION))
    mass_numbers(batch, group, chunk, v, out, ws)
