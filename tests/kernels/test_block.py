"""Blocks of 6 x 6 numbers against NumPy: products, and inverses of definite, indefinite and singular ones."""

import fractions

import numpy as np
import pytest

from ancf.compiled import kernel
from ancf.linalg.block import invert_symmetric, multiply, subtract_product

RNG = np.random.default_rng(11)


@kernel
def inverse(A, original, in_order):
    return invert_symmetric(A, 0, original, in_order)


@kernel
def products(A, B, C, CT, D):
    multiply(A, 36, B, 0, C, CT, 36)
    subtract_product(D, 0, A, 36, B, 0)


def with_eigenvalues(values, scale):
    """A symmetric block with these eigenvalues, its unknowns scaled."""
    Q, _ = np.linalg.qr(RNG.standard_normal((6, 6)))
    A = scale[:, None] * (Q * values @ Q.T) * scale
    return 0.5 * (A + A.T)


def inverted(A, in_order=False):
    """Its inverse and the number of negative pivots."""
    found = A.flatten()
    negative = inverse(found, A.flatten(), in_order)
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


@pytest.mark.parametrize("in_order", [False, True])
@pytest.mark.parametrize("left", [2.0**-k for k in (10, 25, 28, 40)])
def test_what_is_left_of_a_pivot(left, in_order):
    """A pivot that has lost nearly all is no pivot while there is a better one: no digits are lost."""
    A = np.eye(6)
    A[:3, :3] = [[1.0, 1.0, 0.5], [1.0, 1.0 + left, 0.25], [0.5, 0.25, 2.0]]  # 1/left is in the inverse
    for sign in (1.0, -1.0):
        found, count = inverted(sign * A, in_order)
        assert count == (1 if sign > 0 else 5)
        exact = exactly(sign * A)
        assert np.max(np.abs(found - exact) / np.max(np.abs(exact))) < 1e-14 + 1e-16 / left * in_order


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
    assert inverse(A.flatten(), A.flatten(), False) == inverse(A.flatten(), A.flatten(), True) == -1


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


@pytest.mark.parametrize("slope", [0.0, 1e-6, 1.0, 1e6])
@pytest.mark.parametrize("give", [1e-7, 1e-11, 1e-15])
def test_multipliers_before_what_slides(give, slope):
    """Three multipliers, against each of which a step gives little, and the place on a line that they hold.

    Taken last, after that place, two of them keep no digit of what gives across the line.
    """
    along = np.array([0.3, -0.5, 0.8])
    lower = np.tril(RNG.uniform(0.5, 1.0, (3, 3)))
    A = np.eye(6)
    A[:3, :3], A[:3, 3], A[3, :3], A[3, 3] = -give * lower @ lower.T, -along, -along, slope
    found, count = inverted(A, in_order=True)
    wanted = exactly(A)
    assert count == 3
    size = np.sqrt(np.abs(np.outer(np.diag(wanted), np.diag(wanted)))) + np.abs(wanted)
    assert np.max(np.abs(found - wanted)[:3, :3]) < 1e-11 * np.max(np.abs(wanted[:3, :3]))
    assert np.all(np.abs(found - wanted)[3] <= 1e-9 * size[3])


@pytest.mark.parametrize("negative", [1, 3, 6])
def test_in_order_where_that_does_not_do(negative):
    """A first pivot that vanishes, or that loses all: the largest ones come first then."""
    for _ in range(20):
        values = np.geomspace(0.1, 1.0, 6) * np.where(np.arange(6) < negative, -1.0, 1.0)
        A = with_eigenvalues(values, np.ones(6))
        A[0, 0] = 0.0
        found, count = inverted(A, in_order=True)
        assert np.max(np.abs(A @ found - np.eye(6))) < 1e-10 * max(1.0, np.max(np.abs(found)))
        assert count == int(np.sum(np.linalg.eigvalsh(A) < 0.0))
