"""The 24-dof ("original") and the 30-dof ("nonlocking") beam element (paper, sections 2-4): the batch.

Unknowns of a node: r, r_x, r_y, r_z (eqs. 3, 4); the nonlocking element has r_yx and r_zx at its first node
as well (eq. 15).  The material is that of St. Venant and Kirchhoff: the energy is quadratic in the
Green-Lagrange strains of the whole volume.  How it is evaluated: :mod:`ancf.elements.solid_force`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import Role, implements, inline_kernel
from ..simd import LANES, store, total, vector
from ..vectors import dot
from .cable_tangent import add_block
from .solid_changes import kinds_of, solid_changes
from .solid_force import (
    ACCELERATION,
    FORCE,
    RATE,
    VECTORS,
    VISCOUS,
    D,
    damping_force,
    elastic_force,
    inertia_force,
    point,
    strains,
    stresses,
    vectors,
)
from .solid_numbers import elements_numbers, joined, numbers
from .solid_rate_work import damping_slopes
from .solid_rates import rate_blocks, store_half
from .solid_rows import (
    add_viscous,
    clear_unused,
    load_constants,
    load_natural,
    store_forces,
    store_nodal,
    take,
    take_vectors,
)
from .solid_tangent import (
    BLOCKS,
    ELEMENT,
    PLACES,
    damping_blocks,
    diagonal_blocks,
    other_blocks,
    spread_dampers,
    spread_tangent,
)
from .solid_tangent_work import elastic_slopes
from .workspace import clear


class SolidBatch(NamedTuple):
    """All elements of one kind in a System, in chunks of LANES that share what stands in ``groups``.

    A chunk that is not full repeats its last element with all stiffnesses and masses zero.
    """

    base: NDArray[np.int64]  # (n, 8 or 10) first unknown of r, r_x, r_y, r_z, twice; of r_yx, r_zx
    dest: NDArray[np.int64]  # (n, 64 or 100) place of each 3x3 block in the matrix, -1: none
    first: NDArray[np.int64]  # (chunks + 1,) first element of each chunk
    lane_base: NDArray[np.int64]  # (chunks, columns of base, LANES)
    lane_data: FloatArray  # (chunks, CONSTANTS, LANES) rows LENGTH ... VISCOUS
    lane_reference: FloatArray  # (chunks, 15 points, LANES) scalars of the natural shape; none if straight
    groups: NDArray[np.int64]  # (k, 7) first chunk, end, first gp, points, damping, viscous, curved
    gp: FloatArray  # (m, 14) coefficients of the Gauss points
    mass: FloatArray  # (10, 10) factors of the mass matrix by columns of base
    lane_scale: FloatArray  # (chunks, 20, LANES) by column: d(element's vector)/d(unknown), root of mass


@inline_kernel
def solid_force(batch, q, v, a, r, ws):
    """Add inertia, elastic and damping forces to r."""
    gp = batch.gp
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        g0, points, curved = group[2], group[3], group[6] != 0
        clear_unused(ws)
        for chunk in range(group[0], group[1]):
            load_constants(batch, ws, chunk)
            take_vectors(batch, q, ws, chunk, np.int64(D))
            clear(ws, FORCE, VECTORS)
            for g in range(points):
                load_natural(batch, ws, chunk, g, curved)
                elastic_force(ws, gp, g0 + g)
            if group[4] != 0:
                take_vectors(batch, v, ws, chunk, np.int64(RATE))
                for g in range(points):
                    damping_force(ws, gp, g0 + g, np.int64(RATE))
            take(batch, a, ws, chunk, np.int64(ACCELERATION))
            if group[5] != 0:
                add_viscous(batch, v, ws, chunk)
            inertia_force(ws, batch.mass)
            store_nodal(batch, r, ws, chunk)


@inline_kernel
def solid_inertia(batch, a, r, ws):
    """Add the mass matrix times a to r."""
    clear_unused(ws)
    for chunk in range(batch.first.shape[0] - 1):
        load_constants(batch, ws, chunk)
        take(batch, a, ws, chunk, np.int64(ACCELERATION))
        clear(ws, FORCE, VECTORS)
        inertia_force(ws, batch.mass)
        store_nodal(batch, r, ws, chunk)


@inline_kernel
def store_tangent(batch, A, ws, chunk, c_mass, c_damping):
    """Add stiffness blocks and mass of a chunk to the block values A."""
    columns, first, factors = batch.base.shape[1], batch.first[chunk], batch.lane_scale
    for m in range(batch.first[chunk + 1] - first):
        for x in range(columns):
            centreline = x % 4 < 2 and x < 8
            for y in range(columns):
                place = batch.dest[first + m, columns * x + y]
                if place >= 0:
                    scale = factors[chunk, x, m] * factors[chunk, y, m]
                    viscous = c_damping * ws[VISCOUS * LANES + m] if centreline else 0.0
                    mass = batch.mass[x, y] * (c_mass + viscous)
                    if mass != 0.0:
                        mass *= factors[chunk, 10 + x, m] * factors[chunk, 10 + y, m]
                    add_block(A, place, ws, PLACES[x, y], m, scale, mass)


@inline_kernel
def solid_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add c_mass M + c_damping C + c_stiffness K to the block values A."""
    gp = batch.gp
    own = 3 if batch.base.shape[1] == 10 else 2
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        g0, points, curved = group[2], group[3], group[6] != 0
        clear_unused(ws)
        for chunk in range(group[0], group[1]):
            load_constants(batch, ws, chunk)
            take_vectors(batch, q, ws, chunk, np.int64(D))
            clear(ws, ELEMENT, 9 * BLOCKS)
            if c_stiffness == 0.0:
                for g in range(points if c_damping != 0.0 and group[4] != 0 else 0):
                    damping_blocks(ws, gp, g0 + g, c_damping * gp[g0 + g, 7])
                    spread_dampers(ws, gp, g0 + g, own)
                store_tangent(batch, A, ws, chunk, c_mass, c_damping)
                continue
            for g in range(points):
                load_natural(batch, ws, chunk, g, curved)
                weight = gp[g0 + g, 7]
                diagonal_blocks(ws, gp, g0 + g, c_stiffness * weight, c_damping * weight)
                other_blocks(ws, gp, g0 + g, c_stiffness * weight, c_damping * weight)
                spread_tangent(ws, gp, g0 + g, own)
            store_tangent(batch, A, ws, chunk, c_mass, c_damping)


