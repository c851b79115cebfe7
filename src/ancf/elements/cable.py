"""The 12-dof cable element (paper, section 5, eqs. 18-27): batch, mass, force, tangent, energy.

Unknowns of a node: r and r_x (eq. 18).  The element has no torsional stiffness and one bending
stiffness (eq. 24).  Force and tangent follow from the strain energy

    W = int_0^L  EA/2 (eps - eps0)^2 + EI/2 (kappa - kappa0)^2  dx

with the measures of :mod:`ancf.elements.measures`, five Gauss points for the axial and three for the
bending part by default.  With a curved reference (kappa0 > 0) the difference of the two curvatures is
what remains when the section turns freely about the tangent, as it does without torsional stiffness.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import Role, formula, implements, inline_kernel
from ..simd import every, load, total, zero
from .cable_changes import cable_changes, kinds_of
from .cable_columns import (
    AXIAL,
    AXIALLY,
    BEGIN,
    BENDING,
    CURVATURE,
    CURVED,
    DA_L,
    DAMPED,
    DB_L,
    EA_L,
    EI_L,
    END,
    FIRST,
    IN_BENDING,
    IN_SLOPE,
    INV_L,
    LENGTH,
    MASS,
    PAPER,
    VISCOUS,
    VISCOUSLY,
)
from .cable_damping import axial_damping, bending_damping, bending_damping_tangent, slope_damping
from .cable_hessian import add_elastic
from .cable_nodes import add_to_nodes, nodes
from .cable_numbers import elements_work, joined, numbers
from .cable_rate_work import rate_work
from .cable_rates import TWIST, rate_blocks, store_twists
from .cable_strain import (
    WEIGHT,
    a_of,
    add_a,
    add_abc,
    axial_energy,
    axial_force,
    b_of,
    bend,
    bending_energy,
    bending_force,
    c_of,
    forces,
    product_rates,
    products,
    slope,
)
from .cable_tangent import (
    BLOCKS,
    KDD,
    spread,
    spread_slope_damping,
    store_tangent,
    whole_blocks,
)
from .cable_tangent_work import elastic_along, reference
from .chunks import in_lanes
from .workspace import clear


class CableBatch(NamedTuple):
    """All cable elements of a System, in chunks of LANES that share strain measure and Gauss points.

    A chunk that is not full repeats its last element with all stiffnesses and masses zero.
    """

    base: NDArray[np.int64]  # (n, 4) first unknown of r, r_x, r, r_x of each element
    dest: NDArray[np.int64]  # (n, 16) place of each 3x3 block in the matrix, -1: none
    first: NDArray[np.int64]  # (chunks + 1,) first element of each chunk
    lane_base: NDArray[np.int64]  # (chunks, 4, LANES) base by slot and lane
    nodal: NDArray[np.bool_]  # (chunks,) whether r_x follows r in the state vector at all nodes
    lane_data: FloatArray  # (chunks, 8, LANES) rows LENGTH ... VISCOUS
    lane_slope: FloatArray  # (chunks, 1, LANES) slope damping c L/30
    lane_reference: FloatArray  # (chunks, 20, LANES) strain at the axial gp, from CURVATURE on curvature
    groups: NDArray[np.int64]  # (k, 8) columns BEGIN ... CURVED
    gp: FloatArray  # (m, 20) coefficients of the Gauss points
    lane_block: NDArray[np.int64]  # (chunks, 3, LANES) places of the 6x6 blocks of the nodes in the matrix
    order: NDArray[np.int64]  # (chunks,) how these lie, see cable_tangent.whole_blocks, 0: dest has to do


@formula
def shape(batch, x, chunk):
    """d, t1 and t2 of a chunk, or their rates."""
    r1, t1, r2, t2 = nodes(batch, x, chunk)
    return load(batch.lane_data, chunk, INV_L) * (r2 - r1), t1, t2


@formula
def differences(x):
    """d, u1 and u2 of d, t1 and t2."""
    d, t1, t2 = x
    return d, t1 - d, t2 - d


@formula
def elastic(batch, group, chunk, G, along, across):
    """R = 2 dW/dG of the strain energy; factors of EA L and of EI L."""
    gp, first, axial = batch.gp, group[FIRST], group[AXIAL]
    paper, curved = group[PAPER] != 0, group[CURVED] != 0
    none = every(0.0)
    R = none, none, none, none, none, none
    ea = along * load(batch.lane_data, chunk, EA_L)
    for k in range(axial):
        at = gp[first + k]
        eps0 = reference(batch, chunk, k, curved)
        R = add_a(R, at, at[WEIGHT] * ea * axial_force(a_of(at, G), eps0, paper))
    ei, inv_l = across * load(batch.lane_data, chunk, EI_L), load(batch.lane_data, chunk, INV_L)
    inv_l2 = inv_l * inv_l
    for k in range(group[BENDING]):
        at = gp[first + axial + k]
        kappa0 = reference(batch, chunk, CURVATURE + k, curved)
        wa, wb, wc = bending_force(
            a_of(at, G), inv_l * b_of(at, G), inv_l2 * c_of(at, G), kappa0, paper, curved
        )
        w = at[WEIGHT] * ei
        R = add_abc(R, at, w * wa, w * inv_l * wb, w * inv_l2 * wc)
    return R


@formula
def axially_damped(batch, group, chunk, x, v, R, along):
    """Add to R what the axial damping does; v are the rates of d, t1 and t2."""
    G, dG = products(x), product_rates(x, differences(v))
    da = along * load(batch.lane_data, chunk, DA_L)
    for g in range(group[FIRST], group[FIRST] + group[AXIAL]):
        at = batch.gp[g]
        R = add_a(R, at, at[WEIGHT] * da * axial_damping(a_of(at, G), a_of(at, dG), group[PAPER] != 0))
    return R


@formula
def bending_damped(batch, group, chunk, x, v, force, across):
    """Add the damping of bending to the forces on d, t1 and t2; v are the rates of these."""
    (d, t1, t2), (vd, v1, v2), (fd, f1, f2) = x, v, force
    gp, first = batch.gp, group[FIRST] + group[AXIAL]
    db, inv_l = across * load(batch.lane_data, chunk, DB_L), load(batch.lane_data, chunk, INV_L)
    for g in range(first, first + group[BENDING]):
        p, s = slope(gp, g, d, t1, t2), bend(gp, g, d, t1, t2, inv_l)
        dp, ds = slope(gp, g, vd, v1, v2), bend(gp, g, vd, v1, v2, inv_l)
        n, m = bending_damping(p, s, dp, ds, group[PAPER] != 0, inv_l)
        n, m = gp[g, WEIGHT] * db * n, gp[g, WEIGHT] * db * inv_l * m
        fd = fd + gp[g, 0] * n + gp[g, 3] * m
        f1 = f1 + gp[g, 1] * n + gp[g, 4] * m
        f2 = f2 + gp[g, 2] * n + gp[g, 5] * m
    return fd, f1, f2


@formula
def with_dampers(batch, group, chunk, x, rates, R, along, across):
    """Forces on d, t1 and t2 of R and of the dampers; factors as of :func:`damped_force`."""
    u, damped = differences(x), group[DAMPED]
    if damped & AXIALLY:
        R = axially_damped(batch, group, chunk, u, rates, R, along)
    force = forces(R, u)
    if damped & IN_BENDING:
        force = bending_damped(batch, group, chunk, x, rates, force, across)
    if damped & IN_SLOPE:
        (fd, f1, f2), (vd, v1, v2) = force, rates
        nd, n1, n2 = slope_damping(along * load(batch.lane_slope, chunk, 0), vd, v1, v2)
        force = fd + nd, f1 + n1, f2 + n2
    return force


@inline_kernel
def damped_force(batch, group, chunk, x, rates, along, across):
    """Elastic and damping forces on d, t1 and t2; factors of the constants along the axis and of bending."""
    R = elastic(batch, group, chunk, products(differences(x)), along, across)
    return with_dampers(batch, group, chunk, x, rates, R, along, across)


@formula
def accelerations(batch, v, a, chunk, viscous):
    """Of the four slots, plus (damping/rhoA) velocity for the external damping."""
    a1, s1, a2, s2 = nodes(batch, a, chunk)
    if viscous:
        c = load(batch.lane_data, chunk, VISCOUS)
        v1, w1, v2, w2 = nodes(batch, v, chunk)
        a1, s1, a2, s2 = a1 + c * v1, s1 + c * w1, a2 + c * v2, s2 + c * w2
    return a1, s1, a2, s2


@formula
def on_nodes(batch, chunk, acceleration, force):
    """Forces on the four slots of those on d, t1, t2 and the consistent mass (eq. 23) times accelerations."""
    (a1, s1, a2, s2), (fd, f1, f2) = acceleration, force
    h, m = load(batch.lane_data, chunk, LENGTH), load(batch.lane_data, chunk, MASS)
    fd, s1, s2, mh = load(batch.lane_data, chunk, INV_L) * fd, h * s1, h * s2, m * h
    r1 = m * (156.0 * a1 + 22.0 * s1 + 54.0 * a2 - 13.0 * s2) - fd
    t1 = mh * (22.0 * a1 + 4.0 * s1 + 13.0 * a2 - 3.0 * s2) + f1
    r2 = m * (54.0 * a1 + 13.0 * s1 + 156.0 * a2 - 22.0 * s2) + fd
    t2 = mh * (4.0 * s2 - 13.0 * a1 - 3.0 * s1 - 22.0 * a2) + f2
    return r1, t1, r2, t2


@inline_kernel
def cable_force(batch, q, v, a, r, ws):
    """Add inertia, elastic and damping forces to r."""
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        damped = group[DAMPED]
        for chunk in range(group[BEGIN], group[END]):
            x = shape(batch, q, chunk)
            if damped & ~VISCOUSLY:
                force = damped_force(batch, group, chunk, x, shape(batch, v, chunk), 1.0, 1.0)
            else:
                u = differences(x)
                force = forces(elastic(batch, group, chunk, products(u), 1.0, 1.0), u)
            acceleration = accelerations(batch, v, a, chunk, damped & VISCOUSLY != 0)
            add_to_nodes(batch, r, chunk, on_nodes(batch, chunk, acceleration, force))


@inline_kernel
def cable_inertia(batch, a, r, ws):
    """Add the mass matrix times a to r (eq. 23)."""
    for chunk in range(batch.first.shape[0] - 1):
        none = zero(), zero(), zero()
        add_to_nodes(batch, r, chunk, on_nodes(batch, chunk, accelerations(batch, a, a, chunk, False), none))


@inline_kernel
def stiffness(batch, group, chunk, x, ws, c_damping, c_stiffness, along, across):
    """Add the tangents of strains and damping in the shape x to the blocks between d, t1 and t2.

    There are factors of the axial constants, and of those of bending.
    """
    d, t1, t2 = x
    gp, first, data = batch.gp, group[FIRST] + group[AXIAL], batch.lane_data
    damped = group[DAMPED] if c_damping != 0.0 else 0
    ea, da = along * (c_stiffness * load(data, chunk, EA_L)), along * (c_damping * load(data, chunk, DA_L))
    ei, db = across * (c_stiffness * load(data, chunk, EI_L)), across * (c_damping * load(data, chunk, DB_L))
    if c_stiffness != 0.0 or damped & AXIALLY:
        add_elastic(batch, group, chunk, differences(x), ws, ea, ei, da, c_stiffness != 0.0)
    if damped & IN_BENDING:
        inv_l = load(data, chunk, INV_L)
        for g in range(first, first + group[BENDING]):
            p, s = slope(gp, g, d, t1, t2), bend(gp, g, d, t1, t2, inv_l)
            pairs = bending_damping_tangent(p, s, gp[g, WEIGHT] * db, group[PAPER] != 0, inv_l)
            spread(ws, gp, g, inv_l, pairs)
    if damped & IN_SLOPE:
        spread_slope_damping(ws, along * (c_damping * load(batch.lane_slope, chunk, 0)))


@inline_kernel
def cable_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add c_mass M + c_damping C + c_stiffness K (c_stiffness is 0 or 1) to the block values A."""
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        if c_mass == 0.0 and c_stiffness == 0.0 and group[DAMPED] == 0:
            continue
        for chunk in range(group[BEGIN], group[END]):
            clear(ws, KDD, BLOCKS)
            stiffness(batch, group, chunk, shape(batch, q, chunk), ws, c_damping, c_stiffness, 1.0, 1.0)
            factor = c_mass + c_damping * load(batch.lane_data, chunk, VISCOUS)
            store_tangent(batch, A, ws, chunk, factor * load(batch.lane_data, chunk, MASS))


