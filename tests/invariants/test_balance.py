"""Newton and Euler: all that answers say of what acts from outside changes the momenta, or is in balance."""

import numpy as np
import pytest

import ancf
from random_models import RandomModel

#: Soft beams under loads that follow, without a path of equilibria to the whole load.
WITHOUT = {5, 14}
#: Of the forces: in each step Newton's method may leave 1e-5 of the largest acceleration where points slide.
LEFT = 20 * 1e-5
EXACT = ancf.Trapezoidal(newton=ancf.Newton(tolerance=1e-14))


@pytest.mark.parametrize("seed", range(40))
def test_in_motion(seed):
    """In trapezoidal steps the momentum changes by the mean force, the angular one nearly so."""
    made, errors = RandomModel(seed), []
    for step in (1e-4, 5e-5):
        run = ancf.simulate(made.model, t_end=20 * step, step=step, integrator=EXACT)
        force, moment, size = made.acting(run, run.t)
        for given, changed in ((force, run.momentum), (moment, run.angular_momentum((0, 0, 0)))):
            left = np.diff(changed, axis=0) / step - 0.5 * (given[1:] + given[:-1])
            errors.append(float(np.max(np.abs(left[2:]))) / size)
    assert max(errors[0], errors[2]) < LEFT
    assert errors[3] < LEFT or errors[3] < 0.4 * errors[1]


@pytest.mark.parametrize("seed", sorted(set(range(40)) - WITHOUT))
def test_at_rest(seed):
    """Whatever given motions do next."""
    made = RandomModel(seed, loose=False)
    state = ancf.equilibrium(made.model)
    force, moment, size = made.acting(state, 0.0)
    assert np.max(np.abs(force)) < 1e-7 * size
    assert np.max(np.abs(moment)) < 1e-7 * size


def test_a_joint_whose_direction_has_vanished_balances_nothing():
    """A soft beam's end turned until the planar joint there had no normal left, with a force of 1e11 N."""
    made = RandomModel(31, loose=False, corners=False)
    state = ancf.equilibrium(made.model)
    force, moment, size = made.acting(state, 0.0)
    assert size < 1e3
    assert np.max(np.abs(force)) < 1e-7 * size
    assert np.max(np.abs(moment)) < 1e-7 * size
