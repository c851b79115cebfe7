"""A wire as a string without bending stiffness: where form finding starts."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray


def string_loads(x: FloatArray, z: FloatArray, tension: float, weight: float) -> FloatArray:
    """Upward forces (n,) in N that hold a string at heights z (n,) at places x (n,), m.

    Between them it sags by its weight (N/m); those at the ends carry half a cell and the slope there.
    """
    cell = np.diff(x)
    slope = np.diff(z) / cell
    half = 0.5 * weight * cell
    force: FloatArray = np.zeros(x.size)
    force[:-1] += half - tension * slope
    force[1:] += half + tension * slope
    return force


def string_shape(
    x: FloatArray, held: FloatArray, load: FloatArray, tension: float | FloatArray
) -> FloatArray:
    """Displacements (n,) in m of a string under nodal loads (n,) in N, NaN in `held` where it is free.

    The tension in N is one number or one for each cell (n-1,).
    """
    from scipy.linalg import solveh_banded

    k = tension / np.diff(x)
    diagonal = np.concatenate([k, [0.0]]) + np.concatenate([[0.0], k])
    fixed = ~np.isnan(held)
    value = np.where(fixed, held, 0.0)
    right = load.copy()
    right[:-1] += k * value[1:]
    right[1:] += k * value[:-1]
    upper = np.where(fixed[1:] | fixed[:-1], 0.0, -k)
    band = np.vstack([np.concatenate([[0.0], upper]), np.where(fixed, 1.0, diagonal)])
    shape: FloatArray = solveh_banded(band, np.where(fixed, value, right))
    return shape


def lumped(x: FloatArray, weight: float) -> FloatArray:
    """Weights (n,) in N of a wire of `weight` N/m, half a cell to each of its ends; downwards, negative."""
    half = 0.5 * weight * np.diff(x)
    load: FloatArray = np.zeros(x.size)
    load[:-1] -= half
    load[1:] -= half
    return load
