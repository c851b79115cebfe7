"""Series in runs against equations that scipy solves: begun late, ended early, smoothed."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.signal import butter, filtfilt

import ancf

MASS, STIFFNESS, DAMPING, T_END = 2.0, 80.0, 1.0, 1.0
#: First and last time: all of a run, within it, over its start, after it and before it.
SPANS = [(0.0, 2.0), (0.3, 2.0), (0.0, 0.5), (0.3, 0.7), (-1.0, 0.4), (0.35, 0.4), (1.5, 2.0), (-2.0, -1.0)]
METHODS = {
    "trapezoidal": (ancf.Trapezoidal(), 1e-5),
    "alpha": (ancf.GeneralizedAlpha(rho_inf=0.8), 2e-5),
    "radau": (ancf.Radau(tolerance=1e-9), 1e-8),
}


def wave(t):
    return 0.02 * np.sin(9 * t + 0.4)


def moved(series):
    """A mass on a spring and a damper, the other end of which follows a series."""
    model = ancf.Model()
    hand = model.add_point_mass("hand", at=(0, 0, 0), mass=1.0)
    mass = model.add_point_mass("mass", at=(1, 0, 0), mass=MASS)
    model.add_spring(hand, mass, stiffness=STIFFNESS, length=1.0, damping=DAMPING)
    model.hold(hand, position="xyz", displacement=(series, 0, 0))
    model.hold(mass, position="yz")
    return model


def pushed(series):
    """The same mass, pushed; the other end stands."""
    model = ancf.Model()
    mass = model.add_point_mass("mass", at=(1, 0, 0), mass=MASS)
    model.add_spring(mass, (0, 0, 0), stiffness=STIFFNESS, length=1.0, damping=DAMPING)
    model.add_force(mass, (series, 0, 0))
    model.hold(mass, position="yz")
    return model


def follows(force, cuts):
    """Where a mass is in the end that this force acts on beside spring and damper, from rest."""
    y, times = np.zeros(2), [0.0, *(t for t in cuts if 0.0 < t < T_END), T_END]
    for begin, end in pairwise(times):
        inside = np.nextafter(begin, end), np.nextafter(end, begin)

        def rates(t, y, inside=inside):
            push = force(float(np.clip(t, *inside)))
            return y[1], (push - STIFFNESS * y[0] - DAMPING * y[1]) / MASS

        y = solve_ivp(rates, (begin, end), y, rtol=1e-11, atol=1e-13).y[:, -1]
    return y[0]


def ends_at(model, method, step=1e-3):
    run = ancf.simulate(model, t_end=T_END, step=step, integrator=method)
    return run.position("mass")[-1, 0] - 1.0


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("first", "last"), SPANS)
def test_outside_of_its_times_it_stays(first, last, method):
    """Forces and motions keep the first value before, the last one after; a motion has no rate there."""
    how, left = METHODS[method]
    t = np.linspace(first, last, 401)
    series = ancf.Series(t, wave(t) * 100.0)
    wanted = follows(lambda s: 100.0 * wave(np.clip(s, first, last)), (first, last))
    assert abs(ends_at(pushed(series), how) - wanted) < left

    def carried(s):
        rate = 0.18 * np.cos(9 * s + 0.4) if first < s < last else 0.0
        return STIFFNESS * (wave(np.clip(s, first, last)) - here) + DAMPING * rate

    here = wave(np.clip(0.0, first, last))
    wanted = follows(carried, (first, last))
    found = ends_at(moved(ancf.Series(t, wave(t) - here)), how)
    assert abs(found - wanted) < left


@pytest.mark.parametrize("method", ["trapezoidal", "alpha"])
@pytest.mark.parametrize("size", [1e-18, 1e-16, 1e-14, 1e-12])
@pytest.mark.parametrize("grown", [False, True])
def test_a_motion_of_round_off_moves_nothing(grown, size, method):
    """From the start on or later: as little energy is none, though it came from nowhere."""
    t = np.linspace(0.0, 2.0, 201)
    series = ancf.Series(t, size * (np.sin(3 * t) ** 2 if grown else np.cos(1e-3 * t)))
    assert abs(ends_at(moved(series), METHODS[method][0])) <= 3 * max(size, np.spacing(1.0))


def by_hand(t, y, cutoff):
    """Least of the sum of w (y - f)^2 and lam times the integral of f''^2, by Reinsch's matrices."""
    h, n = np.diff(t), len(t)
    Q, R = np.zeros((n, n - 2)), np.diag((h[:-1] + h[1:]) / 3)
    for k in range(n - 2):
        Q[k : k + 3, k] = 1 / h[k], -1 / h[k] - 1 / h[k + 1], 1 / h[k + 1]
    R += np.diag(h[1:-1] / 6, 1) + np.diag(h[1:-1] / 6, -1)
    W, strength = np.diag(np.gradient(t)), (np.sqrt(2) - 1) / (2 * np.pi * cutoff) ** 4
    return np.linalg.solve(W + strength * Q @ np.linalg.solve(R, Q.T), W @ y)


