"""The 12-dof cable element (paper, section 5, eqs. 18-27): batch, mass, force, tangent, energy.

Unknowns of a node: r and r_x (eq. 18).  The element has no torsional stiffness and one bending
stiffness (eq. 24).  Force and tangent follow from the strain energy

    W = int_0^L  EA/2 (eps - eps0)^2 + EI/2 (kappa - kappa0)^2  dx

with the measures of :mod:`ancf.elements.measures`, five Gauss points for the axial and three for the
bending part by default.  With a curved reference (kappa0 > 0) the difference of the two curvatures is
what remains when the section turns freely about the tangent, as it does without torsional stiffness.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import Role, implements, inline_kernel
from ..vectors import dot
from .lanes import (
    A1,
    CONSTANTS,
    EA_L,
    EI_L,
    FD,
    INV_L,
    KDD,
    LANES,
    LENGTH,
    MASS,
    NODAL,
    REFERENCE,
    SLOPE,
    SMOOTHING,
    VD,
    VISCOUS,
    D,
    axial_force,
    axial_tangent,
    bending_force,
    bending_tangent,
    clear,
    inertia_force,
)
from .lanes_damping import (
    bending_damping,
    bending_damping_tangent,
    damped_axial_force,
    shape_at,
    slope_damping,
    slope_damping_tangent,
)
from .lanes_tangent import BLOCKS, PLACES, add_block, spread_axial, spread_bending

#: Bits of the column ``damped`` of the groups.
VISCOUSLY, AXIALLY, IN_BENDING, IN_SLOPE = 1, 2, 4, 8


class CableBatch(NamedTuple):
    """All cable elements of a System, in chunks of LANES that share strain measure and Gauss points.

    A chunk that is not full repeats its last element with all stiffnesses and masses zero.
    """

    base: NDArray[np.int64]  # (n, 4) first unknown of r, r_x, r, r_x of each element
    dest: NDArray[np.int64]  # (n, 16) place of each 3x3 block in the matrix, -1: none
    first: NDArray[np.int64]  # (chunks + 1,) first element of each chunk
    lane_base: NDArray[np.int64]  # (chunks, 4 LANES) base by slot and lane
    lane_data: FloatArray  # (chunks, CONSTANTS LANES) rows LENGTH ... VISCOUS
    lane_slope: FloatArray  # (chunks, LANES) row SLOPE, apart: undamped elements do not load it
    lane_reference: FloatArray  # (chunks, 20 LANES) strain at axial, then at 10.. curvature at bending gp
    groups: NDArray[np.int64]  # (k, 8) first chunk, end, paper, first gp, axial, bending, damped, curved
    gp: FloatArray  # (m, 7) coefficients of the Gauss points


@inline_kernel
def load_data(batch, ws, chunk):
    """Rows of the elements' constants."""
    for i in range(CONSTANTS * LANES):
        ws[LENGTH * LANES + i] = batch.lane_data[chunk, i]


@inline_kernel
def load_reference(batch, ws, chunk, k, curved):
    """Row REFERENCE: column k of the reference strains; it stays zero for a straight reference."""
    if curved:
        for m in range(LANES):
            ws[REFERENCE * LANES + m] = batch.lane_reference[chunk, k * LANES + m]


@inline_kernel
def load_slope(batch, ws, chunk):
    """Row SLOPE of a damped chunk."""
    for m in range(LANES):
        ws[SLOPE * LANES + m] = batch.lane_slope[chunk, m]


@inline_kernel
def load_shape(batch, q, ws, chunk, first):
    """Rows d, t1, t2 (starting at ``first``) of a chunk from the nodal values q."""
    for m in range(LANES):
        i0, i1 = batch.lane_base[chunk, m], batch.lane_base[chunk, LANES + m]
        i2, i3 = batch.lane_base[chunk, 2 * LANES + m], batch.lane_base[chunk, 3 * LANES + m]
        il = ws[INV_L * LANES + m]
        for k in range(3):
            ws[(first + k) * LANES + m] = (q[i2 + k] - q[i0 + k]) * il
            ws[(first + 3 + k) * LANES + m] = q[i1 + k]
            ws[(first + 6 + k) * LANES + m] = q[i3 + k]


