"""What velocities do to the stiffness of damped beams: the derivative of their damping forces by the shape.

Of the dampers of a Gauss point, see :mod:`ancf.elements.solid_force`,

    N_aa = D_a (a.a' I + a a'^T) + D_b (B B'^T + C C'^T),     N_BB = D_b a a'^T,
    N_aB = D_b (f I + B a'^T),     N_Ba = D_b (f I + a B'^T),     f = a.B' + B.a',

and of C as of B.  It is parted into the halves (N + N^T)/2 and (N - N^T)/2, which are spread over the blocks
between the element's vectors as the tangent is.
"""

from __future__ import annotations

from ..compiled import formula, inline_kernel
from ..simd import every, vector
from ..vectors import dot
from .cable_tangent import add_block
from .solid_force import AXIAL, BENDING, RATE, D, point, vectors
from .solid_tangent import A_A, A_BB, A_CC, BB_BB, CC_CC, PLACES, put_rows
from .workspace import row


@formula
def mixed(T, f, x, y, sign):
    """Block T I + f (x y^T + sign y x^T)."""
    return two_dyads(T, f, x, y, sign * f, y, x)


@formula
def two_dyads(T, f, x, y, h, u, v):
    """Block T I + f x y^T + h u v^T."""
    none, s, t = every(0.0), f * x, h * u
    return (
        s[0] * y + t[0] * v + vector(T, none, none),
        s[1] * y + t[1] * v + vector(none, T, none),
        s[2] * y + t[2] * v + vector(none, none, T),
    )


@formula
def sum_of(x, y, z):
    """Sum of three blocks."""
    return x[0] + y[0] + z[0], x[1] + y[1] + z[1], x[2] + y[2] + z[2]


@inline_kernel
def rate_blocks(ws, gp, g, sign):
    """Blocks of Gauss point g of the half with this sign, see ``spread_dampers``."""
    at, none = point(gp, g), every(0.0)
    (a, _, B, _, C), (da, _, dB, _, dC) = vectors(ws, at, D), vectors(ws, at, RATE)
    axial, bending, own = 0.5 * at[7] * row(ws, AXIAL), 0.5 * at[7] * row(ws, BENDING), 1.0 + sign
    by_b, by_c = own * bending * (dot(a, dB) + dot(B, da)), own * bending * (dot(a, dC) + dot(C, da))
    stretched = mixed(own * axial * dot(a, da), axial, a, da, sign)
    bent = mixed(none, bending, B, dB, sign), mixed(none, bending, C, dC, sign)
    put_rows(ws, A_A, sum_of(stretched, bent[0], bent[1]))
    put_rows(ws, A_BB, two_dyads(by_b, bending, B, da, sign * bending, dB, a))
    put_rows(ws, A_CC, two_dyads(by_c, bending, C, da, sign * bending, dC, a))
    put_rows(ws, BB_BB, mixed(none, bending, a, da, sign))
    put_rows(ws, CC_CC, mixed(none, bending, a, da, sign))


@inline_kernel
def store_half(batch, values, ws, chunk, sign):
    """Add the blocks of a chunk to block values; of those on the other side of the diagonal with the sign."""
    columns, first, factors = batch.base.shape[1], batch.first[chunk], batch.lane_scale
    for m in range(batch.first[chunk + 1] - first):
        for x in range(columns):
            for y in range(columns):
                place = batch.dest[first + m, columns * x + y]
                if place >= 0:
                    own = sign if PLACES[x, y, 1] == 1 else 1.0
                    scale = own * factors[chunk, x, m] * factors[chunk, y, m]
                    add_block(values, place, ws, PLACES[x, y], m, scale, 0.0)