def tones(rng, t, cutoff):
    """Vibrations around a cut-off, and noise."""
    parts = zip(rng.normal(size=5), cutoff * rng.uniform(0.1, 3, 5), rng.uniform(0, 6, 5), strict=True)
    return sum(a * np.sin(2 * np.pi * f * t + p) for a, f, p in parts) + 0.1 * rng.standard_normal(len(t)) + 2


class TestCutoff:
    @pytest.mark.parametrize("seed", range(6))
    @pytest.mark.parametrize(("rate", "cutoff"), [(1000, 4), (500, 1.5), (2000, 9)])
    def test_is_butterworth_forth_and_back(self, rate, cutoff, seed):
        """Away from the ends: |H|^2 of the second order is 1/(1 + (f/fb)^4)."""
        rng, t = np.random.default_rng(seed), np.arange(int(30 / cutoff * rate)) / rate - 0.7
        y = tones(rng, t, cutoff)
        edge = len(t) // 4
        wanted = filtfilt(*butter(2, cutoff / (np.sqrt(2) - 1) ** 0.25, fs=rate), y, padlen=edge)[edge:-edge]
        found = ancf.Series(1e3 * t, 1e3 * y, unit="mm", time_unit="ms", cutoff=cutoff)(t)[edge:-edge, 0]
        assert np.abs(found - wanted).max() < 1e-3 * np.ptp(wanted)

    @pytest.mark.parametrize("seed", range(6))
    @pytest.mark.parametrize(("rate", "cutoff"), [(100, 5), (100, 24), (30, 1)])
    def test_of_uneven_times(self, rate, cutoff, seed):
        """With gaps, up to the ends."""
        rng, t = np.random.default_rng(seed), np.arange(400) / rate - 0.7
        t = t[np.sort(rng.permutation(len(t))[:320])]
        y = tones(rng, t, cutoff)
        found = ancf.Series(t, y, cutoff=cutoff)(t)[:, 0]
        assert np.abs(found - by_hand(t, y, cutoff)).max() < 1e-9 * np.ptp(y)

    @pytest.mark.parametrize("make", [moved, pushed])
    @pytest.mark.parametrize("seed", [1, 2])
    def test_in_a_run(self, make, seed):
        """What follows a noisy measurement is what follows the smooth one that is made by hand."""
        rng, t = np.random.default_rng(seed), np.linspace(-1.0, 2.0, 601)
        y = wave(t) + 1e-3 * rng.standard_normal(len(t))
        scale = 100.0 if make is pushed else 1.0
        smooth = by_hand(t, y, 6.0)
        curve = CubicSpline(t, smooth, bc_type="natural")
        first = float(curve(0.0)) if make is moved else 0.0
        force = (
            (lambda s: scale * curve(s))
            if make is pushed
            else lambda s: STIFFNESS * (curve(s) - first) + DAMPING * curve(s, 1)
        )
        found = ends_at(make(ancf.Series(t, scale * (y - first), cutoff=6.0)), METHODS["radau"][0])
        assert found == pytest.approx(follows(force, ()), abs=1e-8)