@inline_kernel
def cable_rate_stiffness(batch, q, v, S, W, ws):
    """See :func:`ancf.compiled.add_rate_stiffness`: damping of strains alone changes with the shape."""
    data = batch.lane_data
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        damped, middle = group[DAMPED], group[FIRST] + group[AXIAL]
        if damped & (AXIALLY | IN_BENDING) == 0:
            continue
        axial = (group[FIRST], middle if damped & AXIALLY else group[FIRST])
        bending = (middle, middle + group[BENDING] if damped & IN_BENDING else middle)
        for chunk in range(group[BEGIN], group[END]):
            clear(ws, KDD, BLOCKS)
            clear(ws, TWIST, BLOCKS)
            x, rates, inv_l = shape(batch, q, chunk), shape(batch, v, chunk), load(data, chunk, INV_L)
            da, db = load(data, chunk, DA_L), load(data, chunk, DB_L)
            rate_blocks(ws, batch.gp, x, rates, da, db, inv_l, group[PAPER] != 0, axial, bending)
            store_twists(batch, W, ws, chunk, inv_l)
            store_tangent(batch, S, ws, chunk, every(0.0))


@inline_kernel
def cable_rate_work(batch, q, v, x, out, ws):
    """See :func:`ancf.compiled.add_rate_work`."""
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        if group[DAMPED] & (AXIALLY | IN_BENDING) == 0:
            continue
        for chunk in range(group[BEGIN], group[END]):
            states = shape(batch, q, chunk), shape(batch, v, chunk), shape(batch, x, chunk)
            d, t1, t2 = rate_work(batch, group, chunk, *states)
            d = load(batch.lane_data, chunk, INV_L) * d
            add_to_nodes(batch, out, chunk, (-1.0 * d, t1, d, t2))


