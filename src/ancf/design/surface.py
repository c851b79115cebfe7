"""A smooth surface through numbers and their derivatives at scattered places, which may have small kinks.

Where droppers slacken, a number of a run has kinks a tenth of a millimetre apart: its derivative is exact and
yet tells little of what is a few millimetres away. The surface is the mean of a Gaussian process (Rasmussen,
Williams, *Gaussian Processes for Machine Learning*, 2006, chapters 2, 5 and 9.4) with the covariance

    k(x, y) = s^2 exp(-|x - y|^2/(2 l^2)),

given values f and derivatives g at the places. Both are taken with an error: that of the derivatives is what
kinks do. The length l and the errors are those under which the data are likeliest.
"""

from __future__ import annotations

import itertools

import numpy as np

from ..arrays import FloatArray

#: Lengths that are tried, of places from 0 to 1, and errors of values and derivatives beside their spread.
LENGTHS = (0.25, 0.4, 0.6, 0.9, 1.4, 2.0)
ERRORS = ((1e-3, 0.03), (1e-3, 0.1), (3e-3, 0.2), (1e-2, 0.35), (3e-2, 0.6))


class Surface:
    """A surface through numbers of runs.

    Parameters
    ----------
    places : (m, p)
    values : (m,)
    slopes : (m, p)
        Derivatives there.
    """

    def __init__(self, places: FloatArray, values: FloatArray, slopes: FloatArray) -> None:
        self.places, self.middle = places, float(np.mean(values))
        spread = float(np.std(values)) or 1.0
        steep = float(np.sqrt(np.mean(slopes**2))) or 1.0
        data = np.concatenate([values - self.middle, slopes.ravel()])
        best = np.inf
        for length, (error, rough) in itertools.product(LENGTHS, ERRORS):
            made = _covariance(places, places, length)
            errors = np.concatenate(
                [np.full(len(values), error * spread), np.full(slopes.size, rough * steep)]
            )
            size, unlikely, weights = _likeliest(made, errors, data)
            if unlikely < best:
                best, self.length, self.error, self.weights = unlikely, length, rough, size * weights

    def at(self, u: FloatArray) -> tuple[float, FloatArray]:
        """The surface and its derivatives (p,) at a place (p,)."""
        rows = _covariance(u[None], self.places, self.length) @ self.weights
        return self.middle + float(rows[0]), rows[1:]


def _covariance(x: FloatArray, y: FloatArray, length: float) -> FloatArray:
    """Of values, then derivatives, at the places x (n, p) with those at y (m, p), of size 1."""
    (n, p), m = x.shape, len(y)
    apart = (x[:, None] - y[None]) / length**2  # (n, m, p)
    k = np.exp(-0.5 * length**2 * np.sum(apart**2, axis=2))
    made = np.empty((n * (1 + p), m * (1 + p)))
    made[:n, :m] = k
    made[:n, m:] = (k[:, :, None] * apart).reshape(n, m * p)
    made[n:, :m] = -(k[:, :, None] * apart).transpose(0, 2, 1).reshape(n * p, m)
    both = np.eye(p)[None, None] / length**2 - apart[:, :, :, None] * apart[:, :, None, :]
    made[n:, m:] = (k[:, :, None, None] * both).transpose(0, 2, 1, 3).reshape(n * p, m * p)
    return made


def _likeliest(made: FloatArray, errors: FloatArray, data: FloatArray) -> tuple[float, float, FloatArray]:
    """The size s^2 under which the data are likeliest, minus the logarithm of how likely, and weights."""
    size = used = 1.0
    for _ in range(4):  # s^2 and the share of the errors in it follow from each other
        whole = size * made + np.diag(errors**2)
        try:
            lower = np.linalg.cholesky(whole + 1e-10 * size * np.diag(np.diag(made)))
        except np.linalg.LinAlgError:
            return size, np.inf, np.zeros_like(data)
        weights = np.linalg.solve(lower.T, np.linalg.solve(lower, data))
        unlikely, used = 0.5 * float(data @ weights) + float(np.sum(np.log(np.diag(lower)))), size
        size *= min(max(float(data @ weights) / len(data), 0.05), 20.0)
    return used, unlikely, weights