@inline_kernel
def load_acceleration(batch, v, a, ws, chunk, damped):
    """Rows A1 ... AS2: acceleration, plus (damping / rhoA) velocity for the external damping."""
    for slot in range(4):
        for m in range(LANES):
            i = batch.lane_base[chunk, slot * LANES + m]
            for k in range(3):
                ws[(A1 + 3 * slot + k) * LANES + m] = a[i + k]
    if damped:
        for slot in range(4):
            for m in range(LANES):
                i = batch.lane_base[chunk, slot * LANES + m]
                c = ws[VISCOUS * LANES + m]
                for k in range(3):
                    ws[(A1 + 3 * slot + k) * LANES + m] += c * v[i + k]


@inline_kernel
def store_nodal(batch, r, ws, chunk):
    """Add the rows NODAL of a chunk to the residual."""
    for m in range(LANES):
        for slot in range(4):
            i = batch.lane_base[chunk, slot * LANES + m]
            for k in range(3):
                r[i + k] += ws[(NODAL + 3 * slot + k) * LANES + m]


@inline_kernel
def cable_force(batch, q, v, a, r, ws):
    """Add inertia, elastic and damping forces to r."""
    gp = batch.gp
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        paper, g0, axial, bending = group[2] != 0, group[3], group[4], group[5]
        damped, curved = group[6], group[7] != 0
        clear(ws, REFERENCE, 1)
        for chunk in range(group[0], group[1]):
            load_data(batch, ws, chunk)
            load_shape(batch, q, ws, chunk, D)
            load_acceleration(batch, v, a, ws, chunk, damped & VISCOUSLY != 0)
            clear(ws, FD, 9)
            if damped & ~VISCOUSLY:
                load_shape(batch, v, ws, chunk, VD)
            for g in range(axial):
                load_reference(batch, ws, chunk, g, curved)
                if damped & AXIALLY:
                    damped_axial_force(ws, gp, g0 + g, paper)
                else:
                    axial_force(ws, gp, g0 + g, paper)
            for g in range(bending):
                load_reference(batch, ws, chunk, 10 + g, curved)
                bending_force(ws, gp, g0 + axial + g, paper, curved)
            if damped & IN_BENDING:
                for g in range(bending):
                    bending_damping(ws, gp, g0 + axial + g, paper)
            if damped & IN_SLOPE:
                load_slope(batch, ws, chunk)
                slope_damping(ws)
            inertia_force(ws)
            store_nodal(batch, r, ws, chunk)


@inline_kernel
def cable_inertia(batch, a, r, ws):
    """Add the mass matrix times a to r (eq. 23)."""
    clear(ws, FD, 9)
    for chunk in range(batch.first.shape[0] - 1):
        load_data(batch, ws, chunk)
        load_acceleration(batch, a, a, ws, chunk, False)
        inertia_force(ws)
        store_nodal(batch, r, ws, chunk)


@inline_kernel
def mass_entry(x, y, length):
    """420/(rhoA L) times the integral of S_x S_y of eq. 23."""
    if x > y:
        x, y = y, x
    if x == y:
        return 156.0 if x % 2 == 0 else 4.0 * length * length
    if x == 0:
        return 22.0 * length if y == 1 else (54.0 if y == 2 else -13.0 * length)
    if x == 1:
        return 13.0 * length if y == 2 else -3.0 * length * length
    return -22.0 * length