@inline_kernel
def cable_number_work(batch, q, v, a, x, out, ws):
    """See :func:`ancf.compiled.add_number_work`."""
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        for chunk in range(group[BEGIN], group[END]):
            states = nodes(batch, q, chunk), nodes(batch, v, chunk), nodes(batch, a, chunk)
            elements_work(batch, group, chunk, states, nodes(batch, x, chunk), out)


@inline_kernel
def cable_tangent_work(batch, q, v, x, by_q, by_v, by_a, ws):
    """See :func:`ancf.compiled.add_tangent_work`."""
    none, o = zero(), every(0.0)
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        for chunk in range(group[BEGIN], group[END]):
            at, moved, own = shape(batch, q, chunk), shape(batch, x, chunk), nodes(batch, x, chunk)
            force = elastic_along(batch, group, chunk, differences(at), differences(moved))
            add_to_nodes(batch, by_q, chunk, on_nodes(batch, chunk, (none, none, none, none), force))
            if group[DAMPED] != 0:
                c, (r1, t1, r2, t2) = load(batch.lane_data, chunk, VISCOUS), own
                force = with_dampers(batch, group, chunk, at, moved, (o, o, o, o, o, o), 1.0, 1.0)
                lost = on_nodes(batch, chunk, (c * r1, c * t1, c * r2, c * t2), force)
                add_to_nodes(batch, by_v, chunk, lost)
            add_to_nodes(batch, by_a, chunk, on_nodes(batch, chunk, own, (none, none, none)))


