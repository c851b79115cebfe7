"""Shape functions of the two fully parameterised beams (paper, eqs. 7, 8, 16, 17), initial nodal values.

A point of the beam is at r(x) + y r_y(x) + z r_z(x).  The columns of a table of factors are r, r_x, r_y,
r_z of the first node, the same of the second and, for the nonlocking element, r_yx and r_zx at the first
node, which no other element shares.  With xi = x/L in [0, 1]

* r is the cubic Hermite polynomial of the cable,
* r_y and r_z are linear (``original``), or (``nonlocking``)
  r_y = (1 - xi^2) r_y1 + xi^2 r_y2 + L (xi - xi^2) r_yx1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import FloatArray
from ..model.bodies.beam import Beam
from .shapes import hermite

#: Internal vectors by element.
INTERNAL = {"original": 0, "nonlocking": 2}


def section_shape(element: str, xi: ArrayLike, length: float, derivative: int = 0) -> FloatArray:
    """Factors of r_y1, r_y2 and (nonlocking) r_yx1 in r_y or r_yx; those of r_z are the same.

    Parameters
    ----------
    element : {"original", "nonlocking"}
    xi : array_like, shape (...,)
        Position in the element, 0 at the first node and 1 at the second.
    length : float
        Reference length of the element, m.
    derivative : {0, 1, 2}
        Order of the derivative with respect to x = xi * length.

    Returns
    -------
    ndarray, shape (..., 2) or (..., 3)
    """
    s, h = np.asarray(xi, dtype=np.float64), float(length)
    one = np.ones_like(s)
    if element == "original":
        columns = ([1 - s, s], [-one / h, one / h], [0 * s, 0 * s])[derivative]
    else:
        columns = (
            [1 - s**2, s**2, h * s * (1 - s)],
            [-2 * s / h, 2 * s / h, 1 - 2 * s],
            [-2 * one / h**2, 2 * one / h**2, -2 * one / h],
        )[derivative]
    return np.stack(columns, axis=-1)


def shape(
    element: str,
    xi: ArrayLike,
    length: float,
    y: float = 0.0,
    z: float = 0.0,
    derivative: int | str = 0,
) -> FloatArray:
    """Factors of the element's vectors in the position of a point or in one of its derivatives.

    Parameters
    ----------
    element : {"original", "nonlocking"}
    xi, length
        As for :func:`section_shape`.
    y, z : float
        Place in the cross-section, m; of no effect on r_y, r_z, r_yx and r_zx.
    derivative : {0, 1, "r", "r_x", "r_y", "r_z", "r_yx", "r_zx", 2, "r_xx"}
        What is wanted at (x, y, z): 0, 1, 2 are short for r, r_x, r_xx.

    Returns
    -------
    ndarray, shape (..., 8) or (..., 10)
    """
    name = ("r", "r_x", "r_xx")[derivative] if isinstance(derivative, int) else derivative
    s = np.asarray(xi, dtype=np.float64)
    out = np.zeros((*s.shape, 8 + INTERNAL[element]))
    if name in ("r_y", "r_z", "r_yx", "r_zx"):
        out[..., _columns(element, name[2])] = section_shape(element, s, length, len(name) - 3)
        return out
    order = ("r", "r_x", "r_xx").index(name)
    out[..., [0, 1, 4, 5]] = hermite(s, length, order)
    for place, axis in ((y, "y"), (z, "z")):
        if place != 0.0:
            factors = section_shape(element, s, length, order)
            out[..., _columns(element, axis)] = place * factors
    return out


def _columns(element: str, axis: str) -> list[int]:
    k = 2 if axis == "y" else 3
    return [k, k + 4] if element == "original" else [k, k + 4, k + 6]


def initial_vectors(beam: Beam) -> FloatArray:
    """The vectors of the nodes and, in the row of its first node, of each element in the initial shape.

    The internal r_yx and r_zx of the nonlocking element are such that r_y and r_z at mid-element are the
    section's axes there.

    Returns
    -------
    ndarray, shape (nodes, vectors + internal, 3)
        r (m), r_x, r_y, r_z and r_yx, r_zx (1/m); the last row's internal ones are zero.
    """
    out = np.zeros((beam.elements + 1, 4 + INTERNAL[beam.element], 3))
    out[:, 0], out[:, 1] = beam.node_position, beam.stretch * beam.node_tangent
    axes = np.stack([beam.node_y, beam.node_z], axis=1)
    out[:, 2:4] = axes
    if INTERNAL[beam.element]:
        h = np.diff(beam.node_x)[:, None, None]
        out[:-1, 4:] = (4 * beam.middle_axes - 3 * axes[:-1] - axes[1:]) / h
    return out
