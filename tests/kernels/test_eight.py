"""Eight matrices, and eight right-hand sides, at once: against one after the other and dense algebra."""

import numpy as np
import pytest

from ancf.linalg.block_ldl import allocate
from ancf.linalg.eight import LANES, allocate_eight, factor_of, factorise_eight
from ancf.linalg.eight_twisted import allocate_twisted, factorise_twisted
from ancf.linalg.lanes import (
    multiply_abreast,
    multiply_both_abreast,
    multiply_twisted_abreast,
    rows_of,
    solve_abreast,
)
from ancf.linalg.ordering import fill_pattern
from ancf.system.core import factorise_matrix, solve_matrix
from ancf.system.matrix import Places
from block_matrices import PATTERNS, boolean, definite, random_symmetric, values

RNG = np.random.default_rng(3)
BOTH = pytest.mark.parametrize("definite_ones", [True, False])


@pytest.fixture(params=PATTERNS)
def pattern(request):
    return PATTERNS[request.param]


def different(A, pairs, n, size=0.1):
    """Eight matrices near one, of its pattern."""
    return [A + size * random_symmetric(pairs, n, seed) * np.abs(A) for seed in range(LANES)]


def together(matrices, pairs, n, definite_ones, count=LANES):
    """Pattern, factors and what is said of eight matrices."""
    places = Places(*fill_pattern(pairs, n))
    factor = allocate(places.row_start, places.column)
    eight = allocate_eight(factor)
    for row, A in zip(eight.A, matrices, strict=True):
        row[:] = values(A, places)
    eight.A[count:] = np.nan
    return places, factor, eight, factorise_eight(factor, eight, count, definite_ones, True)


def solved(factor, eight, m, b):
    x = b.copy()
    solve_matrix(factor_of.py_func(factor, eight, m), x)
    return x


@BOTH
@pytest.mark.parametrize("count", [1, 5, LANES])
def test_as_one_after_the_other(pattern, count, definite_ones):
    pairs, n = pattern
    matrices = different(definite(pairs, n), pairs, n, 0.01)
    places, factor, eight, said = together(matrices, pairs, n, definite_ones, count)
    assert said == -1
    for m in range(count):
        assert factorise_matrix(values(matrices[m], places), factor) == 0
        for mine, name in ((eight.L, "L"), (eight.LT, "LT"), (eight.D_inv, "D_inv")):
            wanted = getattr(factor, name)
            assert mine[m] == pytest.approx(wanted, rel=1e-9, abs=1e-12 * np.abs(wanted).max()), name


@BOTH
def test_indefinite_ones_are_solved(pattern, definite_ones):
    """Also where positive ones were promised: each is then taken by itself."""
    pairs, n = pattern
    A = random_symmetric(pairs, n, 5) + 8.0 * np.diag(RNG.choice([-1.0, 1.0], 6 * n))
    matrices = different(A, pairs, n, 0.001)
    _, factor, eight, said = together(matrices, pairs, n, definite_ones)
    assert said == -1
    b = RNG.standard_normal(6 * n)
    for m, own in enumerate(matrices):
        x = solved(factor, eight, m, b)
        assert np.abs(own @ x - b).max() < 1e-9 * (np.abs(own) @ np.abs(x)).max()


def test_a_matrix_that_wants_another_order_of_pivots():
    """Next to zero where the first has its largest pivot, as a joint that has just closed."""
    pairs, n = PATTERNS["chain"]
    matrices = [definite(pairs, n) + 50.0 * np.diag(np.arange(6 * n) == 6) for _ in range(LANES)]
    odd = matrices[3]
    odd[6:8], odd[:, 6:8] = 0.0, 0.0
    odd[6:8, 6:8] = [[1e-10, 5.0], [5.0, 10.0]]
    _, factor, eight, said = together(matrices, pairs, n, False)
    assert said == -1
    b = RNG.standard_normal(6 * n)
    for m, own in enumerate(matrices):
        assert np.abs(own @ solved(factor, eight, m, b) - b).max() < 1e-11 * np.abs(b).max(), m


