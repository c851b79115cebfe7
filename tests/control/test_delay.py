"""A controller behind a dead time: a mass by its closed form, what the controller sees, names."""

import numpy as np
import pytest

import ancf
from ancf.control.delay import Delayed
from ancf.errors import ModelError


def pushed():
    """A free mass of 2 kg with an input for its force."""
    model = ancf.Model()
    mass = model.add_point_mass("mass", at=(0.0, 0.0, 0.0), mass=2.0)
    model.add_force(mass, (model.add_input("thrust"), 0.0, 0.0))
    return model, mass


@pytest.mark.parametrize(("delay", "acts"), [(0.0, 0.0), (0.03, 0.03), (0.025, 0.03), (0.1, 0.1)])
def test_acts_later(delay, acts):
    """A force of 6 N from the beginning: v = 3 (t - delay), the delay in whole control steps."""

    def push(run):
        run.inputs["thrust"] = 6.0

    model, mass = pushed()
    result = ancf.simulate(model, t_end=0.2, step=1e-3, controller=Delayed(push, delay), control_step=0.01)
    told = 3.0 * np.maximum(result.t - acts, 0.0)
    assert result.velocity(mass)[:, 0] == pytest.approx(told, abs=2e-3)


def test_sees_what_it_gave():
    """An integrator that counts on its own last value climbs whatever the delay."""
    seen = []

    def climb(run):
        seen.append(run.inputs["thrust"])
        run.inputs["thrust"] += 1.0

    model, _ = pushed()
    ancf.simulate(model, t_end=0.05, step=1e-3, controller=Delayed(climb, 0.02), control_step=0.01)
    assert seen == [float(k) for k in range(len(seen))]
    assert len(seen) >= 5


def test_refused():
    with pytest.raises(ModelError, match="delay"):
        Delayed(lambda run: None, -0.1)
