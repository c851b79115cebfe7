"""Eigenvalues of l^2 M + l D + K next to zero, and what of them is zero but for round-off."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ...later import eig

SHIFT = 1e-6  # of a mean frequency: about what eigenvalues are found
NEUTRAL = 256.0 * np.finfo(float).eps  # of the stiffnesses that cancel: what is zero
SLOW, BESIDE = 1e3, 0.6  # times the shift: what is slow; of the slowest other, its shift, which is none of it
UNSEEN = 0.1  # of the shift: frequencies below are zero where nothing resists
SAME = 1e-3  # by which motions differ that are one

ComplexArray = np.ndarray


def lowest(
    M: FloatArray, D: FloatArray, K: FloatArray, Z: FloatArray, terms: FloatArray, count: int
) -> tuple[ComplexArray, ComplexArray]:
    """Eigenvalues next to zero of l^2 M + l D + K among the motions Z y, of conjugate pairs one.

    By the inverse about a shift. Neutral motions come first, each once and with the value zero.

    Parameters
    ----------
    M, D, K : ndarray, shape (n, n)
    Z : ndarray, shape (n, m)
    terms : ndarray, shape (n, n)
        Sizes of what cancels in K.
    count : int

    Returns
    -------
    values : ndarray of complex, shape (count,)
        Of a pair that with the positive imaginary part.
    shapes : ndarray of complex, shape (n, count)
    """
    sigma = SHIFT * float(np.sqrt(np.abs(K).sum() / np.abs(M).sum()) or 1.0)
    values, shapes = _both(M, D, K, Z, sigma)
    neutral = _is_neutral(M, D, terms, values, shapes, UNSEEN * sigma)
    still = _independent(M, shapes[:, neutral])
    upper = np.flatnonzero(~neutral & (values.imag > -1e-9 * np.abs(values)))
    order = upper[np.argsort(np.abs(values[upper]), kind="stable")]
    found = np.concatenate([np.zeros(still.shape[1]), values[order]])
    return found[:count], np.hstack([still, shapes[:, order]])[:, :count]


def _both(
    M: FloatArray, D: FloatArray, K: FloatArray, Z: FloatArray, sigma: float
) -> tuple[ComplexArray, ComplexArray]:
    """What is slow about ``sigma``, the rest about a shift of its own size.

    A motion that nothing resists is a double zero, beside which the inverse about a small shift keeps few
    digits of all others.
    """
    values, shapes = _about(M, D, K, Z, sigma)
    slow = np.abs(values) <= SLOW * sigma
    if not np.any(slow) or np.all(slow):
        return values, shapes
    least = float(np.min(np.abs(values[~slow])))
    others, forms = _about(M, D, K, Z, BESIDE * least)
    quick = np.abs(others) > np.sqrt(SLOW * sigma * least)
    return np.concatenate([values[slow], others[quick]]), np.hstack([shapes[:, slow], forms[:, quick]])


def _about(
    M: FloatArray, D: FloatArray, K: FloatArray, Z: FloatArray, sigma: float
) -> tuple[ComplexArray, ComplexArray]:
    """All eigenvalues and shapes among the motions Z y, by the inverse about ``sigma``."""
    m, d, k = (Z.T @ matrix @ Z for matrix in (M, D, K))
    n = len(m)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-k, -d]])
    B = np.block([[np.eye(n), np.zeros((n, n))], [np.zeros((n, n)), m]])
    mu, vectors = eig(np.linalg.solve(A - sigma * B, B))
    finite = np.flatnonzero(np.abs(mu) > 1e-14 * np.max(np.abs(mu), initial=0.0))
    return sigma + 1.0 / mu[finite], Z @ vectors[:n, finite]


def _is_neutral(
    M: FloatArray, D: FloatArray, terms: FloatArray, values: ComplexArray, shapes: ComplexArray, least: float
) -> np.ndarray:
    """Whether damping and inertia of each motion are no larger than the round-off of its stiffness.

    The stiffness is a sum of ``terms`` that cancel. A double zero comes out to half of the digits, as two
    values of either sign or as a pair, and nothing is seen of an inertia below the frequency ``least``.
    """

    def of(A: FloatArray, x: ComplexArray) -> FloatArray:
        found: FloatArray = np.abs(np.sum(x.conj() * (A @ x), axis=0))
        return found

    inertia = of(M, shapes)
    own = np.abs(values) * of(D, shapes) + np.abs(values) ** 2 * inertia
    neutral: np.ndarray = own <= NEUTRAL * of(terms, np.abs(shapes)) + least**2 * inertia
    return neutral


def _independent(M: FloatArray, shapes: ComplexArray) -> FloatArray:
    """Real motions that span those given, each of kinetic energy 1/2 at the speed 1."""
    both = np.hstack([shapes.real, shapes.imag])
    if not both.size:
        return np.zeros((len(M), 0))
    energy = np.sum(both * (M @ both), axis=0)
    both = both[:, energy > SAME**2 * np.max(energy)]
    both /= np.sqrt(np.sum(both * (M @ both), axis=0))
    squares, mixed = np.linalg.eigh(both.T @ M @ both)
    kept = squares > SAME**2 * squares[-1]
    found: FloatArray = both @ (mixed[:, kept] / np.sqrt(squares[kept]))
    return found
