"""Blocks of 6 x 6 numbers against NumPy: products, and inverses of definite, indefinite and singular ones."""

import fractions

import numpy as np
import pytest

from ancf.compiled import kernel
from ancf.linalg.block import invert_symmetric, multiply, subtract_product

RNG = np.random.default_rng(11)


@kernel
def inverse(A, original):
    return invert_symmetric(A, 0, original)


@kernel
def products(A, B, C, CT, D):
    multiply(A, 36, B, 0, C, CT, 36)
    subtract_product(D, 0, A, 36, B, 0)


def with_eigenvalues(values, scale):
    """A symmetric block with these eigenvalues, its unknowns scaled."""
    Q, _ = np.linalg.qr(RNG.standard_normal((6, 6)))
    A = scale[:, None] * (Q * values @ Q.T) * scale
    return 0.5 * (A + A.T)


def inverted(A):
    """Its inverse and the number of negative pivots."""
    found = A.flatten()
    negative = inverse(found, A.flatten())
    return found.reshape(6, 6), negative


@pytest.mark.parametrize("scale", [1.0, 1e3], ids=["alike", "scaled"])
@pytest.mark.parametrize("least", [0.5, 1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize("negative", [0, 1, 3, 6])
def test_inverse(negative, least, scale):
    """The residual is round-off times the condition, whatever the signs and the scales are."""
    for _ in range(20):
        values = np.geomspace(least, 1.0, 6) * np.where(np.arange(6) < negative, -1.0, 1.0)
        sizes = np.geomspace(1.0, scale, 6)[RNG.permutation(6)]
        A = with_eigenvalues(values, sizes)
        found, count = inverted(A)
        assert count == negative
        assert np.array_equal(found, found.T)
        plain = A / sizes / sizes[:, None]
        residual = plain @ (found * sizes * sizes[:, None]) - np.eye(6)
        assert np.max(np.abs(residual)) < 1e-13 / least


@pytest.mark.parametrize("left", [2.0**-k for k in (10, 25, 28, 40)])
def test_what_is_left_of_a_pivot(left):
    """A pivot that has lost nearly all is no pivot while there is a better one: no digits are lost."""
    A = np.eye(6)
    A[:3, :3] = [[1.0, 1.0, 0.5], [1.0, 1.0 + left, 0.25], [0.5, 0.25, 2.0]]  # 1/left is in the inverse
    found, count = inverted(A)
    assert count == 1 if left < 0.02 else 0
    exact = exactly(A)
    assert np.max(np.abs(found - exact) / np.max(np.abs(exact))) < 1e-14


def exactly(A):
    """The inverse of a matrix in rational numbers."""
    rows = [[fractions.Fraction(x) for x in (*a, *e)] for a, e in zip(A, np.eye(6), strict=True)]
    for p in range(6):
        k = next(k for k in range(p, 6) if rows[k][p])
        rows[p], rows[k] = rows[k], rows[p]
        rows[p] = [x / rows[p][p] for x in rows[p]]
        for i in range(6):
            if i != p:
                rows[i] = [x - rows[i][p] * y for x, y in zip(rows[i], rows[p], strict=True)]
    return np.array([[float(x) for x in row[6:]] for row in rows])


@pytest.mark.parametrize("entry", [0.0, np.nan])
@pytest.mark.parametrize("at", range(6))
def test_no_inverse(at, entry):
    """A row of zeros, or what is not a number, is singular wherever it stands."""
    A = with_eigenvalues(np.ones(6), np.ones(6)) + np.ones((6, 6))
    A[at] = A[:, at] = entry
    assert inverse(A.flatten(), A.flatten()) == -1


def test_products():
    A, B, D = RNG.standard_normal((3, 72))
    C, CT = np.zeros((2, 72))
    before = D.copy()
    products(A, B, C, CT, D)
    one, two = A[36:].reshape(6, 6), B[:36].reshape(6, 6)
    np.testing.assert_allclose(C[36:].reshape(6, 6), one @ two, rtol=1e-14, atol=1e-14)
    np.testing.assert_array_equal(CT[36:].reshape(6, 6).T, C[36:].reshape(6, 6))
    np.testing.assert_allclose(D[:36], before[:36] - (one @ two).ravel(), rtol=1e-14, atol=1e-14)
    assert not C[:36].any()
    assert not CT[:36].any()
    assert np.array_equal(D[36:], before[36:])