@inline_kernel
def solid_rate_stiffness(batch, q, v, S, W, ws):
    """See :func:`ancf.compiled.add_rate_stiffness`."""
    own = 3 if batch.base.shape[1] == 10 else 2
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        if group[4] == 0:
            continue
        clear_unused(ws)
        for chunk in range(group[0], group[1]):
            load_constants(batch, ws, chunk)
            take_vectors(batch, q, ws, chunk, np.int64(D))
            take_vectors(batch, v, ws, chunk, np.int64(RATE))
            for sign in (1.0, -1.0):
                clear(ws, ELEMENT, 9 * BLOCKS)
                for g in range(group[3]):
                    rate_blocks(ws, batch.gp, group[2] + g, sign)
                    spread_dampers(ws, batch.gp, group[2] + g, own)
                store_half(batch, S if sign > 0.0 else W, ws, chunk, sign)


@inline_kernel
def solid_rate_work(batch, q, v, x, out, ws):
    """See :func:`ancf.compiled.add_rate_work`."""
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        if group[4] == 0:
            continue
        clear_unused(ws)
        for chunk in range(group[0], group[1]):
            load_constants(batch, ws, chunk)
            take_vectors(batch, q, ws, chunk, np.int64(D))
            take_vectors(batch, v, ws, chunk, np.int64(RATE))
            take_vectors(batch, x, ws, chunk, np.int64(ACCELERATION))
            clear(ws, FORCE, VECTORS)
            for g in range(group[3]):
                damping_slopes(ws, batch.gp, group[2] + g)
            store_forces(batch, out, ws, chunk)