@inline_kernel
def cable_energy(batch, q, ws):
    """Strain energy, J (the integral behind eq. 27)."""
    energy, gp, data = 0.0, batch.gp, batch.lane_data
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        first, axial, paper, curved = group[FIRST], group[AXIAL], group[PAPER] != 0, group[CURVED] != 0
        for chunk in range(group[BEGIN], group[END]):
            G = products(differences(shape(batch, q, chunk)))
            ea, ei, inv_l = load(data, chunk, EA_L), load(data, chunk, EI_L), load(data, chunk, INV_L)
            for k in range(axial):
                at = gp[first + k]
                found = ea * axial_energy(a_of(at, G), reference(batch, chunk, k, curved), paper)
                energy += at[WEIGHT] * total(found)
            for k in range(group[BENDING]):
                at = gp[first + axial + k]
                b, c = inv_l * b_of(at, G), inv_l * inv_l * c_of(at, G)
                kappa0 = reference(batch, chunk, CURVATURE + k, curved)
                energy += at[WEIGHT] * total(ei * bending_energy(a_of(at, G), b, c, kappa0, paper))
    return energy


def bind(plain, seen, places):
    """See :class:`ancf.compiled.Traits`; shadows may part r_x from r, and nodes be blocks of the matrix."""
    base, dest = seen.lane_base, places.dest(plain.base)
    nodal = np.all(base[:, 1::2] == base[:, ::2] + 3, axis=(1, 2))
    blocks, order = whole_blocks(dest)
    lanes = in_lanes(np.column_stack([blocks, order]), plain.first)
    alike = np.all(lanes[:, 3] == lanes[:, 3, :1], axis=1)
    order, lane_block = np.where(alike, lanes[:, 3, 0], 0), np.ascontiguousarray(lanes[:, :3])
    return seen._replace(dest=dest, nodal=nodal, lane_block=lane_block, order=order)


implements(
    CableBatch,
    force=cable_force,
    inertia=cable_inertia,
    tangent=cable_tangent,
    energy=cable_energy,
    rate_stiffness=cable_rate_stiffness,
    rate_work=cable_rate_work,
    number_work=cable_number_work,
    tangent_work=cable_tangent_work,
    changes=cable_changes,
    numbers=numbers,
    numbered=("lane_data", "lane_slope"),
    joined=joined,
    kinds=kinds_of,
    role=Role.DISSIPATES,
    slots=("base", "lane_base"),
    bind=bind,
    damped=lambda batch: bool(np.any(batch.groups[:, DAMPED])),
    exact=lambda batch, moving: not (moving and np.any(batch.groups[:, DAMPED] & (AXIALLY | IN_BENDING))),
)
