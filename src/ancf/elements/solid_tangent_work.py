"""Products of the matrices of the two beams with a vector, without these: for LANES elements at a time.

Along changes y of the vectors of a Gauss point stresses change by those of the changes of the strains, and
forces by these on the vectors and by the stresses on y.
"""

from __future__ import annotations

from ..compiled import formula, inline_kernel
from ..vectors import dot
from .solid_force import D, point, pulled, spread, strains, stresses, vectors


@formula
def strain_slopes(x, y):
    """Changes of the fifteen scalars of :func:`ancf.elements.solid_force.strains` along y, linear in it."""
    (a, b, B, c, C), (ya, yb, yB, yc, yC) = x, y
    return (
        dot(a, ya),
        dot(b, yb),
        dot(c, yc),
        2.0 * dot(B, yB),
        2.0 * dot(C, yC),
        dot(B, yC) + dot(C, yB),
        dot(a, yB) + dot(B, ya),
        dot(a, yC) + dot(C, ya),
        dot(a, yb) + dot(b, ya),
        dot(a, yc) + dot(c, ya),
        dot(b, yc) + dot(c, yb),
        dot(b, yB) + dot(B, yb),
        dot(c, yC) + dot(C, yc),
        dot(b, yC) + dot(C, yb),
        dot(c, yB) + dot(B, yc),
    )


@inline_kernel
def elastic_slopes(ws, gp, g, along):
    """Add what the elastic force of Gauss point g changes by along the vectors from a row on to FORCE."""
    at = point(gp, g)
    x, y, w = vectors(ws, at, D), vectors(ws, at, along), at[7]
    pa, pb, pB, pc, pC = pulled(stresses(ws, w, strains(ws, x)), y)
    ta, tb, tB, tc, tC = pulled(stresses(ws, w, strain_slopes(x, y)), x)
    spread(ws, at, pa + ta, pb + tb, pB + tB, pc + tc, pC + tC)
