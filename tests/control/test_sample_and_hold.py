"""Controllers that sample and hold, with dead times, beside a plain loop over exact steps."""

from collections import deque

import numpy as np
import pytest
from scipy.linalg import expm

import ancf
from ancf.control.delay import Delayed

STEPS, FIRST, SPEED, SAME = 240, 0.3, 0.4, 1e-9


class Loop:
    """A mass on a damped spring, whose force is a law of what was measured every few steps."""

    def __init__(self, seed):
        rng = np.random.default_rng(seed)
        self.mass, self.k, self.c = rng.uniform(0.5, 2), rng.uniform(20, 200), rng.uniform(0, 2)
        self.gain, self.rate = rng.uniform(5, 20), rng.uniform(0.2, 1)
        self.every, self.h = int(rng.integers(1, 6)), float(rng.choice([1e-3, 2e-3, 4e-3]))
        self.late = float(rng.choice([0.0, 1.5, 3.0])) * self.every * self.h
        self.times = []

    def law(self, t, x, v):
        return np.sin(30 * t) - self.gain * x - self.rate * v

    def exactly(self):
        """Places at all steps, with the input held from when it is due."""
        A = np.array([[0, 1, 0], [-self.k / self.mass, -self.c / self.mass, 1 / self.mass], [0, 0, 0]])
        step, z, due, places = expm(A * self.h), np.array([0.0, SPEED, FIRST]), deque(), [0.0]
        for n in range(STEPS):
            t = n * self.h
            if n % self.every == 0:
                due.append((t + self.late, self.law(t, *z[:2])))
                while due and due[0][0] <= t + SAME:
                    z[2] = due.popleft()[1]
            z = step @ z
            places.append(z[0])
        return np.array(places)

    def control(self, run):
        self.times.append(run.t)
        run.inputs["u"] = self.law(run.t, run.position("body")[0], run.velocity("body")[0])

    def off(self, parts=1, **how):
        """Of a run in parts of the steps, in the largest place."""
        model = ancf.Model()
        body = model.add_point_mass("body", at=(0, 0, 0), mass=self.mass)
        model.hold(body, position="yz")
        model.add_spring(body, (-1, 0, 0), length=1.0, stiffness=self.k, damping=self.c)
        model.add_force(body, (model.add_input("u", FIRST), 0, 0))
        body.set_motion(velocity=(SPEED, 0, 0))
        self.times = []
        given = {"controller": Delayed(self.control, self.late), "control_step": self.every * self.h}
        given |= {"step": self.h / parts, "output_step": self.h, "t_end": STEPS * self.h} | how
        found, wanted = ancf.simulate(model, **given).position(body)[:, 0], self.exactly()
        return np.max(np.abs(found - wanted)) / np.max(np.abs(wanted))


@pytest.mark.parametrize("seed", range(10))
def test_as_a_plain_loop(seed):
    """Radau's steps see the value that holds in them; others go to it within a step, of first order."""
    loop = Loop(seed)
    assert loop.off(integrator=ancf.Radau(adaptive=False)) < 1e-9
    wanted = loop.every * loop.h * np.arange(-(-STEPS // loop.every))
    assert loop.times == pytest.approx(wanted, abs=1e-12)
    for method in (ancf.Trapezoidal(), ancf.GeneralizedAlpha(0.9), ancf.Explicit(check=False)):
        coarse, fine = (loop.off(parts, integrator=method) for parts in (2, 4))
        assert coarse < 1e-2
        assert 0.4 * coarse < fine < 0.6 * coarse
        assert loop.times == pytest.approx(wanted, abs=1e-12)
