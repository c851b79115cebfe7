"""Random models by all methods: the same motion, with half the step a quarter of the difference."""

import numpy as np
import pytest

import ancf
from random_models import RandomModel

T_END = 0.04
#: All kinds of bodies, supports and joints; 30 and 55 have clamps that turn and sliding joints with friction.
SEEDS = [2, 5, 17, 30, 55, 120]


def ends(model, **how):
    """Places of all points of a model at the end."""
    run = ancf.simulate(model.model, t_end=T_END, **how)
    return np.array([run.position(point)[-1] for point in model.points])


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("seed", SEEDS)
def test_all_methods_agree(seed):
    model = RandomModel(seed)
    wanted = ends(model, step=1e-4, integrator=ancf.Radau(tolerance=1e-9))
    way = np.abs(wanted - [point.initial_position for point in model.points]).max()
    off = [np.abs(ends(model, step=step) - wanted).max() for step in (2e-4, 1e-4, 5e-5)]
    assert 3.0 < off[0] / off[1] < 5.0
    assert 3.0 < off[1] / off[2] < 5.0
    assert off[2] < 1e-3 * way
    smooth = ends(model, step=5e-5, integrator=ancf.GeneralizedAlpha(rho_inf=0.8))
    assert np.abs(smooth - wanted).max() < 10.0 * off[2]
