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

from numpy.typing import NDArray

from ..compiled import implements, inline_kernel
from .lanes import (
    A1,
    DA_L,
    DB_L,
    EA_L,
    EI_L,
    EPS0,
    FD,
    INV_L,
    KAPPA0,
    KDD,
    LANES,
    LENGTH,
    MASS,
    NODAL,
    SMOOTHING,
    VISCOUS,
    axial_force,
    axial_tangent,
    bending_force,
    bending_tangent,
    inertia_force,
)
from .lanes_damping import axial_damping, bending_damping, bending_damping_tangent, dot, shape_at
from .lanes_tangent import BLOCKS, slot_entry, spread_axial, spread_bending
from .shapes import FloatArray


class CableBatch(NamedTuple):
    """All cable elements of a System; elements of one group share strain measure and Gauss points."""

    base: NDArray  # type: ignore[type-arg]  # (n, 4) first unknown of r, r_x, r, r_x
    dest: NDArray  # type: ignore[type-arg]  # (n, 16) place of each 3x3 block in the matrix, -1: none
    data: FloatArray  # (n, 8) L, EA, EI, rhoA, damping, axial_damping, bending_damping, unused
    eps0: FloatArray  # (n, 10) reference strain at the axial Gauss points
    kappa0: FloatArray  # (n, 10) reference curvature at the bending Gauss points
    groups: NDArray  # type: ignore[type-arg]  # (k, 8) start, stop, paper, first gp, axial, bending, damped, curved
    gp: FloatArray  # (m, 7) coefficients of the Gauss points


@inline_kernel
def load_shape(batch, q, ws, e0, stop, first):  # type: ignore[no-untyped-def]
    """Rows d, t1, t2 (starting at ``first``) of the elements e0 ... from the nodal values q."""
    for m in range(LANES):
        e = min(e0 + m, stop - 1)
        i0, i1, i2, i3 = batch.base[e, 0], batch.base[e, 1], batch.base[e, 2], batch.base[e, 3]
        il = 1.0 / batch.data[e, 0]
        for k in range(3):
            ws[(first + k) * LANES + m] = (q[i2 + k] - q[i0 + k]) * il
            ws[(first + 3 + k) * LANES + m] = q[i1 + k]
            ws[(first + 6 + k) * LANES + m] = q[i3 + k]


@inline_kernel
def load_data(batch, ws, e0, stop, group):  # type: ignore[no-untyped-def]
    """Rows of the elements' constants."""
    for m in range(LANES):
        e = min(e0 + m, stop - 1)
        length = batch.data[e, 0]
        ws[LENGTH * LANES + m] = length
        ws[INV_L * LANES + m] = 1.0 / length
        ws[EA_L * LANES + m] = batch.data[e, 1] * length
        ws[EI_L * LANES + m] = batch.data[e, 2] * length
        ws[MASS * LANES + m] = batch.data[e, 3] * length / 420.0
    for k in range(group[4]):
        for m in range(LANES):
            ws[(EPS0 + k) * LANES + m] = 0.0
    if group[7]:
        for m in range(LANES):
            e = min(e0 + m, stop - 1)
            for k in range(group[4]):
                ws[(EPS0 + k) * LANES + m] = batch.eps0[e, k]
            for k in range(group[5]):
                ws[(KAPPA0 + k) * LANES + m] = batch.kappa0[e, k]
    if group[6]:
        for m in range(LANES):
            e = min(e0 + m, stop - 1)
            length = batch.data[e, 0]
            ws[VISCOUS * LANES + m] = batch.data[e, 4] / batch.data[e, 3]
            ws[DA_L * LANES + m] = batch.data[e, 5] * length
            ws[DB_L * LANES + m] = batch.data[e, 6] * length


