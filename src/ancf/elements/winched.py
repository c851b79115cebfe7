"""The cable whose natural length a winch changes at one end: an arbitrary Lagrangian-Eulerian element.

The nodes keep their places X on the mesh, X = 0 at the far end, and share the change of the length L(t):
the material that is at X now is x = lam X, lam = L/L0.  With mu = (dL/dt)/L and the unknowns r and r_X

    r_x = r_X/lam,     w = v - mu D q,     D f = X f_X,
    material acceleration = a - (dmu/dt) D q - mu D (v + w).

v and a are the rates of the unknowns, w is the velocity of the material.  D of a cubic is a cubic, so that
all of it is exact in the element: mass, strains and damping are those of :mod:`ancf.elements.cable`, of an
element of the length lam h whose rates are those of the material.

L is an unknown with a given motion.  Its row of the residual is the force Q on it, whose power Q dL/dt is
what the winch and the material that enters bring.  With the forces F of inertia and damping on the unknowns,
those of the strains f, V_a and V_b the axial and bending energy, and w at the winch,

    L Q = sum (V_a - V_b - f.q - F.D q - weight of the element * height of its middle) + L rhoA w^2/2,

so that kinetic + strain + potential energy change by exactly what is supplied and dissipated.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import Role, formula, implements, inline_kernel
from ..simd import every, gather, load, scatter, total, vector
from ..vectors import dot
from .cable import bind, damped_force, differences, elastic, on_nodes, stiffness
from .cable_columns import (
    AXIAL,
    BEGIN,
    BENDING,
    CURVATURE,
    CURVED,
    DAMPED,
    EA_L,
    EI_L,
    END,
    FIRST,
    INV_L,
    LENGTH,
    MASS,
    PAPER,
    VISCOUS,
    VISCOUSLY,
)
from .cable_nodes import add_to_nodes, nodes
from .cable_strain import WEIGHT, a_of, axial_energy, b_of, bending_energy, c_of, forces, products
from .cable_tangent import BLOCKS, KDD, store_tangent
from .cable_tangent_work import reference
from .workspace import clear

# rows of ``lane_run``: X of both nodes, 1/L0, rhoA/2 at the node that is the winch, gravity
X1, X2, INV_L0, ENTER1, ENTER2, GX, GY, GZ = range(8)
#: Nodal factors of the mass, as in cable.MASS, that make the mass of an element.
WHOLE = 420.0


class WinchedBatch(NamedTuple):
    """All elements of cables with a winch; the first fields are those of a CableBatch, of the mesh."""

    base: NDArray[np.int64]  # (n, 4)
    dest: NDArray[np.int64]  # (n, 16)
    first: NDArray[np.int64]  # (chunks + 1,)
    lane_base: NDArray[np.int64]  # (chunks, 4, LANES)
    nodal: NDArray[np.bool_]  # (chunks,)
    lane_data: FloatArray  # (chunks, 8, LANES)
    lane_slope: FloatArray  # (chunks, 1, LANES)
    lane_reference: FloatArray  # (chunks, 20, LANES)
    groups: NDArray[np.int64]  # (k, 8)
    gp: FloatArray  # (m, 20)
    lane_block: NDArray[np.int64]  # (chunks, 3, LANES)
    order: NDArray[np.int64]  # (chunks,)
    lane_winch: NDArray[np.int64]  # (chunks, 1, LANES) unknown of the length L
    lane_run: FloatArray  # (chunks, 8, LANES) rows X1 ... GZ


@formula
def length(batch, x, chunk):
    """L of the lanes, or its rates."""
    return gather(x, batch.lane_winch, chunk, 0)[0]


@formula
def stretch(batch, q, chunk):
    """lam."""
    return length(batch, q, chunk) * load(batch.lane_run, chunk, INV_L0)


@formula
def along(batch, chunk, f):
    """D f = X f_X of a cubic, as values and slopes at its nodes."""
    f1, s1, f2, s2 = f
    inv = load(batch.lane_data, chunk, INV_L)
    x1, x2, chord = load(batch.lane_run, chunk, X1), load(batch.lane_run, chunk, X2), inv * (f2 - f1)
    c1, c2 = inv * (6.0 * chord - 4.0 * s1 - 2.0 * s2), inv * (2.0 * s1 + 4.0 * s2 - 6.0 * chord)
    return x1 * s1, s1 + x1 * c1, x2 * s2, s2 + x2 * c2


@formula
def less(f, factor, g):
    """f - factor g, of four slots."""
    f1, s1, f2, s2 = f
    g1, t1, g2, t2 = g
    return f1 - factor * g1, s1 - factor * t1, f2 - factor * g2, s2 - factor * t2


@formula
def scaled(factor, f):
    """A factor times four slots."""
    f1, s1, f2, s2 = f
    return factor * f1, factor * s1, factor * f2, factor * s2


@formula
def shaped(batch, chunk, f):
    """d, t1 and t2 of four slots."""
    f1, s1, f2, s2 = f
    return load(batch.lane_data, chunk, INV_L) * (f2 - f1), s1, s2


@formula
def work(f, g):
    """Sum of the products of four slots."""
    f1, s1, f2, s2 = f
    g1, t1, g2, t2 = g
    return dot(f1, g1) + dot(s1, t1) + dot(f2, g2) + dot(s2, t2)


@formula
def three(factor, x):
    """A factor times d, t1 and t2."""
    d, t1, t2 = x
    return factor * d, factor * t1, factor * t2


@formula
def stored(batch, group, chunk, G, axially, across):
    """Axial and bending energy of the lanes."""
    gp, first, axial = batch.gp, group[FIRST], group[AXIAL]
    paper, curved = group[PAPER] != 0, group[CURVED] != 0
    ea, ei = axially * load(batch.lane_data, chunk, EA_L), across * load(batch.lane_data, chunk, EI_L)
    inv_l = load(batch.lane_data, chunk, INV_L)
    stretching, bent = every(0.0), every(0.0)
    for k in range(axial):
        at = gp[first + k]
        found = ea * axial_energy(a_of(at, G), reference(batch, chunk, k, curved), paper)
        stretching = stretching + at[WEIGHT] * found
    for k in range(group[BENDING]):
        at = gp[first + axial + k]
        b, c = inv_l * b_of(at, G), inv_l * inv_l * c_of(at, G)
        kappa0 = reference(batch, chunk, CURVATURE + k, curved)
        bent = bent + at[WEIGHT] * (ei * bending_energy(a_of(at, G), b, c, kappa0, paper))
    return stretching, bent


@formula
def weight_work(batch, chunk, lam, r):
    """Weight of the elements times the mean of r."""
    r1, s1, r2, s2 = r
    h, run = load(batch.lane_data, chunk, LENGTH), batch.lane_run
    mean = 0.5 * (r1 + r2) + (h / 12.0) * (s1 - s2)
    g = vector(load(run, chunk, GX), load(run, chunk, GY), load(run, chunk, GZ))
    return WHOLE * lam * load(batch.lane_data, chunk, MASS) * dot(g, mean)


@formula
def entering(batch, chunk, w):
    """rhoA w^2/2 where the material enters."""
    w1, _, w2, _ = w
    run = batch.lane_run
    return load(run, chunk, ENTER1) * dot(w1, w1) + load(run, chunk, ENTER2) * dot(w2, w2)


@inline_kernel
def winched_chunk(batch, group, chunk, q, v, a, r):
    """Forces of a chunk, and those on the lengths."""
    size = length(batch, q, chunk)
    inv = 1.0 / size
    lam, mu = size * load(batch.lane_run, chunk, INV_L0), inv * length(batch, v, chunk)
    dmu, il = inv * length(batch, a, chunk) - mu * mu, 1.0 / lam
    place, rate = nodes(batch, q, chunk), nodes(batch, v, chunk)
    drawn = along(batch, chunk, place)
    w = less(rate, mu, drawn)
    both = along(batch, chunk, less(rate, -1.0, w))
    acceleration = less(less(nodes(batch, a, chunk), dmu, drawn), mu, both)
    if group[DAMPED] & VISCOUSLY:
        acceleration = less(acceleration, -1.0 * load(batch.lane_data, chunk, VISCOUS), w)
    x = three(il, shaped(batch, chunk, place))
    u = differences(x)
    G = products(u)
    strained = three(il, forces(elastic(batch, group, chunk, G, lam, il), u))
    force = strained
    if group[DAMPED] & ~VISCOUSLY:
        rates = three(il, shaped(batch, chunk, w))
        force = three(il, damped_force(batch, group, chunk, x, rates, lam, il))
    found = on_nodes(batch, chunk, scaled(lam, acceleration), force)
    add_to_nodes(batch, r, chunk, found)
    # on the length: what the strains do along D q is not in F
    fd, f1, f2 = strained
    d, t1, t2 = shaped(batch, chunk, place)
    dd, d1, d2 = shaped(batch, chunk, drawn)
    stretching, bent = stored(batch, group, chunk, G, lam, il)
    on_length = stretching - bent - (dot(fd, d) + dot(f1, t1) + dot(f2, t2))
    on_length = on_length + dot(fd, dd) + dot(f1, d1) + dot(f2, d2) - work(found, drawn)
    on_length = on_length - weight_work(batch, chunk, lam, place)
    on_length = inv * on_length + entering(batch, chunk, w)
    scatter(vector(on_length, every(0.0), every(0.0)), r, batch.lane_winch, chunk, 0)


@inline_kernel
def winched_force(batch, q, v, a, r, ws):
    """Add inertia, elastic and damping forces to r, and the forces on the lengths."""
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        for chunk in range(group[BEGIN], group[END]):
            winched_chunk(batch, group, chunk, q, v, a, r)


@inline_kernel
def winched_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """Add c_mass M + c_damping C + c_stiffness K to the block values A.

    Of what the convection adds it has the symmetric part of first order in mu: mu M but at the winch.
    """
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        for chunk in range(group[BEGIN], group[END]):
            clear(ws, KDD, BLOCKS)
            lam = stretch(batch, q, chunk)
            il = 1.0 / lam
            x = three(il, shaped(batch, chunk, nodes(batch, q, chunk)))
            stiffness(batch, group, chunk, x, ws, c_damping, c_stiffness, il, il * il * il)
            mu = length(batch, v, chunk) / length(batch, q, chunk)
            mass = c_mass + c_damping * (load(batch.lane_data, chunk, VISCOUS) + mu)
            store_tangent(batch, A, ws, chunk, lam * mass * load(batch.lane_data, chunk, MASS))


@inline_kernel
def winched_energy(batch, q, ws):
    """Strain energy, J."""
    energy = 0.0
    for n in range(batch.groups.shape[0]):
        group = batch.groups[n]
        for chunk in range(group[BEGIN], group[END]):
            lam = stretch(batch, q, chunk)
            il = 1.0 / lam
            u = differences(three(il, shaped(batch, chunk, nodes(batch, q, chunk))))
            stretching, bent = stored(batch, group, chunk, products(u), lam, il)
            energy += total(stretching + bent)
    return energy


def inertial(batch):
    """The batch without all but its mass: its forces depend on velocities and dissipate nothing."""
    lane_data, run = batch.lane_data.copy(), batch.lane_run.copy()
    kept = [LENGTH, INV_L, MASS]
    lane_data[:, [k for k in range(lane_data.shape[1]) if k not in kept]] = 0.0
    run[:, [GX, GY, GZ]] = 0.0
    return batch._replace(lane_data=lane_data, lane_run=run, lane_slope=0.0 * batch.lane_slope)


implements(
    WinchedBatch,
    force=winched_force,
    tangent=winched_tangent,
    energy=winched_energy,
    role=Role.DISSIPATES,
    slots=("base", "lane_base", "lane_winch"),
    bind=bind,
    damped=lambda batch: bool(np.any(batch.groups[:, DAMPED])),
    turning_mass=lambda batch: True,
    inertial=inertial,
)
