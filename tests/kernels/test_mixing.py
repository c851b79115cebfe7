"""Corrections that are mixed: of few rows they end after as many, however much these would make them grow."""

import numpy as np
import pytest

from ancf.compiled import kernel
from ancf.solvers.mixing import OF_X, ROOM, mixed


@kernel
def mix(mask, g, room, scale, turn):
    mixed(mask, g, room, scale, turn)


@pytest.mark.parametrize("multipliers", [0, 3])
@pytest.mark.parametrize("rows", [1, 2, 5])
@pytest.mark.parametrize("stiff", [0.3, 40.0, 3e3])
def test_they_end(stiff, rows, multipliers):
    """x = b - M x with M of low rank, of lambda and rho; sums go with x wherever it is led."""
    n, rng = 12, np.random.default_rng(3)
    M = sum(np.outer(*rng.uniform(-1, 1, (2, 2 * n))) for _ in range(rows))
    M *= stiff / np.linalg.norm(M, 2)
    b, T = rng.uniform(-1, 1, 2 * n), rng.uniform(-1, 1, (4, n, 2 * n))
    mask = np.zeros(n)
    mask[n - multipliers :] = 1.0
    room, scale, g, x = np.zeros((ROOM, n)), np.zeros(3), np.zeros((OF_X, n)), np.zeros(2 * n)
    for turn in range(rows + 3):
        room[:2] = x.reshape(2, n)
        g[:2] = (b - M @ x).reshape(2, n)
        g[2:] = T @ g[:2].ravel()
        mix(mask, g, room, scale, turn)
        x = g[:2].ravel().copy()
    wanted = np.linalg.solve(np.eye(2 * n) + M, b)
    assert np.max(np.abs(x - wanted)) < 1e-15 * max(stiff, 1.0) ** 2 + 1e-12 * np.max(np.abs(wanted))
    assert np.max(np.abs(g[2:] - T @ x)) < 1e-11 * max(stiff, 1.0)