@inline_kernel
def load_acceleration(batch, v, a, ws, e0, stop, damped):  # type: ignore[no-untyped-def]
    """Rows A1 ... AS2: acceleration, plus (damping / rhoA) velocity for the external damping."""
    for m in range(LANES):
        e = min(e0 + m, stop - 1)
        for slot in range(4):
            i = batch.base[e, slot]
            for k in range(3):
                ws[(A1 + 3 * slot + k) * LANES + m] = a[i + k]
    if damped:
        for m in range(LANES):
            e = min(e0 + m, stop - 1)
            c = ws[VISCOUS * LANES + m]
            for slot in range(4):
                i = batch.base[e, slot]
                for k in range(3):
                    ws[(A1 + 3 * slot + k) * LANES + m] += c * v[i + k]


@inline_kernel
def clear(ws, first, rows):  # type: ignore[no-untyped-def]
    """Set rows to zero."""
    for i in range(first * LANES, (first + rows) * LANES):
        ws[i] = 0.0


@inline_kernel
def store_nodal(batch, r, ws, e0, stop):  # type: ignore[no-untyped-def]
    """Add the rows NODAL of the elements e0 ... to the residual."""
    for m in range(min(LANES, stop - e0)):
        for slot in range(4):
            i = batch.base[e0 + m, slot]
            for k in range(3):
                r[i + k] += ws[(NODAL + 3 * slot + k) * LANES + m]


@inline_kernel
def cable_force(batch, q, v, a, r, ws):  # type: ignore[no-untyped-def]
    """Add inertia, elastic and damping forces to r."""
    gp = batch.gp
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        stop, paper, g0, axial, bending = group[1], group[2] != 0, group[3], group[4], group[5]
        damped, curved = group[6] != 0, group[7] != 0
        for e0 in range(group[0], stop, LANES):
            load_data(batch, ws, e0, stop, group)
            load_shape(batch, q, ws, e0, stop, 0)
            load_acceleration(batch, v, a, ws, e0, stop, damped)
            clear(ws, FD, 9)
            for g in range(axial):
                axial_force(ws, gp, g0 + g, EPS0 + g, paper)
            for g in range(bending):
                bending_force(ws, gp, g0 + axial + g, KAPPA0 + g, paper, curved)
            if damped:
                load_shape(batch, v, ws, e0, stop, 18)
                for g in range(axial):
                    axial_damping(ws, gp, g0 + g, paper)
                for g in range(bending):
                    bending_damping(ws, gp, g0 + axial + g, paper)
            inertia_force(ws)
            store_nodal(batch, r, ws, e0, stop)


@inline_kernel
def cable_inertia(batch, a, r, ws):  # type: ignore[no-untyped-def]
    """Add the mass matrix times a to r (eq. 23)."""
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        stop = group[1]
        for e0 in range(group[0], stop, LANES):
            load_data(batch, ws, e0, stop, group)
            load_acceleration(batch, a, a, ws, e0, stop, False)
            clear(ws, FD, 9)
            inertia_force(ws)
            store_nodal(batch, r, ws, e0, stop)


@inline_kernel
def mass_entry(x, y, length):  # type: ignore[no-untyped-def]
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
def store_tangent(batch, A, ws, e0, stop, c_mass, c_damping):  # type: ignore[no-untyped-def]
    """Add stiffness blocks and mass of the elements e0 ... to the block values A."""
    for m in range(min(LANES, stop - e0)):
        e = e0 + m
        length = batch.data[e, 0]
        mass = (c_mass * batch.data[e, 3] + c_damping * batch.data[e, 4]) * length / 420.0
        for x in range(4):
            for y in range(4):
                place = batch.dest[e, 4 * x + y]
                if place < 0:
                    continue
                for i in range(3):
                    A[place + 7 * i] += mass * mass_entry(x, y, length)
                    for j in range(3):
                        A[place + 6 * i + j] += slot_entry(ws, x, y, i, j, m)


