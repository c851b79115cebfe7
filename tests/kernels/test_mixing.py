"""Corrections that are mixed: of few rows they end after as many, however much these would make them grow."""

import numpy as np
import pytest

from ancf.compiled import kernel
from ancf.solvers.derivatives.mixing import OF_X, ROOM, mixed


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


@pytest.mark.parametrize("noise", [1e-16, 1e-15, 7e-15])
def test_round_off_leads_nowhere(noise):
    """Corrections in the last digits, all but the same: what tells them apart is none that x could follow."""
    n, rng = 6, np.random.default_rng(5)
    x = rng.uniform(0.5, 1.0, 2 * n)
    x[0] = 0.0
    wanted, room, scale, g = x.copy(), np.zeros((ROOM, n)), np.zeros(3), np.zeros((OF_X, n))
    for turn in range(8):
        room[:2] = x.reshape(2, n)
        g[:2] = (x + noise * rng.choice([-1.0, 1.0], 2 * n)).reshape(2, n)
        g[0, 0] = x[0] + noise * (1.0 + 1e-14 * turn)
        if turn > 0:
            g[:2].flat[1:] = x[1:]
        mix(np.zeros(n), g, room, scale, turn)
        x = g[:2].ravel().copy()
    assert np.max(np.abs(x - wanted)) < 100 * noise
