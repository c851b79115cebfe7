"""Solutions near their right-hand side, against whole solves of the same factors."""

import numpy as np
import pytest

from ancf.compiled import kernel
from ancf.linalg.block_ldl import allocate
from ancf.linalg.ordering import fill_pattern
from ancf.linalg.reach import solve_near, spread_of
from ancf.system.core import factorise_matrix, solve_sparse
from ancf.system.matrix import Places


@kernel
def near(factor, x, low, high, count, spread):
    """A kernel of its own: :func:`solve_near` is a part of others."""
    return solve_near(factor, factor.row_start.shape[0] - 1, x, low, high, count, spread)


def banded(n, width, stiffness, seed=0):
    """Factors of I + stiffness L for the Laplacian L of blocks coupled up to a distance: it forgets."""
    rng = np.random.default_rng(seed)
    pairs = np.array([(i, j) for i in range(n) for j in range(i + 1, min(i + width + 1, n))])
    places = Places(*fill_pattern(pairs, n))
    A = np.zeros((6 * n, 6 * n))
    for i, j in pairs.tolist():
        rows = rng.normal(size=(6, 12))
        at = np.r_[6 * i : 6 * i + 6, 6 * j : 6 * j + 6]
        A[np.ix_(at, at)] += stiffness * rows.T @ rows
    A += np.eye(6 * n)
    values = np.zeros(places.size)
    for i in range(n):
        values[36 * i : 36 * i + 36] = A[6 * i : 6 * i + 6, 6 * i : 6 * i + 6].ravel()
        for k in range(places.row_start[i], places.row_start[i + 1]):
            j = places.column[k]
            values[36 * (n + k) : 36 * (n + k) + 36] = A[6 * i : 6 * i + 6, 6 * j : 6 * j + 6].ravel()
    factor = allocate(places.row_start, places.column)
    assert factorise_matrix(values, factor) == 0
    return factor


def both(factor, ranges, seed=0):
    """Solution near the ranges, set to zero beyond, the whole one, and the ranges of the first."""
    n = len(factor.row_start) - 1
    b = np.zeros(6 * n)
    rng = np.random.default_rng(seed)
    for low, high in ranges:
        b[6 * low : 6 * high] = rng.normal(size=6 * (high - low))
    whole = b.copy()
    solve_sparse(factor, whole, 0)
    low, high = (np.array(side, dtype=np.int64) for side in zip(*ranges, strict=True))
    x = np.where(b == 0.0, np.nan, b)  # what stands elsewhere must not matter
    count = near(factor, x, low, high, len(low), spread_of(factor))
    found, inside = np.zeros_like(x), np.zeros(n, dtype=bool)
    for k in range(count):
        found[6 * low[k] : 6 * high[k]] = x[6 * low[k] : 6 * high[k]]
        assert not inside[low[k] : high[k]].any()
        inside[low[k] : high[k]] = True
    return found, whole, inside, x


CASES = {
    "middle": [(100, 103)],
    "first": [(0, 1)],
    "last": [(199, 200)],
    "apart": [(20, 22), (90, 95), (170, 171)],
    "adjacent": [(50, 52), (52, 60)],
    "near each other": [(50, 52), (56, 57), (70, 71)],
    "all": [(0, 200)],
}


class TestSolveNear:
    @pytest.mark.parametrize("ranges", CASES.values(), ids=CASES)
    @pytest.mark.parametrize("width", [1, 2, 5])
    def test_equals_a_whole_solve(self, width, ranges):
        found, whole, _, _ = both(banded(200, width, 0.05), ranges)
        assert np.abs(found - whole).max() <= 1e-7 * np.abs(whole).max()

    @pytest.mark.parametrize("width", [1, 3])
    def test_goes_no_further_than_it_has_to(self, width):
        """Beyond the rows that it solves the whole solution is nothing; most rows it leaves alone."""
        _, whole, inside, _ = both(banded(400, width, 0.02), [(200, 202)])
        assert 2 < inside.sum() < 200
        assert np.abs(whole.reshape(-1, 6)[~inside]).max() <= 1e-7 * np.abs(whole).max()

    def test_a_matrix_that_forgets_nothing_is_solved_as_a_whole(self):
        found, whole, inside, _ = both(banded(60, 1, 1e9), [(30, 31)])
        assert inside.all()
        assert np.abs(found - whole).max() <= 1e-6 * np.abs(whole).max()

    def test_rows_beside_are_zero(self):
        """As many as the matrix is wide, so that products with them need no care."""
        factor = banded(200, 3, 0.05)
        _, _, inside, x = both(factor, [(100, 103)])
        first = np.flatnonzero(inside)[0]
        assert not x.reshape(-1, 6)[first - spread_of(factor) : first].any()

    @pytest.mark.parametrize("width", [1, 4])
    def test_spread(self, width):
        assert spread_of(banded(30, width, 0.1)) == width
