"""Corrections with what would follow them, against the sum of the series by dense algebra."""

import numpy as np
import pytest

from ancf.compiled import kernel
from ancf.simd import LANES
from ancf.solvers.derivatives.abreast_room import room_for
from ancf.solvers.derivatives.foreseen import foresee

SIZE = 12
RNG = np.random.default_rng(7)


@kernel
def foreseen(room, weight, round):
    foresee(room, weight, round)


def operator(ratios):
    """M of a rank, whose eigenvalues are these."""
    left, right = RNG.standard_normal((2, SIZE, len(ratios)))
    right = np.linalg.solve(left.T @ right, np.diag(ratios)).T @ right.T
    M = left @ right
    found = np.linalg.eigvals(M)
    assert np.allclose(np.sort(found[np.argsort(-np.abs(found))][: len(ratios)].real), np.sort(ratios))
    return M


def summed(M, first, rounds, room, closed=()):
    """What rounds of corrections add up to, and the last one."""
    weight = np.geomspace(0.1, 10.0, SIZE)
    total = np.zeros_like(first)
    room.open[:] = 1.0
    room.open[list(closed)] = 0.0
    for round in range(rounds):
        room.r[:] = first if round == 0 else M @ room.r
        foreseen(room, weight, round)
        total += room.r
    return total, room.r


@pytest.mark.parametrize("ratio", [-20.0, -1.5, -0.5, -0.05, -1e-6, 0.3, 0.7])
def test_one_contact(ratio):
    """Of rank one all is there after three, also where the series itself does not end."""
    M, room = operator([ratio]), room_for(SIZE)
    for step in range(3):  # the ratio is that of the step before, which differs a little
        first = RNG.standard_normal((SIZE, LANES))
        exact = np.linalg.solve(np.eye(SIZE) - (1.0 + 0.1 * step) * M, first)
        found, _ = summed((1.0 + 0.1 * step) * M, first, 4, room)
        np.testing.assert_allclose(found, exact, rtol=0, atol=1e-11 * np.max(np.abs(exact)))


@pytest.mark.parametrize("ratios", [(-0.05, -0.02), (-0.1, -0.1), (-0.3, -0.2, -0.1)])
def test_more_contacts(ratios):
    """What is left shrinks from round to round, and faster than without."""
    M, room = operator(ratios), room_for(SIZE)
    first = RNG.standard_normal((SIZE, LANES))
    exact = np.linalg.solve(np.eye(SIZE) - M, first)
    plain = sum(np.linalg.matrix_power(M, k) @ first for k in range(9))
    found, _ = summed(M, first, 9, room)
    assert np.max(np.abs(found - exact)) < max(np.max(np.abs(plain - exact)), 1e-14)
    assert np.max(np.abs(found - exact)) < 1e-4 * np.max(np.abs(exact))


def test_lanes_that_are_closed_stay():
    M, room = operator([-0.4]), room_for(SIZE)
    first = RNG.standard_normal((SIZE, LANES))
    summed(M, first, 3, room)
    _, last = summed(M, first, 2, room, closed=(2, 5))
    assert not last[:, [2, 5]].any()
    assert last[:, [0, 1, 3, 4, 6, 7]].all()
