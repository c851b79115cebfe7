"""The noise of measured columns from what a fit leaves of them, for their weights in the next one.

Iteratively reweighted least squares: of each column sum r^2 / (n - l) is the variance of its noise, with l
the leverage of its numbers, the trace of their part of the hat matrix: what the parameters took of them.
Source: M. Davidian and R. J. Carroll, Variance function estimation, J. Am. Stat. Assoc. 82 (1987).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..arrays import FloatArray

#: Ratio of the noise of two columns to what was assumed from which on they are weighed anew; then until this.
NOTABLE, SETTLED = 1.5, 1.05
ROUNDS = 6
#: Numbers beyond the parameters that a column needs for its noise to be told.
FEWEST = 5.0
#: Part of a column's spread below which nothing is noise: data that were computed have none.
FLOOR = 1e-6
#: Singular values of the derivatives below this part of the largest tell nothing.
NOTHING = 1e-9


def noise_of(
    rows: Mapping[str, slice], residuals: FloatArray, jacobian: FloatArray, known: frozenset[str]
) -> dict[str, float]:
    """Deviation of the noise of each column, in units of what is assumed.

    Parameters
    ----------
    rows : mapping of str to slice
        Of the residuals, by column.
    residuals : (n,)
    jacobian : (n, p)
    known : frozenset of str
        Columns whose deviations are given; what they leave is the unit.

    Returns
    -------
    dict
        Without columns that have too few numbers.
    """
    left, singular, _ = np.linalg.svd(jacobian, full_matrices=False)
    left = left[:, singular > NOTHING * max(float(singular[0]), 1e-300)]
    lever = np.sum(left**2, axis=1)
    free = {name: part.stop - part.start - float(np.sum(lever[part])) for name, part in rows.items()}
    squares = {name: float(np.sum(residuals[part] ** 2)) for name, part in rows.items()}
    unit = 1.0
    if known:
        unit = sum(squares[name] for name in known) / max(sum(free[name] for name in known), 1.0)
    return {
        name: 1.0 if name in known else float(np.sqrt(squares[name] / free[name] / max(unit, FLOOR**2)))
        for name in rows
        if name in known or free[name] >= FEWEST
    }


def apart(noise: Mapping[str, float]) -> float:
    """Ratio of the largest noise to the smallest, each in units of what is assumed."""
    if len(noise) < 2:
        return 1.0
    return max(max(noise.values()), FLOOR) / max(min(noise.values()), FLOOR)
