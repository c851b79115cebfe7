"""Derivatives by the shape of x . force of damped beams at fixed rates, for LANES elements at a time.

With the vectors a, B, C of a Gauss point, their rates and those of x in the place of one of the two, the work
is that of three dampers, D_a (a.a') (a.x_a) and, of B and likewise of C, D_b (a.B' + B.a') (a.x_B + B.x_a).
"""

from __future__ import annotations

from ..compiled import inline_kernel
from ..simd import zero
from ..vectors import dot
from .solid_force import ACCELERATION, AXIAL, BENDING, RATE, D, point, spread, vectors
from .workspace import row


@inline_kernel
def damping_slopes(ws, gp, g):
    """Add to the rows FORCE what the dampers of Gauss point g do; x is in the rows ACCELERATION."""
    at = point(gp, g)
    a, _, B, _, C = vectors(ws, at, D)
    da, _, dB, _, dC = vectors(ws, at, RATE)
    xa, _, xB, _, xC = vectors(ws, at, ACCELERATION)
    axial, bending = at[7] * row(ws, AXIAL), at[7] * row(ws, BENDING)
    rate, moved = axial * dot(a, da), axial * dot(a, xa)
    rate1, moved1 = bending * (dot(a, dB) + dot(B, da)), bending * (dot(a, xB) + dot(B, xa))
    rate2, moved2 = bending * (dot(a, dC) + dot(C, da)), bending * (dot(a, xC) + dot(C, xa))
    by_a = moved * da + rate * xa + moved1 * dB + rate1 * xB + moved2 * dC + rate2 * xC
    spread(ws, at, by_a, zero(), moved1 * da + rate1 * xa, zero(), moved2 * da + rate2 * xa)