@BOTH
def test_the_singular_one_is_named(definite_ones):
    pairs, n = PATTERNS["chain"]
    matrices = [definite(pairs, n) for _ in range(LANES)]
    matrices[5] = matrices[5].copy()
    matrices[5][7], matrices[5][:, 7] = 0.0, 0.0
    assert together(matrices, pairs, n, definite_ones)[3] == 5
    assert together(matrices, pairs, n, definite_ones, count=5)[3] == -1


def test_eight_right_hand_sides(pattern):
    pairs, n = pattern
    A = definite(pairs, n)
    _, factor, eight, _ = together([A] * LANES, pairs, n, True)
    X = RNG.standard_normal((6 * n, LANES))
    Y = X.copy()
    solve_abreast(rows_of.py_func(factor, eight, 2, False), Y)
    assert pytest.approx(X, abs=1e-11 * np.abs(X).max()) == A @ Y
    Z = X.copy()
    multiply_abreast(factor, eight.A[0], Y, Z, len(factor.row_start) - 1)
    assert pytest.approx(2.0 * X, abs=1e-11 * np.abs(X).max()) == Z


def twisted_ones(pairs, n, size):
    """Eight positive definite matrices, and what is antisymmetric to be added to them."""
    pattern = np.kron(boolean(pairs, n), np.ones((6, 6)))
    free = [np.random.default_rng(seed).standard_normal((6 * n, 6 * n)) for seed in range(LANES)]
    return different(definite(pairs, n), pairs, n, 0.01), [size * (W - W.T) * pattern for W in free]


@pytest.mark.parametrize("size", [0.0, 1e-3, 3.0])
@pytest.mark.parametrize("count", [1, 5, LANES])
def test_matrices_that_are_not_symmetric(pattern, count, size):
    """The antisymmetric part may be as large as the symmetric one, or nothing."""
    pairs, n = pattern
    matrices, twists = twisted_ones(pairs, n, size)
    places, factor, eight, _ = together(matrices, pairs, n, True)
    W = np.array([values(twist, places) for twist in twists])
    eight.A[count:], W[count:], eight.LT[:] = np.nan, np.nan, np.nan
    assert factorise_twisted(factor, eight, allocate_twisted(factor, True), W, count)
    X = RNG.standard_normal((6 * n, LANES))
    for m in range(count):
        Y, A = X.copy(), matrices[m] + twists[m]
        solve_abreast(rows_of.py_func(factor, eight, m, True), Y)
        assert np.abs(A @ Y - X).max() < 1e-11 * np.abs(X).max()
        Z, rows = [X.copy(), X.copy()], len(factor.row_start) - 1
        multiply_both_abreast(factor, eight.A[m], W[m], Y, Z[0], rows, np.zeros((2, 36)))
        multiply_abreast(factor, eight.A[m], Y, Z[1], rows)
        multiply_twisted_abreast(factor, W[m], Y, Z[1], rows)
        for found in Z:
            assert pytest.approx(2.0 * X, abs=1e-11 * np.abs(X).max()) == found


def test_twisted_ones_need_pivots_above_zero():
    """Where it is not so in one lane, it is said, and none of the factors count."""
    for pairs, n in PATTERNS.values():
        matrices, twists = twisted_ones(pairs, n, 1e-2)
        places, factor, eight, _ = together(matrices, pairs, n, True)
        W = np.array([values(twist, places) for twist in twists])
        eight.A[6] -= values(1e3 * np.diag(np.arange(6 * n) == 6 * n - 1), places)
        assert not factorise_twisted(factor, eight, allocate_twisted(factor, True), W, LANES)
        assert factorise_twisted(factor, eight, allocate_twisted(factor, True), W, 6)