@inline_kernel
def store_tangent(batch, A, ws, chunk, c_mass, c_damping):
    """Add stiffness blocks and mass of a chunk to the block values A."""
    for m in range(batch.first[chunk + 1] - batch.first[chunk]):
        e = batch.first[chunk] + m
        length, il = ws[LENGTH * LANES + m], ws[INV_L * LANES + m]
        mass = (c_mass + c_damping * ws[VISCOUS * LANES + m]) * ws[MASS * LANES + m]
        for x in range(4):
            for y in range(4):
                place = batch.dest[e, 4 * x + y]
                if place >= 0:
                    scale = (il * (x - 1.0) if x % 2 == 0 else 1.0) * (il * (y - 1.0) if y % 2 == 0 else 1.0)
                    add_block(A, place, ws, PLACES[4 * x + y], m, scale, mass * mass_entry(x, y, length))


@inline_kernel
def cable_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add c_mass M + c_damping C + c_stiffness K (c_stiffness is 0 or 1) to the block values A."""
    gp = batch.gp
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        paper, g0, axial, bending = group[2] != 0, group[3], group[4], group[5]
        damped, curved = group[6] if c_damping != 0.0 else 0, group[7] != 0
        clear(ws, REFERENCE, 1)
        for chunk in range(group[0], group[1]):
            load_data(batch, ws, chunk)
            load_shape(batch, q, ws, chunk, D)
            if c_stiffness == 0.0:
                clear(ws, EA_L, 2)
            clear(ws, KDD, BLOCKS)
            for g in range(axial):
                load_reference(batch, ws, chunk, g, curved)
                axial_tangent(ws, gp, g0 + g, paper, c_damping)
                spread_axial(ws, gp, g0 + g)
            for g in range(bending):
                load_reference(batch, ws, chunk, 10 + g, curved)
                bending_tangent(ws, gp, g0 + axial + g, paper, curved)
                if damped & IN_BENDING:
                    bending_damping_tangent(ws, gp, g0 + axial + g, paper, c_damping)
                spread_bending(ws, gp, g0 + axial + g)
            if damped & IN_SLOPE:
                load_slope(batch, ws, chunk)
                slope_damping_tangent(ws, c_damping)
            store_tangent(batch, A, ws, chunk, c_mass, c_damping)


@inline_kernel
def gauss_energy(ws, gp, g, m, paper, bending):
    """Energy of one Gauss point of lane m."""
    p, s = shape_at(ws, gp, g, D, m)
    a = dot(p, p)
    ref = ws[REFERENCE * LANES + m]
    if not bending:
        eps = 0.5 * (a - 1.0) if paper else math.sqrt(a) - 1.0
        return 0.5 * gp[g, 6] * ws[EA_L * LANES + m] * (eps - ref) ** 2
    b, c = dot(p, s), dot(s, s)
    k2 = max((a * c - b * b) / (a * a * (a if paper else 1.0)), 0.0)
    khat = math.sqrt((1.0 + SMOOTHING**2) * (k2 + (SMOOTHING * ref) ** 2))
    constant = ref * ref * (1.0 + 2.0 * SMOOTHING**2)
    return 0.5 * gp[g, 6] * ws[EI_L * LANES + m] * (k2 - 2.0 * ref * khat + constant)


@inline_kernel
def cable_energy(batch, q, ws):
    """Strain energy, J (the integral behind eq. 27)."""
    energy = 0.0
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        g0, axial = group[3], group[4]
        clear(ws, REFERENCE, 1)
        for chunk in range(group[0], group[1]):
            load_data(batch, ws, chunk)
            load_shape(batch, q, ws, chunk, D)
            for g in range(axial + group[5]):
                load_reference(batch, ws, chunk, g if g < axial else 10 + g - axial, group[7] != 0)
                for m in range(LANES):
                    energy += gauss_energy(ws, batch.gp, g0 + g, m, group[2] != 0, g >= axial)
    return energy


implements(
    CableBatch,
    force=cable_force,
    inertia=cable_inertia,
    tangent=cable_tangent,
    energy=cable_energy,
    role=Role.DISSIPATES,
    slots=("base", "lane_base"),
    damped=lambda batch: bool(np.any(batch.groups[:, 6])),
)
