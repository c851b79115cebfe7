"""Surfaces through numbers and derivatives: against functions that are known, with and without kinks."""

import numpy as np
import pytest

from ancf.design.surface import Surface


def smooth(rng, count):
    A = rng.normal(size=(count, count))
    A = A @ A.T / count + np.eye(count)

    def of(u):
        return 0.5 * (u - 0.5) @ A @ (u - 0.5) + np.sin(2.0 * u[0])

    def slope(u):
        made = A @ (u - 0.5)
        made[0] += 2.0 * np.cos(2.0 * u[0])
        return made

    return of, slope


@pytest.mark.parametrize("count", [1, 2, 5])
def test_of_a_smooth_function(count):
    rng = np.random.default_rng(count)
    of, slope = smooth(rng, count)
    places = rng.uniform(size=(6 * count, count))
    made = Surface(places, np.array([of(u) for u in places]), np.stack([slope(u) for u in places]))
    for u in rng.uniform(0.3, 0.7, size=(4, count)):
        value, rates = made.at(u)
        assert value == pytest.approx(of(u), abs=0.02)
        assert rates == pytest.approx(slope(u), abs=0.15)
        e = 1e-5 * np.eye(count)
        differences = [(made.at(u + x)[0] - made.at(u - x)[0]) / 2e-5 for x in e]
        assert rates == pytest.approx(np.array(differences), rel=1e-5, abs=1e-5)


@pytest.mark.parametrize("size", [0.002, 0.01])
def test_kinks_are_taken_as_errors(size):
    """Ripples whose slopes are as large as that of the function itself: the surface goes through them."""
    rng = np.random.default_rng(7)
    of, slope = smooth(rng, 3)
    places, ripple = rng.uniform(size=(20, 3)), 0.5 / size
    values = [of(u) + size * np.sin(ripple * u[1]) for u in places]
    rates = np.stack([slope(u) for u in places])
    rates[:, 1] += size * ripple * np.cos(ripple * places[:, 1])
    made = Surface(places, np.array(values), rates)
    for u in rng.uniform(0.3, 0.7, size=(4, 3)):
        assert made.at(u)[0] == pytest.approx(of(u), abs=0.05)