@inline_kernel
def cable_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):  # type: ignore[no-untyped-def]
    """Add c_mass M + c_damping C + c_stiffness K (c_stiffness is 0 or 1) to the block values A."""
    gp = batch.gp
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        stop, paper, g0, axial, bending = group[1], group[2] != 0, group[3], group[4], group[5]
        damped, curved = group[6] != 0 and c_damping != 0.0, group[7] != 0
        for e0 in range(group[0], stop, LANES):
            load_data(batch, ws, e0, stop, group)
            load_shape(batch, q, ws, e0, stop, 0)
            if not damped:
                clear(ws, DA_L, 2)
            if c_stiffness == 0.0:
                clear(ws, EA_L, 2)
            clear(ws, KDD, BLOCKS)
            for g in range(axial):
                axial_tangent(ws, gp, g0 + g, EPS0 + g, paper, c_damping)
                spread_axial(ws, gp, g0 + g)
            for g in range(bending):
                bending_tangent(ws, gp, g0 + axial + g, KAPPA0 + g, paper, curved)
                if damped:
                    bending_damping_tangent(ws, gp, g0 + axial + g, paper, c_damping)
                spread_bending(ws, gp, g0 + axial + g)
            store_tangent(batch, A, ws, e0, stop, c_mass, c_damping)


@inline_kernel
def gauss_energy(ws, gp, g, k0, m, paper, bending):  # type: ignore[no-untyped-def]
    """Energy of one Gauss point of lane m."""
    p, s = shape_at(ws, gp, g, 0, m)
    a = dot(p, p)
    ref = ws[k0 * LANES + m]
    if not bending:
        eps = 0.5 * (a - 1.0) if paper else math.sqrt(a) - 1.0
        return 0.5 * gp[g, 6] * ws[EA_L * LANES + m] * (eps - ref) ** 2
    b, c = dot(p, s), dot(s, s)
    k2 = max((a * c - b * b) / (a * a * (a if paper else 1.0)), 0.0)
    khat = math.sqrt((1.0 + SMOOTHING**2) * (k2 + (SMOOTHING * ref) ** 2))
    constant = ref * ref * (1.0 + 2.0 * SMOOTHING**2)
    return 0.5 * gp[g, 6] * ws[EI_L * LANES + m] * (k2 - 2.0 * ref * khat + constant)


@inline_kernel
def cable_energy(batch, q, ws):  # type: ignore[no-untyped-def]
    """Strain energy, J (the integral behind eq. 27)."""
    energy = 0.0
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        stop, g0, axial = group[1], group[3], group[4]
        for e0 in range(group[0], stop, LANES):
            clear(ws, KAPPA0, group[5])
            load_data(batch, ws, e0, stop, group)
            load_shape(batch, q, ws, e0, stop, 0)
            for m in range(min(LANES, stop - e0)):
                for g in range(axial + group[5]):
                    k0 = EPS0 + g if g < axial else KAPPA0 + g - axial
                    energy += gauss_energy(ws, batch.gp, g0 + g, k0, m, group[2] != 0, g >= axial)
    return energy


@inline_kernel
def cable_power(batch, q, v, ws):  # type: ignore[no-untyped-def]
    """Power taken out by external and Kelvin-Voigt damping and power put in (none), W."""
    power = 0.0
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        stop, paper, g0, axial = group[1], group[2] != 0, group[3], group[4]
        if group[6] == 0:
            continue
        for e0 in range(group[0], stop, LANES):
            load_data(batch, ws, e0, stop, group)
            for m in range(stop - e0, LANES):  # repeated elements count once
                for k in (VISCOUS, DA_L, DB_L, MASS):
                    ws[k * LANES + m] = 0.0
            load_shape(batch, q, ws, e0, stop, 0)
            load_shape(batch, v, ws, e0, stop, 18)
            load_acceleration(batch, v, v, ws, e0, stop, False)
            clear(ws, FD, 9)
            inertia_force(ws)
            for m in range(min(LANES, stop - e0)):
                for slot in range(12):
                    f = ws[(NODAL + slot) * LANES + m] * ws[VISCOUS * LANES + m]
                    power += f * ws[(A1 + slot) * LANES + m]
            for g in range(axial):
                power += axial_damping(ws, batch.gp, g0 + g, paper)
            for g in range(group[5]):
                power += bending_damping(ws, batch.gp, g0 + axial + g, paper)
    return power, 0.0


implements(
    CableBatch,
    force=cable_force,
    inertia=cable_inertia,
    tangent=cable_tangent,
    energy=cable_energy,
    power=cable_power,
)
