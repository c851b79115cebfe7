"""The search for lengths: sums of squares against SciPy's least squares, limits by Lagrange's conditions."""

import numpy as np
import pytest
from scipy.optimize import least_squares

from ancf.design.descent import least
from ancf.design.droppers import Droppers, Tried


class Runs:
    """Stands for runs along a line: a history f(x) whose size is the objective, linear between runs."""

    def __init__(self, history, slopes, starts, extra=None):
        self.history, self.slopes, self.extra = history, slopes, extra
        self.parameters = {
            f"p{k}": Droppers((f"1-{k + 1}",), -2.0, 2.0, start) for k, start in enumerate(starts)
        }
        self.widths = np.full(len(starts), 4.0)
        self.tried, self._seen = [], {}

    def values(self, u):
        return dict(zip(self.parameters, (-2.0 + 4.0 * np.asarray(u)).tolist(), strict=True))

    def lengths(self, values):
        return np.array([*values.values()])

    def at(self, u):
        return self.predicted(u, u)

    def known(self):
        places = [*self._seen.values()]
        found = [self.at(u) for u in places]
        return np.stack(places), np.stack([x for x, _ in found]), np.stack([rows for _, rows in found])

    def predicted(self, u, near):
        near = np.asarray(near)
        x = -2.0 + 4.0 * near
        if near.tobytes() not in self._seen:
            self._seen[near.tobytes()] = near.copy()
            self.tried.append(Tried(self.values(near), float(np.linalg.norm(self.history(x))), {}))
        J = self.slopes(x)
        f = self.history(x) + J @ (4.0 * (u - near))
        size = float(np.linalg.norm(f))
        numbers, rows = [size], [J.T @ f / size]
        if self.extra is not None:
            numbers.append(float(self.extra @ (-2.0 + 4.0 * u)))
            rows.append(self.extra)
        return np.array(numbers), 4.0 * np.array(rows)


def valley(x):
    """Rosenbrock's valley, with a third number that bends it, and something that never vanishes."""
    return np.array([10.0 * (x[1] - x[0] ** 2), 1.0 - x[0], 3.0 * (x[2] - np.sin(x[0])), 0.5])


def valley_slopes(x):
    return np.array(
        [[-20.0 * x[0], 10.0, 0.0], [-1.0, 0.0, 0.0], [-3.0 * np.cos(x[0]), 0.0, 3.0], [0.0, 0.0, 0.0]]
    )


@pytest.mark.parametrize("starts", [(-1.0, 1.0, 0.5), (0.0, -1.0, 1.5), (1.8, -1.8, 0.0)])
def test_finds_what_least_squares_finds(starts):
    runs = Runs(valley, valley_slopes, starts)
    found = least(runs, most=60)
    wanted = least_squares(valley, starts, valley_slopes, bounds=(-2.0, 2.0))
    assert found.converged
    assert found.objective == pytest.approx(np.sqrt(2.0 * wanted.cost), rel=2e-3)
    assert [*found.values.values()] == pytest.approx(wanted.x, abs=0.1)
    assert found.objective == min(t.objective for t in runs.tried)
    assert len(runs.tried) < 45


def test_of_a_linear_history_takes_steps_of_newton():
    """Nothing to learn from more runs than the radius needs to grow: 0.25, 0.5 and there."""
    A = np.array([[3.0, 1.0], [1.0, -2.0], [0.5, 0.5]])
    target = np.array([1.6, -1.3])
    b = A @ target + np.array([0.1, 0.05, -0.02])
    runs = Runs(lambda x: A @ x - b, lambda x: A, (-1.5, 1.5))
    found = least(runs)
    solution = np.linalg.lstsq(A, b, rcond=None)[0]
    assert [*found.values.values()] == pytest.approx(solution, abs=1e-3)
    assert found.converged
    assert len(runs.tried) <= 5


@pytest.mark.parametrize("ripple", [0.02, 0.05])
def test_ripples_do_not_stop_it(ripple):
    """A valley with ripples whose slopes are many times its own: the search ends near the valley's floor."""

    def rippled(x):
        return np.append(x - 0.7, [1.0 + ripple * np.sin(40.0 * x[0]) * np.sin(37.0 * x[1]), 0.5])

    def slopes(x):
        s, c = np.sin([40.0 * x[0], 37.0 * x[1]]), np.cos([40.0 * x[0], 37.0 * x[1]])
        row = ripple * np.array([40.0 * c[0] * s[1], 37.0 * s[0] * c[1]])
        return np.vstack([np.eye(2), row, np.zeros(2)])

    runs = Runs(rippled, slopes, (-1.3, -0.9))
    found = least(runs)
    floor = float(np.sqrt((1.0 - ripple) ** 2 + 0.25))
    assert found.objective < floor + 1.2 * ripple
    assert len(runs.tried) <= 30


def test_bounds_hold():
    runs = Runs(lambda x: x - np.array([3.0, 0.5]), lambda x: np.eye(2), (0.0, 0.0))
    found = least(runs)
    assert [*found.values.values()] == pytest.approx([2.0, 0.5], abs=1e-3)
    assert found.slope["p0"] < 0.0


@pytest.mark.parametrize("start", [(0.0, 0.0), (1.5, 1.5)])
def test_limits_are_kept(start):
    """The nearest point to (1, 1) on x + 2 y <= 1.5, from inside and from outside."""
    runs = Runs(lambda x: np.append(x - 1.0, 0.3), lambda x: np.eye(3, 2), start, extra=np.array([1.0, 2.0]))
    found = least(runs, {"sum": (None, 1.5)})
    assert [*found.values.values()] == pytest.approx([0.7, 0.4], abs=2e-3)
    assert found.constraints["sum"] <= 1.5 + 1e-6
    assert found.converged


def test_says_that_it_was_stopped():
    found = least(Runs(valley, valley_slopes, (-1.0, 1.0, 0.5)), most=2)
    assert not found.converged
    assert "limit of 2 steps" in found.message
