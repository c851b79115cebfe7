"""Cubic Hermite shape functions of the centreline (paper eqs. 20-22) and their derivatives."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import FloatArray


def hermite(xi: ArrayLike, length: ArrayLike, derivative: int = 0) -> FloatArray:
    """Shape functions ``S1 ... S4`` of eq. 22, or a derivative with respect to x.

    Parameters
    ----------
    xi : array_like, shape (...,)
        Position in the element, 0 at the first node and 1 at the second (the paper's xi is 2 xi - 1).
    length : float or array_like that xi can be broadcast with
        Reference length of the element, m.
    derivative : {0, 1, 2}
        Order of the derivative with respect to x = xi * length.

    Returns
    -------
    ndarray, shape (..., 4)
        Factors of r(0), r_x(0), r(L), r_x(L).
    """
    s, h = np.asarray(xi, dtype=np.float64), np.asarray(length, dtype=np.float64)
    if derivative == 0:
        columns = [1 - s**2 * (3 - 2 * s), h * s * (1 - s) ** 2, s**2 * (3 - 2 * s), h * s**2 * (s - 1)]
    elif derivative == 1:
        columns = [6 * s * (s - 1) / h, 1 + s * (3 * s - 4), 6 * s * (1 - s) / h, s * (3 * s - 2)]
    else:
        columns = [(12 * s - 6) / h**2, (6 * s - 4) / h, (6 - 12 * s) / h**2, (6 * s - 2) / h]
    return np.stack(columns, axis=-1)


@cache
def gauss(points: int) -> tuple[FloatArray, FloatArray]:
    """Gauss-Legendre positions and weights on [0, 1]; exact for polynomials of degree 2 points - 1."""
    x, w = np.polynomial.legendre.leggauss(points)
    x, w = (x + 1) / 2, w / 2
    x.flags.writeable = w.flags.writeable = False  # everybody gets these
    return x, w