@inline_kernel
def solid_tangent_work(batch, q, v, x, by_q, by_v, by_a, ws):
    """See :func:`ancf.compiled.add_tangent_work`."""
    gp = batch.gp
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        clear_unused(ws)
        for chunk in range(group[0], group[1]):
            load_constants(batch, ws, chunk)
            take_vectors(batch, q, ws, chunk, np.int64(D))
            take_vectors(batch, x, ws, chunk, np.int64(RATE))
            clear(ws, FORCE, VECTORS)
            for g in range(group[3]):
                load_natural(batch, ws, chunk, g, group[6] != 0)
                elastic_slopes(ws, gp, group[2] + g, np.int64(RATE))
            store_forces(batch, by_q, ws, chunk)
            if group[4] != 0 or group[5] != 0:
                clear(ws, FORCE, VECTORS)
                for g in range(group[3] if group[4] != 0 else 0):
                    damping_force(ws, gp, group[2] + g, np.int64(RATE))
                clear(ws, ACCELERATION, VECTORS)
                if group[5] != 0:
                    add_viscous(batch, x, ws, chunk)
                inertia_force(ws, batch.mass)
                store_nodal(batch, by_v, ws, chunk)
            clear(ws, FORCE, VECTORS)
            take(batch, x, ws, chunk, np.int64(ACCELERATION))
            inertia_force(ws, batch.mass)
            store_nodal(batch, by_a, ws, chunk)


@inline_kernel
def solid_number_work(batch, q, v, a, x, out, ws):
    """See :func:`ancf.compiled.add_number_work`."""
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        clear_unused(ws)
        for chunk in range(group[0], group[1]):
            elements_numbers(batch, group, chunk, (q, v, a), x, out, ws)


@inline_kernel
def solid_energy(batch, q, ws):
    """Strain energy, J."""
    energy = 0.0
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        clear_unused(ws)
        for chunk in range(group[0], group[1]):
            load_constants(batch, ws, chunk)
            take_vectors(batch, q, ws, chunk, np.int64(D))
            for g in range(group[3]):
                load_natural(batch, ws, chunk, g, group[6] != 0)
                at = point(batch.gp, group[2] + g)
                e = strains(ws, vectors(ws, at, D))
                s = stresses(ws, at[7], e)
                for k in range(15):
                    energy += 0.5 * total(e[k] * s[k])
    return energy


@inline_kernel
def solid_inverted(batch, q, ws):
    """First element with det [r_x r_y r_z] <= 0 at a Gauss point of the axis, -1: none."""
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        clear_unused(ws)
        for chunk in range(group[0], group[1]):
            load_constants(batch, ws, chunk)
            take_vectors(batch, q, ws, chunk, np.int64(D))
            for g in range(group[3]):
                at = point(batch.gp, group[2] + g)
                a, b, _, c, _ = vectors(ws, at, D)
                bc = vector(b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0])
                store(dot(a, bc), ws, FORCE * LANES)
                for m in range(LANES):
                    if not ws[FORCE * LANES + m] > 0.0:
                        return batch.base[min(batch.first[chunk] + m, batch.first[chunk + 1] - 1), 2]
    return -1


implements(
    SolidBatch,
    force=solid_force,
    inertia=solid_inertia,
    tangent=solid_tangent,
    energy=solid_energy,
    rate_stiffness=solid_rate_stiffness,
    rate_work=solid_rate_work,
    tangent_work=solid_tangent_work,
    number_work=solid_number_work,
    changes=solid_changes,
    kinds=kinds_of,
    numbers=numbers,
    numbered=("lane_data", "lane_scale"),
    joined=joined,
    inverted=solid_inverted,
    role=Role.DISSIPATES,
    slots=("base", "lane_base"),
    damped=lambda batch: bool(np.any(batch.groups[:, 4:6])),
    exact=lambda batch, moving: not (moving and np.any(batch.groups[:, 4])),
)
